// kernels/chosen_law.h - the contact laws of Pettersson 2015, chapter 2, beside those of kernels/contact_law.h.
//
//   normal      linear spring and dashpot (2.9), Kuwabara & Kono (2.11), hysteretic of Walton & Braun; Hertz too
//   tangential  Coulomb (2.16), viscous (2.17), Haff & Werner (2.18), Walton & Braun (2.22)-(2.24); the spring too
//   rolling     constant torque (2.26), viscous (2.27), the spring with its dashpot (2.28)-(2.31)
//
// A law's parts are chosen at run time, by a switch that is the same for every contact: 4 x 6 x 4 combinations, compiled for
// every set of vector instructions, would be a hundred times the machine code of the one that most scenes use. They are
// there to be compared, so they run on plain doubles: every path takes the same loop, and has its bits.
//
// Springs and dashpots of a contact have one scale each, which the coefficients multiply:
//                    stiffness                  dashpot
//   hertz            a = sqrt(R_eff g)          sqrt(a m_eff)
//   kuwabara_kono    a                          a               gamma = A k: both relax within A
//   linear, w.&b.    1                          sqrt(m_eff)
// so that a spring and its dashpot are the same few lines (kernels/contact_law.h) whatever the normal law.
#pragma once
#include <algorithm>
#include <cmath>
#include "engine/world.h"
#include "kernels/contact_law.h"
#include "kernels/contact_model.h"

namespace skred {

// Of a pair of materials. Those of LawCoefficients multiply the scales above.
struct ChosenCoefficients : LawCoefficients {
  double unloading_stiffness = 0;      // k_2 [N/m] of Walton & Braun's normal law
  double tangential_viscosity = 0;     // gamma_t [N s/m]
  double rolling_viscosity = 0;        // [s/m]
  double rolling_damping = 0;          // eta_r [1], part of the critical damping
  double rolling_damping_at_limit = 0; // f [1]: what is left of it while the spring slips
};

// A contact as these laws see it.
struct ChosenContact : ContactState<double> {
  double mass_eff;          // m_eff [kg]
  double rolling_inertia;   // I_r [kg m^2], 1/I_r = sum of 1 / (7/5 m R^2): of a sphere about the point it rolls on
  Vec3 rolling_slip;        // R_i w_i - R_j w_j [m/s], without its part along n
};

// `remembers`: some part has a history, which is a row of the column `memory`. `keeps_moment`: the energy ledger asks for rolling moments.
template <bool tangential, bool rolling, bool remembers_, bool keeps_moment_ = false> struct ChosenLaw {
  using Coefficients = ChosenCoefficients;
  static constexpr bool chosen = true;
  static constexpr bool has_tangential = tangential, has_rolling = rolling, rotates = tangential || rolling;
  static constexpr bool keeps_spring = false, keeps_rolling = false, remembers = remembers_, keeps_moment = keeps_moment_;
  ContactModel model;
};

// The scales of the table above, of a contact that has those of Hertz.
inline void set_scales(NormalLaw law, double mass_eff, ContactState<double>& c) {
  if (is_linear(law)) c.contact_radius = 1, c.damping_scale = std::sqrt(mass_eff);
  else if (law == NormalLaw::kuwabara_kono) c.damping_scale = c.contact_radius;
}

inline double normal_force(const ContactModel& laws, const ContactState<double>& c, const ChosenCoefficients& k, ContactMemory& memory) {
  const auto cut_off = [&](double force) { return laws.pull ? force : std::max(0.0, force); };
  switch (laws.normal) {
    case NormalLaw::hertz:                                   // (3.1)
    case NormalLaw::kuwabara_kono:                           // F_n = max(0, k_H (g^(3/2) + 3/2 A sqrt(g) dg/dt))   [N]  (2.11) repaired
      return cut_off(Hertz<true>{}.uncut(c, k));
    case NormalLaw::linear:                                  // F_n = max(0, k_n g + c dg/dt), c = 2 zeta sqrt(k_n m_eff)   [N]  (2.9)
      return cut_off(k.normal_stiffness * c.overlap - k.normal_damping * c.damping_scale * c.normal_velocity);
    case NormalLaw::walton_braun: {                          // k_1 g when it is pressed as never before, else k_2 (g - g_0) >= 0   [N]
      double& greatest = memory.greatest_overlap;
      greatest = std::max(greatest, c.overlap);
      const double plastic = greatest * (1 - k.normal_stiffness / k.unloading_stiffness);                 // g_0 [m]
      return std::clamp(k.unloading_stiffness * (c.overlap - plastic), 0.0, k.normal_stiffness * c.overlap);
    }
    case NormalLaw::none: break;
  }
  return 0;
}

// Walton & Braun 1986: dF_t = -B u_t dt, |F_t| <= mu F_n, and B falls from B_0 = k_t to nothing at the limit,
//   B = B_0 ((mu F_n + e F_t) / (mu F_n + e F*))^(1/3)              (2.24), both branches, e = u_t / |u_t|
// F* is the force at which the slip last turned round: where it moves the force back towards F*. It is kept as part of mu F_n,
// so that it follows the normal force. At constant F_n this is Mindlin & Deresiewicz 1953, from slip to force
//   F_t = mu F_n (1 - (1 - 2/3 B_0 s / (mu F_n))^(3/2)).
inline Vec3 walton_braun_friction(const ContactState<double>& c, const ChosenCoefficients& k, double limit, double time_step,
                                  ContactMemory& memory) {
  Vec3 force = in_tangent_plane(memory.tangential, c.normal);
  Vec3 reversal = in_tangent_plane(memory.reversal, c.normal);   // F* / (mu F_n)
  force *= reduction(force, limit);
  const double speed = norm(c.tangential_velocity);
  if (speed > 0 && limit > 0) {
    const Vec3 e = (1 / speed) * c.tangential_velocity;
    if (dot(force - limit * reversal, e) > 0) reversal = (1 / limit) * force;
    const double room = limit + dot(force, e), whole = limit + limit * dot(reversal, e);
    const double part = whole > 0 ? std::cbrt(std::clamp(room / whole, 0.0, 1.0)) : 0;
    force -= (part * k.tangential_stiffness * c.contact_radius * time_step) * c.tangential_velocity;
    force *= reduction(force, limit);
  }
  memory.tangential = force;
  memory.reversal = reversal;
  return force;
}

inline Vec3 tangential_force(TangentialLaw law, const ContactState<double>& c, const ChosenCoefficients& k, double normal_force,
                             double time_step, ContactMemory& memory) {
  const Vec3& u = c.tangential_velocity;
  const double limit = k.friction * normal_force, speed = norm(u);
  switch (law) {
    case TangentialLaw::spring: return TangentialSpring<true>{}.force(c, k, normal_force, time_step, memory.tangential);
    case TangentialLaw::coulomb: return speed > 0 ? (-limit / speed) * u : Vec3{};                                     // (2.16)
    case TangentialLaw::viscous: return -k.tangential_viscosity * u;                                                   // (2.17)
    case TangentialLaw::haff_werner:                                                                                   // (2.18)
      return speed > 0 ? (-std::min(k.tangential_viscosity * speed, limit) / speed) * u : Vec3{};
    case TangentialLaw::walton_braun: return walton_braun_friction(c, k, limit, time_step, memory);
    case TangentialLaw::none: break;
  }
  return {};
}

// The spring's dashpot: M_d = -c_r w while the spring holds, -f c_r w while it slips   (2.31), c_r = 2 eta_r sqrt(I_r k_r).
inline Vec3 rolling_moment(RollingLaw law, const ChosenContact& contact, const ContactState<double>& c, const ChosenCoefficients& k,
                           double normal_force, double time_step, ContactMemory& memory) {
  const Vec3& w = c.rolling_velocity;
  const double limit = k.rolling_friction * c.radius_eff * normal_force;
  switch (law) {
    case RollingLaw::spring: {
      const Vec3 elastic = RollingSpring{}.moment(c, k, normal_force, time_step, memory.rolling);
      if (k.rolling_damping == 0) return elastic;
      const double stiffness = k.tangential_stiffness * c.contact_radius * c.radius_eff * c.radius_eff;                // k_r (3.8)
      const double damping = 2 * k.rolling_damping * std::sqrt(contact.rolling_inertia * stiffness);                   // c_r
      const bool slips = dot(elastic, elastic) >= limit * limit * (1 - 1e-12);
      return elastic - (slips ? k.rolling_damping_at_limit * damping : damping) * w;
    }
    case RollingLaw::constant_torque: {                                                                                // (2.26)
      const double speed = norm(w);
      return speed > 0 ? (-limit / speed) * w : Vec3{};
    }
    case RollingLaw::viscous:                                                                                          // (2.27)
      return (-k.rolling_viscosity * c.radius_eff * normal_force) * contact.rolling_slip;
    case RollingLaw::none: break;
  }
  return {};
}

template <bool tangential, bool rolling, bool remembers, bool keeps_moment>
ContactForce<double> evaluate(const ChosenLaw<tangential, rolling, remembers, keeps_moment>& law, const ChosenContact& contact,
                              const ChosenCoefficients& k, double time_step, ContactMemory& memory) {
  ContactState<double> c = contact;
  set_scales(law.model.normal, contact.mass_eff, c);

  const double normal = normal_force(law.model, c, k, memory), pressing = std::max(0.0, normal);   // what pulls does not rub
  ContactForce<double> out{normal * c.normal, {}, {}};
  if constexpr (tangential) {
    const Vec3 f = tangential_force(law.model.tangential, c, k, pressing, time_step, memory);
    out.force += f;
    out.couple = cross(c.normal, f);
  }
  if constexpr (rolling) out.rolling = rolling_moment(law.model.rolling, contact, c, k, pressing, time_step, memory);
  return out;
}

}  // namespace skred
