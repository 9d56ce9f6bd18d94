// tasks/sdem.cpp - one step of smooth DEM: positions, contacts, forces from overlaps, velocities.
#include "kernels/force_application.h"
#include "kernels/move_bodies.h"
#include "tasks/steps.h"

namespace skred {

namespace {

template <bool contacts, bool bodies, class Inertia>
void add_application(Task& task, const Model& m, const Effects& e, double h, const Inertia& inertia) {
  // Torques exist where a law makes them; an orientation that is only watched has none.
  const auto add = [&]<bool rotates> {
    using Update = VelocityUpdate<rotates, Inertia>;
    task.add(ForceApplicationParticle<contacts, bodies, rotates, Inertia>{Update{m.gravity, h, inertia}, velocity_loop<Update>(m.vector_path)});
  };
  if (e.friction || e.rolling) add.template operator()<true>();
  else add.template operator()<false>();
}

template <class Inertia> void add_application(Task& task, const Model& m, const Effects& e, double h, const Inertia& inertia) {
  if (e.contacts && e.bodies) add_application<true, true>(task, m, e, h, inertia);
  else if (e.contacts) add_application<true, false>(task, m, e, h, inertia);
  else if (e.bodies) add_application<false, true>(task, m, e, h, inertia);
  else add_application<false, false>(task, m, e, h, inertia);
}

}  // namespace

void add_sdem(Task& task, const World& world, const Model& model, bool initial) {
  const Effects e = decide_effects(world, model);
  const double h = initial ? 0 : model.time_step;

  const bool torques = e.friction || e.rolling;
  add_integrate(task, world, model, e, h);
  if (e.moving_bodies) task.add(MoveBodies{model.pieces, model.bodies_at_start, model.time_step, h});
  if (!initial) {
    add_crossings(task, model);
    add_flow(task, model);
  }
  const ContactColumns columns{.sums = true, .torque = torques, .rolling_torque = e.rolling,
                               .spring = e.friction && !e.chosen, .rolling = e.rolling && !e.chosen, .memory = e.memory,
                               .moment = e.rolling && e.chosen && e.energy};
  add_collision(task, world, model, e, columns, h);
  add_rigid_collision(task, world, e, 0, columns.spring);
  add_force_calculation(task, world, model, e, h);

  if (e.alike) add_application(task, model, e, h, inertia_of_all(world));
  else add_application(task, model, e, h, Inertia<false>{});
  if (e.rigid_contacts) task.add(ForceApplicationBody<true>{model.gravity, h});
  else if (e.dynamic_bodies) task.add(ForceApplicationBody<false>{model.gravity, h});
  if (e.energy) add_energy_ledger(task, model, e, h);
}

}  // namespace skred
