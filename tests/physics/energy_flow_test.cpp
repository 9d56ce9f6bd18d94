// The energy ledger while particles come and go: what they carry is in it.
#include <gtest/gtest.h>
#include "tests/physics/books.h"

namespace skred::lab {
namespace {

constexpr double g = 9.81, R = pellet_radius;
const double m = sphere_mass(R);

struct Kind { Method method; double step; };
class EnergyFlowOf : public ::testing::TestWithParam<Kind> {
 protected:
  bool smooth() const { return GetParam().method == Method::sdem; }
  double step() const { return GetParam().step; }
  Account account(const Lab& lab, double time, double part = 1) const { return run(smooth() ? lab : nonsmooth(lab), time, part * step()); }
};
INSTANTIATE_TEST_SUITE_P(Methods, EnergyFlowOf, ::testing::Values(Kind{Method::sdem, 4e-5}, Kind{Method::ndem, 1e-3}),
                         [](const auto& of) { return of.param.method == Method::sdem ? "Smooth" : "Nonsmooth"; });

Inflow from_above(double rate, std::int64_t number) {
  Inflow f;
  f.region = CylinderRegion{{0, 0, 0.06}, {0, 0, 1}, 0.04, 0.04};
  f.rate = rate, f.number = number;
  f.radius_min = 0.8 * R, f.radius_max = R;
  f.density = pellet_density;
  f.velocity = {0, 0, -0.5}, f.angular_velocity = {10, 0, 20};
  f.seed = 3;
  return f;
}

// In free fall nothing is lost: what came in is there.
TEST_P(EnergyFlowOf, ParticlesThatFallIn) {
  Lab l(0.5, 0, 0);
  l.model.gravity = {0, 0, -g};
  l.sphere({0, 0, -5});
  l.model.inflows = {from_above(200, 8)};
  const Account a = account(l, 0.1);
  EXPECT_GT(a.flow.carried_in, 8 * 0.5 * 0.5 * m * 0.25);    // the smallest, without its height
  EXPECT_EQ(a.flow.lost(), 0);
  // symplectic Euler takes m g^2 h t / 2 from each
  EXPECT_LT(std::abs(a.error), smooth() ? 1e-12 * 5 * m * g : 9 * m * 0.5 * g * g * step() * 0.1);
}

// One sphere of known size: 1/2 m v^2 + 1/2 I w^2 + m g z.
TEST_P(EnergyFlowOf, WhatOneCarriesIn) {
  Lab l(0.5, 0, 0);
  l.model.gravity = {0, 0, -g};
  l.sphere({0, 0, -5});
  Inflow f = from_above(100, 1);
  f.radius_min = f.radius_max = R;
  f.region = BoxRegion{{-R, -R, 0.1 - 1.0001 * R}, {R, R, 0.1 + R}};
  l.model.inflows = {f};
  const Account a = account(l, 0.03);
  EXPECT_NEAR(a.flow.carried_in / (0.5 * m * 0.25 + 0.2 * m * R * R * 500 + m * g * 0.1), 1, 1e-4);
}

// A sphere that falls for 0.1 s and is taken out has carried away what it began with.
TEST_P(EnergyFlowOf, ParticlesThatFallOut) {
  Lab l(0.5, 0.3, 0.1);
  l.model.gravity = {0, 0, -g};
  l.sphere({0, 0, -5});
  l.sphere({0, 0, 0.2}, {1, 0, 0}, {5, 6, 7});
  l.model.removers = {{BoxRegion{{-1, -1, -1}, {1, 1, 0.2 - 0.5 * g * 0.01}}}};
  const Account a = account(l, 0.15);
  const double began_with = 0.5 * m + 0.2 * m * R * R * 110 + m * g * 0.2;
  EXPECT_NEAR(a.flow.carried_out / began_with, 1, smooth() ? 1e-12 : 0.5 * m * g * g * step() * 0.11 / began_with);
  EXPECT_LT(std::abs(a.error), smooth() ? 1e-12 * 5 * m * g : 0.5 * m * g * g * step() * 0.27);
}

// Two spheres pressed together, one is taken out: with it goes what their contact held, and the other has no more than it got in that time.
TEST_P(EnergyFlowOf, WhatAContactHeldGoesToo) {
  Lab l(1, 0, 0);
  const double overlap = 1e-3 * R;
  l.sphere({0, 0, 0});
  l.sphere({2 * R - overlap, 0, 0});
  l.model.removers = {{BoxRegion{{R, -R, -R}, {3 * R, R, R}}, smooth() ? step() : 0}};         // before the first step is solved for
  const Account a = account(l, 20 * step());
  const double held = 8.0 / 15.0 * elastic_pair(pellet, pellet).young_eff * std::sqrt(0.5 * R) * std::pow(overlap, 2.5);
  EXPECT_NEAR(a.start.elastic_normal / held, 1, 1e-9);
  EXPECT_EQ(a.now.elastic_normal, 0);
  EXPECT_NEAR((a.flow.carried_out + a.now.total()) / held, 1, 1e-3);
  EXPECT_GT(a.flow.carried_out, 0.9 * held);
  EXPECT_LT(a.greatest, 1e-3 * held);
}

// A cloud falls through a hole into nothing while more comes from above: all lines of the ledger at once.
Lab through(const ContactModel& laws) {
  Lab l(0.4, 0.5, 0.2);
  l.model.contact = laws;
  PairCoefficients& k = l.model.pairs.values[0];
  k.normal_stiffness = 4000, k.damping_time = 1e-4, k.tangential_damping = 0.5, k.rolling_viscosity = 0.5;
  l.model.gravity = {0, 0, -g};
  add_cloud(l, 4, 2.05 * R, 8, 1.0);
  l.body(PlaneShape{}, {{0, 0, -4.5 * R}, rotation_by({0.2, 0, 0})});
  l.model.removers = {{BoxRegion{{-R, -1, -1}, {3 * R, 1, -2 * R}}, 0.02, 1, 0.004}, {BoxRegion{{-1, -1, -1}, {1, -5 * R, 1}}}};
  Inflow f = from_above(500, 1000);
  f.velocity = {0, 0, -1};
  l.model.inflows = {f};
  return l;
}

TEST_P(EnergyFlowOf, CloudWithComingAndGoing) {
  const Account whole = account(through({}), 0.1), half = account(through({}), 0.1, 0.5);
  EXPECT_GT(whole.flow.carried_in, 0.02);                    // [J]
  EXPECT_GT(std::abs(whole.flow.carried_out), 0.005);
  EXPECT_GT(whole.flow.lost(), 0.02);
  EXPECT_LT(whole.greatest, (smooth() ? 1e-3 : 0.05) * whole.flow.lost());
  EXPECT_NEAR(whole.greatest / half.greatest, smooth() ? 4 : 2, smooth() ? 1 : 0.5) << whole.greatest << " " << half.greatest;
}

TEST_P(EnergyFlowOf, SameBitsAndNoTrace) {
  const auto end_of = [&](bool energy, int threads) {
    Lab l = smooth() ? through({NormalLaw::walton_braun, TangentialLaw::walton_braun, RollingLaw::viscous}) : nonsmooth(through({}));
    l.model.time_step = step();
    l.model.energy = energy;
    const auto s = l.build(threads);
    s->start();
    while (s->time() < 0.06) s->step();
    EXPECT_GT(std::get<Removed>(s->world()).count.data[0], 0);
    return std::pair(s->state_hash(), books_of(*s));
  };
  expect_same_bits_and_no_trace(end_of, [](const EnergyFlow& f) { return f.carried_out; });
}

// Under every law what is removed in the midst of contacts leaves books that close.
TEST(EnergyFlow, ClosesUnderOtherLaws) {
  for (const ContactModel& laws : {ContactModel{NormalLaw::linear, TangentialLaw::walton_braun, RollingLaw::spring},
                                   ContactModel{NormalLaw::walton_braun, TangentialLaw::coulomb, RollingLaw::viscous},
                                   ContactModel{NormalLaw::kuwabara_kono, TangentialLaw::spring, RollingLaw::constant_torque}}) {
    const Account a = run(through(laws), 0.1, 2e-5);
    EXPECT_GT(a.flow.lost(), 0.02) << word_of(laws.normal);
    EXPECT_LT(a.greatest, 1e-3 * a.flow.lost()) << word_of(laws.normal);
  }
}

// Gravity along a periodic direction has no potential: what comes and goes is kinetic, and its work is counted while they are there.
TEST_P(EnergyFlowOf, FallsThroughAPeriodicBox) {
  Lab l(0.5, 0.3, 0.1);
  const double edge = 0.2;
  l.model.gravity = {0, 0, -g};
  l.model.periodic = PeriodicSpace{{-edge / 2, -edge / 2, -edge / 2}, {edge, edge, edge}};
  l.sphere({0.05, 0.05, 0.05});
  l.sphere({0.05, 0.05, 0.09}, {0, 0, -1});
  l.sphere({-0.05, -0.05, 0.09}, {1, 0, -1});
  l.model.removers = {{BoxRegion{{-0.06, -1, -1}, {0, 1, 1}}, 0.15, 0.2}};
  Inflow f = from_above(50, 3);
  f.region = CylinderRegion{{0, 0, 0.03}, {0, 0, 1}, 0.03, 0.03};
  l.model.inflows = {f};
  const Account a = account(l, 0.3);
  EXPECT_GT(a.flow.carried_out, 0);
  EXPECT_GT(a.flow.carried_in, 0);
  EXPECT_LT(a.greatest, (smooth() ? 1e-4 : 1e-2) * a.now.translation);
}

}  // namespace
}  // namespace skred::lab
