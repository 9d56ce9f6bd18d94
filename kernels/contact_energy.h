// kernels/contact_energy.h - what the springs of one contact hold, for the energy ledger.
//
// To add a law, give it an overload of `stored` here. What a law does not store of the work done on it, it has lost.
#pragma once
#include "kernels/contact_law.h"

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

struct StoredInContact { ElasticNormal normal; double tangential = 0, rolling = 0; };

template <class Law>
StoredInContact stored_in_contact(const Law& law, const ContactState<double>& c, const LawCoefficients& k, const Vec3& spring, const Vec3& moment) {
  StoredInContact s{stored(law.normal, c, k)};
  if constexpr (Law::has_tangential) s.tangential = stored(law.tangential, c, k, spring);
  if constexpr (Law::has_rolling) s.rolling = stored(law.rolling, c, k, moment);
  return s;
}

}  // namespace skred
