// tasks/steps.h - the steps that tasks are made of.
#pragma once
#include "tasks/model.h"
#include "tasks/task.h"

namespace skred {

// One step of smooth DEM from time n to n+1. With `initial` it is a step of length zero: it lists the contacts and computes the
// forces of the state as it stands, which a run does once before its first step.
void add_sdem(Task&, const World&, const Model&, bool initial = false);

// The parts it shares with other methods.
void add_collision(Task&, const World&, const Model&, const Effects&, double time_step);

// Points where bodies touch each other, and those less than `margin` [m] apart.
void add_rigid_collision(Task&, const World&, const Effects&, double margin);

// Contact force kernels, one template instance per combination of laws (tasks/force_kernels.cpp).
void add_force_calculation(Task&, const World&, const Model&, const Effects&, double time_step);

}  // namespace skred
