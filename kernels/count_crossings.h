// kernels/count_crossings.h - how many particles have crossed an area, and their mass: along its normal less against it.
//
// The way of a step is taken as straight. What leaves through a periodic boundary goes on at the other one: both ends of its way count.
#pragma once
#include <vector>
#include "engine/access.h"
#include "engine/periodic.h"
#include "engine/region.h"

namespace skred {

template <class Space> struct CountCrossings {
  static constexpr const char* name = "count_crossings";

  Space space;
  std::vector<Area> areas;

  void operator()(Parallel parallel, Read<&Particles::id> id, Read<&Particles::position> position, Read<&Particles::mass> mass,
                  Update<&Particles::before> before, Update<&Crossed::count> count, Update<&Crossed::mass> crossed_mass) const;
};

extern template struct CountCrossings<OpenSpace>;
extern template struct CountCrossings<PeriodicSpace>;

}  // namespace skred
