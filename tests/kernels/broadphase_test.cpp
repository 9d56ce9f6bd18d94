// The search: all pairs within the margins of both, once, whatever the grid.
#include "kernels/broadphase.h"
#include <gtest/gtest.h>
#include <limits>
#include "kernels/cell_grid.h"
#include "tests/kernels/spheres.h"

namespace skred {
namespace {

// The pairs found; checks that each is with its lower id, once, and in order.
template <class Space> Pairs neighbours(World& w, const Space& space, double cell, VectorPath path = VectorPath::scalar) {
  std::get<Search>(w).due.data[0] = 1;
  call(Broadphase<Space>{space, cell, near_loop<Space>(path)}, w);
  const Particles& p = std::get<Particles>(w);
  const Neighbours& list = std::get<Neighbours>(w);
  const Neighbourhood& of = std::get<Neighbourhood>(w);
  EXPECT_EQ(of.first.data.size(), p.rows() + 1);
  EXPECT_EQ(of.first.data[p.rows()], list.rows());
  Pairs out;
  for (std::size_t a = 0; a < p.rows(); ++a)
    for (Index e = of.first.data[a]; e < of.first.data[a + 1]; ++e) {
      EXPECT_LT(p.id.data[a], list.id.data[e]);
      EXPECT_EQ(list.id.data[e], p.id.data[list.row.data[e]]);
      EXPECT_TRUE(out.insert({p.id.data[a], list.id.data[e]}).second) << "found twice";
    }
  EXPECT_EQ(out.size(), list.rows());
  return out;
}

TEST(Broadphase, FindsEveryPairOnce) {
  for (const double cell : {least_cell, 2.9, 40.0}) {
    World w = random_spheres(800, 12, 3);
    EXPECT_EQ(neighbours(w, OpenSpace{}, cell), by_brute_force(w, OpenSpace{}, &Particles::search_margin)) << cell;
  }
}

TEST(Broadphase, EveryPathFindsTheSame) {
  const PeriodicSpace box{{0, 0, 0}, {12, 12, 12}};
  for (const VectorPath path : vector_paths())
    for (const int n : {1, 9, 800}) {
      World w = random_spheres(n, 12, 3);
      EXPECT_EQ(neighbours(w, OpenSpace{}, least_cell, path), by_brute_force(w, OpenSpace{}, &Particles::search_margin)) << name_of(path);
      EXPECT_EQ(neighbours(w, box, least_cell, path), by_brute_force(w, box, &Particles::search_margin)) << name_of(path);
    }
}

TEST(Broadphase, MarginsOfBothCount) {
  World w = random_spheres(2, 1, 1);
  Particles& p = std::get<Particles>(w);
  p.radius.data = {0.5, 0.25};
  p.position.data = {{0, 0, 0}, {0.85, 0, 0}};               // a gap of 0.1
  for (const auto& [one, other, near] : {std::tuple{0.1, 0.01, true}, {0.01, 0.1, true}, {0.06, 0.06, true}, {0.04, 0.04, false}}) {
    p.search_margin.data = {one, other};
    EXPECT_EQ(neighbours(w, OpenSpace{}, least_cell).size(), near ? 1u : 0u) << one << " " << other;
  }
}

TEST(Broadphase, ListsAreSortedByPartner) {
  World w = random_spheres(800, 12, 5);
  neighbours(w, OpenSpace{}, least_cell);
  const Neighbourhood& of = std::get<Neighbourhood>(w);
  const auto& id = std::get<Neighbours>(w).id.data;
  for (std::size_t p = 0; p + 1 < of.rows(); ++p)
    EXPECT_TRUE(std::is_sorted(id.begin() + of.first.data[p], id.begin() + of.first.data[p + 1])) << p;
}

TEST(Broadphase, PeriodicDirections) {
  for (const double edge : {12.0, 5.0, 3.4}) {               // many cells, three, two along a direction
    World w = random_spheres(edge > 10 ? 800 : 60, edge, 9);
    const double infinite = std::numeric_limits<double>::infinity();
    const PeriodicSpace all{{0, 0, 0}, {edge, edge, edge}}, one{{0, 0, 0}, {infinite, edge, infinite}};
    EXPECT_EQ(neighbours(w, all, least_cell), by_brute_force(w, all, &Particles::search_margin)) << edge;
    EXPECT_EQ(neighbours(w, one, least_cell), by_brute_force(w, one, &Particles::search_margin)) << edge;
  }
}

// A bed and a few particles very far away: memory stays bounded and nothing is missed.
TEST(Broadphase, FarParticlesCostNoMemory) {
  World w = random_spheres(3000, 15, 1);
  Particles& p = std::get<Particles>(w);
  p.position.data[17] = {1e9, -3e8, 5};
  p.position.data[18] = {1e9, -3e8, 5.1};
  p.position.data[19] = {-1e12, 4, 4};
  EXPECT_EQ(neighbours(w, OpenSpace{}, least_cell), by_brute_force(w, OpenSpace{}, &Particles::search_margin));
  EXPECT_LT(std::get<CellGrid>(w).start.data.size(), 5 * p.rows() + 100);
}

TEST(Broadphase, NoParticlesAndOne) {
  for (const int n : {0, 1, 2}) {
    World w = random_spheres(n, 1, 1);
    EXPECT_EQ(neighbours(w, OpenSpace{}, least_cell), by_brute_force(w, OpenSpace{}, &Particles::search_margin)) << n;
  }
}

TEST(Broadphase, KeepsTheOldListUntilASearchIsDue) {
  World w = random_spheres(50, 3, 2);
  neighbours(w, OpenSpace{}, least_cell);
  const Buffer<Index> before = std::get<Neighbours>(w).row.data;
  ASSERT_FALSE(before.empty());
  for (Vec3& x : std::get<Particles>(w).position.data) x *= 100.0;
  std::get<Search>(w).due.data[0] = 0;
  call(Broadphase<OpenSpace>{{}, least_cell}, w);
  EXPECT_EQ(std::get<Neighbours>(w).row.data, before);
}

}  // namespace
}  // namespace skred
