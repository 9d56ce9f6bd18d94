// kernels/reorder.h - every so many steps the rows of the particles are sorted along a space-filling curve, so that neighbours in
// space are neighbours in memory. Ids stay. Smooth DEM adds up contact forces in the order of the rows, so that the last bits of its
// results depend on these steps and on the curve's cells: neither may depend on the search (kernels/check_motion.h makes one due
// then). Where particles have come or gone in this step, it is from before that that previous_row tells.
#pragma once
#include "engine/access.h"

namespace skred {

struct Reorder {
  static constexpr const char* name = "reorder";
  double cell;        // [m] edge of the curve's finest cells
  int every;          // steps between two reorderings; 0: never

  void operator()(Read<&Search::due> due, Read<&Clock::step> step, Update<&Search::rows_changed> changed,
                  Write<&Search::reordered> reordered, Resize<Particles> particles) const;
};

inline bool reorders(std::int64_t step, int every) { return every > 0 && step % every == 0; }

}  // namespace skred
