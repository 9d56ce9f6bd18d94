// kernels/broadphase_loop.h - which places of the grid are near a particle (kernels/broadphase.h).
#pragma once
#include "engine/pack.h"
#include "kernels/broadphase.h"

namespace skred {

template <class Space> template <VectorPath path> [[gnu::flatten]]
std::size_t Surroundings<Space>::near(const Surroundings& s, const Vec3& at, double mine, const Places* first, const Places* last, Index* out) {
  using R = NumberOf<path>;
  const Vec3T<R> x{R(at.x), R(at.y), R(at.z)};
  std::size_t count = 0;
  for (const Places* places = first; places < last; ++places)
    for (Index k = places->first; k < places->last; k += lanes<R>) {
      const FullRange<R> row{k};
      const Vec3T<R> d = s.space.shortest(load<R>(s.position, row) - x);
      const R touch = R(mine) + load<R>(s.reach, row);
      const auto near = dot(d, d) < touch * touch;
      for (Index lane = 0; lane < Index(lanes<R>); ++lane) { // no branch on nearness: which of them are near is a matter of chance
        out[count] = k + lane;
        count += (k + lane < places->last) & is_set(near, int(lane));
      }
    }
  return count;
}

}  // namespace skred
