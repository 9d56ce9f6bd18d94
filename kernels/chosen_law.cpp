// kernels/chosen_law.cpp - the loops over contacts for laws that are chosen at run time, on plain doubles.
#include "engine/periodic.h"
#include "kernels/chosen_law.h"
#include "kernels/force_calculation_loop.h"
#include "kernels/force_calculation_particle_body_loop.h"
#include "kernels/laws.h"

namespace skred {

// In place of the one in kernels/force_calculation_loop.h: one contact, which takes more to look at, and one column of history.
template <bool tangential, bool rolling, bool remembers, bool keeps_moment, class Space, class Lanes>
void apply_law(const PairForces<ChosenLaw<tangential, rolling, remembers, keeps_moment>, ChosenParticles, Space>& pairs, const PairState<double>& pair,
               const PairColumns& c, const Lanes& lanes, const PairBlock& block) {
  using Law = ChosenLaw<tangential, rolling, remembers, keeps_moment>;
  const std::size_t row = lanes[0];
  ContactForce<double> f;                                    // not touching: no force, and the contact forgets
  Vec3 torque_i, torque_j;
  ContactMemory memory;
  if (pair.contact.overlap > 0) {
    const Index i = c.i[row], j = c.j[row];
    const SeenParticle &at_i = block.seen[i - block.first_particle], &at_j = block.seen[c.place_of_j[row]];
    const double mass_i = at_i.velocity.s, mass_j = at_j.velocity.s, radius_i = at_i.position.s, radius_j = at_j.position.s;
    ChosenContact contact{pair.contact, mass_i * mass_j / (mass_i + mass_j),
                          1.4 / (1 / (mass_i * radius_i * radius_i) + 1 / (mass_j * radius_j * radius_j)), {}};
    if constexpr (rolling) contact.rolling_slip = in_tangent_plane(radius_i * at_i.spin.v - radius_j * at_j.spin.v, contact.normal);
    if constexpr (remembers) memory = c.memory[row];
    f = evaluate(pairs.law, contact, pairs.kinds.coefficients[c.material[i] * pairs.kinds.materials + c.material[j]], pairs.time_step, memory);
    if constexpr (Law::rotates) torque_i = -pair.arm_i * f.couple, torque_j = -pair.arm_j * f.couple;
  }
  if (c.force) c.force[row] = f.force;
  if constexpr (remembers) c.memory[row] = memory;
  if constexpr (keeps_moment) c.moment[row] = f.rolling;
  add_to_sums<Law>(f.force, torque_i, torque_j, f.rolling, c, lanes, block);
}

#define SKRED_INSTANTIATE(...) \
  template void PairForces<__VA_ARGS__>::run<VectorPath::scalar>(const PairForces&, const PairColumns&, std::size_t, std::size_t, const PairBlock&);
#define SKRED_INSTANTIATE_LAW(LAW) \
  SKRED_INSTANTIATE(LAW, ChosenParticles, OpenSpace) SKRED_INSTANTIATE(LAW, ChosenParticles, PeriodicSpace) \
  template void WallForces<LAW>::run<VectorPath::scalar>(const WallForces&, const WallColumns&, std::size_t, std::size_t);

SKRED_FOR_EACH_CHOSEN_LAW(SKRED_INSTANTIATE_LAW)

}  // namespace skred
