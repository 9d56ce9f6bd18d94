// tasks/sdem.cpp - one step of smooth DEM: positions, contacts, forces from overlaps, velocities.
#include "kernels/force_application.h"
#include "kernels/move_bodies.h"
#include "tasks/steps.h"

namespace skred {

namespace {

template <bool contacts, bool bodies, class Inertia>
Task::RowKernel application(Task& task, const Model& m, const Effects& e, double h, const Inertia& inertia) {
  // Torques exist where a law makes them; an orientation that is only watched has none.
  const auto kernel = [&]<bool rotates> {
    using Update = VelocityUpdate<rotates, Inertia>;
    return task.over_rows(ForceApplicationParticle<contacts, bodies, rotates, Inertia>{Update{m.gravity, h, inertia}, velocity_loop<Update>(m.vector_path)});
  };
  return e.friction || e.rolling ? kernel.template operator()<true>() : kernel.template operator()<false>();
}

template <class Inertia> Task::RowKernel application(Task& task, const Model& m, const Effects& e, double h, const Inertia& inertia) {
  if (e.contacts && e.bodies) return application<true, true>(task, m, e, h, inertia);
  if (e.contacts) return application<true, false>(task, m, e, h, inertia);
  if (e.bodies) return application<false, true>(task, m, e, h, inertia);
  return application<false, false>(task, m, e, h, inertia);
}

}  // namespace

// Not where every state is looked at: by the energy ledger, and at dynamic bodies by who runs the steps.
bool can_move_on(const Model& model, const Effects& e) { return model.method == Method::sdem && !e.energy && !e.dynamic_bodies; }

void add_sdem(Task& task, const World& world, const Model& model, const Effects& e, StepPart part) {
  const double h = length_of(model, part);

  const bool torques = e.friction || e.rolling;
  if (!part.moved) task.add(integrate(task, world, model, e, h));
  if (e.moving_bodies) task.add(MoveBodies{model.pieces, model.bodies_at_start, model.time_step, h});
  if (!part.initial) {
    add_crossings(task, model);
    add_flow(task, model);
  }
  const ContactColumns columns{.sums = true, .torque = torques, .rolling_torque = e.rolling,
                               .spring = e.friction && !e.chosen, .rolling = e.rolling && !e.chosen, .memory = e.memory,
                               .moment = e.rolling && e.chosen && e.energy};
  add_collision(task, world, model, e, columns, h);
  add_rigid_collision(task, world, e, 0, columns.spring);
  add_force_calculation(task, world, model, e, part);

  const Task::RowKernel apply = e.alike ? application(task, model, e, h, inertia_of_all(world)) : application(task, model, e, h, Inertia<false>{});
  if (part.moves_on) task.add_chain(apply, integrate_ahead(task, world, model, e));
  else task.add(apply);
  if (e.rigid_contacts) task.add(ForceApplicationBody<true>{model.gravity, h});
  else if (e.dynamic_bodies) task.add(ForceApplicationBody<false>{model.gravity, h});
  if (e.energy) add_energy_ledger(task, model, e, h);
}

}  // namespace skred
