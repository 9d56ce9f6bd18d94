// tasks/steps.h - the steps that tasks are made of.
#pragma once
#include "kernels/chosen_law.h"
#include "kernels/contact_listing.h"
#include "kernels/inertia.h"
#include "tasks/model.h"
#include "tasks/task.h"

namespace skred {

// One step of smooth DEM from time n to n+1. With `initial` it is a step of length zero: it lists the contacts and computes the
// forces of the state as it stands, which a run does once before its first step.
void add_sdem(Task&, const World&, const Model&, bool initial = false);

// One step of nonsmooth DEM. With `initial` it lists the contacts of the state as it stands and gives them their elastic forces.
void add_ndem(Task&, const World&, const Model&, bool initial = false);

// What both share. `columns` of the contacts; of those, springs, memories and as a rule rolling moments are history.
void add_collision(Task&, const World&, const Model&, const Effects&, const ContactColumns& columns, double time_step);
void add_integrate(Task&, const World&, const Model&, const Effects&, double time_step);
Inertia<true> inertia_of_all(const World&);      // where the particles are alike

// Particles that are removed and created (at the head of what follows positions), and those that cross an area (after they moved).
void add_flow(Task&, const Model&);
void add_crossings(Task&, const Model&);

// Points where bodies touch each other, and those less than `margin` [m] apart; with `springs` or the effect `memory` they remember.
void add_rigid_collision(Task&, const World&, const Effects&, double margin, bool springs);

// Contact force kernels, one template instance per combination of laws (tasks/force_kernels.cpp).
void add_force_calculation(Task&, const World&, const Model&, const Effects&, double time_step);

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
