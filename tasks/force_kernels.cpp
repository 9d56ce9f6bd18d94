// tasks/force_kernels.cpp - from the laws that a scene chooses to one instance of the fused force kernels.
#include <cmath>
#include "kernels/force_calculation_body_body.h"
#include "kernels/force_calculation_particle_body.h"
#include "kernels/force_calculation_particle_particle.h"
#include "kernels/laws.h"
#include "kernels/restitution.h"
#include "tasks/steps.h"

namespace skred {

namespace {

// beta = sqrt(10/3) zeta, so that gamma_n = beta sqrt(S_n m_eff)   eq (3.2) repaired
LawCoefficients coefficients(const PairCoefficients& p) {
  const double beta = std::sqrt(10.0 / 3.0) * damping_ratio_of(p.restitution);
  return {2 * p.young_eff, 8 * p.shear_eff, beta * std::sqrt(2 * p.young_eff), beta * std::sqrt(8 * p.shear_eff), p.friction, p.rolling_friction};
}

std::vector<LawCoefficients> coefficients(const PairTable& pairs) {
  std::vector<LawCoefficients> table;
  for (const PairCoefficients& p : pairs.values) table.push_back(coefficients(p));
  return table;
}

template <class Law> void add_kernels(Task& task, const World& w, const Model& m, const Effects& e, double h, Law law) {
  const std::vector<LawCoefficients> table = coefficients(m.pairs);
  const Particles& p = std::get<Particles>(w);

  const auto add_pairs = [&](auto kinds, auto space) {
    using Kernel = ForceCalculationParticleParticle<Law, decltype(kinds), decltype(space)>;
    task.add(Kernel{{law, kinds, space, h}, pair_loop<decltype(Kernel::pairs)>(m.vector_path)});
  };
  const auto add_in = [&](auto space) {
    if (e.alike) {
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
  if (e.bodies) task.add(ForceCalculationParticleBody<Law>{law, m.pairs.count, table, h});
}

template <bool damped> void choose(Task& task, const World& w, const Model& m, const Effects& e, double h) {
  if (e.friction && e.rolling) add_kernels(task, w, m, e, h, FrictionAndRolling<damped>{});
  else if (e.friction) add_kernels(task, w, m, e, h, FrictionOnly<damped>{});
  else if (e.rolling) add_kernels(task, w, m, e, h, RollingOnly<damped>{});
  else add_kernels(task, w, m, e, h, NormalOnly<damped>{});
  const auto add_bodies = [&](auto law) { task.add(ForceCalculationBodyBody<decltype(law)>{law, m.pairs.count, coefficients(m.pairs), h}); };
  if (e.rigid_contacts && e.friction) add_bodies(FrictionOnly<damped>{});
  else if (e.rigid_contacts) add_bodies(NormalOnly<damped>{});
}

}  // namespace

void add_force_calculation(Task& task, const World& w, const Model& m, const Effects& e, double h) {
  if (e.damping) choose<true>(task, w, m, e, h);
  else choose<false>(task, w, m, e, h);
}

}  // namespace skred
