// tasks/flow.cpp - particles that come and go, and the areas they cross: nothing where the scene asks for none of it.
#include "kernels/count_crossings.h"
#include "kernels/emit_particles.h"
#include "kernels/remove_particles.h"
#include "tasks/steps.h"

namespace skred {

void add_flow(Task& task, const Model& m) {
  const int steps_behind = m.method == Method::ndem ? 1 : 0;   // nonsmooth DEM moves particles at the end of its step
  if (!m.removers.empty()) {
    if (m.energy) add_energy_ledger_removal(task, m);
    task.add(RemoveParticles{m.removers, m.time_step, steps_behind});
  }
  const auto emit = [&](const auto& space) {
    task.add(EmitParticles<std::decay_t<decltype(space)>>{space, m.inflows, m.time_step, steps_behind, m.gravity, m.orientation,
                                                          !m.areas.empty()});
  };
  if (m.inflows.empty()) return;
  if (m.periodic) emit(*m.periodic);
  else emit(OpenSpace{});
  if (m.energy) add_energy_ledger_inflow(task, m);
}

void add_crossings(Task& task, const Model& m) {
  if (m.areas.empty()) return;
  if (m.periodic) task.add(CountCrossings<PeriodicSpace>{*m.periodic, m.areas});
  else task.add(CountCrossings<OpenSpace>{{}, m.areas});
}

}  // namespace skred
