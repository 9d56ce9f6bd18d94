// The energy ledger under every contact law of Pettersson 2015, chapter 2: what it says was lost is what closed forms say, and it closes to
// second order in the step.
#include <gtest/gtest.h>
#include <algorithm>
#include "tests/physics/books.h"
#include "tests/physics/stir.h"

namespace skred::lab {
namespace {

constexpr double g = 9.81;
const double m = sphere_mass(pellet_radius);

PairCoefficients& pair_of(Lab& l) { return l.model.pairs.values[0]; }

std::string name_of(const ContactModel& c) { return std::string(word_of(c.normal)) + " " + word_of(c.tangential) + " " + word_of(c.rolling) + (c.pull ? " pull" : ""); }

Lab with(const ContactModel& laws, double restitution, double friction, double rolling_friction) {
  Lab l(restitution, friction, rolling_friction);
  l.model.contact = laws;
  PairCoefficients& k = pair_of(l);
  k.normal_stiffness = 4000, k.damping_time = 1e-4, k.tangential_damping = 0.5, k.rolling_viscosity = 0.5;
  return l;
}

// Impacts --------------------------------------------------------------------------------------------------------------

Lab head_on(NormalLaw law, double e, double speed, double radius = pellet_radius, double mass = sphere_mass(pellet_radius)) {
  Lab l = with({.normal = law}, e, 0, 0);
  l.sphere({-1.0001 * radius, 0, 0}, {0.5 * speed, 0, 0}, {}, radius, mass);
  l.sphere({1.0001 * radius, 0, 0}, {-0.5 * speed, 0, 0}, {}, radius, mass);
  return l;
}

// (1 - e^2) 1/2 m_eff v^2
TEST(EnergyOfLaws, ImpactLosesOneLessESquared) {
  const double speed = 1, kinetic = 0.25 * m * speed * speed;
  for (const NormalLaw law : {NormalLaw::hertz, NormalLaw::linear, NormalLaw::walton_braun})
    for (const double e : {0.3, 0.6, 1.0}) {
      const Lab l = head_on(law, e, speed);
      const Account a = run(l, 8e-3, 4e-6), half = run(l, 8e-3, 2e-6);
      // the dashpot of the linear law begins with a jump, at a moment within the step
      EXPECT_NEAR(a.flow.normal / kinetic, 1 - e * e, law == NormalLaw::linear ? 4e-3 : 2e-4) << word_of(law) << " " << e;
      EXPECT_EQ(a.now.elastic_normal, 0);
      EXPECT_LT(a.greatest, 1e-4 * kinetic) << word_of(law) << " " << e;
      EXPECT_NEAR(a.greatest / half.greatest, 4, 0.5) << word_of(law) << " " << e;
    }
}

// Restitutions of an independent integration (tests/physics/contact_laws_test.cpp).
TEST(EnergyOfLaws, KuwabaraKonoLosesMoreWhenFast) {
  const double speeds[] = {0.1, 1, 3}, e[] = {0.8116, 0.7241, 0.6732}, mass = sphere_mass(0.01, 2500);
  for (int k = 0; k < 3; ++k) {
    Lab l = head_on(NormalLaw::kuwabara_kono, 1, speeds[k], 0.01, mass);
    l.model.pairs = one_pair(1, 0, 0, {2500, 1e8, 0.3});
    pair_of(l).damping_time = 5e-5;
    const double kinetic = 0.25 * mass * speeds[k] * speeds[k];
    const Account a = run(l, 4e-4 / speeds[k] + 2e-3, 1e-6);
    EXPECT_NEAR(a.flow.normal / kinetic, 1 - e[k] * e[k], 1e-3) << speeds[k];
    EXPECT_LT(a.greatest, 1e-4 * kinetic);
  }
}

// Pressed, let go by half and pressed further, a contact of Walton & Braun's has kept 1/2 k_1 (1 - k_1 / k_2) g_max^2 and holds 1/2 k_1^2 g_max^2 / k_2.
TEST(EnergyOfLaws, WaltonBraunKeepsThePlasticWork) {
  const double e = 0.5, stiffness = 4000, deep = 2e-4, speed = 0.002;
  Lab l = with({.normal = NormalLaw::walton_braun}, e, 0, 0);
  l.sphere({0, 0, pellet_radius});
  l.body(PlaneShape{});
  l.body(PlaneShape{}, {{0, 0, 2 * pellet_radius}, rotation_by({M_PI, 0, 0})}, Motion::kinematic);
  const double first = 1.2 * deep / speed, back = 0.1 * deep / speed, again = 0.9 * deep / speed;     // the sphere has two sides
  l.model.pieces = {{}, {{0, first, {0, 0, -speed}, {}, {}}, {first, first + back, {0, 0, speed}, {}, {}},
                         {first + back, first + back + again, {0, 0, -speed}, {}, {}}}};
  const Account a = run(l, first + back + again + 0.05, 5e-6);
  const double pressed = 2 * 0.5 * stiffness * deep * deep;  // both sides
  EXPECT_NEAR(a.flow.normal / (pressed * (1 - e * e)), 1, 0.01);
  EXPECT_NEAR(a.now.elastic_normal / (pressed * e * e), 1, 0.02);
  EXPECT_NEAR(a.flow.bodies / pressed, 1, 0.01);
  EXPECT_LT(a.greatest, 1e-3 * pressed);
}

// On a floor -----------------------------------------------------------------------------------------------------------

// A sphere that lies on a floor; its normal force is its weight.
Lab on_a_floor(const ContactModel& laws, double friction, double rolling_friction, Vec3 velocity, Vec3 spin) {
  Lab l = with(laws, 0.18, friction, rolling_friction);
  const double hertz = 4.0 / 3.0 * pair_of(l).young_eff * std::sqrt(pellet_radius);
  const double overlap = is_linear(laws.normal) ? m * g / pair_of(l).normal_stiffness : std::pow(m * g / hertz, 2.0 / 3.0);
  l.model.gravity = {0, 0, -g};
  l.body(PlaneShape{});
  l.sphere({0, 0, pellet_radius - overlap}, velocity, spin);
  return l;
}
double arm_of(Lab& l) { return 0.5 * (1 + l.particles().position.data[0].z / pellet_radius); }              // of R

// Until it rolls, friction takes 1 / (1 + m a^2 / I) of the energy of a sphere that was set down sliding, whatever its law.
TEST(EnergyOfLaws, SlidingUntilItRolls) {
  for (const NormalLaw normal : {NormalLaw::hertz, NormalLaw::linear, NormalLaw::walton_braun, NormalLaw::kuwabara_kono})
    for (const TangentialLaw law : {TangentialLaw::spring, TangentialLaw::coulomb, TangentialLaw::viscous, TangentialLaw::haff_werner,
                                    TangentialLaw::walton_braun}) {
      const ContactModel laws{.normal = normal, .tangential = law};
      Lab l = on_a_floor(laws, 0.3, 0, {0.5, 0, 0}, {});
      const double arm = arm_of(l), kinetic = 0.5 * m * 0.25, slip = kinetic / (1 + 2.5 * arm * arm);
      const Account a = run(l, 0.1, 4e-5);
      EXPECT_NEAR(a.flow.tangential / slip, 1, 2e-3) << name_of(laws);
      EXPECT_LT(std::abs(a.flow.normal) + std::abs(a.flow.rolling) + a.now.elastic_tangential, 1e-3 * kinetic) << name_of(laws);
      const double force = law == TangentialLaw::viscous ? pair_of(l).tangential_damping * 0.5 : 0.3 * m * g;
      const double of_verlet = 0.125 * 4e-5 * 4e-5 * force * force * (1 + 2.5 * arm * arm) / m;       // h^2/8 (F^2/m + T^2/I)
      EXPECT_LT(a.greatest, 1.1 * of_verlet + 1e-7 * kinetic) << name_of(laws);
    }
}

// A sphere that sways on its friction spring: after a quarter of a period the spring holds what slipped, m_red v^2 / 2, 1/m_red = 1/m + a^2/I.
TEST(EnergyOfLaws, FrictionSpringHoldsTheSway) {
  const double v = 1e-4;
  Lab l = on_a_floor({.normal = NormalLaw::linear}, 100, 0, {v, 0, 0}, {});
  pair_of(l).restitution = 1;
  const double arm = arm_of(l), mobility = (1 + 2.5 * arm * arm) / m, slipping = 0.5 * v * v / mobility;
  const double stiffness = pair_of(l).normal_stiffness * 4 * pair_of(l).shear_eff / pair_of(l).young_eff;
  const double period = 2 * M_PI / std::sqrt(stiffness * mobility);
  const Account quarter = run(l, period / 4, period / 4000), half = run(l, period / 2, period / 4000);
  EXPECT_NEAR(quarter.now.elastic_tangential / slipping, 1, 0.01);
  EXPECT_NEAR(half.now.elastic_tangential / slipping, 0, 0.01);
  EXPECT_NEAR(half.flow.tangential / slipping, 0, 0.01);     // the spring's history is of first order
}

// A sphere on smooth ground that is turned a little: its rolling spring takes up I w^2 / 2.
TEST(EnergyOfLaws, RollingSpringHoldsTheTurn) {
  const double w = 0.01, turning = 0.2 * m * pellet_radius * pellet_radius * w * w;
  Lab l = on_a_floor({.normal = NormalLaw::linear, .tangential = TangentialLaw::none}, 0, 5, {}, {0, w, 0});
  const double stiffness = pair_of(l).normal_stiffness * 4 * pair_of(l).shear_eff / pair_of(l).young_eff;
  const double period = 2 * M_PI / std::sqrt(stiffness / (0.4 * m));
  const Account quarter = run(l, period / 4, period / 4000), half = run(l, period / 2, period / 4000);
  EXPECT_NEAR(quarter.now.elastic_rolling / turning, 1, 0.01);
  EXPECT_NEAR(half.now.elastic_rolling / turning, 0, 0.01);
  EXPECT_NEAR(half.flow.rolling / turning, 0, 0.01);
}

// Slip under the viscous law decays with the rate gamma_t (1/m + a^2/I).
TEST(EnergyOfLaws, ViscousSlip) {
  Lab l = on_a_floor({.tangential = TangentialLaw::viscous}, 0, 0, {0.5, 0, 0}, {});
  pair_of(l).tangential_damping = 0.05;
  const double arm = arm_of(l), mobility = (1 + 2.5 * arm * arm) / m, rate = 0.05 * mobility;
  for (const double time : {0.5 / rate, 2 / rate})
    EXPECT_NEAR(run(l, time, 1e-5).flow.tangential / (0.5 * 0.25 / mobility * (1 - std::exp(-2 * rate * time))), 1, 2e-3);
}

// mu N s of a box that slides, N its weight.
TEST(EnergyOfLaws, ABoxThatSlides) {
  for (const TangentialLaw law : {TangentialLaw::coulomb, TangentialLaw::haff_werner, TangentialLaw::walton_braun, TangentialLaw::spring}) {
    const double mu = 0.5, a = 0.02, mass = 0.05, i = 2 * mass * a * a / 3, stiffness = 4000;
    Lab l = with({.normal = NormalLaw::linear, .tangential = law}, 0.3, mu, 0);
    l.model.gravity = {0, 0, -g};
    l.model.energy = true;
    l.model.time_step = 2e-5;
    l.body(PlaneShape{});
    l.sphere({0, 1, pellet_radius - m * g / stiffness});     // a step needs a particle
    l.body(BoxShape{{a, a, a}}, {{0, 0, a}, {}}, Motion::dynamic, mass, {i, i, i});
    l.bodies().velocity.data[1] = {1.2, 0, 0};
    const auto s = l.build();
    s->start();
    const auto go = [&](double until) {
      while (s->time() < until) s->step(Execution::list);
      return std::pair(books_of(*s), std::get<Bodies>(s->world()).pose.data[1].position.x);
    };
    const auto [before, from] = go(0.1);                     // it has come to lie flat
    const auto [after, to] = go(0.2);
    EXPECT_GT(to - from, 0.01);
    EXPECT_NEAR((after.flow.tangential - before.flow.tangential) / (mu * mass * g * (to - from)), 1, 0.01) << word_of(law);
    EXPECT_LT(std::abs(after.error), 1e-4 * after.start.total()) << word_of(law);
  }
}

// mu_r R m g per angle: rolling resistance takes it all. A viscous one leaves exp(-2 * 5/7 mu g t) of it.
TEST(EnergyOfLaws, RollingToRest) {
  const double v = 0.5, kinetic = 0.7 * m * v * v;
  for (const NormalLaw normal : {NormalLaw::hertz, NormalLaw::linear})
    for (const RollingLaw law : {RollingLaw::constant_torque, RollingLaw::spring, RollingLaw::viscous}) {
      const ContactModel laws{.normal = normal, .rolling = law};
      Lab l = on_a_floor(laws, 0.91, 0.3211, {v, 0, 0}, {0, v / pellet_radius, 0});
      pair_of(l).rolling_damping = 0.1, pair_of(l).rolling_viscosity = 0.8;
      const Account a = run(l, 0.4, 4e-5);
      const double left = law == RollingLaw::viscous ? std::exp(-2 * 5.0 / 7.0 * 0.8 * g * 0.4) : 0;
      EXPECT_NEAR(a.flow.rolling / kinetic, 1 - left, 0.01) << name_of(laws);
      EXPECT_LT(std::abs(a.flow.tangential), 0.01 * kinetic) << name_of(laws);
      EXPECT_LT(a.greatest, 5e-5 * kinetic) << name_of(laws);
    }
}

// A stir of all ---------------------------------------------------------------------------------------------------------

// Each law of its kind beside the defaults, and mixtures.
const ContactModel every_law[] = {
    {NormalLaw::linear, TangentialLaw::spring, RollingLaw::spring},
    {NormalLaw::kuwabara_kono, TangentialLaw::spring, RollingLaw::spring},
    {NormalLaw::walton_braun, TangentialLaw::spring, RollingLaw::spring},
    {NormalLaw::hertz, TangentialLaw::coulomb, RollingLaw::spring},
    {NormalLaw::hertz, TangentialLaw::viscous, RollingLaw::spring},
    {NormalLaw::hertz, TangentialLaw::haff_werner, RollingLaw::spring},
    {NormalLaw::hertz, TangentialLaw::walton_braun, RollingLaw::spring},
    {NormalLaw::hertz, TangentialLaw::spring, RollingLaw::constant_torque},
    {NormalLaw::hertz, TangentialLaw::spring, RollingLaw::viscous},
    {NormalLaw::walton_braun, TangentialLaw::walton_braun, RollingLaw::constant_torque},
    {NormalLaw::linear, TangentialLaw::coulomb, RollingLaw::viscous},
    {NormalLaw::hertz, TangentialLaw::spring, RollingLaw::spring, true},
    {NormalLaw::linear, TangentialLaw::haff_werner, RollingLaw::viscous, true},
    {NormalLaw::kuwabara_kono, TangentialLaw::none, RollingLaw::viscous},
    {NormalLaw::walton_braun, TangentialLaw::haff_werner, RollingLaw::none},
    {NormalLaw::linear, TangentialLaw::none, RollingLaw::none},
};

Lab stirred(const ContactModel& laws) {
  Lab l = with(laws, 0.4, 0.5, 0.2);
  pair_of(l).rolling_damping = 0.1;
  l.model.gravity = {0, 0, -g};
  add_stir(l);
  return l;
}

class EnergyOfEveryLaw : public ::testing::TestWithParam<ContactModel> {};
INSTANTIATE_TEST_SUITE_P(Laws, EnergyOfEveryLaw, ::testing::ValuesIn(every_law), [](const auto& of) {
  std::string name = name_of(of.param);
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

TEST_P(EnergyOfEveryLaw, Closes) {
  const Account whole = run(stirred(GetParam()), 0.06, 2e-5), half = run(stirred(GetParam()), 0.06, 1e-5);
  EXPECT_GT(whole.flow.lost(), 0.01);                        // [J]
  EXPECT_LT(whole.greatest, 1e-3 * whole.flow.lost());
  // A hysteretic contact that is pressed again begins to lose energy at a moment within the step: first order, either way.
  if (GetParam().normal == NormalLaw::walton_braun) EXPECT_LT(half.greatest, whole.greatest);
  else EXPECT_NEAR(whole.greatest / half.greatest, 4, 1) << whole.greatest << " " << half.greatest;
}

TEST_P(EnergyOfEveryLaw, LeavesNoTraceAndHasTheSameBits) {
  const auto end_of = [](bool energy, int threads) {
    Lab l = stirred(GetParam());
    l.model.energy = energy;
    const auto s = l.build(threads);
    s->start();
    std::size_t touched = 0;
    while (s->steps_done() < 300) {
      s->step();
      if (s->steps_done() % 50 == 0) touched += measure(*s).contacts;
    }
    EXPECT_GT(touched, 20u);
    return std::pair(s->state_hash(), books_of(*s));
  };
  expect_same_bits_and_no_trace(end_of, [](const EnergyFlow& f) { return f.lost(); });
}

}  // namespace
}  // namespace skred::lab
