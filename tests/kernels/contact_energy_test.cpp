// What each law says its springs hold is what comes back when the contact is let go (kernels/contact_energy.h).
#include <gtest/gtest.h>
#include "kernels/contact_energy.h"

namespace skred {
namespace {

ContactState<double> at(double overlap, double velocity) {
  ContactState<double> c{};
  c.overlap = overlap, c.radius_eff = 2, c.normal = {0, 0, 1}, c.contact_radius = 1, c.normal_velocity = velocity;
  return c;
}

ChosenCoefficients coefficients() {
  ChosenCoefficients k;
  k.normal_stiffness = 100, k.unloading_stiffness = 400, k.tangential_stiffness = 1000, k.friction = 0.5;
  return k;
}

// Pressed to g, the contact has taken 1/2 k_1 g^2; 1/2 k_1^2 g^2 / k_2 of that comes back down the steep line.
TEST(ContactEnergy, WaltonBraunGivesBackWhatItHolds) {
  const ChosenCoefficients k = coefficients();
  constexpr double step = 1e-6;
  ContactMemory memory;
  double lost = 0, returned = 0;
  for (double overlap = step; overlap <= 1; overlap += step) {
    const ContactState<double> c = at(overlap, -1);
    const double force = normal_force({.normal = NormalLaw::walton_braun}, c, k, memory);
    lost += (force - stored(NormalLaw::walton_braun, c, k, memory).force) * step;
  }
  const double held = stored(NormalLaw::walton_braun, at(1 - step, 0), k, memory).energy;
  EXPECT_NEAR(held, 0.5 * 100 * 100 / 400, 1e-3);
  EXPECT_NEAR(lost, 0.5 * 100 * (1 - 0.25), 1e-3);
  for (double overlap = 1; overlap > 0; overlap -= step) {
    const ContactState<double> c = at(overlap, 1);
    const double force = normal_force({.normal = NormalLaw::walton_braun}, c, k, memory);
    EXPECT_EQ(stored(NormalLaw::walton_braun, c, k, memory).force, force);       // nothing more is lost
    returned += force * step;
  }
  EXPECT_NEAR(returned, held, 1e-3);
  EXPECT_EQ(stored(NormalLaw::walton_braun, at(0.7, -1), k, memory).energy, 0);  // it is still pressed flat to 3/4
}

// dE/dg is the part of the force that stores it.
TEST(ContactEnergy, ForceIsItsSlope) {
  const ChosenCoefficients k = coefficients();
  ContactMemory pressed;
  pressed.greatest_overlap = 0.5;
  for (const NormalLaw law : {NormalLaw::hertz, NormalLaw::linear, NormalLaw::kuwabara_kono, NormalLaw::walton_braun})
    for (const double overlap : {0.4, 0.45, 0.6}) {
      const auto energy = [&](double g) {
        ContactMemory memory = pressed;
        memory.greatest_overlap = std::max(memory.greatest_overlap, g);
        ContactState<double> c = at(g, -1);
        if (!is_linear(law)) c.contact_radius = std::sqrt(c.radius_eff * g);
        return stored(law, c, k, memory);
      };
      const double slope = (energy(overlap + 1e-5).energy - energy(overlap - 1e-5).energy) / 2e-5;
      EXPECT_NEAR(energy(overlap).force, slope, 1e-6 * slope) << word_of(law) << " " << overlap;
    }
}

// A slip forth and back under constant load: going back to no force returns what was held, and a full cycle of the force between F and -F loses
//   2/B_0 (L + F)^(1/3) [3/2 L y^(2/3) - 3/5 y^(5/3)] from y = L - F to L + F,  L = mu F_n    from (2.24)
TEST(ContactEnergy, WaltonBraunFriction) {
  const ChosenCoefficients k = coefficients();
  const double limit = 3, step = 1e-7;
  ContactState<double> c = at(1, 0);
  ContactMemory memory;
  double force = 0;
  const auto held = [&] { return stored(TangentialLaw::walton_braun, c, k, limit / k.friction, memory); };
  // Slips along x until the force on the contact is `target`; the work that it takes [J].
  const auto slip_until = [&](double target) {
    const double along = target < force ? 1 : -1;
    c.tangential_velocity = {along, 0, 0};
    double work = 0;
    while (along * (force - target) > 0) {
      const double before = force;
      force = walton_braun_friction(c, k, limit, step, memory).x;
      work -= 0.5 * (before + force) * along * step;
    }
    return work;
  };
  const double first = slip_until(-2);
  const double after_first = held();
  EXPECT_GT(after_first, 0.5 * 4 / 1000);                    // a little more than of a linear spring
  EXPECT_LT(after_first, first);
  const double half_way = slip_until(-1);                    // what comes back is negative work
  EXPECT_NEAR(after_first + half_way, held(), 1e-3 * first);
  EXPECT_NEAR(after_first + half_way + slip_until(0), 0, 1e-3 * first);
  EXPECT_NEAR(held(), 0, 1e-3 * first);
  slip_until(2);
  slip_until(-2);
  const double cycle = slip_until(2) + slip_until(-2);
  const auto primitive = [&](double y) { return 1.5 * limit * std::pow(y, 2.0 / 3.0) - 0.6 * std::pow(y, 5.0 / 3.0); };
  EXPECT_NEAR(cycle, 2.0 / 1000 * std::cbrt(limit + 2) * (primitive(limit + 2) - primitive(limit - 2)), 1e-3 * cycle);
}

}  // namespace
}  // namespace skred
