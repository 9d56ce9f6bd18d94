// kernels/motion_watch.h - is a particle where the lists know it, and where it can be?
//
// Of one particle, or of as many as the number type R is wide. NaN fails every comparison.
#pragma once
#include <limits>
#include "engine/geometry/shape.h"

namespace skred {

inline constexpr double no_end = std::numeric_limits<double>::infinity();
inline constexpr Bounds no_bounds{{-no_end, -no_end, -no_end}, {no_end, no_end, no_end}};

template <class R> auto is_inside(const Bounds& b, const Vec3T<R>& x) {
  return (x.x >= R(b.min.x)) & (x.x <= R(b.max.x)) & (x.y >= R(b.min.y)) & (x.y <= R(b.max.y)) & (x.z >= R(b.min.z)) & (x.z <= R(b.max.z));
}

// A contact lasts tens of steps: half a radius in one step is far beyond any sound motion.
template <class R> auto is_sound_speed(const Vec3T<R>& velocity, const R& radius, double time_step) {
  const R reach_of_step = R(0.5) * radius;
  return dot(velocity, velocity) * R(time_step) * R(time_step) <= reach_of_step * reach_of_step;
}

// Within `margin` [m] of the place where its contacts were listed.
template <class R, class Space> auto is_in_margin(const Space& space, const Vec3T<R>& x, const Vec3T<R>& listed, const R& margin) {
  const Vec3T<R> moved = space.shortest(x - listed);
  return dot(moved, moved) <= margin * margin;
}

}  // namespace skred
