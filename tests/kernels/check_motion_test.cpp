// When a search or a listing is due, the margins that follow, and what watching the motion finds.
#include "kernels/check_motion.h"
#include <gtest/gtest.h>
#include <limits>
#include "kernels/broadphase.h"
#include "kernels/contact_listing.h"
#include "kernels/reorder.h"
#include "tests/kernels/spheres.h"

namespace skred {
namespace {

constexpr double step = 0.01;                                // [s]
constexpr Margins margins{.list_steps = 5, .list_rest = 0.01, .search_steps = 25, .search_rest = 0.05, .largest = 0.1, .walls = 0.1};

// Spheres at rest in a row, found and listed where they are.
struct Watched {
  World w;
  Particles& p = std::get<Particles>(w);
  Bodies& b = std::get<Bodies>(w);
  Geometries& g = std::get<Geometries>(w);
  Search& s = std::get<Search>(w);
  CheckMotion<OpenSpace> kernel{{}, margins, step, false, {}, true};

  explicit Watched(int n) {
    for (int k = 0; k < n; ++k) {
      p.id.data.push_back(Index(n - 1 - k));                 // rows are not ids
      p.position.data.push_back({1.0 * k, 0, 0});
      p.velocity.data.push_back({});
      p.radius.data.push_back(0.4);
    }
    p.searched.data = p.listed.data = p.position.data;
    p.search_margin.data.resize(p.rows());
    p.list_margin.data.resize(p.rows());
    check();
  }
  // A body of one geometry, where it was when places at walls were last searched for.
  void body(Motion motion, Shape shape) {
    b.motion.data = {motion};
    b.pose.data = b.searched.data = {Pose{}};
    g.body.data = {0};
    g.shape.data = {std::move(shape)};
    g.local.data = {Pose{}};
    kernel.extent = extent_of_bodies(b, g);
  }
  void check() { call(kernel, w); }
  bool search_due() { check(); return s.due.data[0]; }
  bool list_due() { check(); return s.list_due.data[0]; }
  Trouble trouble() { check(); return s.trouble.data[0]; }
};

TEST(CheckMotion, TheFirstStepSearchesAndLists) {
  Watched w(9000);
  EXPECT_TRUE(w.s.due.data[0] && w.s.list_due.data[0]);
  EXPECT_EQ(w.s.count.data[0], 1);
  EXPECT_EQ(w.s.listings.data[0], 1);
  EXPECT_EQ(w.s.reach.data[0], 8999 + 0.4);
  w.check();                                                 // nobody moved
  EXPECT_FALSE(w.s.due.data[0] || w.s.list_due.data[0]);
  EXPECT_EQ(w.s.count.data[0], 1);
  EXPECT_EQ(w.s.listings.data[0], 1);
  Watched none(0);
  EXPECT_TRUE(none.s.due.data[0]);
  EXPECT_FALSE(none.list_due());
}

TEST(CheckMotion, ListingIsDueWhenAParticleLeavesItsMargin) {
  Watched w(9000);
  w.p.position.data[8000].y = 0.0099;
  EXPECT_FALSE(w.list_due());
  w.p.position.data[8000].y = 0.0101;
  EXPECT_TRUE(w.list_due());
  EXPECT_FALSE(w.s.due.data[0]);
  EXPECT_EQ(w.p.listed.data, w.p.position.data);
  EXPECT_EQ(w.p.searched.data[8000].y, 0) << "where it was at the search";
  EXPECT_FALSE(w.list_due()) << "it was listed where it is";
  EXPECT_EQ(w.s.listings.data[0], 2);
}

TEST(CheckMotion, SearchIsDueWhenAMarginWouldEndOutside) {
  Watched w(9000);
  w.p.position.data[8000].y = 0.0399;                        // and 0.01 from there
  EXPECT_TRUE(w.list_due());
  EXPECT_FALSE(w.s.due.data[0]);
  w.p.position.data[8000].y = 0.0505;
  EXPECT_TRUE(w.list_due());
  EXPECT_TRUE(w.s.due.data[0]);
  EXPECT_EQ(w.p.searched.data, w.p.position.data);
  EXPECT_EQ(w.s.count.data[0], 2);
  EXPECT_FALSE(w.list_due());
}

// Outside by its own speed: it was at rest when it was searched for.
TEST(CheckMotion, SearchIsDueForOneThatBecameFast) {
  Watched w(3);
  w.p.velocity.data[1] = {0, 0, 1};
  EXPECT_FALSE(w.list_due()) << "it is still in its margin";
  w.p.position.data[1].z = 0.011;
  EXPECT_TRUE(w.search_due());                               // 0.011 + (0.01 + 5 steps of 0.01) > 0.05
}

TEST(CheckMotion, MarginsGrowWithSpeed) {
  Watched w(5);
  for (int k = 0; k < 5; ++k) w.p.velocity.data[k] = {0, 0.3 * k, 0.4 * k};     // 0, 0.5, ... 2 m/s
  w.p.position.data[0].x += 1;                               // all is done anew
  EXPECT_TRUE(w.search_due());
  for (int k = 0; k < 5; ++k) {
    EXPECT_NEAR(w.p.list_margin.data[k], std::min(0.01 + 5 * step * 0.5 * k, 0.1), 1e-15) << k;
    EXPECT_NEAR(w.p.search_margin.data[k], std::min(0.05 + 25 * step * 0.5 * k, 0.1), 1e-15) << k;
  }
  EXPECT_EQ(w.p.list_margin.data[4], 0.1);
  EXPECT_EQ(w.p.search_margin.data[2], 0.1);
  EXPECT_LT(w.p.list_margin.data[2], 0.1);
  EXPECT_FALSE(w.list_due()) << "the widest margins end where they may";
}

TEST(CheckMotion, OneFastParticleMakesListingDueRarely) {
  for (const double speed : {0.55, 1.7, 4.0}) {
    Watched w(100);
    w.p.velocity.data[40] = {0, speed, 0};
    const double margin = std::min(0.01 + 5 * step * speed, 0.1);
    const std::int64_t before = w.s.listings.data[0];
    constexpr int steps = 200;
    for (int k = 0; k < steps; ++k) {
      w.p.position.data[40].y += step * speed;
      if (!w.list_due()) continue;
      EXPECT_EQ(w.p.list_margin.data[39], 0.01) << "margins of others are their own";
    }
    const double steps_in_margin = std::floor(margin / (step * speed));
    EXPECT_NEAR(double(w.s.listings.data[0] - before), steps / (steps_in_margin + 1), 2) << speed;
    EXPECT_LE(w.s.count.data[0], w.s.listings.data[0]);
  }
}

TEST(CheckMotion, SearchIsDueWhenABodyMayHaveCome) {
  const auto turned = [](double angle) { return Pose{{}, rotation_by({0, 0, angle})}; };
  Watched w(3);
  w.body(Motion::kinematic, BoxShape{{1, 1, 1}});
  EXPECT_FALSE(w.search_due());
  w.b.pose.data[0] = turned(0.05);                           // its corners come 0.05 * sqrt(3) = 0.087
  EXPECT_FALSE(w.search_due());
  w.b.pose.data[0].position.z = 0.012;
  EXPECT_FALSE(w.search_due());
  w.b.pose.data[0].position.z = 0.015;
  EXPECT_TRUE(w.search_due());
  EXPECT_TRUE(w.s.list_due.data[0]);
  w.b.searched.data = w.b.pose.data;                         // as the search at walls does
  EXPECT_FALSE(w.search_due());
  w.b.pose.data[0].position.x = 0.11;
  EXPECT_TRUE(w.search_due());
  w.b.motion.data[0] = Motion::fixed;
  EXPECT_FALSE(w.search_due());
}

// A plane has no end; the particles do.
TEST(CheckMotion, ATurningPlaneComesAsFarAsTheParticlesReach) {
  Watched w(11);                                             // up to 10.4 m from its axis
  w.body(Motion::dynamic, PlaneShape{});
  w.b.pose.data[0].orientation = rotation_by({0, 0.009, 0});
  EXPECT_FALSE(w.search_due());
  w.b.pose.data[0].orientation = rotation_by({0, 0.0097, 0});
  EXPECT_TRUE(w.search_due());
}

TEST(CheckMotion, NamesTheLowestIdInTheGravestTrouble) {
  Watched w(9000);
  EXPECT_EQ(w.trouble(), Trouble::none);
  EXPECT_EQ(w.s.culprit.data[0], no_index);
  w.p.velocity.data[4] = {0, 21, 0};                         // 0.21 m in a step of 0.01 s, radius 0.4 m
  w.p.velocity.data[7777] = {0, 0, -30};
  EXPECT_EQ(w.trouble(), Trouble::too_fast);
  EXPECT_EQ(w.s.culprit.data[0], w.p.id.data[7777]);
  w.p.position.data[100].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(w.trouble(), Trouble::not_finite);
  EXPECT_EQ(w.s.culprit.data[0], w.p.id.data[100]);
  EXPECT_FALSE(w.s.due.data[0] || w.s.list_due.data[0]);     // there is nowhere to search
}

TEST(CheckMotion, WhatIsNotANumberIsSeenInVelocitiesToo) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Watched w(3);
    w.p.velocity.data[1].z = bad;
    EXPECT_EQ(w.trouble(), Trouble::not_finite);
    EXPECT_EQ(w.s.culprit.data[0], w.p.id.data[1]);
  }
}

TEST(CheckMotion, Bounds) {
  Watched w(3);
  w.kernel.bounded = true;
  w.kernel.bounds = {{-0.5, -0.5, -0.5}, {1.5, 0.5, 0.5}};
  EXPECT_EQ(w.trouble(), Trouble::out_of_bounds);
  EXPECT_EQ(w.s.culprit.data[0], w.p.id.data[2]);
  w.kernel.stop_outside = false;
  EXPECT_EQ(w.trouble(), Trouble::none);
  EXPECT_EQ(w.s.outside.data[0], 1);
}

Pairs touching(const World& w, const auto& space) {
  World bare = w;
  auto& none = std::get<Particles>(bare).list_margin.data;
  std::fill(none.begin(), none.end(), 0.0);
  return by_brute_force(bare, space, &Particles::list_margin);
}

Pairs listed(const World& w) {
  const auto& id = std::get<Particles>(w).id.data;
  const Contacts& c = std::get<Contacts>(w);
  Pairs out;
  for (std::size_t k = 0; k < c.rows(); ++k) out.insert({id[c.i.data[k]], id[c.j.data[k]]});
  return out;
}

bool contains(const Pairs& all, const Pairs& some) { return std::includes(all.begin(), all.end(), some.begin(), some.end()); }

// Particles fly through each other, one of them fast and one slower and slower, with the kernels that a step has.
template <class Space> void fly(const Space& space) {
  World w = random_spheres(300, 9, 8);
  Particles& p = std::get<Particles>(w);
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 0.3);
  constexpr Index slowing = 18;                              // id
  for (Vec3& v : p.velocity.data) v = {normal(random), normal(random), normal(random)};
  p.velocity.data[17] = {2, -1.5, 1};
  for (std::size_t k = 20; k < 60; ++k) p.velocity.data[k] = {};
  for (std::size_t a = 0; a < p.rows(); ++a)
    if (p.id.data[a] == slowing) p.velocity.data[a] = {0, 12, 1};
  const Search& s = std::get<Search>(w);
  constexpr double fine_step = 0.002;                        // [s]
  std::int64_t in_vain = 0, without_search = 0;
  constexpr int steps = 400;
  for (int k = 0; k < steps; ++k) {
    call(CheckMotion<Space>{space, margins, fine_step, false, {}, true}, w);
    call(Reorder{least_cell, 3}, w);
    call(Broadphase<Space>{space, least_cell}, w);
    call(ContactListing<Space>{space, {}}, w);
    ASSERT_EQ(s.trouble.data[0], Trouble::none);
    const Pairs now = listed(w);
    if (s.list_due.data[0]) {
      ASSERT_EQ(now, by_brute_force(w, space, &Particles::list_margin)) << "step " << k;
      if (!s.due.data[0]) ++without_search;
    }
    const Pairs touch = touching(w, space);
    ASSERT_TRUE(contains(now, touch)) << "step " << k;
    in_vain += now.size() > touch.size();
    for (std::size_t a = 0; a < p.rows(); ++a) {
      p.velocity.data[a] *= p.id.data[a] == slowing ? 0.99 : 1.0;
      p.position.data[a] = space.wrap(p.position.data[a] + fine_step * p.velocity.data[a]);
    }
  }
  EXPECT_GT(without_search, 10);
  EXPECT_GT(in_vain, steps / 2);
  EXPECT_LT(s.count.data[0], s.listings.data[0]);
  EXPECT_LT(s.listings.data[0], steps);
}

// In smooth DEM the integration watches: a step in which it raised no flag looks at no particle.
TEST(CheckMotion, BelievesTheFlagsOfTheIntegration) {
  Watched w(9000);
  w.kernel.watched_by_integrate = true;
  w.p.position.data[8000].y = 0.0101;
  w.p.velocity.data[7777] = {0, 0, -30};
  EXPECT_FALSE(w.list_due());
  EXPECT_EQ(w.trouble(), Trouble::none);
  w.s.left_margin.data[0] = 1;
  EXPECT_TRUE(w.list_due());
  EXPECT_FALSE(w.list_due()) << "a flag counts once";
  w.s.unwell.data[0] = 1;
  EXPECT_EQ(w.trouble(), Trouble::too_fast);
  EXPECT_EQ(w.s.culprit.data[0], w.p.id.data[7777]);
  EXPECT_EQ(w.trouble(), Trouble::none) << "a flag counts once";
  w.s.rows_changed.data[0] = 1;                              // nobody has watched those that came
  EXPECT_EQ(w.trouble(), Trouble::too_fast);
}

TEST(CheckMotion, NoPairTouchesUnlisted) { fly(OpenSpace{}); }
TEST(CheckMotion, NoPairTouchesUnlistedInAPeriodicBox) { fly(PeriodicSpace{{0, 0, 0}, {9, 9, 9}}); }

}  // namespace
}  // namespace skred
