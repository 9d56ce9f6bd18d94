// At rest smooth and nonsmooth DEM are the same model: the force of Hertz for the overlap.
//
// With friction the forces of a packing are not unique, but depend on how it came to rest: a heap that one method has settled moves a
// little when the other takes it over without its friction. Compared is then the weight that is carried, and the means of normal
// forces and overlaps.
#include "tests/physics/nonsmooth_lab.h"

namespace skred {
namespace {

using namespace lab;

// The same experiment by one of the methods.
std::unique_ptr<Simulation> settle(NonsmoothLab lab, Method method, double time) {
  lab.model.method = method;
  if (method == Method::sdem) lab.model.time_step = thesis_step;
  auto s = lab.build(2);
  run(*s, time);
  return s;
}

struct State {
  std::vector<Vec3> position;
  std::vector<double> force;                                   // between particles, listed or not in the same order
  double floor, overlaps = 0, normal_force;
  Measures seen;
  explicit State(const Simulation& s) : position(by_id(s, &Particles::position)), force(pair_forces(s)), seen(measure(s)) {
    floor = -seen.loads[0].force.z;
    normal_force = seen.normal_force + seen.body_normal_force;
    std::erase(force, 0.0);
    for (std::size_t a = 0; a < position.size(); ++a)
      for (std::size_t b = a + 1; b < position.size(); ++b) overlaps += std::max(0.0, 2 * R - norm(position[a] - position[b]));
    const BodyContacts& c = std::get<BodyContacts>(s.world());
    for (std::size_t k = 0; k < c.rows(); ++k) overlaps += std::max(0.0, c.overlap.data[k]);
  }
};

void expect_the_same(const State& a, const State& b) {
  ASSERT_EQ(a.force.size(), b.force.size());
  for (std::size_t k = 0; k < a.force.size(); ++k) EXPECT_NEAR(a.force[k] / b.force[k], 1, 1e-6);
  for (std::size_t k = 0; k < a.position.size(); ++k) EXPECT_LT(norm(a.position[k] - b.position[k]), 1e-6 * 1e-3);
  EXPECT_NEAR(a.overlaps / b.overlaps, 1, 1e-6);
  EXPECT_NEAR(a.floor / b.floor, 1, 1e-6);
}

TEST(MethodsAgree, Column) {
  NonsmoothLab lab(0.18, 0.91, 0.3211);
  lab.under_gravity();
  lab.floor();
  for (const double z : column_at_rest(lab, 10)) lab.sphere({0, 0, z + 1e-5});
  expect_the_same(State(*settle(lab, Method::sdem, 4)), State(*settle(lab, Method::ndem, 4)));
}

TEST(MethodsAgree, PyramidWithoutFriction) {                   // four layers of squares in a frame
  NonsmoothLab lab(0.18, 0, 0);
  lab.under_gravity();
  lab.floor();
  constexpr int base = 4;                                      // even: the middle one of an odd row is pushed aside
  const double half = base * R;
  for (const double side : {-1.0, 1.0}) {
    lab.body(PlaneShape{}, {{side * half, 0, 0}, rotation_by({0, -side * M_PI / 2, 0})});
    lab.body(PlaneShape{}, {{0, side * half, 0}, rotation_by({side * M_PI / 2, 0, 0})});
  }
  for (int k = 0; k < base; ++k)
    for (int i = 0; i < base - k; ++i)
      for (int j = 0; j < base - k; ++j) lab.sphere({(2 * i - (base - k - 1)) * R, (2 * j - (base - k - 1)) * R, R * (1 + k * std::sqrt(2.0))});
  const State smooth(*settle(lab, Method::sdem, 4)), nonsmooth(*settle(lab, Method::ndem, 4));
  EXPECT_GT(smooth.force.size(), 50u);
  EXPECT_NEAR(smooth.floor / (30 * m * g), 1, 1e-6);
  expect_the_same(smooth, nonsmooth);
}

NonsmoothLab heap(double friction, double rolling_friction) {
  NonsmoothLab lab(0.18, friction, rolling_friction);
  lab.under_gravity();
  lab.floor();
  for (const double side : {-1.0, 1.0}) {
    lab.body(PlaneShape{}, {{side * 7 * R, 0, 0}, rotation_by({0, -side * M_PI / 2, 0})});
    lab.body(PlaneShape{}, {{0, side * 7 * R, 0}, rotation_by({side * M_PI / 2, 0, 0})});
  }
  add_cloud(lab, 6, 2.2 * R, 8, 0, false);
  std::fill(lab.particles().radius.data.begin(), lab.particles().radius.data.end(), R);
  std::fill(lab.particles().mass.data.begin(), lab.particles().mass.data.end(), m);
  std::fill(lab.particles().velocity.data.begin(), lab.particles().velocity.data.end(), Vec3{});
  for (Vec3& x : lab.particles().position.data) x.z += 8 * R;
  lab.model.solver.tolerance = 1e-6;
  return lab;
}

// Each method settles its own packing: what carries the weight agrees, forces in the mean.
TEST(MethodsAgree, HeapsCarryTheirWeight) {
  const NonsmoothLab lab = heap(0.91, 0.3211);
  const State smooth(*settle(lab, Method::sdem, 3)), nonsmooth(*settle(lab, Method::ndem, 3));
  const double weight = 216 * m * g;
  for (const State* s : {&smooth, &nonsmooth}) {
    double carried = 0;
    for (const BodyLoad& load : s->seen.loads) carried -= load.force.z;
    EXPECT_NEAR(carried / weight, 1, 1e-3);
  }
  const auto mean = [](const State& s) { return s.normal_force / double(s.seen.contacts + s.seen.body_contacts); };
  const auto note = [](const char* what, double a, double b) { RecordProperty(what, std::to_string(a) + " " + std::to_string(b)); };
  note("contacts", double(smooth.seen.contacts), double(nonsmooth.seen.contacts));
  note("mean_normal_force", mean(smooth), mean(nonsmooth));
  note("overlaps_in_diameters", smooth.overlaps / (2 * R), nonsmooth.overlaps / (2 * R));
  note("floor_of_weight", smooth.floor / weight, nonsmooth.floor / weight);
  note("highest", smooth.seen.highest, nonsmooth.seen.highest);
  note("speed", smooth.seen.max_speed, nonsmooth.seen.max_speed);
  EXPECT_NEAR(mean(nonsmooth) / mean(smooth), 1, 0.1);
  EXPECT_NEAR(nonsmooth.overlaps / smooth.overlaps, 1, 0.1);
}

// Without friction, the packing that one method has settled is at rest for the other too, under the same forces.
TEST(MethodsAgree, HeapWithoutFrictionIsHandedOver) {
  NonsmoothLab lab = heap(0, 0);
  lab.model.solver.tolerance = 1e-9;
  const auto before = settle(lab, Method::sdem, 6);
  const std::vector<Vec3> at_rest = by_id(*before, &Particles::position);
  lab.particles().position.data.assign(at_rest.begin(), at_rest.end());
  expect_the_same(State(*before), State(*settle(lab, Method::ndem, 1)));
}

}  // namespace
}  // namespace skred
