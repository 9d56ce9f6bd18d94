// Rigid bodies that particles push, and bodies that push particles.
#include <gtest/gtest.h>
#include "tests/physics/lab.h"

namespace skred::lab {
namespace {

// A free ball, as a body, hit off-centre by particles in empty space: nothing is lost between them.
TEST(DynamicBody, MomentumAndAngularMomentum) {
  Lab l(0.4, 0.6, 0.1);
  const double radius = 3 * pellet_radius, mass = 4 * sphere_mass(pellet_radius), inertia = 0.4 * mass * radius * radius;
  l.body(SphereShape{radius}, {}, Motion::dynamic, mass, {inertia, inertia, inertia});
  l.sphere({5 * pellet_radius, 0.5 * pellet_radius, 0}, {-0.5, 0, 0.1}, {3, 2, 1});
  l.sphere({-1 * pellet_radius, -5 * pellet_radius, 0.2 * pellet_radius}, {0.05, 0.6, 0}, {0, -9, 1});
  const auto simulation = l.build();
  Simulation& s = *simulation;
  s.start();
  const auto totals = [&] {
    const Particles& p = std::get<Particles>(s.world());
    const Bodies& b = std::get<Bodies>(s.world());
    Vec3 momentum = b.mass.data[0] * b.velocity.data[0];
    Vec3 angular = cross(b.pose.data[0].position, momentum) + inertia * b.angular_velocity.data[0];
    for (std::size_t k = 0; k < p.rows(); ++k) {
      const double m = p.mass.data[k];
      momentum += m * p.velocity.data[k];
      angular += m * cross(p.position.data[k], p.velocity.data[k]) + 0.4 * m * p.radius.data[k] * p.radius.data[k] * p.angular_velocity.data[k];
    }
    return std::pair{momentum, angular};
  };
  const auto [p0, l0] = totals();
  for (int k = 0; k < 4000; ++k) s.step(Execution::serial);
  const auto [p1, l1] = totals();
  EXPECT_GT(norm(std::get<Bodies>(s.world()).velocity.data[0]), 0.05);   // they did meet
  EXPECT_GT(norm(std::get<Bodies>(s.world()).angular_velocity.data[0]), 0.1);
  EXPECT_LT(norm(p1 - p0) / norm(p0), 1e-12);
  EXPECT_LT(norm(l1 - l0) / norm(l0), 1e-11);
}

// A body is a sphere of its mass: a particle bounces off a ball-shaped body as off a particle of the same size.
TEST(DynamicBody, BallOfABodyEqualsAParticle) {
  const auto bounce = [](bool as_body) {
    Lab l(0.5, 0.4, 0.1);
    const double mass = sphere_mass(pellet_radius), inertia = 0.4 * mass * pellet_radius * pellet_radius;
    l.sphere({2.5 * pellet_radius, 0.4 * pellet_radius, 0}, {-0.5, 0, 0}, {0, 0, 5});
    if (as_body) l.body(SphereShape{pellet_radius}, {}, Motion::dynamic, mass, {inertia, inertia, inertia});
    else l.sphere({});
    auto s = l.build();
    s->start();
    for (int k = 0; k < 1500; ++k) s->step(Execution::serial);
    return velocity(*s, 0);
  };
  EXPECT_LT(norm(bounce(true) - bounce(false)), 1e-12);
}

// Torque-free motion of a box about its middle axis turns over (Dzhanibekov) and keeps energy and angular momentum.
TEST(DynamicBody, FreeSpinKeepsAngularMomentum) {
  Lab l(0.5, 0, 0);
  l.model.time_step = 1e-4;
  l.sphere({10, 0, 0});
  const Vec3 inertia{1e-3, 2e-3, 3e-3};
  l.body(BoxShape{{0.1, 0.08, 0.05}}, {}, Motion::dynamic, 1, inertia);
  l.bodies().angular_velocity.data[0] = {0.02, 10, 0.01};
  const auto simulation = l.build();
  Simulation& s = *simulation;
  s.start();
  const auto angular_momentum = [&] {
    const Bodies& b = std::get<Bodies>(s.world());
    const Vec3 w = rotate_back(b.pose.data[0].orientation, b.angular_velocity.data[0]);
    return rotate(b.pose.data[0].orientation, {inertia.x * w.x, inertia.y * w.y, inertia.z * w.z});
  };
  const Vec3 before = angular_momentum();
  double lowest = 1;
  for (int k = 0; k < 30000; ++k) {
    s.step(Execution::serial);
    lowest = std::min(lowest, rotate(std::get<Bodies>(s.world()).pose.data[0].orientation, {0, 1, 0}).y);
  }
  EXPECT_LT(lowest, -0.9);
  EXPECT_LT(norm(angular_momentum() - before) / norm(before), 1e-4);
}

// A dropped ball settles on a plate of fixed particles with its weight on them.
TEST(DynamicBody, RestsOnParticles) {
  Lab l(0.18, 0.9, 0.3);
  l.model.gravity = {0, 0, -9.81};
  l.body(PlaneShape{});
  const double radius = 5 * pellet_radius, mass = 10 * sphere_mass(pellet_radius), inertia = 0.4 * mass * radius * radius;
  const Index ball = l.body(SphereShape{radius}, {{0, 0, 2.2 * pellet_radius + radius}, {}}, Motion::dynamic, mass, {inertia, inertia, inertia});
  for (const double angle : {0.3, 2.4, 4.5}) l.sphere({3 * pellet_radius * std::cos(angle), 3 * pellet_radius * std::sin(angle), pellet_radius});
  const auto simulation = l.build();
  Simulation& s = *simulation;
  s.start();
  for (int k = 0; k < 60000; ++k) s.step(Execution::serial);
  const Bodies& b = std::get<Bodies>(s.world());
  EXPECT_LT(norm(b.velocity.data[ball]), 1e-4);
  EXPECT_NEAR(b.force.data[ball].z / (mass * 9.81), 1, 1e-2);
  const Measures m = measure(s);
  EXPECT_NEAR(m.loads[0].force.z / (-9.81 * (mass + 3 * sphere_mass(pellet_radius))), 1, 1e-2);
}

TEST(KinematicBody, PrescribedMotionIsExactInTime) {
  const MotionPiece turn{1, 3, {}, {0, 0, M_PI / 2}, {1, 0, 0}}, shift{2, 4, {0, 0, 0.5}, {}, {}};
  const std::vector<MotionPiece> pieces{turn, shift};
  const Pose start{{2, 0, 0}, {}};
  EXPECT_EQ(prescribed_state(start, pieces, 0.5).pose, start);
  EXPECT_EQ(prescribed_state(start, pieces, 0.5).velocity, Vec3{});
  const BodyState middle = prescribed_state(start, pieces, 2.0);          // a quarter turn about (1, 0), just starting to rise
  EXPECT_LT(norm(middle.pose.position - Vec3{1, 1, 0}), 1e-14);
  EXPECT_LT(norm(middle.velocity - Vec3{-M_PI / 2, 0, 0.5}), 1e-14);
  const BodyState end = prescribed_state(start, pieces, 9.0);
  EXPECT_LT(norm(end.pose.position - Vec3{0, 0, 1}), 1e-14);
  EXPECT_EQ(end.velocity, Vec3{});
  EXPECT_EQ(end.angular_velocity, Vec3{});
}

TEST(KinematicBody, SwingsExactlyInTime) {
  const double f = 4, w = 2 * M_PI * f, amplitude = 0.05;
  const MotionPiece shake{.start = 1, .end = 1.5, .velocity = {0, 0, w * amplitude}, .frequency = f, .phase = M_PI / 2};   // from rest, downwards
  const std::vector<MotionPiece> pieces{shake};
  for (const double t : {1.0, 1.01, 1.3, 1.49}) {
    const BodyState s = prescribed_state({{0, 0, 2}, {}}, pieces, t);
    EXPECT_NEAR(s.pose.position.z, 2 + amplitude * (std::cos(w * (t - 1)) - 1), 1e-15);
    EXPECT_NEAR(s.velocity.z, -w * amplitude * std::sin(w * (t - 1)), 1e-14);
  }
  EXPECT_EQ(prescribed_state({{0, 0, 2}, {}}, pieces, 0.9).velocity, Vec3{});
  EXPECT_EQ(prescribed_state({{0, 0, 2}, {}}, pieces, 1.5).velocity, Vec3{});

  const double angle = 0.3;                                  // [rad] to either side, about the origin
  const std::vector<MotionPiece> rocking{{.start = 0, .end = 9, .angular_velocity = {0, 0, w * angle}, .frequency = f}};
  for (const double t : {0.0, 0.04, 0.1, 2.2}) {
    const BodyState s = prescribed_state({{2, 0, 0}, {}}, rocking, t);
    const double now = angle * std::sin(w * t), rate = w * angle * std::cos(w * t);
    EXPECT_LT(norm(s.pose.position - Vec3{2 * std::cos(now), 2 * std::sin(now), 0}), 1e-14);
    EXPECT_LT(norm(s.velocity - rate * Vec3{-2 * std::sin(now), 2 * std::cos(now), 0}), 1e-13);
    EXPECT_NEAR(s.angular_velocity.z, rate, 1e-14);
  }
}

// A turning plane carries a resting sphere along without slip; a lifted one gives it its speed.
TEST(KinematicBody, BeltCarriesASphere) {
  Lab l(0.18, 0.9, 0.5);
  l.model.gravity = {0, 0, -9.81};
  l.body(BoxShape{{5, 1, 0.1}}, {{0, 0, -0.1}, {}}, Motion::kinematic);
  l.model.pieces = {{MotionPiece{0, 10, {0.3, 0, 0}, {}, {}}}};
  l.sphere({0, 0, pellet_radius});
  const auto simulation = l.build();
  Simulation& s = *simulation;
  s.start();
  for (int k = 0; k < 20000; ++k) s.step(Execution::serial);
  EXPECT_NEAR(velocity(s, 0).x, 0.3, 0.003);
}

}  // namespace
}  // namespace skred::lab
