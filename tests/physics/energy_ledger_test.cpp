// The energy ledger closes: to second order in the step for smooth DEM, to first for nonsmooth DEM, and what it says was lost is
// what closed forms say.
#include <gtest/gtest.h>
#include "tests/physics/books.h"

namespace skred::lab {
namespace {

constexpr double g = 9.81;
const double m = sphere_mass(pellet_radius);

// Both methods; steps that both can take.
struct Kind { Method method; double step; };
class EnergyLedgerOf : public ::testing::TestWithParam<Kind> {
 protected:
  bool smooth() const { return GetParam().method == Method::sdem; }
  double step() const { return GetParam().step; }
  Account account(const Lab& lab, double time, double part = 1) const { return run(smooth() ? lab : nonsmooth(lab), time, part * step()); }

  // Halving the step quarters the error of smooth DEM, and halves that of nonsmooth DEM.
  Account expect_order(const Lab& lab, double time, double bound) const {
    const Account whole = account(lab, time), half = account(lab, time, 0.5);
    EXPECT_LT(whole.greatest, bound);
    const double ratio = whole.greatest / half.greatest;
    EXPECT_NEAR(ratio, smooth() ? 4 : 2, smooth() ? 0.4 : 0.5) << whole.greatest << " " << half.greatest;
    return whole;
  }
};
INSTANTIATE_TEST_SUITE_P(Methods, EnergyLedgerOf, ::testing::Values(Kind{Method::sdem, 4e-5}, Kind{Method::ndem, 1e-3}),
                         [](const auto& of) { return of.param.method == Method::sdem ? "Smooth" : "Nonsmooth"; });

double resting_overlap() { return std::pow(m * g / (4.0 / 3.0 * elastic_pair(pellet, pellet).young_eff * std::sqrt(pellet_radius)), 2.0 / 3.0); }

// A sphere that lies on a floor.
Lab on_a_floor(double friction, double rolling, Vec3 velocity, Vec3 spin) {
  Lab l(0.18, friction, rolling);
  l.model.gravity = {0, 0, -g};
  l.body(PlaneShape{});
  l.sphere({0, 0, pellet_radius - resting_overlap()}, velocity, spin);
  return l;
}

TEST_P(EnergyLedgerOf, FreeFlight) {
  Lab l(0.5, 0.3, 0.1);
  l.model.gravity = {1, 0, -g};
  l.sphere({0, 0, 1}, {1, 2, 3}, {4, 5, 6});
  const Account a = account(l, 0.2);
  EXPECT_EQ(a.flow.lost(), 0);
  // Symplectic Euler takes m g^2 h t / 2 from a body that falls for t, and gives it back when it rises.
  const double of_euler = smooth() ? 0 : -0.5 * m * (g * g + 1) * step() * 0.2;
  EXPECT_NEAR(a.error, of_euler, 1e-12 * a.start.total());
}

TEST_P(EnergyLedgerOf, BinaryCollisionLosesOneLessESquared) {
  const double kinetic = m * 0.25;                           // [J] of both
  for (const double e : {1.0, 0.5, 0.18}) {
    Lab l(e, 0, 0);
    l.sphere({-1.01 * pellet_radius, 0, 0}, {0.5, 0, 0});
    l.sphere({1.01 * pellet_radius, 0, 0}, {-0.5, 0, 0});
    const Account a = account(l, 0.01);
    EXPECT_NEAR(a.flow.lost() / kinetic, 1 - e * e, smooth() ? 2e-3 : 1e-12) << e;
    EXPECT_EQ(smooth() ? a.flow.impacts : a.flow.normal, 0);
    EXPECT_NEAR(a.flow.tangential + a.flow.rolling, 0, 1e-15);
    EXPECT_EQ(a.now.elastic_normal, 0);                      // they have parted
    EXPECT_LT(a.greatest, (smooth() ? 2e-3 : 1e-12) * kinetic) << e;
    if (!smooth()) continue;
    const Account half = account(l, 0.01, 0.5);
    EXPECT_NEAR(a.greatest / half.greatest, 4, 0.5) << e;
  }
}

// Until it rolls, friction takes 1 / (1 + m a^2 / I) of the energy of a sphere that was set down sliding; a = R - overlap/2.
TEST_P(EnergyLedgerOf, SlidingUntilItRolls) {
  const Account a = account(on_a_floor(0.3, 0, {0.5, 0, 0}, {}), 0.1);
  const double arm = 1 - 0.5 * resting_overlap() / pellet_radius, kinetic = 0.5 * m * 0.25;
  EXPECT_NEAR(a.flow.tangential / kinetic, 1 / (1 + 2.5 * arm * arm), 1e-4);
  EXPECT_NEAR((a.now.translation + a.now.rotation) / kinetic, 1 - 1 / (1 + 2.5 * arm * arm), 1e-4);
  EXPECT_LT(std::abs(a.flow.normal) + std::abs(a.flow.rolling) + std::abs(a.flow.impacts), 1e-9 * kinetic);
  EXPECT_LT(a.greatest, 1e-6 * kinetic);
}

// Rolling resistance takes it all, and is mu_r m g times the way.
TEST_P(EnergyLedgerOf, RollingToRest) {
  Lab l = on_a_floor(0.91, 0.3211, {0.5, 0, 0}, {0, 0.5 / pellet_radius, 0});
  l.model.energy = true;
  l.model.time_step = step();
  if (!smooth()) l = nonsmooth(l);
  const auto s = l.build();
  s->start();
  while (s->time() < 0.4) s->step(Execution::list);
  const Books a = books_of(*s);
  const double kinetic = 0.7 * m * 0.25;
  EXPECT_NEAR(a.flow.rolling / kinetic, 1, 1e-3);
  EXPECT_NEAR(a.flow.rolling / (0.3211 * m * g * position(*s, 0).x), 1, 0.01);
  EXPECT_LT(std::abs(a.flow.tangential), 1e-3 * kinetic);
  EXPECT_LT(std::abs(a.error), 1e-6 * kinetic);
}

// Friction takes mu m g s from a box that slides.
TEST_P(EnergyLedgerOf, ABoxThatSlides) {
  Lab l(0.3, 0.5, 0);
  l.model.gravity = {0, 0, -g};
  l.model.energy = true;
  l.model.time_step = smooth() ? step() : 0.5 * step();
  if (!smooth()) l = nonsmooth(l);
  l.body(PlaneShape{});
  const double a = 0.02, mass = 0.05, i = 2 * mass * a * a / 3;
  l.sphere({0, 1, pellet_radius - resting_overlap()});       // a step needs a particle
  l.body(BoxShape{{a, a, a}}, {{0, 0, a}, {}}, Motion::dynamic, mass, {i, i, i});
  l.bodies().velocity.data[1] = {1.2, 0, 0};
  const auto s = l.build();
  const auto go = [&](double until) {
    while (s->time() < until) s->step(Execution::list);
    return std::pair(books_of(*s), std::get<Bodies>(s->world()).pose.data[1].position.x);
  };
  s->start();
  const auto [before, from] = go(0.12);                      // it has come to lie flat
  const auto [after, to] = go(0.22);
  EXPECT_GT(to - from, 0.01);
  EXPECT_NEAR((after.flow.tangential - before.flow.tangential) / (0.5 * mass * g * (to - from)), 1, 0.01);
  EXPECT_LT(std::abs(after.error), (smooth() ? 1e-4 : 1e-2) * after.start.total());
}

Lab stirred_cloud(Motion of_floor = Motion::fixed) {
  Lab l(0.18, 0.91, 0.3211);
  l.model.gravity = {0, 0, -g};
  l.body(PlaneShape{}, {{0, 0, -0.03}, {}}, of_floor);
  add_cloud(l, 4, 2.1 * pellet_radius, 3, 1.0);
  return l;
}

TEST_P(EnergyLedgerOf, CloudOnAPlane) {
  const Account a = expect_order(stirred_cloud(), 0.1, smooth() ? 2e-5 : 8e-4);
  EXPECT_GT(a.flow.lost(), 0.04);                            // [J]; the bound is 1/2000 and 1/50 of that
  EXPECT_EQ(a.flow.bodies, 0);
}

// A drum that turns: what its wall does is neither stored nor lost otherwise.
TEST_P(EnergyLedgerOf, Drum) {
  Lab l(0.18, 0.91, 0.3211);
  l.model.gravity = {0, 0, -g};
  add_cloud(l, 4, 2.1 * pellet_radius, 3, 1.0);
  const double size = 12 * pellet_radius;
  const Index drum = l.body(HollowCylinderShape{0.5 * size, size, 0.02}, {{}, rotation_by({M_PI / 2, 0, 0})}, Motion::kinematic);
  l.geometry(drum, BoxShape{{0.5 * pellet_radius, pellet_radius, pellet_radius}}, {{0.5 * size - pellet_radius, 0, 0}, {}});
  l.model.pieces = {{MotionPiece{0, 10, {0, 0, 0}, {0, 8, 0}, {}}}};
  const Account a = expect_order(l, 0.2, smooth() ? 3e-5 : 1.2e-3);
  EXPECT_GT(a.flow.bodies, 0.015);                           // [J]
}

TEST_P(EnergyLedgerOf, AShakenFloor) {
  Lab l = stirred_cloud(Motion::kinematic);
  const double w = 2 * M_PI * 20;
  l.model.pieces = {{MotionPiece{.end = 10, .velocity = {0, 0, w * 0.004}, .frequency = 20}}};
  const Account a = expect_order(l, 0.2, smooth() ? 1e-4 : 3e-3);
  EXPECT_GT(a.flow.bodies, 0.05);                            // [J]
}

// A plate that presses a sphere down and stops: its work is what the springs hold, and what the dashpots took. A prescribed velocity that
// jumps by dv under the force F leaves an error of h/2 F dv behind.
TEST_P(EnergyLedgerOf, AKinematicPlatePressesASphere) {
  Lab l = on_a_floor(0.5, 0.1, {}, {});
  l.body(PlaneShape{}, {{0, 0, 2 * pellet_radius - resting_overlap()}, rotation_by({M_PI, 0, 0})}, Motion::kinematic);
  l.model.pieces = {{}, {MotionPiece{0, 0.05, {0, 0, -0.01}, {}, {}}}};
  const Account a = account(l, 0.1);
  const double hertz = 4.0 / 3.0 * elastic_pair(pellet, pellet).young_eff * std::sqrt(pellet_radius);
  const double each = 0.5 * (0.01 * 0.05 + resting_overlap());               // [m] overlap at the plate and at the floor, but for the weight
  EXPECT_NEAR(a.now.elastic_normal / (2 * 0.4 * hertz * std::pow(each, 2.5)), 1, 0.01);
  EXPECT_GT(a.flow.bodies, 0);
  const double jump = 0.5 * step() * hertz * std::pow(each, 1.5) * 0.01;
  EXPECT_LT(a.greatest, smooth() ? 1.1 * jump : 0.02 * a.flow.bodies);
  if (!smooth()) return;
  EXPECT_LT(1.1 * jump, 2e-3 * a.flow.bodies);
}

// Gravity along a periodic direction has no potential that particles could come back to.
TEST_P(EnergyLedgerOf, FallsThroughAPeriodicBox) {
  Lab l(0.5, 0.3, 0.1);
  const double edge = 0.1;
  l.model.gravity = {0, 0, -g};
  l.model.periodic = PeriodicSpace{{0, 0, 0}, {edge, edge, edge}};
  l.sphere({0.05, 0.05, 0.05});
  l.sphere({0.05, 0.05, 0.09}, {0, 0, -1});
  const Account a = account(l, 0.3);
  EXPECT_GT(a.now.translation, 10 * 2 * m * g * edge * 0.1);
  EXPECT_LT(std::abs(a.error), (smooth() ? 1e-4 : 1e-2) * a.now.translation);
}

TEST_P(EnergyLedgerOf, SameBitsForAnyNumberOfThreads) {
  const Lab l = smooth() ? stirred_cloud() : nonsmooth(stirred_cloud());
  const Account one = run(l, 0.05, step()), many = run(l, 0.05, step(), 4);
  EXPECT_EQ(one.error, many.error);
  EXPECT_EQ(one.now.total(), many.now.total());
  EXPECT_EQ(one.flow.lost(), many.flow.lost());
}

TEST(EnergyLedger, IsNotKeptUnasked) {
  const auto s = stirred_cloud().build();
  s->start();
  s->step();
  EXPECT_EQ(books_of(*s).start.total(), 0);
  for (std::size_t k = 0; k < s->task().size(); ++k) EXPECT_EQ(std::string(s->task().name(k)).find("energy"), std::string::npos);
}

}  // namespace
}  // namespace skred::lab
