// The contact laws of Pettersson 2015, chapter 2, against their closed forms (kernels/chosen_law.h).
#include <gtest/gtest.h>
#include "kernels/chosen_law.h"
#include "tasks/time_step.h"
#include "tests/physics/lab.h"

namespace skred::lab {
namespace {

constexpr double g = 9.81;

PairCoefficients& pair_of(Lab& l) { return l.model.pairs.values[0]; }

// Head-on impacts ------------------------------------------------------------------------------------------------------

struct Impact { double restitution = 0, force_time = 0, overlap = 0; };

// Two equal spheres that begin to touch at this closing speed; `force_time` [s]: until the force has fallen to nothing.
Impact collide(Lab l, double speed, double step, double radius = pellet_radius, double mass = 0) {
  l.model.time_step = step;
  l.sphere({-radius, 0, 0}, {0.5 * speed, 0, 0}, {}, radius, mass);
  l.sphere({radius, 0, 0}, {-0.5 * speed, 0, 0}, {}, radius, mass);
  const auto simulation = l.build();
  Simulation& s = *simulation;
  s.start();
  const Particles& p = std::get<Particles>(s.world());
  Impact out;
  for (int k = 0; k < 200000; ++k) {
    s.step(Execution::serial);
    const double overlap = 2 * radius - norm(p.position.data[1] - p.position.data[0]);
    out.overlap = std::max(out.overlap, overlap);
    if (out.force_time == 0 && p.force.data[0] == Vec3{}) out.force_time = s.time();
    out.restitution = norm(p.velocity.data[1] - p.velocity.data[0]) / speed;
    if (overlap <= 0) return out;
  }
  ADD_FAILURE() << "they do not part";
  return out;
}

Lab head_on(NormalLaw law, double e) {
  Lab l(e, 0, 0);
  l.model.contact.normal = law;
  pair_of(l).normal_stiffness = 2000;
  return l;
}

const double pellet_mass_eff = sphere_mass(pellet_radius) / 2;

// e at every speed, and the force ends when the damped oscillator's first does: t = -ln(e) / (zeta omega) [Schwager & Poeschel 2007].
TEST(LinearLaw, RestitutionAndContactTime) {
  const double omega = std::sqrt(2000 / pellet_mass_eff);
  for (const double e : {0.18, 0.5, 0.9})
    for (const double speed : {0.01, 1.0}) {
      const Impact i = collide(head_on(NormalLaw::linear, e), speed, 1 / omega / 1000);
      EXPECT_NEAR(i.restitution, e, 0.002 * e) << speed;
      EXPECT_NEAR(i.force_time / (-std::log(e) / (damping_ratio_of(e) * omega)), 1, 0.002) << e << " " << speed;
    }
  const Impact elastic = collide(head_on(NormalLaw::linear, 1), 0.3, 1 / omega / 1000);
  EXPECT_NEAR(elastic.overlap / (0.3 / omega), 1, 1e-5);
  EXPECT_NEAR(elastic.force_time * omega / M_PI, 1, 0.001);
}

// beta / omega_0 = .1, .3, .5, .8, .95, 1.5 as integrated by others.
TEST(LinearLaw, RestitutionOfDampingRatios) {
  const double ratio[] = {0.1, 0.3, 0.5, 0.8, 0.95, 1.5}, e[] = {0.7440794, 0.4509755, 0.2984361, 0.1797833, 0.1448127, 0.0755883};
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(restitution_of(ratio[k]), e[k], 1e-6);
}

// The restitution that is asked for when the force may pull, too; the contact then ends with the overlap, after half a period.
TEST(PullingLaw, Restitution) {
  const double omega = std::sqrt(2000 / pellet_mass_eff);
  for (const NormalLaw law : {NormalLaw::hertz, NormalLaw::linear})
    for (const double e : {0.18, 0.5, 0.9, 1.0})
      for (const double speed : {0.01, 1.0}) {
        Lab l = head_on(law, e);
        l.model.contact.pull = true;
        const Impact i = collide(l, speed, 1 / omega / 4000);
        EXPECT_NEAR(i.restitution, e, 0.003 * e) << word_of(law) << " " << speed;
      }
}

// What its dashpot would give with the force cut off: 0.31 for 0.18, as integrated by others.
TEST(PullingLaw, DashpotsOfBothKinds) {
  const double e[] = {0.1, 0.18, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
  const double cut_off[] = {0.2527, 0.3106, 0.3249, 0.3971, 0.4720, 0.5503, 0.6323, 0.7182, 0.8081, 0.9020};
  for (int k = 0; k < 10; ++k) EXPECT_NEAR(restitution_of(damping_ratio_if_pulling(e[k])), cut_off[k], 1e-4);
  EXPECT_EQ(damping_ratio_if_pulling(1), 0);
}

TEST(PullingLaw, ForcePullsAndWhatPullsDoesNotRub) {
  ChosenCoefficients k;
  k.normal_stiffness = 1000, k.normal_damping = 10, k.tangential_stiffness = 700, k.friction = 0.5;
  ChosenContact c{};
  c.overlap = 1e-4, c.normal = {1, 0, 0}, c.normal_velocity = 1, c.tangential_velocity = {0, 0.1, 0}, c.radius_eff = 0.003;
  c.mass_eff = 0.01;
  for (const bool pull : {false, true}) {
    ContactMemory memory;
    const ChosenLaw<true, false, true> law{{NormalLaw::linear, TangentialLaw::spring, RollingLaw::none, pull}};
    const ContactForce<double> f = evaluate(law, c, k, 1e-5, memory);
    EXPECT_NEAR(f.force.x, pull ? 1000 * 1e-4 - 10 * 0.1 : 0, 1e-12);
    EXPECT_EQ(f.force.y, 0);
    EXPECT_EQ(memory.tangential, Vec3{});
  }
}

// Spheres of 10 mm, 100 MPa, nu 0.3, 2500 kg/m^3, A = 50 us; the integral of the equation, cut off at zero.
TEST(KuwabaraKono, RestitutionFallsWithSpeed) {
  const Material soft{2500, 1e8, 0.3};
  Lab l(1, 0, 0);
  l.model.pairs = one_pair(1, 0, 0, soft);
  l.model.contact.normal = NormalLaw::kuwabara_kono;
  pair_of(l).damping_time = 5e-5;
  const double speed[] = {0.1, 0.3, 1, 3}, e[] = {0.8116, 0.7731, 0.7241, 0.6732};
  for (int k = 0; k < 4; ++k)
    EXPECT_NEAR(collide(l, speed[k], 1e-6 / std::pow(speed[k], 0.2), 0.01, sphere_mass(0.01, 2500)).restitution, e[k], 5e-4) << speed[k];
}

// e = sqrt(k_1 / k_2); a quarter of a period of each spring.
TEST(WaltonBraunNormal, RestitutionAndContactTime) {
  const double time = std::sqrt(pellet_mass_eff / 2000);     // 1 / omega
  for (const double e : {0.18, 0.6, 1.0})
    for (const double speed : {0.01, 1.0}) {
      const Impact i = collide(head_on(NormalLaw::walton_braun, e), speed, e * time / 1000);
      EXPECT_NEAR(i.restitution, e, 0.002 * e) << speed;
      EXPECT_NEAR(i.overlap / (speed * time), 1, 1e-4) << e;
      EXPECT_NEAR(i.force_time / (M_PI / 2 * (1 + e) * time), 1, 0.002) << e << " " << speed;
    }
}

TEST(WaltonBraunNormal, PathOfTheForce) {
  ChosenCoefficients k;
  k.normal_stiffness = 100, k.unloading_stiffness = 400;
  ContactMemory memory;
  ContactState<double> c{};
  const auto force = [&](double overlap) {
    c.overlap = overlap;
    return normal_force({.normal = NormalLaw::walton_braun}, c, k, memory);
  };
  EXPECT_NEAR(force(0.5), 50, 1e-10);
  EXPECT_NEAR(force(1.0), 100, 1e-10);
  EXPECT_NEAR(force(0.9), 60, 1e-10);          // down the steep line, g_0 = 3/4
  EXPECT_NEAR(force(0.7), 0, 1e-10);
  EXPECT_NEAR(force(0.8), 20, 1e-10);          // and up again
  EXPECT_NEAR(force(2.0), 200, 1e-10);         // until it meets the old one
  EXPECT_NEAR(force(1.75), 100, 1e-10);
  EXPECT_EQ(memory.greatest_overlap, 2);
}

// The automatic step knows the contact time of each law: restitution within 5 %, also where the dashpot's force begins with a jump.
TEST(ContactLaws, AutomaticStepResolvesThem) {
  for (const NormalLaw law : {NormalLaw::hertz, NormalLaw::linear, NormalLaw::walton_braun})
    for (const double e : {0.2, 0.5, 0.9}) {
      Lab l = head_on(law, e);
      l.sphere({}, {});
      l.sphere({1, 0, 0}, {});
      const double step = advise_time_step(l.world, l.model, 0.5).step;
      EXPECT_NEAR(collide(head_on(law, e), 0.5, step).restitution, e, 0.05 * e) << word_of(law) << " " << step;
    }
  Lab stiff = head_on(NormalLaw::linear, 0.5), soft = stiff;
  for (Lab* l : {&stiff, &soft}) l->sphere({}), l->sphere({1, 0, 0});
  pair_of(stiff).normal_stiffness = 2e5;
  EXPECT_NEAR(advise_time_step(soft.world, soft.model, 0.5).step / advise_time_step(stiff.world, stiff.model, 0.5).step, 10, 1);
}

// On a plane ----------------------------------------------------------------------------------------------------------

constexpr double v0 = 0.5;

// A sphere at rest on the plane z = 0 (overlap of its weight) that is sent along x.
Lab on_plane(const ContactModel& contact, double friction, double rolling_friction, Vec3 spin = {}, double speed = v0) {
  Lab l(0.18, friction, rolling_friction);
  l.model.contact = contact;
  l.model.gravity = {0, 0, -g};
  l.model.time_step = 2e-5;
  const double hertz = 4.0 / 3.0 * pair_of(l).young_eff * std::sqrt(pellet_radius);
  l.body(PlaneShape{});
  l.sphere({0, 0, pellet_radius - std::pow(sphere_mass(pellet_radius) * g / hertz, 2.0 / 3.0)}, {speed, 0, 0}, spin);
  return l;
}
const double rolling_spin = v0 / pellet_radius;

struct Moving { double speed, spin; };   // [m/s]; spin times R [m/s]
Moving after(const Lab& l, double time) {
  const auto s = l.build();
  s->start();
  while (s->time() < time - 1e-12) s->step(Execution::serial);
  return {velocity(*s, 0).x, spin(*s, 0).y * pellet_radius};
}

// dv/dt = -mu g until it rolls at 5/7 v_0, t = 2 v_0 / (7 mu g)
TEST(TangentialLaws, CoulombAndWaltonBraunSlideToRoll) {
  const double mu = 0.4, end = 2 * v0 / (7 * mu * g);
  for (const TangentialLaw law : {TangentialLaw::coulomb, TangentialLaw::walton_braun}) {
    const Lab l = on_plane({.tangential = law}, mu, 0);
    const Moving half = after(l, 0.5 * end);
    EXPECT_NEAR(half.speed, v0 - mu * g * 0.5 * end, 0.005 * v0) << word_of(law);
    EXPECT_NEAR(half.spin, 2.5 * mu * g * 0.5 * end, 0.005 * v0) << word_of(law);
    const Moving rolling = after(l, 3 * end);
    EXPECT_NEAR(rolling.speed / (5.0 / 7.0 * v0), 1, 0.005) << word_of(law);
    EXPECT_NEAR(rolling.spin / (5.0 / 7.0 * v0), 1, 0.005) << word_of(law);
  }
}

// The contact point's u = v - R w:  du/dt = -7/2 gamma_t u / m
TEST(TangentialLaws, ViscousSlipDecays) {
  Lab l = on_plane({.tangential = TangentialLaw::viscous}, 0, 0);
  pair_of(l).tangential_damping = 0.05;
  const double rate = 3.5 * 0.05 / sphere_mass(pellet_radius);
  for (const double time : {0.5 / rate, 2 / rate}) {
    const double u = v0 * std::exp(-rate * time);
    const Moving m = after(l, time);
    EXPECT_NEAR(m.speed - m.spin, u, 0.005 * v0);
    EXPECT_NEAR(m.speed, v0 - 2.0 / 7.0 * (v0 - u), 0.005 * v0);
  }
}

// Coulomb until gamma_t u = mu m g, then viscous.
TEST(TangentialLaws, HaffWernerSlidesThenCreeps) {
  const double mu = 0.2, gamma = 0.05, mass = sphere_mass(pellet_radius), rate = 3.5 * gamma / mass;
  const double u1 = mu * mass * g / gamma, t1 = (v0 - u1) / (3.5 * mu * g);
  ASSERT_GT(t1, 0);
  Lab l = on_plane({.tangential = TangentialLaw::haff_werner}, mu, 0);
  pair_of(l).tangential_damping = gamma;
  const Moving sliding = after(l, 0.5 * t1), creeping = after(l, t1 + 1 / rate);
  EXPECT_NEAR(sliding.speed - sliding.spin, v0 - 3.5 * mu * g * 0.5 * t1, 0.005 * v0);
  EXPECT_NEAR(creeping.speed - creeping.spin, u1 * std::exp(-1.0), 0.005 * v0);
}

// A slip of constant direction under constant load, back and forth [Mindlin & Deresiewicz 1953]:
//   F = mu N (1 - (1 - 2/3 B_0 s / (mu N))^(3/2));   back from F*: F* - F = (mu N + F*) (1 - (1 - 2/3 B_0 s / (mu N + F*))^(3/2))
TEST(TangentialLaws, WaltonBraunIsMindlinAndDeresiewicz) {
  ChosenCoefficients k;
  k.tangential_stiffness = 1000;
  ContactState<double> c{};
  c.normal = {0, 0, 1}, c.contact_radius = 1;
  const double limit = 3, step = 1e-7;
  ContactMemory memory;
  const auto slip = [&](double distance, const Vec3& along) {
    c.tangential_velocity = along;
    Vec3 f;
    for (int n = 0; n < std::lround(distance / step); ++n) f = walton_braun_friction(c, k, limit, step, memory);
    return -dot(f, normalized(Vec3{3, 4, 0}));
  };
  const auto curve = [](double room, double s) { return room * (1 - std::pow(1 - 2.0 / 3.0 * 1000 * s / room, 1.5)); };
  const Vec3 forth = normalized(Vec3{3, 4, 0}), back = -forth;
  EXPECT_NEAR(slip(1e-3, forth), curve(limit, 1e-3), 1e-3);
  const double turned = slip(2e-3, forth);
  EXPECT_NEAR(turned, curve(limit, 3e-3), 1e-3);
  EXPECT_NEAR(slip(1e-3, back), turned - curve(limit + turned, 1e-3), 1e-3);
  const double again = slip(4e-3, back);
  EXPECT_NEAR(again, turned - curve(limit + turned, 5e-3), 1e-3);
  EXPECT_LT(again, 0);
  EXPECT_NEAR(slip(1e-3, forth), again + curve(limit - again, 1e-3), 1e-3);
  EXPECT_NEAR(slip(2e-2, back), -limit, 1e-3);               // slides
  EXPECT_NEAR(dot(memory.tangential, c.normal), 0, 1e-15);
}

// The same history under any load: F* goes with it, and the force stays within its limit while it falls.
TEST(TangentialLaws, WaltonBraunUnderFallingLoad) {
  ChosenCoefficients k;
  k.tangential_stiffness = 1000;
  ContactState<double> c{};
  c.normal = {0, 0, 1}, c.contact_radius = 1, c.tangential_velocity = {1, 0, 0};
  ContactMemory memory;
  for (int n = 0; n < 20000; ++n) walton_braun_friction(c, k, 3, 1e-7, memory);
  c.tangential_velocity = {-1, 0.5, 0};
  for (double limit = 3; limit > 0; limit -= 0.001) EXPECT_LE(norm(walton_braun_friction(c, k, limit, 1e-7, memory)), limit * (1 + 1e-12));
  EXPECT_EQ(norm(walton_braun_friction(c, k, 0, 1e-7, memory)), 0);
}

// v = v_0 - 5/7 g mu_r t
TEST(RollingLaws, ConstantTorqueStopsIt) {
  const double mu_r = 0.3211;
  const Lab l = on_plane({.rolling = RollingLaw::constant_torque}, 0.91, mu_r, {0, rolling_spin, 0});
  const double measured = (after(l, 0.15).speed - after(l, 0.05).speed) / 0.1;
  EXPECT_NEAR(measured / (-5.0 / 7.0 * g * mu_r), 1, 0.005);
}

// v = v_0 exp(-5/7 mu g t)
TEST(RollingLaws, ViscousDecays) {
  Lab l = on_plane({.rolling = RollingLaw::viscous}, 0.91, 0, {0, rolling_spin, 0});
  pair_of(l).rolling_viscosity = 0.8;
  EXPECT_NEAR(std::log(after(l, 0.05).speed / after(l, 0.25).speed) / (5.0 / 7.0 * 0.8 * g * 0.2), 1, 0.005);
}

// Two spheres that press on each other and roll: M = -mu R_eff F_n (R_1 w_1 - R_2 w_2) on the first, the opposite on the second.
TEST(RollingLaws, ViscousOfAPair) {
  ChosenCoefficients k;
  k.rolling_viscosity = 0.5;
  ChosenContact contact{};
  contact.radius_eff = 2, contact.rolling_slip = {0, 3, 0};
  ContactMemory memory;
  EXPECT_EQ(rolling_moment(RollingLaw::viscous, contact, contact, k, 7, 1, memory), (Vec3{0, -0.5 * 2 * 7 * 3, 0}));
}

// Its power is -mu R_eff F_n (R_1 w_1 - R_2 w_2) (w_1 - w_2): of unequal spheres it feeds energy in while w_2 / w_1 is between 1 and R_1 / R_2.
// That is in the equation, not in what is made of it, and `skred models` says so.
TEST(RollingLaws, ViscousOfUnequalSpheresGivesEnergyBetweenTwoSpins) {
  ChosenCoefficients k;
  k.rolling_viscosity = 0.5;
  const double r_1 = 2, r_2 = 1, w_1 = 3;
  ChosenContact contact{};
  contact.radius_eff = r_1 * r_2 / (r_1 + r_2);
  ContactMemory memory;
  for (const double ratio : {0.5, 1.5, 2.5}) {
    const double w_2 = ratio * w_1;
    contact.rolling_slip = {0, r_1 * w_1 - r_2 * w_2, 0};
    const double power = rolling_moment(RollingLaw::viscous, contact, contact, k, 7, 1, memory).y * (w_1 - w_2);
    EXPECT_EQ(power > 0, ratio > 1 && ratio < r_1 / r_2) << ratio << ": " << power;
  }
}

// A sphere on smooth ground that is turned a little: I dw/dt = -k_r theta - c_r w, I = 2/5 m R^2, k_r = k_t R^2, c_r = 2 eta sqrt(7/5 m R^2 k_r).
TEST(RollingLaws, DashpotOfTheSpringDampsItsOscillation) {
  const double mass = sphere_mass(pellet_radius), r2 = pellet_radius * pellet_radius, small = 0.01;
  for (const double eta : {0.0, 0.05, 0.2}) {
    Lab l = on_plane({.tangential = TangentialLaw::none}, 0, 5, {0, small, 0}, 0);
    l.model.time_step = 1e-6;                                // the spring itself loses 1/4 omega^2 h t: its history is of first order
    pair_of(l).rolling_damping = eta;
    const double overlap = pellet_radius - l.particles().position.data[0].z;
    const double stiffness = 8 * pair_of(l).shear_eff * std::sqrt(pellet_radius * overlap) * r2, omega = std::sqrt(stiffness / (0.4 * mass * r2));
    const double rate = eta * std::sqrt(1.4 / 0.4) * omega, damped = std::sqrt(omega * omega - rate * rate), period = 2 * M_PI / damped;
    for (const double time : {0.25 * period, period, 2.5 * period}) {
      const double want = small * std::exp(-rate * time) * (std::cos(damped * time) - rate / damped * std::sin(damped * time));
      EXPECT_NEAR(after(l, time).spin / pellet_radius, want, 0.01 * small) << eta << " " << time / period;
    }
  }
}

// While it slips, the part f of the dashpot acts beside the limit:  I dw/dt = -mu_r R m g - f c_r w
TEST(RollingLaws, DashpotAtTheLimit) {
  const double mass = sphere_mass(pellet_radius), r2 = pellet_radius * pellet_radius, w0 = 60, mu_r = 0.05, f = 0.5, eta = 0.3;
  Lab l = on_plane({.tangential = TangentialLaw::none}, 0, mu_r, {0, w0, 0}, 0);
  pair_of(l).rolling_damping = eta;
  pair_of(l).rolling_damping_at_limit = f;
  const double overlap = pellet_radius - l.particles().position.data[0].z;
  const double stiffness = 8 * pair_of(l).shear_eff * std::sqrt(pellet_radius * overlap) * r2, inertia = 0.4 * mass * r2;
  const double a = mu_r * pellet_radius * mass * g / inertia, b = f * 2 * eta * std::sqrt(1.4 * mass * r2 * stiffness) / inertia;
  const double time = 1 / b;
  EXPECT_NEAR(after(l, time).spin / pellet_radius, (w0 + a / b) * std::exp(-b * time) - a / b, 0.01 * w0);
}

// Springs beside a linear normal law: k_t / k_n = 4 G* / E*. Half a period of a sphere that sways on its friction spring, 7/2 k_t / m.
TEST(ContactLaws, FrictionSpringBesideLinearNormal) {
  Lab l = on_plane({.normal = NormalLaw::linear}, 100, 0, {}, 1e-4);
  pair_of(l).normal_stiffness = 5000;
  pair_of(l).restitution = 1;
  l.model.time_step = 1e-6;
  const double mass = sphere_mass(pellet_radius);
  l.particles().position.data[0].z = pellet_radius - mass * g / 5000;
  const double stiffness = 5000 * 4 * pair_of(l).shear_eff / pair_of(l).young_eff;
  const Moving m = after(l, M_PI / std::sqrt(3.5 * stiffness / mass));
  EXPECT_NEAR(m.speed - m.spin, -1e-4, 0.005e-4);
}

// Contacts between rigid bodies: a cube falls flat on a plane under each normal law.
TEST(ContactLaws, CubeReboundsUnderEveryNormalLaw) {
  for (const NormalLaw law : {NormalLaw::linear, NormalLaw::walton_braun}) {
    const double e = 0.5, edge = 0.02, mass = 0.02, inertia = mass * edge * edge / 6;
    Lab l(e, 0.3, 0);
    l.model.contact = {law, TangentialLaw::walton_braun, RollingLaw::none};
    pair_of(l).normal_stiffness = 2e4;
    l.model.time_step = 2e-6;
    l.body(PlaneShape{});
    const Index cube = l.body(BoxShape{{edge / 2, edge / 2, edge / 2}}, {{0, 0, edge / 2 + 1e-6}, {}}, Motion::dynamic, mass, {inertia, inertia, inertia});
    l.bodies().velocity.data[cube] = {0, 0, -0.2};
    const auto s = l.build();
    s->start();
    for (int k = 0; k < 10000; ++k) s->step(Execution::serial);
    EXPECT_NEAR(std::get<Bodies>(s->world()).velocity.data[cube].z, e * 0.2, 0.01 * 0.2) << word_of(law);
  }
}

}  // namespace
}  // namespace skred::lab
