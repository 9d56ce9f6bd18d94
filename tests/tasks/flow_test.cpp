// tests/tasks/flow_test.cpp - particles that come and go leave the others as they are, and the same bits everywhere.
#include <gtest/gtest.h>
#include <algorithm>
#include <map>
#include "tests/physics/lab.h"

namespace skred::lab {
namespace {

constexpr double R = pellet_radius;

Lab with_method(Lab l, Method method) {
  l.model.method = method;
  if (method == Method::ndem) l.model.time_step = 5e-4;
  return l;
}

// A cloud that falls into a turning drum with a mesh for a floor.
Lab stirred(Method method) {
  Lab l(0.18, 0.91, 0.3211);
  l.model.gravity = {0, 0, -9.81};
  add_cloud(l, 5, 2.1 * R, 11, 1.0);
  const double size = 14 * R;
  l.body(HollowCylinderShape{0.5 * size, size, 0.02}, {}, Motion::kinematic);
  l.model.pieces = {{MotionPiece{0, 1, {0, 0, 0}, {0, 0, 8}, {}}}, {}};
  l.body(MeshShape{std::make_shared<Mesh>(std::vector<Vec3>{{-0.2, -0.2, -0.03}, {0.2, -0.2, -0.03}, {0.2, 0.2, -0.035}, {-0.2, 0.2, -0.03}},
                                          std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}})});
  return with_method(l, method);
}

Inflow from_above(double rate) {
  Inflow f;
  f.region = CylinderRegion{{0, 0, 0.06}, {0, 0, 1}, 0.04, 0.04};
  f.rate = rate;
  f.radius_min = 0.8 * R, f.radius_max = R;
  f.density = pellet_density;
  f.velocity = {0, 0, -0.5};
  f.seed = 3;
  return f;
}

struct State { Vec3 x, v, w, force; };
bool operator==(const State& a, const State& b) { return a.x == b.x && a.v == b.v && a.w == b.w && a.force == b.force; }
std::map<Index, State> states(const Simulation& s) {
  const Particles& p = std::get<Particles>(s.world());
  std::map<Index, State> out;
  for (std::size_t r = 0; r < p.rows(); ++r)
    out[p.id.data[r]] = {p.position.data[r], p.velocity.data[r], p.angular_velocity.data[r], p.force.data[r]};
  return out;
}

void run(Simulation& s, int steps) {
  s.start();
  for (int k = 0; k < steps; ++k) s.step();
}

class BothMethods : public ::testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(Flow, BothMethods, ::testing::Values(Method::sdem, Method::ndem),
                         [](const auto& given) { return given.param == Method::sdem ? "Smooth" : "Nonsmooth"; });

// Far away, particles that touch nothing, of ids between the others' and around them; in the midst of the run they are taken out.
TEST_P(BothMethods, RemovalLeavesTheOthersBitsAlone) {
  Lab l = stirred(GetParam());
  Particles& p = l.particles();
  const auto n = static_cast<Index>(p.rows());
  for (int k = 0; k < 3; ++k) l.sphere({0.5 + 0.1 * k, 0.5, 0.5});
  l.model.pieces.resize(2);
  for (Index k = 0; k < n + 3; ++k) p.id.data.push_back(k);
  std::swap(p.id.data[n], p.id.data[10]);
  std::swap(p.id.data[n + 1], p.id.data[0]);
  const double h = l.model.time_step;
  const auto kept = l.build(2);
  l.model.removers = {{BoxRegion{{0.3, 0.3, -9}, {0.9, 0.9, 9}}, 101 * h}};
  const auto removed = l.build(2);
  run(*kept, 300);
  run(*removed, 300);

  const Removed& table = std::get<Removed>(removed->world());
  EXPECT_EQ(table.count.data[0], 3);
  EXPECT_DOUBLE_EQ(table.mass.data[0], 3 * sphere_mass(R));
  auto expected = states(*kept);
  for (const Index id : {Index{10}, Index{0}, n + 2}) EXPECT_EQ(expected.erase(id), 1u);
  EXPECT_EQ(states(*removed), expected);
  EXPECT_GT(measure(*removed).contacts + measure(*removed).body_contacts, 20u) << "nothing touches: nothing is tested";
}

// A sphere slides and rolls while others go: with its history lost it would not go on as before. With nonsmooth DEM those that go are in
// the air: its sweeps end by the sum of all impulses, so that a contact more or less changes the number of them for all.
TEST_P(BothMethods, ASlidingContactKeepsItsHistory) {
  Lab l(0.5, 0.5, 0.1);
  l.model.gravity = {0, 0, -9.81};
  l.sphere({0, 0, 0.9999 * R}, {0.4, 0, 0});
  l.sphere({0, 0.1, 0.9999 * R}, {0.4, 0, 0}, {0, 30, 0});
  l.sphere({0, -0.1, 0.9999 * R});                                   // and two that lean against each other
  l.sphere({1.999 * R, -0.1, 0.9999 * R}, {-0.1, 0, 0});
  for (int k = 0; k < 20; ++k) l.sphere({0.3, 0.02 * k, GetParam() == Method::sdem ? R : 0.1});
  l.body(PlaneShape{});
  l = with_method(l, GetParam());
  const auto kept = l.build();
  const double h = l.model.time_step;
  l.model.removers = {{BoxRegion{{0.25, -1, -1}, {0.35, 1, 1}}, 50 * h, 51 * h}};
  const auto removed = l.build();
  run(*kept, 49);
  run(*removed, 49);
  bool moved_on = false;
  for (int k = 0; k < 60; ++k) {
    kept->step();
    removed->step();
    auto expected = states(*kept);
    if (std::get<Removed>(removed->world()).count.data[0] > 0) {
      moved_on = true;
      for (Index id = 4; id < 24; ++id) expected.erase(id);
    }
    ASSERT_EQ(states(*removed), expected) << k;
  }
  EXPECT_TRUE(moved_on);
  const BodyContacts& c = std::get<BodyContacts>(removed->world());
  EXPECT_TRUE(std::any_of(c.spring.data.begin(), c.spring.data.end(), [](const Vec3& s) { return s != Vec3{}; }));
}

Lab flowing(Method method) {
  Lab l = stirred(method);
  l.model.inflows = {from_above(4000)};
  l.model.removers = {{HalfSpaceRegion{{0, 0, -0.01}, {0, 0, -1}}, 0, std::numeric_limits<double>::infinity(), 7 * l.model.time_step}};
  l.model.areas = {Disc{{0, 0, 0.01}, {0, 0, -1}, 0.05}};
  return l;
}

TEST_P(BothMethods, FlowHasTheSameBitsOnAnyThreadsAndInAnyOrder) {
  const Lab l = flowing(GetParam());
  const int steps = GetParam() == Method::sdem ? 600 : 200;
  std::uint64_t reference = 0;
  std::array<std::int64_t, 3> counts{};
  for (const int threads : {1, 2, 4}) {
    const auto s = l.build(threads);
    run(*s, steps);
    const World& w = s->world();
    if (threads == 1) {
      reference = s->state_hash();
      counts = {std::get<Removed>(w).count.data[0], std::get<Created>(w).count.data[0], std::get<Crossed>(w).count.data[0]};
      for (const auto c : counts) EXPECT_GT(c, 10);
    }
    EXPECT_EQ(s->state_hash(), reference) << threads;
    EXPECT_EQ(std::get<Crossed>(w).count.data[0], counts[2]);
  }
  Lab other = l;                                             // nor does the skin leave a trace
  other.model.skin = 0.1 * R;
  const auto s = other.build(2);
  s->start();
  std::mt19937 random(7);
  for (int k = 0; k < steps; ++k) {
    std::vector<std::size_t> waiting(s->task().size()), order, ready;
    const auto edges = s->task().edges();
    for (const auto& e : edges) ++waiting[e.to];
    for (std::size_t n = 0; n < waiting.size(); ++n)
      if (waiting[n] == 0) ready.push_back(n);
    while (!ready.empty()) {
      std::swap(ready[random() % ready.size()], ready.back());
      order.push_back(ready.back());
      ready.pop_back();
      for (const auto& e : edges)
        if (e.from == order.back() && --waiting[e.to] == 0) ready.push_back(e.to);
    }
    s->step_in_order(order);
  }
  EXPECT_EQ(s->state_hash(), reference);
}

TEST_P(BothMethods, InflowComesAtItsRateAndOverlapsNothing) {
  Lab l(0.18, 0.5, 0);
  l.body(PlaneShape{}, {{0, 0, -1}, {}});
  l.body(SphereShape{0.02}, {{0, 0, 0.08}, {}});             // in the midst of the region
  l = with_method(l, GetParam());
  Inflow f = from_above(1000);
  f.number = 30;
  l.model.inflows = {f};
  const auto s = l.build();                                  // a scene that starts empty
  s->start();
  Index last = 0;
  for (int k = 0; s->time() < 0.06; ++k) {
    s->step();
    const double t = s->time() - (GetParam() == Method::ndem ? l.model.time_step : 0);
    const Created& c = std::get<Created>(s->world());
    EXPECT_EQ(c.count.data[0] + c.waiting.data[0], std::min<std::int64_t>(30, std::int64_t(1000 * t + 1e-6))) << t;
    const Particles& p = std::get<Particles>(s->world());
    if (GetParam() == Method::sdem)                          // the forces are those of the places: nothing touches at the start
      for (std::size_t r = 0; r < p.rows(); ++r)
        if (p.id.data[r] >= last) {
          EXPECT_EQ(p.velocity.data[r], f.velocity);
          EXPECT_EQ(p.force.data[r], Vec3{});
          EXPECT_TRUE(contains(shrunk(f.region, p.radius.data[r]), p.position.data[r]));
        }
    last = static_cast<Index>(p.rows());
  }
  EXPECT_EQ(std::get<Created>(s->world()).count.data[0], 30);
  EXPECT_EQ(std::get<Particles>(s->world()).rows(), 30u);
  for (const double r : std::get<Particles>(s->world()).radius.data) EXPECT_TRUE(r >= f.radius_min && r <= f.radius_max);
}

TEST(Flow, MassRate) {
  Lab l(0.18, 0.5, 0);
  Inflow f = from_above(0);
  f.mass_rate = 2;                                           // [kg/s]
  f.velocity = {0, 0, -3};
  l.model.inflows = {f};
  const auto s = l.build();
  run(*s, 1000);                                             // 0.05 s
  const Created& c = std::get<Created>(s->world());
  EXPECT_LE(c.mass.data[0], 0.1);
  EXPECT_GT(c.mass.data[0], 0.1 - sphere_mass(R));
}

// A region that is full: what is due waits, and is told.
TEST(Flow, WhatFindsNoRoomWaits) {
  Lab l(0.18, 0.5, 0);
  Inflow f = from_above(10000);
  f.region = BoxRegion{{0, 0, 0}, {2.1 * R, 2.1 * R, 2.1 * R}};
  f.radius_min = f.radius_max = R;
  f.velocity = {};
  l.model.inflows = {f};
  const auto s = l.build();
  run(*s, 100);
  const Created& c = std::get<Created>(s->world());
  EXPECT_EQ(c.count.data[0], 1);
  EXPECT_EQ(c.waiting.data[0], 49);                          // of 50 in 5 ms
}

TEST(Flow, IdsAreNeverGivenAgain) {
  Lab l(0.18, 0.5, 0);
  l.sphere({0, 0, -1});
  l.model.inflows = {from_above(2000)};
  l.model.removers = {{HalfSpaceRegion{}}};                  // all above z = 0: at once
  const auto s = l.build();
  run(*s, 400);                                              // 20 ms
  EXPECT_EQ(std::get<Population>(s->world()).next_id.data[0], 41u);
  EXPECT_EQ(std::get<Removed>(s->world()).count.data[0] + std::int64_t(std::get<Particles>(s->world()).rows()), 41);
}

TEST(Flow, LooksAreMadeAtTheirInterval) {
  Lab l(0.18, 0, 0);
  l.sphere({0, 0, -1});
  l.sphere({0, 0, 1});
  const double h = l.model.time_step;
  l.model.removers = {{HalfSpaceRegion{}, 10 * h, 100 * h, 8 * h}};
  std::get<Particles>(l.world).velocity.data[0] = {0, 0, 1 / (12 * h * 1e3)};
  std::get<Particles>(l.world).position.data[0] = {0.5, 0, -1e-3};
  const auto s = l.build();
  s->start();
  std::vector<std::size_t> rows;
  for (int k = 0; k < 30; ++k) {
    s->step();
    rows.push_back(std::get<Particles>(s->world()).rows());
  }
  EXPECT_EQ(rows[8], 2u);                                    // step 9: no look yet
  EXPECT_EQ(rows[9], 1u);
  EXPECT_EQ(rows[16], 1u);                                   // it has crossed in step 12 or 13; the next look is step 18
  EXPECT_EQ(rows[17], 0u);
  EXPECT_EQ(rows[29], 0u);                                   // and an empty world goes on
}

TEST(Flow, SuchScenesKeepWhatMayBecomeOfUse) {
  Lab l(0.18, 0.5, 0);
  l.sphere({});
  Effects e = decide_effects(l.world, l.model);
  EXPECT_FALSE(e.contacts || e.inflow || e.removal || e.crossings);
  EXPECT_TRUE(e.alike);
  Inflow f = from_above(10);
  f.radius_min = 0.2 * R;
  f.radius_max = 3 * R;
  l.model.inflows = {f};
  e = decide_effects(l.world, l.model);
  EXPECT_TRUE(e.contacts && e.inflow);
  EXPECT_FALSE(e.alike);
  EXPECT_EQ(largest_radius(l.world, l.model), 3 * R);
  EXPECT_EQ(smallest_radius(l.world, l.model), 0.2 * R);
}

// Probes: closed forms.

TEST(Probes, ALatticeInABox) {
  Lab l(0.18, 0.5, 0);
  for (int k = 0; k < 1000; ++k) {
    const Vec3 site{double(k % 10), double(k / 10 % 10), double(k / 100)};
    l.sphere(2 * R * site, site.x < 5 ? Vec3{1, 0, 2} : Vec3{-1, 0, 2});   // of diameter 2 R: they touch
  }
  l.particles().radius.data.assign(1000, R * (1 + 1e-9));
  const auto s = l.build();
  s->start();
  const double a = 2 * R;
  const Vec3 half{R, R, R};
  // 4 x 4 x 4 whole cells, the lower corner counted and the upper not; and all, from a half-space and a cylinder.
  const auto m = measure_regions(*s, {BoxRegion{Vec3{3 * a, 3 * a, 3 * a}, Vec3{7 * a, 7 * a, 7 * a}}, HalfSpaceRegion{-1.0 * half, {0, 0, 1}},
                                      CylinderRegion{{0, 0, 0}, {0, 0, 1}, 1.1 * a, 2 * a}});
  EXPECT_EQ(m[0].count, 64u);
  EXPECT_NEAR(m[0].solid_fraction, M_PI / 6, 1e-8);
  EXPECT_NEAR(m[0].mass, 64 * sphere_mass(R), 1e-12);
  EXPECT_EQ(m[0].mean_velocity, (Vec3{0, 0, 2}));
  EXPECT_DOUBLE_EQ(m[0].mean_speed, std::sqrt(5));
  EXPECT_DOUBLE_EQ(m[0].granular_temperature, 1.0 / 3);
  EXPECT_EQ(m[0].coordination_number, 6);
  EXPECT_EQ(m[1].count, 1000u);
  EXPECT_EQ(m[1].solid_fraction, 0);
  EXPECT_DOUBLE_EQ(m[1].coordination_number, 5.4);           // 2 * 3 * 10 * 10 * 9 / 1000
  EXPECT_EQ(m[2].count, 6u);                                 // (0,0), (1,0), (0,1), two layers
}

TEST_P(BothMethods, AFallingCloudCrossesAnArea) {
  Lab l(0.18, 0, 0);
  for (int k = 0; k < 100; ++k) l.sphere({0.02 * (k % 10), 0.02 * (k / 10), 0.001 * k}, {0, 0, -0.1});
  l = with_method(l, GetParam());
  if (GetParam() == Method::sdem) l.model.time_step = 2e-4;
  // Of the hundred, those with x up to 0.09 cross the rectangle, those within 0.05 of a corner the disc; all cross the whole plane.
  const double infinite = std::numeric_limits<double>::infinity();
  l.model.areas = {Disc{{0, 0, -0.010502}, {0, 0, -1}, infinite}, Rectangle{{0.04, 0.09, -0.010502}, {0, 0, 1}, {1, 0, 0}, 0.1, 0.3},
                   Disc{{0, 0, -0.010502}, {0, 0, -1}, 0.05}};
  const auto s = l.build();
  s->start();
  const Crossed& c = std::get<Crossed>(s->world());
  while (s->time() < 0.6) {
    s->step();
    // at height 0.001 k it passes after (0.010502 + 0.001 k) / 0.1 seconds
    EXPECT_EQ(c.count.data[0], std::clamp(std::floor((0.1 * s->time() - 0.010502) / 0.001) + 1, 0.0, 100.0)) << s->time();
  }
  EXPECT_NEAR(c.mass.data[0], double(c.count.data[0]) * sphere_mass(R), 1e-12);
  while (s->time() < 1.2) s->step();
  EXPECT_EQ(c.count.data[0], 100);
  EXPECT_EQ(c.count.data[1], -50);
  EXPECT_EQ(c.count.data[2], 8);                             // sites (i, j) with i^2 + j^2 <= 6.25
}

// Twice round a periodic box, and back once: what crosses a plane against its normal is taken off.
TEST(Probes, CrossingsThroughAPeriodicBoundary) {
  Lab l(1, 0, 0);
  l.sphere({0.1, 0, 0}, {1, 0, 0});
  l.model.periodic = PeriodicSpace{{0, -0.5, -0.5}, {1, 1, 1}};
  l.model.areas = {Disc{{0.5, 0, 0}, {1, 0, 0}, 0.1}, Disc{{0, 0, 0}, {1, 0, 0}, 0.1}, Disc{{0.5, 0.3, 0}, {1, 0, 0}, 0.1}};
  l.model.time_step = 1e-3;
  const auto s = l.build();
  run(*s, 2000);                                             // 2 m: to 2.1
  const Crossed& c = std::get<Crossed>(s->world());
  EXPECT_EQ(c.count.data[0], 2);
  EXPECT_EQ(c.count.data[1], 2);
  EXPECT_EQ(c.count.data[2], 0);
  std::get<Particles>(s->world()).velocity.data[0] = {-1, 0, 0};
  for (int k = 0; k < 1000; ++k) s->step();
  EXPECT_EQ(c.count.data[0], 1);
  EXPECT_EQ(c.count.data[1], 1);
}

}  // namespace
}  // namespace skred::lab
