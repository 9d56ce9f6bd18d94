// kernels/broadphase.h - the pairs of particles that may touch before the next search.
//
// When a search is due: particles are sorted into the cells of a grid, and each looks through its 27 cells for neighbours within
// the margins of both. Each pair is listed once, with the particle of the lower id, by ascending id of the other.
#pragma once
#include "engine/access.h"
#include "engine/periodic.h"
#include "engine/vector_path.h"

namespace skred {

// Places in the grid's order, [first, last).
struct Places { Index first, last; };

// What surrounds a particle: the columns of the grid, which have room for a pack behind their last place.
template <class Space> struct Surroundings {
  static constexpr std::size_t room = 8;
  Space space;
  const Vec3* position;
  const double* reach;

  // Writes the places that are nearer to x than `mine` and their own reach, and tells how many. Writes up to four more numbers.
  template <VectorPath path>
  static std::size_t near(const Surroundings&, const Vec3& x, double mine, const Places* first, const Places* last, Index* out);
};

template <class Space>
using NearLoop = std::size_t (*)(const Surroundings<Space>&, const Vec3& x, double mine, const Places* first, const Places* last, Index* out);
template <class Space> NearLoop<Space> near_loop(VectorPath path) {
  return for_path(path, []<VectorPath p>() -> NearLoop<Space> { return &Surroundings<Space>::template near<p>; });
}

template <class Space> struct Broadphase {
  static constexpr const char* name = "broadphase";

  Space space;
  double cell;              // [m] edge of a cell, at least the largest diameter + twice the largest margin
  NearLoop<Space> loop = near_loop<Space>(VectorPath::scalar);

  void operator()(Parallel parallel, Read<&Search::due> due, Read<&Particles::id> id, Read<&Particles::position> position,
                  Read<&Particles::radius> radius, Read<&Particles::search_margin> margin, Resize<CellGrid> grid,
                  Resize<Neighbours> neighbours, Resize<Neighbourhood> neighbourhood) const;
};

extern template struct Broadphase<OpenSpace>;
extern template struct Broadphase<PeriodicSpace>;

}  // namespace skred
