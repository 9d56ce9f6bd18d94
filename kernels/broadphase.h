// kernels/broadphase.h - the pairs of particles that may touch before the next search.
//
// When a search is due: particles are sorted into the cells of a grid, and each looks through its 27 cells for neighbours within
// the margins of both. Each pair is listed once, with the particle of the lower id, by ascending id of the other; and each
// particle also gets the entries in which it is the other.
#pragma once
#include "engine/access.h"
#include "engine/periodic.h"

namespace skred {

template <class Space> struct Broadphase {
  static constexpr const char* name = "broadphase";

  Space space;
  double cell;              // [m] edge of a cell, at least the largest diameter + twice the largest margin

  void operator()(Parallel parallel, Read<&Search::due> due, Read<&Particles::id> id, Read<&Particles::position> position,
                  Read<&Particles::radius> radius, Read<&Particles::search_margin> margin, Resize<CellGrid> grid,
                  Resize<Neighbours> neighbours, Resize<Neighbourhood> neighbourhood) const;
};

extern template struct Broadphase<OpenSpace>;
extern template struct Broadphase<PeriodicSpace>;

}  // namespace skred
