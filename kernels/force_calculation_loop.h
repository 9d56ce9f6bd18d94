// kernels/force_calculation_loop.h - the loop over pairs of particles, and the overlap, arms and velocities that a law asks for.
//
// The number type R is double, or a pack of doubles: then one turn of the loop computes as many contacts as R is wide. Lanes that
// do not touch compute numbers without meaning, which the last lines replace by zeros.
#pragma once
#include "engine/pack.h"
#include "kernels/force_calculation_particle_particle.h"

namespace skred {

// Radii, masses and coefficients of the contacts of one batch.
template <class R> struct PairProperties {
  R radius_i, radius_j, radius_eff, mass_eff;
  R young_eff, shear_eff, normal_damping, tangential_damping, friction, rolling_friction;
};

template <class R> PairProperties<R> properties(const AlikeParticles& p, const PairColumns&, const Lanes<R>&, const Lanes<R>&) {
  const LawCoefficients& k = p.coefficients;
  return {p.radius, p.radius, p.radius * p.radius / (p.radius + p.radius), p.mass * p.mass / (p.mass + p.mass),
          k.young_eff, k.shear_eff, k.normal_damping, k.tangential_damping, k.friction, k.rolling_friction};
}

template <class R>
PairProperties<R> properties(const VariousParticles& p, const PairColumns& c, const Lanes<R>& i, const Lanes<R>& j) {
  Lanes<R> pair{{}, i.count};
  for (int k = 0; k < lanes<R>; ++k) pair.row[k] = c.material[i.row[k]] * p.materials + c.material[j.row[k]];
  const LawCoefficients* table = p.coefficients.data();
  const auto of_pair = [&](double LawCoefficients::* what) { return gather<R>(pair, [&](std::size_t row) { return table[row].*what; }); };
  const R radius_i = load<R>(c.radius, i), radius_j = load<R>(c.radius, j), mass_i = load<R>(c.mass, i), mass_j = load<R>(c.mass, j);
  return {radius_i, radius_j, radius_i * radius_j / (radius_i + radius_j), mass_i * mass_j / (mass_i + mass_j),
          of_pair(&LawCoefficients::young_eff), of_pair(&LawCoefficients::shear_eff), of_pair(&LawCoefficients::normal_damping),
          of_pair(&LawCoefficients::tangential_damping), of_pair(&LawCoefficients::friction), of_pair(&LawCoefficients::rolling_friction)};
}

// Flat: a call in the loop would pass packs through memory.
template <class R, class Pairs> [[gnu::flatten]] void calculate_forces(const Pairs& pairs, const PairColumns& c, std::size_t first, std::size_t last) {
  using Law = typename Pairs::Law;
  using std::sqrt;
  for (; first < last; first += lanes<R>) {
    const auto row = Lanes<R>::range(first, last);
    const auto i = Lanes<R>::at(c.i, row), j = Lanes<R>::at(c.j, row);
    const PairProperties<R> p = properties(pairs.kinds, c, i, j);

    const Vec3T<R> branch = pairs.space.shortest(load<R>(c.position, i) - load<R>(c.position, j));
    const R distance2 = dot(branch, branch), reach = p.radius_i + p.radius_j;
    const auto touching = distance2 < reach * reach;
    const R distance = sqrt(distance2);
    ContactState<R> s;
    s.overlap = reach - distance;                            // g = R_i + R_j - |x_i - x_j|   eq (2.8)
    s.normal = select(distance > R(0), (R(1) / distance) * branch, Vec3T<R>{R(0), R(0), R(1)});
    s.radius_eff = p.radius_eff;
    s.contact_radius = sqrt(p.radius_eff * s.overlap);
    s.damping_scale = sqrt(s.contact_radius * p.mass_eff);
    s.young_eff = p.young_eff, s.shear_eff = p.shear_eff, s.normal_damping = p.normal_damping;
    s.tangential_damping = p.tangential_damping, s.friction = p.friction, s.rolling_friction = p.rolling_friction;

    Vec3T<R> u = load<R>(c.velocity, i) - load<R>(c.velocity, j);
    const R half = R(0.5) * s.overlap, arm_i = p.radius_i - half, arm_j = p.radius_j - half;
    s.normal_velocity = dot(u, s.normal);                    // spin adds nothing along n
    if constexpr (Law::rotates) {
      const Vec3T<R> spin_i = load<R>(c.spin, i), spin_j = load<R>(c.spin, j);
      u -= cross(arm_i * spin_i + arm_j * spin_j, s.normal);
      s.tangential_velocity = u - s.normal_velocity * s.normal;
      s.rolling_velocity = in_tangent_plane(spin_i - spin_j, s.normal);
    }
    Vec3T<R> spring, rolling;
    if constexpr (Law::has_tangential) spring = load<R>(c.spring, row);
    if constexpr (Law::has_rolling) rolling = load<R>(c.rolling, row);
    const ContactForce<R> f = evaluate(pairs.law, s, R(pairs.time_step), spring, rolling);

    const Vec3T<R> none{R(0), R(0), R(0)};                   // not touching: no force, and the contact forgets
    store(select(touching, f.force, none), c.force, row);
    if constexpr (Law::rotates) store(select(touching, -arm_i * f.couple, none), c.torque, row);
    if constexpr (Law::rotates && !Pairs::Kinds::alike) store(arm_j / arm_i, c.arm_ratio, row);
    if constexpr (Law::has_tangential) store(select(touching, spring, none), c.spring, row);
    if constexpr (Law::has_rolling) store(select(touching, rolling, none), c.rolling, row);
  }
}

// The number type of a path, in a translation unit that is compiled for it.
template <VectorPath path> struct NumberOf { using type = stdx::native_simd<double>; };
template <> struct NumberOf<VectorPath::scalar> { using type = double; };

template <class Law, class Kinds, class Space> template <VectorPath path>
void PairForces<Law, Kinds, Space>::run(const PairForces& pairs, const PairColumns& c, std::size_t first, std::size_t last) {
  calculate_forces<typename NumberOf<path>::type>(pairs, c, first, last);
}

}  // namespace skred
