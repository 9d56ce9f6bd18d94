// tasks/energy.cpp - the energy ledger of the laws that a scene chose.
#include <cmath>
#include "kernels/energy_ledger.h"
#include "kernels/laws.h"
#include "tasks/steps.h"

namespace skred {

namespace {

ContactState<double> state_of(const LedgerContact& c) {
  ContactState<double> s{};
  s.overlap = c.overlap, s.radius_eff = c.radius_eff, s.normal = c.normal;
  s.normal_velocity = dot(c.velocity, c.normal);
  s.contact_radius = std::sqrt(c.radius_eff * c.overlap);
  return s;
}

// The springs of the laws between each pair of materials; their damping stores nothing.
template <class Law> StoredByLaw stored_by(const Model& m) {
  std::vector<LawCoefficients> pairs;
  for (const PairCoefficients& p : m.pairs.values) pairs.push_back(law_coefficients(p));
  return [pairs, materials = m.pairs.count](const LedgerContact& c) {
    return stored_in_contact(Law{}, state_of(c), pairs[c.material_a * materials + c.material_b], c.spring, c.moment);
  };
}

StoredByLaw stored_by_chosen(const Model& m) {
  std::vector<ChosenCoefficients> pairs;
  for (const PairCoefficients& p : m.pairs.values) pairs.push_back(chosen_coefficients(m.contact, p));
  return [pairs, laws = m.contact, materials = m.pairs.count](const LedgerContact& c) {
    ContactState<double> s = state_of(c);
    set_scales(laws.normal, 0, s);                           // dashpots store nothing
    return stored_in_contact(laws, s, pairs[c.material_a * materials + c.material_b], dot(c.force, c.normal), c.memory);
  };
}

StoredByLaw stored_by_law(const Model& m, const Effects& e) {
  if (m.method == Method::ndem) return stored_by<NormalOnly<false>>(m);   // friction and rolling rows have no springs
  if (e.chosen) return stored_by_chosen(m);
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
  const double let_go_after = m.method == Method::ndem ? 0 : 0.5 * m.time_step;
  const LedgerOptions options{m.periodic, falls_for_ever(m), m.gravity, time_step, stored_by_law(m, e), !m.removers.empty(), let_go_after};
  if (m.method == Method::ndem) task.add(UpdateEnergyLedger<false>{options});
  else task.add(UpdateEnergyLedger<true>{options});
}

void add_energy_ledger_removal(Task& task, const Model& m) {
  if (m.method == Method::ndem) task.add(EnergyLedgerRemoval<false>{m.removers, m.time_step, 1, m.gravity, falls_for_ever(m)});
  else task.add(EnergyLedgerRemoval<true>{m.removers, m.time_step, 0, m.gravity, falls_for_ever(m)});
}

void add_energy_ledger_inflow(Task& task, const Model& m) { task.add(EnergyLedgerInflow{m.gravity, falls_for_ever(m)}); }

}  // namespace skred
