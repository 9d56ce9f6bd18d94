// tasks/force_kernels.cpp - from the laws that a scene chooses to one instance of the fused force kernels.
#include <cmath>
#include "kernels/chosen_law.h"
#include "kernels/force_calculation_body_body.h"
#include "kernels/force_calculation_particle_body.h"
#include "kernels/force_calculation_particle_particle.h"
#include "kernels/laws.h"
#include "kernels/restitution.h"
#include "tasks/steps.h"

namespace skred {

// beta = sqrt(10/3) zeta, so that gamma_n = beta sqrt(S_n m_eff)   eq (3.2) repaired
LawCoefficients law_coefficients(const PairCoefficients& p) { return law_coefficients(p, damping_ratio_of(p.restitution)); }
LawCoefficients law_coefficients(const PairCoefficients& p, double damping_ratio) {
  const double beta = std::sqrt(10.0 / 3.0) * damping_ratio;
  return {2 * p.young_eff, 8 * p.shear_eff, beta * std::sqrt(2 * p.young_eff), beta * std::sqrt(8 * p.shear_eff), p.friction, p.rolling_friction};
}

// The same for a law with other parts: what multiplies the scales of its springs and dashpots (kernels/chosen_law.h). k_t / k_n is that
// of Hertz and Mindlin, 8 G* / (2 E*) = 2 (1 - nu) / (2 - nu), whatever the normal law.
ChosenCoefficients chosen_coefficients(const ContactModel& model, const PairCoefficients& p) {
  const double zeta = model.pull ? damping_ratio_if_pulling(p.restitution) : damping_ratio_of(p.restitution);
  ChosenCoefficients k{law_coefficients(p, zeta)};
  if (model.normal == NormalLaw::kuwabara_kono) {
    k.normal_damping = p.damping_time * k.normal_stiffness;
    k.tangential_damping = p.damping_time * k.tangential_stiffness;
  }
  if (is_linear(model.normal)) {
    k.normal_stiffness = p.normal_stiffness;
    k.tangential_stiffness = p.normal_stiffness * (8 * p.shear_eff) / (2 * p.young_eff);
    k.normal_damping = 2 * zeta * std::sqrt(k.normal_stiffness);                    // c = 2 zeta sqrt(k m_eff)   eq (2.10)
    k.tangential_damping = 2 * zeta * std::sqrt(k.tangential_stiffness);
    k.unloading_stiffness = p.normal_stiffness / (p.restitution * p.restitution);   // e = sqrt(k_1 / k_2), Walton & Braun 1986
  }
  k.tangential_viscosity = p.tangential_damping;
  k.rolling_viscosity = p.rolling_viscosity;
  k.rolling_damping = p.rolling_damping;
  k.rolling_damping_at_limit = p.rolling_damping_at_limit;
  return k;
}

namespace {

template <class Law> std::vector<typename Law::Coefficients> table_of(const Model& m) {
  std::vector<typename Law::Coefficients> table;
  for (const PairCoefficients& p : m.pairs.values) {
    if constexpr (Law::chosen) table.push_back(chosen_coefficients(m.contact, p));
    else table.push_back(law_coefficients(p));
  }
  return table;
}

template <class Law> void add_kernels(Task& task, const World& w, const Model& m, const Effects& e, StepPart part, Law law) {
  const auto table = table_of<Law>(m);
  const Particles& p = std::get<Particles>(w);

  const auto add_pairs = [&](auto kinds, auto space) {
    using Kernel = ForceCalculationParticleParticle<Law, decltype(kinds), decltype(space)>;
    task.add(Kernel{{law, kinds, space, length_of(m, part)}, pair_loop<decltype(Kernel::pairs)>(m.vector_path), part.moves_on});
  };
  const auto add_in = [&](auto space) {
    if constexpr (Law::chosen) {
      add_pairs(ChosenParticles{m.pairs.count, table}, space);
    } else if (e.alike) {
      const auto k = p.material.data[0];
      add_pairs(AlikeParticles{p.radius.data[0], p.mass.data[0], table[k * m.pairs.count + k]}, space);
    } else {
      add_pairs(VariousParticles{m.pairs.count, table}, space);
    }
  };
  if (e.contacts) {
    if (m.periodic) add_in(*m.periodic);
    else add_in(OpenSpace{});
  }
  if (e.bodies) task.add(ForceCalculationParticleBody<Law>{{law, m.pairs.count, table, length_of(m, part)}, wall_loop<Law>(m.vector_path)});
}

template <class Law> void add_rigid_kernel(Task& task, const Model& m, StepPart part, Law law) {
  task.add(ForceCalculationBodyBody<Law>{law, m.pairs.count, table_of<Law>(m), length_of(m, part)});
}

template <bool damped> void choose(Task& task, const World& w, const Model& m, const Effects& e, StepPart part) {
  if (e.friction && e.rolling) add_kernels(task, w, m, e, part, FrictionAndRolling<damped>{});
  else if (e.friction) add_kernels(task, w, m, e, part, FrictionOnly<damped>{});
  else if (e.rolling) add_kernels(task, w, m, e, part, RollingOnly<damped>{});
  else add_kernels(task, w, m, e, part, NormalOnly<damped>{});
  if (e.rigid_contacts && e.friction) add_rigid_kernel(task, m, part, FrictionOnly<damped>{});
  else if (e.rigid_contacts) add_rigid_kernel(task, m, part, NormalOnly<damped>{});
}

template <bool remembers> void choose_other(Task& task, const World& w, const Model& m, const Effects& e, StepPart part) {
  if (e.friction && e.rolling && e.energy) add_kernels(task, w, m, e, part, ChosenLaw<true, true, remembers, true>{m.contact});
  else if (e.rolling && e.energy) add_kernels(task, w, m, e, part, ChosenLaw<false, true, remembers, true>{m.contact});
  else if (e.friction && e.rolling) add_kernels(task, w, m, e, part, ChosenLaw<true, true, remembers>{m.contact});
  else if (e.friction) add_kernels(task, w, m, e, part, ChosenLaw<true, false, remembers>{m.contact});
  else if (e.rolling) add_kernels(task, w, m, e, part, ChosenLaw<false, true, remembers>{m.contact});
  else add_kernels(task, w, m, e, part, ChosenLaw<false, false, remembers>{m.contact});
  if (e.rigid_contacts && e.friction) add_rigid_kernel(task, m, part, ChosenLaw<true, false, remembers>{m.contact});
  else if (e.rigid_contacts) add_rigid_kernel(task, m, part, ChosenLaw<false, false, remembers>{m.contact});
}

}  // namespace

void add_force_calculation(Task& task, const World& w, const Model& m, const Effects& e, StepPart part) {
  if (e.chosen && e.memory) choose_other<true>(task, w, m, e, part);
  else if (e.chosen) choose_other<false>(task, w, m, e, part);
  else if (e.damping) choose<true>(task, w, m, e, part);
  else choose<false>(task, w, m, e, part);
}

}  // namespace skred
