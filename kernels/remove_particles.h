// kernels/remove_particles.h - takes the particles in a region out of the simulation.
//
// The others keep their ids and their contacts the history; a search follows in the same step, which leaves no trace in the result. Rows
// behind move up, so that smooth DEM's sums may be parted into other blocks (engine/world.h): last digits. An id is never given again.
#pragma once
#include <limits>
#include <vector>
#include "engine/access.h"
#include "engine/region.h"

namespace skred {

// Those whose centre is in the region at the time of a look are taken out; looks are made every `interval` from `start` on, before `end`.
struct Remover {
  Region region;
  double start = 0, end = std::numeric_limits<double>::infinity();   // [s]
  double interval = 0;                                               // [s] rounded to steps; 0: every step
};

struct RemoveParticles {
  static constexpr const char* name = "remove_particles";

  std::vector<Remover> removers;    // the first in whose region a particle is counts it
  double time_step;                 // h [s]
  int steps_behind;                 // of the state, behind the clock: 1 where the step begins with this kernel

  void operator()(Parallel parallel, Read<&Clock::step> step, Update<&Search::rows_changed> changed, Update<&Removed::count> count,
                  Update<&Removed::mass> mass, Resize<Particles> particles) const;
};

}  // namespace skred
