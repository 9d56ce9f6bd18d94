// tasks/steps.h - the steps that tasks are made of.
#pragma once
#include "kernels/chosen_law.h"
#include "kernels/contact_listing.h"
#include "kernels/inertia.h"
#include "tasks/model.h"
#include "tasks/task.h"

namespace skred {

// One step of smooth DEM from time n to n+1. `initial`: a step of length zero, which lists the contacts and computes the forces of
// the state as it stands; a run does that once before its first step. Of steps in a row whose states nobody looks at, the
// integration of the next can be done when a particle's new velocity is known, and is still in a cache: `moves_on`; and a step
// after such a one begins behind it: `moved`. The bits are the same.
struct StepPart { bool initial = false, moved = false, moves_on = false; };
inline double length_of(const Model& m, StepPart part) { return part.initial ? 0 : m.time_step; }   // h [s]
void add_sdem(Task&, const World&, const Model&, const Effects&, StepPart = {});
bool can_move_on(const Model&, const Effects&);

// One step of nonsmooth DEM. With `initial` it lists the contacts of the state as it stands and gives them their elastic forces.
void add_ndem(Task&, const World&, const Model&, const Effects&, bool initial = false);

// What both share. `columns` of the contacts; of those, springs, memories and as a rule rolling moments are history.
void add_collision(Task&, const World&, const Model&, const Effects&, const ContactColumns& columns, double time_step);
Task::RowKernel integrate(Task&, const World&, const Model&, const Effects&, double time_step);
Task::RowKernel integrate_ahead(Task&, const World&, const Model&, const Effects&);      // smooth DEM, of the next step
Inertia<true> inertia_of_all(const World&);      // where the particles are alike

// Particles that are removed and created (at the head of what follows positions), and those that cross an area (after they moved).
void add_flow(Task&, const Model&);
void add_crossings(Task&, const Model&);

// Points where bodies touch each other, and those less than `margin` [m] apart; with `springs` or the effect `memory` they remember.
void add_rigid_collision(Task&, const World&, const Effects&, double margin, bool springs);

// Contact force kernels, one template instance per combination of laws (tasks/force_kernels.cpp).
void add_force_calculation(Task&, const World&, const Model&, const Effects&, StepPart);

// What the laws of smooth DEM know of a pair of materials.
LawCoefficients law_coefficients(const PairCoefficients&);         // of a force that never pulls
LawCoefficients law_coefficients(const PairCoefficients&, double damping_ratio);
ChosenCoefficients chosen_coefficients(const ContactModel&, const PairCoefficients&);

// The energy of the state at the end of a step and what became of it, where the output asks; time_step 0 before the first step.
void add_energy_ledger(Task&, const Model&, const Effects&, double time_step);
// What particles carry out and in: before they are removed, and after they were created.
void add_energy_ledger_removal(Task&, const Model&);
void add_energy_ledger_inflow(Task&, const Model&);

}  // namespace skred
