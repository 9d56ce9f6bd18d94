// A sphere on a plane: sliding into rolling, rolling to rest, inclines.
#include <gtest/gtest.h>
#include "tests/physics/lab.h"

namespace skred::lab {
namespace {

constexpr double g = 9.81;

// A sphere resting on the plane z = 0 (overlap of its weight), gravity tilted by `angle` [rad] towards +x.
Lab on_plane(double friction, double rolling_friction, Vec3 v, Vec3 w, double angle = 0) {
  Lab l(0.18, friction, rolling_friction);
  l.model.gravity = {g * std::sin(angle), 0, -g * std::cos(angle)};
  l.model.time_step = 2e-5;
  const double hertz = 4.0 / 3.0 * elastic_pair(pellet, pellet).young_eff * std::sqrt(pellet_radius);
  const double overlap = std::pow(sphere_mass(pellet_radius) * g * std::cos(angle) / hertz, 2.0 / 3.0);
  l.body(PlaneShape{});
  l.sphere({0, 0, pellet_radius - overlap}, v, w);
  return l;
}

std::unique_ptr<Simulation> run(const Lab& l, double time) {
  auto s = l.build();
  s->start();
  while (s->time() < time) s->step(Execution::serial);
  return s;
}

// v = 5/7 v0 once it rolls, at t* = 2 v0 / (7 mu g)
TEST(Rolling, SlideToRoll) {
  const double v0 = 0.5, mu = 0.91;
  const double end = 2 * v0 / (7 * mu * g);
  const Lab l = on_plane(mu, 0, {v0, 0, 0}, {});
  const auto half = run(l, 0.5 * end);
  EXPECT_NEAR(velocity(*half, 0).x, v0 - mu * g * half->time(), 0.005 * v0);
  EXPECT_NEAR(spin(*half, 0).y * pellet_radius, 2.5 * mu * g * half->time(), 0.005 * v0);
  const auto after = run(l, 3 * end);
  EXPECT_NEAR(velocity(*after, 0).x / (5.0 / 7.0 * v0), 1, 0.005);
  EXPECT_NEAR(spin(*after, 0).y * pellet_radius / (5.0 / 7.0 * v0), 1, 0.005);
}

// With rolling resistance: t* = v0 / (g (3.5 mu - 2.5 mu_r)), v* = v0 - mu g t*
TEST(Rolling, SlideToRollWithResistance) {
  const double v0 = 0.5, mu = 0.91, mu_r = 0.3211;
  const double end = v0 / (g * (3.5 * mu - 2.5 * mu_r));
  const auto s = run(on_plane(mu, mu_r, {v0, 0, 0}, {}), end);
  EXPECT_NEAR(velocity(*s, 0).x / (v0 - mu * g * end), 1, 0.005);
}

// a = -5/7 g mu_r while it rolls
TEST(Rolling, Deceleration) {
  const double v0 = 0.5, mu_r = 0.3211;
  const Lab l = on_plane(0.91, mu_r, {v0, 0, 0}, {0, v0 / pellet_radius, 0});
  const auto a = run(l, 0.05), b = run(l, 0.15);
  const double measured = (velocity(*b, 0).x - velocity(*a, 0).x) / (b->time() - a->time());
  EXPECT_NEAR(measured / (-5.0 / 7.0 * g * mu_r), 1, 0.005);
}

TEST(Rolling, DownAnIncline) {
  const double angle = 25 * M_PI / 180, mu_r = 0.3211;
  const Lab l = on_plane(0.91, mu_r, {}, {}, angle);
  const auto a = run(l, 0.1), b = run(l, 0.3);
  const double measured = (velocity(*b, 0).x - velocity(*a, 0).x) / (b->time() - a->time());
  EXPECT_NEAR(measured / (5.0 / 7.0 * g * (std::sin(angle) - mu_r * std::cos(angle))), 1, 0.01);
}

TEST(Rolling, StandsOnAShallowIncline) {   // tan 17 deg < mu_r
  const auto s = run(on_plane(0.91, 0.3211, {}, {}, 17 * M_PI / 180), 1.0);
  EXPECT_LT(std::abs(position(*s, 0).x), 0.02 * pellet_radius);
}

TEST(Rolling, FrictionlessSlides) {
  const auto s = run(on_plane(0, 0, {0.5, 0, 0}, {}), 0.2);
  EXPECT_EQ(velocity(*s, 0).x, 0.5);
  EXPECT_EQ(spin(*s, 0), (Vec3{}));
}

}  // namespace
}  // namespace skred::lab
