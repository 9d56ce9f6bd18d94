// kernels/reorder.h - now and then, when a search is due, the rows of the particles are sorted along a space-filling curve, so that
// neighbours in space are neighbours in memory. Ids stay; no result depends on the order of the rows. Where particles have come or
// gone in this step, it is from before that that previous_row tells.
#pragma once
#include "engine/access.h"

namespace skred {

struct Reorder {
  static constexpr const char* name = "reorder";
  double cell;        // [m] edge of the curve's finest cells
  int every;          // searches between two reorderings; 0: never

  void operator()(Read<&Search::due> due, Read<&Search::count> count, Update<&Search::rows_changed> changed,
                  Write<&Search::reordered> reordered, Resize<Particles> particles) const;
};

}  // namespace skred
