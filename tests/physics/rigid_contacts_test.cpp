// Contacts between rigid bodies: at rest, sliding, bouncing, stacked, pushed.
#include <gtest/gtest.h>
#include "engine/geometry/solid.h"
#include "tasks/time_step.h"
#include "tests/physics/lab.h"

namespace skred::lab {
namespace {

constexpr double half = 0.01, gravity = 9.81;               // [m], [m/s^2]
constexpr double cube_mass = pellet_density * 8 * half * half * half;

Vec3 box_inertia(double mass, const Vec3& h) {
  return (mass / 3) * Vec3{h.y * h.y + h.z * h.z, h.x * h.x + h.z * h.z, h.x * h.x + h.y * h.y};
}

struct Blocks : Lab {
  Blocks(double restitution, double friction) : Lab(restitution, friction, 0) { model.gravity = {0, 0, -gravity}; }
  Index block(Vec3 at, Vec3 h = {half, half, half}, Quaternion turned = {}) {
    const double mass = pellet_density * 8 * h.x * h.y * h.z;
    return body(BoxShape{h}, {at, turned}, Motion::dynamic, mass, box_inertia(mass, h));
  }
  Index ball(Vec3 at, double radius) {
    const double mass = sphere_mass(radius), inertia = 0.4 * mass * radius * radius;
    return body(SphereShape{radius}, {at, {}}, Motion::dynamic, mass, {inertia, inertia, inertia});
  }
};

void run(Simulation& s, double time) {
  for (auto k = std::llround(time / s.model().time_step); k > 0; --k) s.step(Execution::serial);
}
const Bodies& bodies(const Simulation& s) { return std::get<Bodies>(s.world()); }
Vec3 place(const Simulation& s, Index b) { return bodies(s).pose.data[b].position; }
double tilt(const Simulation& s, Index b) { return norm(rotate(bodies(s).pose.data[b].orientation, {0, 0, 1}) - Vec3{0, 0, 1}); }

// Six faces of two triangles each.
std::shared_ptr<const Mesh> box_of_triangles(const Vec3& h) {
  const Polyhedron box = box_polyhedron(h);
  std::vector<Triangle> triangles;
  for (const auto& f : box.faces)
    for (std::size_t k = 2; k < 4; ++k) triangles.push_back({f.corners[0], f.corners[k - 1], f.corners[k]});
  return std::make_shared<Mesh>(box.vertices, triangles);
}

TEST(RigidContacts, ABoxRestsOnAPlane) {
  Blocks l(0.3, 0.5);
  l.body(PlaneShape{});
  const Index box = l.block({0, 0, half});
  const auto s = l.build();
  s->start();
  run(*s, 1);
  const Vec3 settled = place(*s, box);
  run(*s, 1);
  EXPECT_LT(norm(place(*s, box) - settled), 1e-12);         // it does not creep
  EXPECT_LT(std::hypot(settled.x, settled.y), 1e-12);
  EXPECT_LT(tilt(*s, box), 1e-10);
  EXPECT_NEAR(bodies(*s).force.data[box].z / (cube_mass * gravity), 1, 1e-9);
  EXPECT_NEAR(measure(*s).loads[0].force.z / (-cube_mass * gravity), 1, 1e-9);
  const RigidContacts& c = std::get<RigidContacts>(s->world());
  ASSERT_EQ(c.rows(), 4u);
  const double radius = std::cbrt(3 * 8 * half * half * half / (4 * M_PI));
  const double stiffness = 4.0 / 3.0 * l.model.pairs.values[0].young_eff * std::sqrt(radius);
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(c.radius_eff.data[k] / radius, 1, 1e-6);     // the share of the outline of a square that has tilted by nothing
    EXPECT_NEAR(c.overlap.data[k] / std::pow(cube_mass * gravity / 4 / stiffness, 2.0 / 3.0), 1, 1e-6);
  }
}

// On an incline: it stays where tan(theta) < mu, else slides with a = g (sin - mu cos).
TEST(RigidContacts, ABoxOnAnIncline) {
  for (const double friction : {0.7, 0.3}) {
    Blocks l(0.3, friction);
    const double theta = 0.5, ramp_length = 2;               // tan = 0.5463
    l.model.gravity = gravity * Vec3{std::sin(theta), 0, -std::cos(theta)};
    l.body(BoxShape{{ramp_length, 0.1, 0.1}}, {{0, 0, -0.1}, {}});
    const Index box = l.block({-1, 0, 0.5 * half}, {half, half, 0.5 * half});
    const auto s = l.build();
    s->start();
    run(*s, 0.2);
    const double x = place(*s, box).x, v = bodies(*s).velocity.data[box].x;
    run(*s, 0.3);
    const double acceleration = (bodies(*s).velocity.data[box].x - v) / 0.3;
    if (friction > std::tan(theta)) {
      EXPECT_LT(std::abs(place(*s, box).x - x), 1e-9);
      EXPECT_LT(std::abs(acceleration), 1e-6);
    } else {
      EXPECT_NEAR(acceleration / (gravity * (std::sin(theta) - friction * std::cos(theta))), 1, 2e-3);
    }
    EXPECT_LT(tilt(*s, box), 1e-2);
  }
}

TEST(RigidContacts, AStackOfFiveStands) {
  Blocks l(0.3, 0.5);
  l.body(PlaneShape{});
  for (int k = 0; k < 5; ++k) l.block({1e-4 * (k % 2), -5e-5 * (k % 3), (2 * k + 1) * half}, {half, half, half}, rotation_by({0, 0, 0.01 * k}));
  const auto s = l.build();
  s->start();
  run(*s, 0.5);
  std::vector<Vec3> settled;
  for (Index b = 1; b <= 5; ++b) settled.push_back(place(*s, b));
  run(*s, 2);
  for (Index b = 1; b <= 5; ++b) {                           // it sways, less and less: soft springs on a small damping
    EXPECT_LT(norm(place(*s, b) - settled[b - 1]), 5e-4 * half) << b;
    EXPECT_LT(norm(bodies(*s).velocity.data[b]), 2e-5) << b;
    EXPECT_LT(tilt(*s, b), 1e-3) << b;
  }
  EXPECT_NEAR(measure(*s).loads[0].force.z / (-5 * cube_mass * gravity), 1, 1e-4);
}

// Two cubes that hit each other off-centre in empty space. Cubes: the integration of their free rotation loses no angular momentum.
TEST(RigidContacts, MomentumAndAngularMomentum) {
  Blocks l(0.4, 0.6);
  l.model.gravity = {};
  l.model.time_step = 1e-5;
  const Index a = l.block({-0.02, 0.003, 0.002}, {half, half, half}, rotation_by({0.3, 0.5, 0.7}));
  const double small = 0.7 * half;
  const Index b = l.block({0.02, -0.003, 0}, {small, small, small}, rotation_by({-0.2, 0.9, 0.1}));
  l.bodies().velocity.data[a] = {1, 0, 0};
  l.bodies().velocity.data[b] = {-1, 0.1, 0};
  l.bodies().angular_velocity.data[b] = {3, -2, 10};
  const auto s = l.build();
  s->start();
  const auto totals = [&] {
    Vec3 momentum, angular;
    const Bodies& now = bodies(*s);
    for (const Index k : {a, b}) {
      const Vec3 p = now.mass.data[k] * now.velocity.data[k];
      momentum += p;
      angular += cross(now.pose.data[k].position, p) + now.inertia.data[k].x * now.angular_velocity.data[k];
    }
    return std::pair{momentum, angular};
  };
  const auto [p0, l0] = totals();
  bool touched = false;
  for (int k = 0; k < 4000; ++k) {
    s->step(Execution::serial);
    touched |= norm(bodies(*s).force.data[a]) > 0;
  }
  const auto [p1, l1] = totals();
  EXPECT_TRUE(touched);
  EXPECT_GT(norm(bodies(*s).velocity.data[a] - Vec3{1, 0, 0}), 0.1);
  EXPECT_LT(norm(p1 - p0) / norm(p0), 1e-12);
  EXPECT_LT(norm(l1 - l0) / norm(l0), 1e-12);
}

// A sphere and a cube that lands on its face rebound with the prescribed restitution.
TEST(RigidContacts, Restitution) {
  for (const double e : {0.3, 0.8}) {
    Blocks l(e, 0);
    l.model.gravity = {};
    l.model.time_step = 5e-6;
    l.body(PlaneShape{});
    const Index ball = l.ball({0, 0, 1.05 * half}, half), cube = l.block({0.1, 0, 1.05 * half});
    for (const Index b : {ball, cube}) l.bodies().velocity.data[b] = {0, 0, -0.3};
    const auto s = l.build();
    s->start();
    run(*s, 0.05);
    EXPECT_NEAR(bodies(*s).velocity.data[ball].z / 0.3, e, 2e-3);
    EXPECT_NEAR(bodies(*s).velocity.data[cube].z / 0.3, e, 2e-3);
  }
}

// A body of a sphere bounces and rolls as a particle of the same mass does.
TEST(RigidContacts, ABallIsAParticle) {
  Blocks l(0.5, 0.4);
  l.body(BoxShape{{1, 1, 0.1}}, {{0, 0, -0.1}, {}});
  const Index ball = l.ball({0.5, 0, 2 * pellet_radius}, pellet_radius);
  l.sphere({0, 0, 2 * pellet_radius}, {0.4, 0, 0});
  l.bodies().velocity.data[ball] = {0.4, 0, 0};
  const auto s = l.build();
  s->start();
  run(*s, 0.3);
  EXPECT_LT(norm(place(*s, ball) - Vec3{0.5, 0, 0} - position(*s, 0)), 1e-12);
  EXPECT_LT(norm(bodies(*s).angular_velocity.data[ball] - spin(*s, 0)), 1e-9);
}

// A cube of triangles tumbles like a box.
TEST(RigidContacts, AMeshIsTheBoxItLooksLike) {
  const auto tumble = [](bool mesh) {
    Blocks l(0.3, 0.5);
    l.body(PlaneShape{});
    const Vec3 h{half, half, half};
    const Index box = l.block({0, 0, 2.2 * half}, h, rotation_by({0.3, 0.2, 0.1}));
    if (mesh) std::get<Geometries>(l.world).shape.data[box] = MeshShape{box_of_triangles(h)};
    auto s = l.build();
    s->start();
    run(*s, 0.4);
    return bodies(*s).pose.data[box];
  };
  const Pose box = tumble(false), mesh = tumble(true);
  EXPECT_LT(norm(box.position - mesh.position), 1e-6);
  EXPECT_NEAR(box.position.z, half, 1e-4);                   // on a face
}

TEST(RigidContacts, AKinematicPlatePushesABox) {
  Blocks l(0.3, 0.3);
  l.body(PlaneShape{});
  l.body(BoxShape{{0.005, 0.05, 0.05}}, {{-0.03, 0, 0.05}, {}}, Motion::kinematic);
  l.model.pieces = {{}, {MotionPiece{0, 10, {0.1, 0, 0}, {}, {}}}};
  const Index box = l.block({0, 0, half});
  const auto s = l.build();
  s->start();
  run(*s, 1);
  EXPECT_NEAR(bodies(*s).velocity.data[box].x, 0.1, 1e-4);
  EXPECT_NEAR(place(*s, box).x, -0.03 + 0.1 + 0.005 + half, 1e-4);
  EXPECT_NEAR(measure(*s).loads[1].force.x / (-0.3 * cube_mass * gravity), 1, 0.05);   // friction on the floor, and a little on the plate
}

TEST(RigidContacts, ABoxRestsOnABedOfParticles) {
  Blocks l(0.18, 0.6);
  const double width = 12 * pellet_radius;
  l.body(PlaneShape{});
  for (const Vec3& side : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}}) {
    const double angle = 0.5 * M_PI;
    const Vec3 axis = cross({0, 0, 1}, -side);               // turns z to the inside
    l.body(PlaneShape{}, {0.5 * width * side, rotation_by(angle * axis)});
  }
  for (int k = 0; k < 180; ++k)
    l.sphere({(k % 6 - 2.5) * 1.95 * pellet_radius + 1e-4 * (k % 7), (k / 6 % 6 - 2.5) * 1.95 * pellet_radius + 1e-4 * (k % 5), (2.05 * (k / 36) + 1) * pellet_radius},
             {}, {}, 0.95 * pellet_radius);
  const Vec3 h{4 * pellet_radius, 4 * pellet_radius, 2 * pellet_radius};
  const Index box = l.block({0, 0, 16 * pellet_radius}, h, rotation_by({0.1, 0, 0}));
  const auto s = l.build();
  s->start();
  run(*s, 1.5);
  EXPECT_LT(norm(bodies(*s).velocity.data[box]), 2e-3);
  EXPECT_GT(place(*s, box).z, 8 * pellet_radius);
  EXPECT_NEAR(bodies(*s).force.data[box].z / (bodies(*s).mass.data[box] * gravity), 1, 0.05);
}

// Boxes and cylinders poured into a bin come to rest at the step that is advised.
TEST(RigidContacts, AHeapComesToRestAtTheAdvisedStep) {
  Blocks l(0.18, 0.5);
  l.body(PlaneShape{});
  const double width = 5.5 * half;
  for (const Vec3& side : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}})
    l.body(PlaneShape{}, {0.5 * width * side, rotation_by(0.5 * M_PI * cross({0, 0, 1}, -side))});
  for (int k = 0; k < 16; ++k) {
    const Vec3 at{1.3 * half * (k % 2 ? 1 : -1), 1.3 * half * (k / 2 % 2 ? 1 : -1), 1.6 * half + 2.5 * half * (k / 4)};
    const Quaternion turned = rotation_by({0.05 * k, 0.1 * k, 0.2 * k});
    if (k % 4) l.block(at, {half, 0.8 * half, 0.6 * half}, turned);
    else l.body(CylinderShape{0.7 * half, 1.4 * half}, {at, turned}, Motion::dynamic, 0.01, {5e-7, 5e-7, 2.5e-7});
  }
  const TimeStepAdvice advice = advise_time_step(l.world, l.model, expected_speed(l.world, l.model).value);
  l.model.time_step = advice.step;
  EXPECT_GT(advice.step, 1e-5);
  const auto s = l.build();
  s->start();
  run(*s, 0.8);
  double fastest = 0, weight = 0;
  for (Index b = 5; b < bodies(*s).rows(); ++b) {
    fastest = std::max(fastest, norm(bodies(*s).velocity.data[b]));
    weight += bodies(*s).mass.data[b] * gravity;
    EXPECT_GT(place(*s, b).z, 0.5 * half);
  }
  EXPECT_LT(fastest, 2e-3);
  const Measures m = measure(*s);
  double held = 0;
  for (int k = 0; k < 5; ++k) held -= m.loads[k].force.z;
  EXPECT_NEAR(held / weight, 1, 1e-3);
}

// Threads and the order of kernels leave no trace: a heap of boxes, balls, cylinders that falls apart.
TEST(RigidContacts, SameBitsForAnyNumberOfThreads) {
  Blocks l(0.3, 0.4);
  l.body(PlaneShape{});
  for (int k = 0; k < 40; ++k) {
    const Vec3 at{0.015 * (k % 3), 0.013 * (k % 2), 0.02 + 0.023 * k};
    const Quaternion turned = rotation_by({0.1 * k, 0.7 * k, -0.3 * k});
    if (k % 3 == 0) l.block(at, {half, 0.8 * half, 0.6 * half}, turned);
    else if (k % 3 == 1) l.ball(at, 0.8 * half);
    else l.body(CylinderShape{0.7 * half, 2 * half}, {at, turned}, Motion::dynamic, 0.02, {1e-6, 1e-6, 5e-7});
  }
  const auto hash = [&](int threads, Execution how) {
    const auto s = l.build(threads);
    s->start();
    for (int k = 0; k < 6000; ++k) s->step(how);
    EXPECT_GT(std::get<RigidContacts>(s->world()).rows(), 5u);
    return s->state_hash();
  };
  const auto reference = hash(1, Execution::serial);
  EXPECT_EQ(hash(2, Execution::graph), reference);
  EXPECT_EQ(hash(4, Execution::list), reference);
}

}  // namespace
}  // namespace skred::lab
