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

// Rows of the particles that leave at this step, ascending, each with the first remover in whose region it is. None where something is not
// a number: then the run ends in this step, and the lists stay as they are (check_motion).
struct Leaving { Index row, remover; };
std::vector<Leaving> leaving(const Parallel&, std::span<const Remover>, std::int64_t step, double time_step, std::span<const Vec3> position,
                             std::span<const Vec3> velocity);

struct RemoveParticles {
  static constexpr const char* name = "remove_particles";

  std::vector<Remover> removers;
  double time_step;                 // h [s]
  int steps_behind;                 // of the state, behind the clock: 1 where the step begins with this kernel

  void operator()(Parallel parallel, Read<&Clock::step> step, Update<&Search::rows_changed> changed, Update<&Removed::count> count,
                  Update<&Removed::mass> mass, Resize<Particles> particles) const;
};

}  // namespace skred
