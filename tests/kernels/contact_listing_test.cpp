// Listing: the near ones of the neighbours, where each particle finds them, and the history that they keep.
#include "kernels/contact_listing.h"
#include <gtest/gtest.h>
#include <map>
#include "kernels/broadphase.h"
#include "kernels/contact_hashing.h"
#include "kernels/reorder.h"
#include "tests/kernels/spheres.h"

namespace skred {
namespace {

template <class Space> void search(World& w, const Space& space) {
  std::get<Search>(w).due.data[0] = 1;
  call(Broadphase<Space>{space, least_cell}, w);
  std::get<Search>(w).due.data[0] = 0;
  std::get<Particles>(w).searched.data = std::get<Particles>(w).position.data;
}

// In the block of i, or among its guests, who are there once each, and once each in the halo of the block where they are at home.
void expect_every_j_has_its_place(const World& w) {
  const Contacts& c = std::get<Contacts>(w);
  const Guests& guests = std::get<Guests>(w);
  const Halo& halo = std::get<Halo>(w);
  const HaloIncidence& of = std::get<HaloIncidence>(w);
  const std::size_t n = std::get<Particles>(w).rows(), blocks = blocks_of(n);
  ASSERT_TRUE(of.guests.data.size() == blocks + 1 && of.halo.data.size() == blocks + 1);
  EXPECT_EQ(of.guests.data[blocks], guests.rows());
  EXPECT_EQ(std::get<ContactSums>(w).force.data.size(), n);
  EXPECT_TRUE(halo.rows() == guests.rows() && halo.sum.data.size() == guests.rows());
  std::vector<Index> met(guests.rows());
  for (std::size_t k = 0; k < c.rows(); ++k) {
    const std::size_t block = c.i.data[k] / contact_block, place = c.place_of_j.data[k];
    if (place < contact_block) {
      EXPECT_EQ(block * contact_block + place, c.j.data[k]);
      continue;
    }
    const std::size_t g = of.guests.data[block] + place - contact_block;
    ASSERT_LT(g, of.guests.data[block + 1]);
    EXPECT_NE(c.j.data[k] / contact_block, block);
    EXPECT_EQ(guests.particle.data[g], c.j.data[k]);
    ++met[g];
  }
  EXPECT_EQ(std::count(met.begin(), met.end(), Index{0}), 0);
  for (std::size_t block = 0; block < blocks; ++block) {
    const auto first = guests.particle.data.begin() + of.guests.data[block], last = guests.particle.data.begin() + of.guests.data[block + 1];
    EXPECT_EQ(std::set<Index>(first, last).size(), std::size_t(last - first));
  }
  std::set<Index> rows;
  for (std::size_t g = 0; g < guests.rows(); ++g) {
    const Index p = guests.particle.data[g], row = guests.halo_row.data[g];
    EXPECT_EQ(halo.particle.data[row], p);
    EXPECT_TRUE(of.halo.data[p / contact_block] <= row && row < of.halo.data[p / contact_block + 1]);
    rows.insert(row);
  }
  EXPECT_EQ(rows.size(), guests.rows());
}

// The pairs listed; checks the columns and the places of a particle's contacts against each other.
template <class Space> Pairs listed(World& w, const Space& space, ContactColumns columns = {.sums = true}) {
  std::get<Search>(w).list_due.data[0] = 1;
  call(ContactListing<Space>{space, columns}, w);
  const auto& id = std::get<Particles>(w).id.data;
  const Contacts& c = std::get<Contacts>(w);
  const Incidence& in = std::get<Incidence>(w);
  Pairs out;
  EXPECT_EQ(in.first.data.size(), id.size() + 1);
  EXPECT_EQ(in.first.data[id.size()], c.rows());
  for (std::size_t p = 0; p < id.size(); ++p)
    for (Index k = in.first.data[p]; k < in.first.data[p + 1]; ++k) {
      EXPECT_EQ(c.i.data[k], p);
      EXPECT_EQ(c.partner.data[k], id[c.j.data[k]]);
      EXPECT_TRUE(k == in.first.data[p] || c.partner.data[k - 1] < c.partner.data[k]);
      EXPECT_TRUE(out.insert({id[p], c.partner.data[k]}).second) << "listed twice";
    }
  EXPECT_EQ(out.size(), c.rows());
  if (columns.sums) expect_every_j_has_its_place(w);
  return out;
}

// So that every particle's margin still ends within that of the search.
void move_within_margins(World& w, const auto& space, std::mt19937& random) {
  Particles& p = std::get<Particles>(w);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> u(0, 1);
  for (std::size_t k = 0; k < p.rows(); ++k) {
    p.list_margin.data[k] = u(random) * p.search_margin.data[k];
    const double way = u(random) * (p.search_margin.data[k] - p.list_margin.data[k]);
    p.position.data[k] = space.wrap(p.searched.data[k] + way * normalized(Vec3{normal(random), normal(random), normal(random)}));
  }
}

template <class Space> void expect_lists_equal_brute_force(const Space& space, int n, double edge) {
  World w = random_spheres(n, edge, 4);
  std::mt19937 random(6);
  search(w, space);
  for (int round = 0; round < 20; ++round) {
    if (round % 7 == 6) search(w, space);
    const Pairs now = listed(w, space);
    EXPECT_EQ(now, by_brute_force(w, space, &Particles::list_margin)) << round;
    EXPECT_LT(now.size(), std::get<Neighbours>(w).rows());
    move_within_margins(w, space, random);
  }
}

TEST(ContactListing, ListsEqualBruteForce) { expect_lists_equal_brute_force(OpenSpace{}, 1500, 12); }    // more than one chunk

TEST(ContactListing, PeriodicDirections) {
  const double infinite = std::numeric_limits<double>::infinity();
  expect_lists_equal_brute_force(PeriodicSpace{{0, 0, 0}, {7, 7, 7}}, 300, 7);
  expect_lists_equal_brute_force(PeriodicSpace{{0, 0, 0}, {infinite, 3.4, infinite}}, 60, 3.4);
}

TEST(ContactListing, NoParticlesAndOne) {
  for (const int n : {0, 1, 2}) {
    World w = random_spheres(n, 1, 1);
    search(w, OpenSpace{});
    EXPECT_EQ(listed(w, OpenSpace{}), by_brute_force(w, OpenSpace{}, &Particles::list_margin)) << n;
  }
}

TEST(ContactListing, OnlyTheColumnsThatLawsNeed) {
  World w = random_spheres(60, 3, 1);
  search(w, OpenSpace{});
  const Contacts& c = std::get<Contacts>(w);
  for (int bits = 0; bits < 32; ++bits) {
    const ContactColumns columns{.sums = bool(bits & 1), .torque = bool(bits & 8), .spring = bool(bits & 2), .rolling = bool(bits & 4), .memory = bool(bits & 16)};
    const std::size_t n = listed(w, OpenSpace{}, columns).size();
    ASSERT_GT(n, 0u);
    EXPECT_EQ(c.force.data.size(), n);
    EXPECT_EQ(c.place_of_j.data.size(), columns.sums ? n : 0);
    EXPECT_EQ(c.spring.data.size(), columns.spring ? n : 0);
    EXPECT_EQ(c.rolling.data.size(), columns.rolling ? n : 0);
    EXPECT_EQ(std::get<ContactSums>(w).force.data.size(), columns.sums ? 60 : 0);
    EXPECT_EQ(std::get<ContactSums>(w).torque.data.size(), columns.sums && columns.torque ? 60 : 0);
    EXPECT_EQ(c.memory.data.size(), columns.memory ? n : 0);
  }
}

TEST(ContactListing, KeepsTheOldListUntilAListingIsDue) {
  World w = random_spheres(60, 3, 1);
  search(w, OpenSpace{});
  const Pairs before = listed(w, OpenSpace{});
  for (Vec3& x : std::get<Particles>(w).position.data) x *= 100.0;
  std::get<Search>(w).list_due.data[0] = 0;
  call(ContactListing<OpenSpace>{}, w);
  EXPECT_EQ(std::get<Contacts>(w).rows(), before.size());
}

struct History { Vec3 spring, rolling; ContactMemory memory; };

// Listings one after another, some after a search, some after the rows were sorted: what stays listed keeps its history.
template <bool spring, bool rolling, bool memory = false> void expect_history_kept() {
  World w = random_spheres(400, 7, 12);
  Particles& p = std::get<Particles>(w);
  Contacts& c = std::get<Contacts>(w);
  Search& s = std::get<Search>(w);
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  const auto any = [&] { return Vec3{normal(random), normal(random), normal(random)}; };
  std::map<std::pair<Index, Index>, History> before;
  int kept = 0, fresh = 0, sorted = 0, came_back = 0;
  Pairs ever;
  for (int round = 0; round < 40; ++round) {
    s.due.data[0] = round % 3 == 0;
    s.count.data[0] += s.due.data[0];
    if (s.due.data[0])                                       // as if many steps had gone by
      for (Vec3& x : p.position.data) x += 0.03 * any();
    else move_within_margins(w, OpenSpace{}, random);
    std::get<Clock>(w).step.data[0] = round;
    call(Reorder{least_cell, 6}, w);
    const auto& rows = p.previous_row.data;
    sorted += s.reordered.data[0] && !std::is_sorted(rows.begin(), rows.end());
    if (s.due.data[0]) search(w, OpenSpace{});
    listed(w, OpenSpace{}, {.sums = true, .spring = spring, .rolling = rolling, .memory = memory});
    call(ContactHashing<spring, rolling, memory>{}, w);

    std::map<std::pair<Index, Index>, History> now;
    for (std::size_t k = 0; k < c.rows(); ++k) {
      const std::pair pair{p.id.data[c.i.data[k]], c.partner.data[k]};
      const auto old = before.find(pair);
      const bool known = old != before.end();
      const History want = known ? old->second : History{};
      ++(known ? kept : fresh);
      came_back += !known && !ever.insert(pair).second;
      if constexpr (spring) { EXPECT_EQ(c.spring.data[k], want.spring); c.spring.data[k] = any(); now[pair].spring = c.spring.data[k]; }
      if constexpr (rolling) { EXPECT_EQ(c.rolling.data[k], want.rolling); c.rolling.data[k] = any(); now[pair].rolling = c.rolling.data[k]; }
      if constexpr (memory) {
        EXPECT_EQ(c.memory.data[k], want.memory);
        c.memory.data[k] = {normal(random), any(), any(), any()};
        now[pair].memory = c.memory.data[k];
      }
    }
    before = std::move(now);
  }
  EXPECT_GT(kept, 10000);
  EXPECT_GT(fresh, 1000);
  EXPECT_GT(came_back, 100);
  EXPECT_GE(sorted, 5);
}

TEST(ContactListing, HistoryIsKeptOfWhatStaysListed) { expect_history_kept<true, true>(); }
TEST(ContactListing, HistoryOfSpringsAlone) { expect_history_kept<true, false>(); }
TEST(ContactListing, HistoryOfRollingAlone) { expect_history_kept<false, true>(); }
TEST(ContactListing, HistoryOfAChosenLaw) { expect_history_kept<false, false, true>(); }

}  // namespace
}  // namespace skred
