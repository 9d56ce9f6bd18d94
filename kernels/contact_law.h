// kernels/contact_law.h - the force of one contact from its overlap, velocity and history (smooth DEM).
//
// The law of Pettersson 2015, sec. 3.2, as small structs that are combined at compile time and evaluated together:
//   normal      Hertz with a dashpot ~ overlap^(1/4), never pulling          eq (3.1), (3.2)
//   tangential  spring and dashpot with Coulomb limit                        eq (3.3)-(3.7)
//   rolling     elastic-plastic spring, limit mu_r R_eff F_n                 eq (2.29), (2.30), (3.8)
// Repairs of the printed equations: the damping is the one that gives the prescribed restitution although the force is cut
// off (kernels/restitution.h), gamma_t is positive, the contact point lies at R - overlap/2 from either centre.
//
// A law is a template on its number type R - double, or a SIMD pack with the same operators - and branches for all lanes or none.
//
// To add a law that runs on packs: write a struct like the ones below, and name it in kernels/laws.h. Other laws, chosen at run time
// and computed on plain doubles, are in kernels/chosen_law.h.
#pragma once
#include <cmath>
#include "engine/vec3.h"

namespace skred {

// Coefficients of one pair of materials as the laws use them: stiffnesses are proportional to the contact radius a, and so are the
// squares of the dampings, gamma^2 / m_eff.
template <class R> struct LawCoefficientsT {
  R normal_stiffness{};       // S_n / a = 2 E* [Pa]
  R tangential_stiffness{};   // k_t / a = 8 G* [Pa]
  R normal_damping{};         // gamma_n / sqrt(a m_eff) = beta sqrt(2 E*), beta = sqrt(10/3) zeta [Pa^(1/2)]
  R tangential_damping{};     // gamma_t / sqrt(a m_eff) = beta sqrt(8 G*) [Pa^(1/2)]
  R friction{};               // mu [1]
  R rolling_friction{};       // mu_r [1]
};
using LawCoefficients = LawCoefficientsT<double>;

// One contact, as a law sees it. Vectors are of particle i relative to its partner.
template <class R> struct ContactState {
  R overlap;                    // g [m] > 0
  R radius_eff;                 // R_eff [m]
  R contact_radius;             // a = sqrt(R_eff g) [m], Hertz 1882
  R damping_scale;              // sqrt(a m_eff)
  Vec3T<R> normal;              // n, unit, from the partner to i
  R normal_velocity;            // u_n [m/s] > 0 when separating
  Vec3T<R> tangential_velocity; // u_t [m/s] of the contact point
  Vec3T<R> rolling_velocity;    // relative spin without its part along n [rad/s]
};

// v without its part along n.
template <class R> Vec3T<R> in_tangent_plane(const Vec3T<R>& v, const Vec3T<R>& n) { return v - dot(v, n) * n; }

// What v must be scaled by to be no longer than `limit`: 1, or limit / |v|.
template <class R> [[gnu::always_inline]] inline R reduction(const Vec3T<R>& v, R limit) {
  const R length2 = dot(v, v);
  const auto longer = length2 > limit * limit;
  if (none_of(longer)) return R(1);                          // most contacts stick most of the time: no root, no division
  using std::sqrt;
  return select(longer, limit / sqrt(length2), R(1));
}

template <bool damped> struct Hertz {
  static constexpr bool exists = true;

  // F_n = max(0, 4/3 E* sqrt(R_eff) g^(3/2) - gamma_n u_n)                  [N]     eq (3.1), Hertz 1882
  // gamma_n = beta sqrt(S_n m_eff),  S_n = dF/dg = 2 E* sqrt(R_eff g)       [kg/s]  eq (3.2)
  template <class R> R force(const ContactState<R>& c, const LawCoefficientsT<R>& k) const {
    const R f = uncut(c, k);
    return select(f > R(0), f, R(0));
  }
  template <class R> R uncut(const ContactState<R>& c, const LawCoefficientsT<R>& k) const {
    const R stiffness = k.normal_stiffness * c.contact_radius;
    R f = R(2.0 / 3.0) * stiffness * c.overlap;
    if constexpr (damped) f = f - k.normal_damping * c.damping_scale * c.normal_velocity;
    return f;
  }
};

template <bool damped> struct TangentialSpring {
  static constexpr bool exists = true;

  // `spring` is the displacement in the tangent plane since the contact began [m], turned with the contact and kept within the
  // Coulomb limit. k_t = 8 G* sqrt(R_eff g) (3.3), gamma_t = beta sqrt(k_t m_eff) (3.4); F_t is limited again with its dashpot (3.7).
  template <class R> Vec3T<R> force(const ContactState<R>& c, const LawCoefficientsT<R>& k, R normal_force, R time_step,
                                    Vec3T<R>& spring) const {
    const R stiffness = k.tangential_stiffness * c.contact_radius;
    const R limit = k.friction * normal_force;
    spring = in_tangent_plane(spring, c.normal) + time_step * c.tangential_velocity;
    Vec3T<R> f = -(stiffness * spring);
    const R sliding = reduction(f, limit);
    spring *= sliding;
    f *= sliding;
    if constexpr (damped) f -= (k.tangential_damping * c.damping_scale) * c.tangential_velocity;
    return reduction(f, limit) * f;
  }
};

struct RollingSpring {
  static constexpr bool exists = true;

  // `moment` is the elastic moment on i [N m]: M += -k_r w_t h, |M| <= mu_r R_eff F_n, k_r = k_t R_eff^2. Rolling only, no twist.
  template <class R> Vec3T<R> moment(const ContactState<R>& c, const LawCoefficientsT<R>& k, R normal_force, R time_step,
                                     Vec3T<R>& moment) const {
    const R stiffness = k.tangential_stiffness * c.contact_radius * c.radius_eff * c.radius_eff;
    const R limit = k.rolling_friction * c.radius_eff * normal_force;
    moment = in_tangent_plane(moment, c.normal) - (stiffness * time_step) * c.rolling_velocity;
    return moment *= reduction(moment, limit);
  }
};

// The place of a law that the scene does not call for: nothing is computed.
struct NoLaw { static constexpr bool exists = false; };

// The three parts of a contact's law.
template <class Normal, class Tangential, class Rolling> struct ContactLaw {
  Normal normal;
  Tangential tangential;
  Rolling rolling;
  using Coefficients = LawCoefficients;
  static constexpr bool chosen = false;
  static constexpr bool has_tangential = Tangential::exists, has_rolling = Rolling::exists;
  static constexpr bool rotates = has_tangential || has_rolling;   // without them nothing can turn a sphere
  static constexpr bool keeps_spring = has_tangential, keeps_rolling = has_rolling, remembers = false;   // columns of its history
  static constexpr bool keeps_moment = false;                      // the history is the moment
};

// Force on i and the two parts of its torque: `couple` = n x F_t acts on both partners with the arm of each, `rolling` on i (and
// its opposite on the partner).
template <class R> struct ContactForce { Vec3T<R> force, couple, rolling; };

template <class Law, class R>
ContactForce<R> evaluate(const Law& law, const ContactState<R>& c, const LawCoefficientsT<R>& k, R time_step, Vec3T<R>& spring,
                         Vec3T<R>& rolling) {
  const R normal_force = law.normal.force(c, k);
  ContactForce<R> out{normal_force * c.normal, {}, {}};
  if constexpr (Law::has_tangential) {
    const Vec3T<R> f = law.tangential.force(c, k, normal_force, time_step, spring);
    out.force += f;
    out.couple = cross(c.normal, f);
  }
  if constexpr (Law::has_rolling) out.rolling = law.rolling.moment(c, k, normal_force, time_step, rolling);
  return out;
}

}  // namespace skred
