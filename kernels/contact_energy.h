// kernels/contact_energy.h - what the springs of one contact hold, for the energy ledger.
//
// To add a law, give it an overload of `stored` here, or a case. Stored is what would come back if the contact were let go: what a law does
// not store of the work done on it, it has lost.
#pragma once
#include "kernels/chosen_law.h"

namespace skred {

// Of a normal law: the energy [J], and the part of the force that stores it, dE/dg [N]; the rest of the force is damping.
struct ElasticNormal { double energy = 0, force = 0; };

// E = 2/5 k g^(5/2), F = k g^(3/2), k = 4/3 E* sqrt(R_eff)    Hertz 1882
template <bool damped> ElasticNormal stored(const Hertz<damped>&, const ContactState<double>& c, const LawCoefficients& k) {
  const double stiffness = k.normal_stiffness * c.contact_radius;
  return {4.0 / 15.0 * stiffness * c.overlap * c.overlap, 2.0 / 3.0 * stiffness * c.overlap};
}

// E = 1/2 k_t x^2, x the displacement that the law remembers
template <bool damped>
double stored(const TangentialSpring<damped>&, const ContactState<double>& c, const LawCoefficients& k, const Vec3& spring) {
  return 0.5 * k.tangential_stiffness * c.contact_radius * dot(spring, spring);
}

// E = M^2 / (2 k_r), M the elastic moment, k_r = k_t R_eff^2
inline double stored(const RollingSpring&, const ContactState<double>& c, const LawCoefficients& k, const Vec3& moment) {
  return dot(moment, moment) / (2 * k.tangential_stiffness * c.contact_radius * c.radius_eff * c.radius_eff);
}

// Laws that are chosen at run time, with the scales of set_scales().
//   linear          E = 1/2 k_n g^2
//   walton_braun    E = F_n^2 / (2 k_2), what comes back down the steep line. Of the force that presses the contact as never before k_1 / k_2
//                   stores it, dE/dg = k_1^2 g / k_2; the rest is the work that the contact keeps, 1/2 k_1 (1 - k_1 / k_2) g_max^2 in all
inline ElasticNormal stored(NormalLaw law, const ContactState<double>& c, const ChosenCoefficients& k, const ContactMemory& memory) {
  switch (law) {
    case NormalLaw::hertz:
    case NormalLaw::kuwabara_kono: return stored(Hertz<false>{}, c, k);
    case NormalLaw::linear: return {0.5 * k.normal_stiffness * c.overlap * c.overlap, k.normal_stiffness * c.overlap};
    case NormalLaw::walton_braun: {
      ContactMemory as_it_is = memory;
      const double force = normal_force({.normal = law}, c, k, as_it_is);
      const bool as_never_before = c.overlap >= memory.greatest_overlap && c.normal_velocity < 0;
      return {force * force / (2 * k.unloading_stiffness), as_never_before ? force * k.normal_stiffness / k.unloading_stiffness : force};
    }
    case NormalLaw::none: break;
  }
  return {};
}

// Walton & Braun's friction: the work that comes back if the slip turns round and the force falls to nothing under the same normal force,
//   E = 1/k_t int_0^F f ((L + F*) / (L + f))^(1/3) df
//     = (L + F*)^(1/3) / k_t { 3/5 [(L + F)^(5/3) - L^(5/3)] - 3/2 L [(L + F)^(2/3) - L^(2/3)] },   L = mu F_n
// with F* = F where it turns round only then: F^2 / (2 k_t) while F is small. From (2.24).
inline double stored_by_walton_braun(const ContactState<double>& c, const ChosenCoefficients& k, double limit, const ContactMemory& memory) {
  const double force = norm(memory.tangential);
  if (!(force > 0) || !(limit > 0)) return 0;
  const double x = force / limit, turned_at = std::max(x, dot(memory.reversal, memory.tangential) / force);   // F / L, F* / L
  const double integral = 0.6 * (std::pow(1 + x, 5.0 / 3.0) - 1) - 1.5 * (std::pow(1 + x, 2.0 / 3.0) - 1);
  return std::cbrt(1 + turned_at) * integral * limit * limit / (k.tangential_stiffness * c.contact_radius);
}

// Coulomb's, Haff & Werner's and the viscous law store nothing.
inline double stored(TangentialLaw law, const ContactState<double>& c, const ChosenCoefficients& k, double normal_force, const ContactMemory& memory) {
  if (law == TangentialLaw::spring) return stored(TangentialSpring<false>{}, c, k, memory.tangential);
  if (law == TangentialLaw::walton_braun) return stored_by_walton_braun(c, k, k.friction * normal_force, memory);
  return 0;
}

// Nor does a constant torque, or a viscous one; of the spring's moment its dashpot is no part.
inline double stored(RollingLaw law, const ContactState<double>& c, const ChosenCoefficients& k, const ContactMemory& memory) {
  return law == RollingLaw::spring ? stored(RollingSpring{}, c, k, memory.rolling) : 0;
}

struct StoredInContact { ElasticNormal normal; double tangential = 0, rolling = 0; };

// `normal_force` [N] as it is, with its damping.
inline StoredInContact stored_in_contact(const ContactModel& laws, const ContactState<double>& c, const ChosenCoefficients& k, double normal_force,
                                         const ContactMemory& memory) {
  return {stored(laws.normal, c, k, memory), stored(laws.tangential, c, k, normal_force, memory), stored(laws.rolling, c, k, memory)};
}

template <class Law>
StoredInContact stored_in_contact(const Law& law, const ContactState<double>& c, const LawCoefficients& k, const Vec3& spring, const Vec3& moment) {
  StoredInContact s{stored(law.normal, c, k)};
  if constexpr (Law::has_tangential) s.tangential = stored(law.tangential, c, k, spring);
  if constexpr (Law::has_rolling) s.rolling = stored(law.rolling, c, k, moment);
  return s;
}

}  // namespace skred
