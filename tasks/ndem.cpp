// tasks/ndem.cpp - one step of nonsmooth DEM: contacts of the state, velocities that satisfy their rows, positions.
//
// Servin, Wang, Lacoursiere & Bodin 2014: the velocities v(n+1) solve the rows of engine/contact_rows.h at x(n); then
// x(n+1) = x(n) + h v(n+1).
#include <algorithm>
#include <limits>
#include "kernels/constraint_setup.h"
#include "kernels/contact_solve.h"
#include "kernels/contact_start.h"
#include "kernels/energy_ledger.h"
#include "kernels/impulse_application.h"
#include "kernels/initial_forces.h"
#include "kernels/move_bodies.h"
#include "kernels/restitution.h"
#include "kernels/swept_test.h"
#include "tasks/steps.h"
#include "tasks/time_step.h"

namespace skred {

namespace {

std::vector<RowCoefficients> coefficients(const Model& m) {
  std::vector<RowCoefficients> table;
  for (const PairCoefficients& p : m.pairs.values)
    table.push_back({4.0 / 3.0 * p.young_eff, damping_ratio_of(std::max(p.restitution, least_restitution)), p.restitution, p.friction,
                     p.rolling_friction});
  return table;
}

template <bool impact, bool friction, bool rolling, bool limited> SweepOptions options(const Model& m, int most) {
  const double error_tolerance = impact ? std::numeric_limits<double>::infinity() : error_tolerance_of(m);
  return {most, m.solver.tolerance, error_tolerance, m.solver.separation_speed.value_or(0), {impact, friction, rolling, limited, true},
          contact_sweep<SweepKind{impact, friction, rolling, limited, false}>(m.vector_path),
          contact_sweep<SweepKind{impact, friction, rolling, limited, true}>(m.vector_path)};
}

template <bool rolling, bool limited> SweepOptions contact_sweeps(const Model& m, const Effects& e) {
  return e.friction ? options<false, true, rolling, limited>(m, m.solver.iterations)
                    : options<false, false, rolling, limited>(m, m.solver.iterations);
}

template <bool rolling> SweepOptions impact_sweeps(const Model& m, const Effects& e) {
  return e.friction ? options<true, true, rolling, false>(m, m.solver.impact_iterations)
                    : options<true, false, rolling, false>(m, m.solver.impact_iterations);
}

template <bool rolling, class Space> void add_solver(Task& task, const World& w, const Model& m, const Effects& e, const Space& space, bool initial) {
  const double h = m.time_step;
  if (initial) {
    task.add(InitialForces<Space, rolling>{space, m.pairs.count, coefficients(m)});
    return;
  }
  const RowOptions rows{h, m.solver.damping_steps, impact_speed_of(m), m.gravity, e.impacts};
  task.add(ConstraintSetup<Space>{space, rows, m.pairs.count, coefficients(m), largest_radius(w, m)});
  if (e.dynamic_bodies) task.add(ConstraintSetupBody{rows, m.pairs.count, coefficients(m)});
  if (e.energy) task.add(EnergyLedgerBefore{});
  if (e.impacts) task.add(ImpactSolve{rolling && m.solver.impact_rolling ? impact_sweeps<rolling>(m, e) : impact_sweeps<false>(m, e)});
  if (e.energy && e.impacts) task.add(EnergyLedgerImpacts{});
  const bool limited = m.solver.separation_speed.has_value();
  task.add(ContactStart<rolling>{h, m.gravity, m.solver.warm_start, std::max(m.solver.trusted_residual, m.solver.tolerance)});
  task.add(ContactSolve{limited ? contact_sweeps<rolling, true>(m, e) : contact_sweeps<rolling, false>(m, e)});
  task.add(ImpulseApplication<rolling>{h});
  if (e.dynamic_bodies) task.add(ImpulseApplicationBody{h});
  if (e.energy) task.add(EnergyLedgerRows{});
}

}  // namespace

void add_ndem(Task& task, const World& world, const Model& model, const Effects& e, bool initial) {
  if (initial && e.moving_bodies) task.add(MoveBodies{model.pieces, model.bodies_at_start, model.time_step, 0});
  if (!initial) add_flow(task, model);
  add_collision(task, world, model, e, {.rolling_torque = e.rolling, .spring = e.history, .rolling = e.rolling}, model.time_step);
  add_rigid_collision(task, world, e, model.time_step * expected_speed(world, model).value, true);
  const auto add = [&](const auto& space) {
    if (e.rolling) add_solver<true>(task, world, model, e, space, initial);
    else add_solver<false>(task, world, model, e, space, initial);
  };
  if (model.periodic) add(*model.periodic);
  else add(OpenSpace{});
  if (initial) {
    if (e.energy) add_energy_ledger(task, model, e, 0);
    return;
  }
  if (e.bodies && model.periodic) task.add(SweptTest<PeriodicSpace>{*model.periodic, model.time_step});
  else if (e.bodies) task.add(SweptTest<OpenSpace>{{}, model.time_step});
  task.add(integrate(task, world, model, e, model.time_step));
  add_crossings(task, model);
  if (e.moving_bodies) task.add(MoveBodies{model.pieces, model.bodies_at_start, model.time_step, model.time_step});
  if (e.energy) add_energy_ledger(task, model, e, model.time_step);
}

}  // namespace skred
