// tasks/energy.cpp - the energy ledger of the laws that a scene chose.
#include <cmath>
#include "kernels/energy_ledger.h"
#include "kernels/laws.h"
#include "tasks/steps.h"

namespace skred {

namespace {

// The springs of the laws between each pair of materials; their damping stores nothing.
template <class Law> StoredByLaw stored_by(const Model& m) {
  std::vector<LawCoefficients> springs;
  for (const PairCoefficients& p : m.pairs.values) {
    LawCoefficients& k = springs.emplace_back();
    k.normal_stiffness = 2 * p.young_eff, k.tangential_stiffness = 8 * p.shear_eff;
  }
  return [springs, materials = m.pairs.count](const LedgerContact& c) {
    ContactState<double> s{};
    s.overlap = c.overlap, s.radius_eff = c.radius_eff, s.normal = c.normal;
    s.contact_radius = std::sqrt(c.radius_eff * c.overlap);
    return stored_in_contact(Law{}, s, springs[c.material_a * materials + c.material_b], c.spring, c.moment);
  };
}

StoredByLaw stored_by_law(const Model& m, const Effects& e) {
  if (m.method == Method::ndem) return stored_by<NormalOnly<false>>(m);   // friction and rolling rows have no springs
  if (e.friction && e.rolling) return stored_by<FrictionAndRolling<false>>(m);
  if (e.friction) return stored_by<FrictionOnly<false>>(m);
  if (e.rolling) return stored_by<RollingOnly<false>>(m);
  return stored_by<NormalOnly<false>>(m);
}

bool falls_for_ever(const Model& m) {
  if (!m.periodic) return false;
  const Vec3 &box = m.periodic->length, g = m.gravity;
  return (std::isfinite(box.x) && g.x != 0) || (std::isfinite(box.y) && g.y != 0) || (std::isfinite(box.z) && g.z != 0);
}

}  // namespace

void add_energy_ledger(Task& task, const Model& m, const Effects& e, double time_step) {
  const LedgerOptions options{m.periodic, falls_for_ever(m), m.gravity, time_step, stored_by_law(m, e)};
  if (m.method == Method::ndem) task.add(UpdateEnergyLedger<false>{options});
  else task.add(UpdateEnergyLedger<true>{options});
}

}  // namespace skred
