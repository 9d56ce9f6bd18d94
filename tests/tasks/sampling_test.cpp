// The numbers of the time series are sums over particles and contacts, whoever adds them up.
#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include "tests/physics/lab.h"

namespace skred::lab {
namespace {

constexpr double floor_height = -0.1;                        // [m]

// More particles than a chunk of a sum holds, in contact with each other and with a floor.
std::unique_ptr<Simulation> crowd(int threads) {
  Lab l(0.5, 0.5, 0.1);
  l.model.gravity = {0, 0, -9.81};
  add_cloud(l, 21, 1.9 * 0.85 * pellet_radius, 5, 1.0);
  l.body(PlaneShape{}, {{0, 0, floor_height}, {}});
  auto s = l.build(threads);
  s->start();
  for (int k = 0; k < 20; ++k) s->step();
  return s;
}

Measures measure_with_threads(Simulation& s) {
  Measures m;
  s.inside([&] { m = measure(s, Parallel(true, nullptr)); });
  return m;
}

void expect_same_bits(const Measures& a, const Measures& b) {
  EXPECT_EQ(a.kinetic_energy, b.kinetic_energy);
  EXPECT_EQ(a.rotational_energy, b.rotational_energy);
  EXPECT_EQ(a.potential_energy, b.potential_energy);
  EXPECT_EQ(a.contacts, b.contacts);
  EXPECT_EQ(a.body_contacts, b.body_contacts);
  EXPECT_EQ(a.coordination_number, b.coordination_number);
  EXPECT_EQ(a.normal_force, b.normal_force);
  EXPECT_EQ(a.body_normal_force, b.body_normal_force);
  EXPECT_EQ(a.max_overlap_ratio, b.max_overlap_ratio);
  EXPECT_EQ(a.max_overlap_particle, b.max_overlap_particle);
  EXPECT_EQ(a.mean_speed, b.mean_speed);
  EXPECT_EQ(a.max_speed, b.max_speed);
  EXPECT_EQ(a.highest, b.highest);
  ASSERT_EQ(a.loads.size(), b.loads.size());
  for (std::size_t k = 0; k < a.loads.size(); ++k) EXPECT_TRUE(a.loads[k].force == b.loads[k].force && a.loads[k].torque == b.loads[k].torque);
}

TEST(Sampling, SameBitsForAnyThreads) {
  const Measures one = measure(*crowd(1));
  for (const int threads : {2, 3}) {
    SCOPED_TRACE(threads);
    const auto s = crowd(threads);
    expect_same_bits(one, measure(*s));
    expect_same_bits(one, measure_with_threads(*s));
  }
}

TEST(Sampling, SumsOverAllParticlesAndPairs) {
  const auto s = crowd(2);
  const Measures m = measure_with_threads(*s);
  const auto x = by_id(*s, &Particles::position), v = by_id(*s, &Particles::velocity), w = by_id(*s, &Particles::angular_velocity);
  const auto radius = by_id(*s, &Particles::radius), mass = by_id(*s, &Particles::mass);

  double kinetic = 0, rotational = 0, potential = 0, speeds = 0, fastest = 0, highest = -1, deepest = 0;
  std::size_t pairs = 0, on_floor = 0;
  std::array<std::size_t, 2> deepest_pair{};
  for (std::size_t i = 0; i < x.size(); ++i) {
    kinetic += 0.5 * mass[i] * dot(v[i], v[i]);
    rotational += 0.2 * mass[i] * radius[i] * radius[i] * dot(w[i], w[i]);
    potential += 9.81 * mass[i] * x[i].z;
    speeds += norm(v[i]);
    fastest = std::max(fastest, norm(v[i]));
    highest = std::max(highest, x[i].z);
    on_floor += x[i].z - floor_height < radius[i];
    for (std::size_t j = 0; j < i; ++j) {
      const double overlap = radius[i] + radius[j] - norm(x[i] - x[j]);
      if (!(overlap > 0)) continue;
      ++pairs;
      const double ratio = overlap / std::min(radius[i], radius[j]);
      if (ratio > deepest) deepest = ratio, deepest_pair = {i, j};
    }
  }
  ASSERT_GT(x.size(), 8192u) << "three chunks";
  ASSERT_GT(pairs, 5000u);
  ASSERT_GT(on_floor, 100u);
  const double n = double(x.size());
  EXPECT_NEAR(m.kinetic_energy / kinetic, 1, 1e-12);
  EXPECT_NEAR(m.rotational_energy / rotational, 1, 1e-12);
  EXPECT_NEAR(m.potential_energy, potential, 1e-12 * 9.81 * 9261 * mass[0]);
  EXPECT_NEAR(m.mean_speed / (speeds / n), 1, 1e-12);
  EXPECT_EQ(m.max_speed, fastest);
  EXPECT_EQ(m.highest, highest);
  EXPECT_EQ(m.contacts, pairs);
  EXPECT_EQ(m.body_contacts, on_floor);
  EXPECT_DOUBLE_EQ(m.coordination_number, double(2 * pairs + on_floor) / n);
  EXPECT_NEAR(m.max_overlap_ratio, deepest, 1e-12);
  EXPECT_TRUE(m.max_overlap_particle == deepest_pair[0] || m.max_overlap_particle == deepest_pair[1]);
  EXPECT_NEAR(m.loads[0].force.z / -m.body_normal_force, 1, 1e-12);
}

}  // namespace
}  // namespace skred::lab
