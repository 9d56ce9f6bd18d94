// kernels/reorder.h - what happens to the particles when a search is due: they note where they are, and now and then their
// rows are sorted along a space-filling curve, so that neighbours in space are neighbours in memory. Ids stay; no result
// depends on the order of the rows.
#pragma once
#include "engine/access.h"

namespace skred {

struct Reorder {
  static constexpr const char* name = "reorder";
  double cell;        // [m] edge of the curve's finest cells
  int every;          // searches between two reorderings; 0: never

  void operator()(Read<&Search::due> due, Read<&Search::count> count, Write<&Search::reach> reach,
                  Resize<Particles> particles) const;
};

}  // namespace skred
