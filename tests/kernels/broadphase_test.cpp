// The search: all pairs within the skin, once, whatever the grid.
#include "kernels/broadphase.h"
#include <gtest/gtest.h>
#include <random>
#include <set>
#include "kernels/cell_grid.h"

namespace skred {
namespace {

using Pairs = std::set<std::pair<Index, Index>>;

template <class Space> Pairs listed(World& w, const Space& space, double skin, double cell, double largest) {
  char due = 1;
  Particles& p = std::get<Particles>(w);
  const Broadphase<Space> kernel{space, skin, cell, largest, {}};
  kernel(Parallel{}, {{&due, 1}}, {p.id.data}, {p.position.data}, {p.radius.data}, {&std::get<CellGrid>(w)},
         {&std::get<Contacts>(w)}, {&std::get<PreviousContacts>(w)}, {&std::get<Incidence>(w)});
  Pairs out;
  const Contacts& c = std::get<Contacts>(w);
  for (std::size_t k = 0; k < c.rows(); ++k) {
    const Index a = p.id.data[c.i.data[k]], b = p.id.data[c.j.data[k]];
    EXPECT_LT(a, b);
    EXPECT_EQ(c.partner.data[k], b);
    EXPECT_TRUE(out.insert({a, b}).second) << "listed twice";
  }
  return out;
}

template <class Space> Pairs by_brute_force(const World& w, const Space& space, double skin) {
  const Particles& p = std::get<Particles>(w);
  Pairs out;
  for (Index a = 0; a < p.rows(); ++a)
    for (Index b = 0; b < p.rows(); ++b) {
      const double near = p.radius.data[a] + p.radius.data[b] + skin;
      const Vec3 d = space.shortest(p.position.data[a] - p.position.data[b]);
      if (p.id.data[a] < p.id.data[b] && dot(d, d) < near * near) out.insert({p.id.data[a], p.id.data[b]});
    }
  return out;
}

World random_spheres(int n, double edge, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0, 1);
  World w;
  Particles& p = std::get<Particles>(w);
  for (Index k = 0; k < Index(n); ++k) {
    p.id.data.push_back(k);
    p.position.data.push_back({edge * u(random), edge * u(random), edge * u(random)});
    p.radius.data.push_back(0.3 + 0.4 * u(random));
  }
  std::shuffle(p.id.data.begin(), p.id.data.end(), random);
  return w;
}

TEST(Broadphase, FindsEveryPairOnce) {
  for (const double cell : {1.6, 2.9, 40.0}) {
    World w = random_spheres(800, 12, 3);
    EXPECT_EQ(listed(w, OpenSpace{}, 0.2, cell, 0.7), by_brute_force(w, OpenSpace{}, 0.2)) << cell;
  }
}

TEST(Broadphase, ListsAreSortedByPartner) {
  World w = random_spheres(800, 12, 5);
  listed(w, OpenSpace{}, 0.2, 1.6, 0.7);
  const auto& in = std::get<Incidence>(w);
  const auto& c = std::get<Contacts>(w);
  const auto& id = std::get<Particles>(w).id.data;
  std::size_t seen = 0;
  for (std::size_t p = 0; p < id.size(); ++p) {
    std::vector<Index> partners;
    for (Index k = in.first_lower.data[p]; k < in.first_lower.data[p + 1]; ++k) {
      EXPECT_EQ(c.j.data[in.lower.data[k]], p);
      partners.push_back(id[c.i.data[in.lower.data[k]]]);
    }
    for (Index k = in.first.data[p]; k < in.first.data[p + 1]; ++k) partners.push_back(c.partner.data[k]);
    EXPECT_TRUE(std::is_sorted(partners.begin(), partners.end()));
    seen += partners.size();
  }
  EXPECT_EQ(seen, 2 * c.rows());
}

TEST(Broadphase, PeriodicDirections) {
  for (const double edge : {12.0, 5.0, 3.4}) {               // many cells, three, two along a direction
    World w = random_spheres(edge > 10 ? 800 : 60, edge, 9);
    const double infinite = std::numeric_limits<double>::infinity();
    const PeriodicSpace all{{0, 0, 0}, {edge, edge, edge}}, one{{0, 0, 0}, {infinite, edge, infinite}};
    EXPECT_EQ(listed(w, all, 0.2, 1.6, 0.7), by_brute_force(w, all, 0.2)) << edge;
    EXPECT_EQ(listed(w, one, 0.2, 1.6, 0.7), by_brute_force(w, one, 0.2)) << edge;
  }
}

// A bed and a few particles very far away: memory stays bounded and nothing is missed.
TEST(Broadphase, FarParticlesCostNoMemory) {
  World w = random_spheres(3000, 15, 1);
  Particles& p = std::get<Particles>(w);
  p.position.data[17] = {1e9, -3e8, 5};
  p.position.data[18] = {1e9, -3e8, 5.1};
  p.position.data[19] = {-1e12, 4, 4};
  EXPECT_EQ(listed(w, OpenSpace{}, 0.2, 1.6, 0.7), by_brute_force(w, OpenSpace{}, 0.2));
  EXPECT_LT(std::get<CellGrid>(w).start.data.size(), 5 * p.rows() + 100);
}

TEST(Broadphase, NoParticlesAndOne) {
  for (const int n : {0, 1, 2}) {
    World w = random_spheres(n, 1, 1);
    EXPECT_EQ(listed(w, OpenSpace{}, 0.2, 1.6, 0.7).size(), n == 2 ? by_brute_force(w, OpenSpace{}, 0.2).size() : 0u);
  }
}

}  // namespace
}  // namespace skred
