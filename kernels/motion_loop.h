// kernels/motion_loop.h - are particles where lists know them, and where they can be (kernels/check_motion.h)?
#pragma once
#include "engine/pack.h"
#include "kernels/check_motion.h"

namespace skred {

template <class Space> template <VectorPath path> [[gnu::flatten]]
AllOf MotionWatch<Space>::run(const MotionWatch& w, std::size_t first, std::size_t last) {
  using R = NumberOf<path>;
  auto in_margin = R(0) == R(0), well = in_margin;           // no branch while all is well
  const auto watch = [&](const auto& row) {
    const Vec3T<R> x = load<R>(w.position, row), v = load<R>(w.velocity, row);
    const Vec3T<R> moved = w.space.shortest(x - load<R>(w.listed, row));
    const R margin = load<R>(w.list_margin, row);
    in_margin = in_margin & (dot(moved, moved) <= margin * margin);
    well = well & is_sound_speed(v, load<R>(w.radius, row), w.time_step) & is_inside(w.bounds, x);
  };
  for (; first + lanes<R> <= last; first += lanes<R>) watch(FullRange<R>{first});
  if (first < last) watch(PartOfRange<R>(first, last));
  using stdx::all_of;
  return {all_of(in_margin), all_of(well)};
}

}  // namespace skred
