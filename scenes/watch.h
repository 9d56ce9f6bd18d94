// scenes/watch.h - a run that becomes unphysical stops, with the time, the culprit and the likely cause.
#pragma once
#include "scenes/scene.h"
#include "tasks/sampling.h"

namespace skred {

// After every step: a particle or dynamic body that is not a number, too fast or gone. Throws NumericalFailure.
void check_trouble(const Scene&, const Simulation&);

// After measuring: overlaps beyond the scene's limit, energies that are not numbers. Throws NumericalFailure.
void check_measures(const Scene&, const Simulation&, const Measures&);

}  // namespace skred
