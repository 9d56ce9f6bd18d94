// kernels/force_calculation_loop.h - the loop over pairs of particles, and the overlap, arms and velocities that a law asks for.
//
// The number type R is double, or a pack of doubles: then one turn of a loop computes as many contacts as R is wide. Lanes that
// do not touch compute numbers without meaning, which the last lines replace by zeros.
#pragma once
#include "engine/pack_quads.h"
#include "engine/pack_vectors.h"
#include "kernels/coefficients_of_lanes.h"
#include "kernels/force_calculation_particle_particle.h"

namespace skred {

// A contact of two particles: what the law sees, and the arms from both centres to the contact point [m].
template <class R> struct PairState {
  ContactState<R> contact;
  R arm_i, arm_j;                                            // of particles that are alike: the first for both
};

template <class R> struct PairRadiiAndMass { R radius_i, radius_j, radius_eff, mass_eff; };

template <class R> PairRadiiAndMass<R> radii_and_mass(const AlikeParticles& p, R, R, R, R) {
  return {p.radius, p.radius, p.radius * p.radius / (p.radius + p.radius), p.mass * p.mass / (p.mass + p.mass)};
}
template <class R, class K> PairRadiiAndMass<R> radii_and_mass(const LookedUpParticles<K>&, R radius_i, R radius_j, R mass_i, R mass_j) {
  return {radius_i, radius_j, radius_i * radius_j / (radius_i + radius_j), mass_i * mass_j / (mass_i + mass_j)};
}

template <class R, class Lanes> LawCoefficientsT<R> coefficients(const AlikeParticles& p, const PairColumns&, const Lanes&) {
  const LawCoefficients& k = p.coefficients;
  return {k.normal_stiffness, k.tangential_stiffness, k.normal_damping, k.tangential_damping, k.friction, k.rolling_friction};
}
template <class R, class Lanes> LawCoefficientsT<R> coefficients(const VariousParticles& p, const PairColumns& c, const Lanes& row) {
  return coefficients_of<R>([&](int k) -> const auto& { return p.coefficients[c.material[c.i[row[k]]] * p.materials + c.material[c.j[row[k]]]]; });
}

// Of the particles i, and of the particles j, of these contacts.
template <class R, class Lanes> QuadT<R> of_i(Quad SeenParticle::* what, const PairColumns& c, const Lanes& row, const PairBlock& block) {
  return load_quads<R>([&](int k) { return &(block.seen[c.i[row[k]] - block.first_particle].*what); });
}
template <class R, class Lanes> QuadT<R> of_j(Quad SeenParticle::* what, const PairColumns& c, const Lanes& row, const PairBlock& block) {
  return load_quads<R>([&](int k) { return &(block.seen[c.place_of_j[row[k]]].*what); });
}

template <class R, class Pairs, class Lanes>
void look_at(const Pairs& pairs, const PairColumns& c, const Lanes& row, const PairBlock& block, PairState<R>& pair) {
  using std::sqrt;
  const QuadT<R> at_i = of_i<R>(&SeenParticle::position, c, row, block), at_j = of_j<R>(&SeenParticle::position, c, row, block);
  const QuadT<R> moves_i = of_i<R>(&SeenParticle::velocity, c, row, block), moves_j = of_j<R>(&SeenParticle::velocity, c, row, block);
  const auto p = radii_and_mass(pairs.kinds, at_i.s, at_j.s, moves_i.s, moves_j.s);

  const Vec3T<R> branch = pairs.space.shortest(at_i.v - at_j.v);
  const R distance = norm(branch);
  ContactState<R>& s = pair.contact;
  s.overlap = p.radius_i + p.radius_j - distance;            // g = R_i + R_j - |x_i - x_j|   eq (2.8)
  s.normal = select(distance > R(0), (R(1) / distance) * branch, Vec3T<R>{R(0), R(0), R(1)});
  s.radius_eff = p.radius_eff;
  s.contact_radius = sqrt(p.radius_eff * s.overlap);
  s.damping_scale = sqrt(s.contact_radius * p.mass_eff);
  const R arm_i = pair.arm_i = p.radius_i - R(0.5) * s.overlap;
  const R arm_j = Pairs::Kinds::alike ? arm_i : p.radius_j - R(0.5) * s.overlap;
  if constexpr (!Pairs::Kinds::alike) pair.arm_j = arm_j;

  Vec3T<R> u = moves_i.v - moves_j.v;
  s.normal_velocity = dot(u, s.normal);                      // spin adds nothing along n
  if constexpr (Pairs::Law::rotates) {
    const Vec3T<R> spin_i = of_i<R>(&SeenParticle::spin, c, row, block).v, spin_j = of_j<R>(&SeenParticle::spin, c, row, block).v;
    u -= cross(arm_i * spin_i + arm_j * spin_j, s.normal);
    s.tangential_velocity = u - s.normal_velocity * s.normal;
    s.rolling_velocity = in_tangent_plane(spin_i - spin_j, s.normal);
  }
}

// Adds what contacts do to the sums of their particles: the force, its torque about either centre, and the rolling moment on i.
template <class Law, class R, class Lanes>
void add_to_sums(const Vec3T<R>& force, const Vec3T<R>& torque_i, const Vec3T<R>& torque_j, const Vec3T<R>& rolling,
                 const PairColumns& c, const Lanes& row, const PairBlock& block) {
  constexpr std::size_t width = lanes<R>;
  Four f[width], t_i[width], t_j[width];
  as_rows(force, f);
  if constexpr (Law::has_rolling) as_rows(torque_i + rolling, t_i), as_rows(torque_j - rolling, t_j);
  else if constexpr (Law::rotates) as_rows(torque_i, t_i), as_rows(torque_j, t_j);
  for (std::size_t k = 0; k < width; ++k) {                  // one after the other: several may be contacts of one particle
    if (int(k) == row.count) break;
    PairSum& on_i = block.sum[c.i[row[k]] - block.first_particle];
    on_i.force += f[k];
    if constexpr (Law::rotates) on_i.torque += t_i[k];
    PairSum& on_j = block.sum[c.place_of_j[row[k]]];
    on_j.force -= f[k];
    if constexpr (Law::rotates) on_j.torque += t_j[k];
  }
}

template <class R, class Pairs, class Lanes>
void apply_law(const Pairs& pairs, const PairState<R>& pair, const PairColumns& c, const Lanes& row, const PairBlock& block) {
  using Law = typename Pairs::Law;
  Vec3T<R> spring, rolling;
  if constexpr (Law::has_tangential) spring = load<R>(c.spring, row);
  if constexpr (Law::has_rolling) rolling = load<R>(c.rolling, row);
  const ContactForce<R> f =
      evaluate(pairs.law, pair.contact, coefficients<R>(pairs.kinds, c, row), R(pairs.time_step), spring, rolling);

  const auto touching = pair.contact.overlap > R(0);
  const Vec3T<R> none{R(0), R(0), R(0)};                     // not touching: no force, and the contact forgets
  const Vec3T<R> force = select(touching, f.force, none);
  if (c.force) store(force, c.force, row);
  if constexpr (Law::has_tangential) store(select(touching, spring, none), c.spring, row);
  if constexpr (Law::has_rolling) store(rolling = select(touching, rolling, none), c.rolling, row);
  Vec3T<R> torque_i, torque_j;
  if constexpr (Law::rotates) {
    torque_i = select(touching, -pair.arm_i * f.couple, none);
    torque_j = select(touching, -(Pairs::Kinds::alike ? pair.arm_i : pair.arm_j) * f.couple, none);
  }
  add_to_sums<Law>(force, torque_i, torque_j, rolling, c, row, block);
}

// In two passes over a few packs at a time: roots and divisions wait long for each other, and a processor fills the waiting with
// work on the next packs only if it is not far ahead. Flat: a call would pass packs through memory.
template <class R, class Pairs> [[gnu::flatten]] void calculate_forces(const Pairs& pairs, const PairColumns& c, std::size_t first, std::size_t last,
                                                                     const PairBlock& block) {
  constexpr std::size_t packs = 4, width = lanes<R>;
  PairState<R> state[packs];
  const auto look = [&](const auto& row, PairState<R>& out) {
    if constexpr (lanes<R> > 1) {
      look_at(pairs, c, row, block, out);                    // where it stays: to return packs, a compiler writes them twice
    } else {
      PairState<R> here;                                     // and plain numbers stay in registers while nobody else can see them
      look_at(pairs, c, row, block, here);
      out = here;
    }
  };
  for (; first + packs * width <= last; first += packs * width) {
    for (std::size_t k = 0; k < packs; ++k) look(FullRange<R>{first + k * width}, state[k]);
    for (std::size_t k = 0; k < packs; ++k) apply_law(pairs, state[k], c, FullRange<R>{first + k * width}, block);
  }
  for (; first < last; first += width) {
    const PartOfRange<R> row(first, last);
    look(row, state[0]);
    apply_law(pairs, state[0], c, row, block);
  }
}

template <class Law, class Kinds, class Space> template <VectorPath path>
void PairForces<Law, Kinds, Space>::run(const PairForces& pairs, const PairColumns& c, std::size_t first, std::size_t last, const PairBlock& block) {
  calculate_forces<NumberOf<path>>(pairs, c, first, last, block);
}

}  // namespace skred
