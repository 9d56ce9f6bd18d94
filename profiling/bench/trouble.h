// profiling/bench/trouble.h - a simulation that became unphysical is not worth timing.
#pragma once
#include <string>
#include "tasks/simulation.h"

namespace skred {

// Throws NumericalFailure, naming the scene.
void check_sound(const Simulation&, const std::string& scene);

}  // namespace skred
