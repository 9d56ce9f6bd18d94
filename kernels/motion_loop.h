// kernels/motion_loop.h - are particles where lists know them, and where they can be (kernels/check_motion.h)?
#pragma once
#include "engine/pack.h"
#include "kernels/check_motion.h"

namespace skred {

template <class Space> template <VectorPath path> [[gnu::flatten]]
AllOf MotionWatch<Space>::run(const MotionWatch& w, std::size_t first, std::size_t last) {
  using R = NumberOf<path>;
  auto in_margin = R(0) == R(0), well = in_margin;           // no branch while all is well; NaN fails every comparison
  const auto watch = [&](const auto& row) {
    const Vec3T<R> x = load<R>(w.position, row), v = load<R>(w.velocity, row);
    const Vec3T<R> moved = w.space.shortest(x - load<R>(w.listed, row));
    const R margin = load<R>(w.list_margin, row), reach_of_step = R(0.5) * load<R>(w.radius, row);
    in_margin = in_margin & (dot(moved, moved) <= margin * margin);
    well = well & (dot(v, v) * R(w.time_step) * R(w.time_step) <= reach_of_step * reach_of_step);
    well = well & (x.x >= R(w.bounds.min.x)) & (x.x <= R(w.bounds.max.x)) & (x.y >= R(w.bounds.min.y)) & (x.y <= R(w.bounds.max.y)) &
           (x.z >= R(w.bounds.min.z)) & (x.z <= R(w.bounds.max.z));
  };
  for (; first + lanes<R> <= last; first += lanes<R>) watch(FullRange<R>{first});
  if (first < last) watch(PartOfRange<R>(first, last));
  using stdx::all_of;
  return {all_of(in_margin), all_of(well)};
}

}  // namespace skred
