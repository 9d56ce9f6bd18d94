// kernels/force_application_loop.h - from the sum of forces on a particle to its velocity (kernels/force_application.h).
#pragma once
#include "engine/pack.h"
#include "kernels/force_application.h"
#include "kernels/integrate.h"

namespace skred {

template <bool rotates, class Inertia> template <VectorPath path> [[gnu::flatten]]
void VelocityUpdate<rotates, Inertia>::run(const VelocityUpdate& update, std::size_t first, std::size_t last, const Vec3* force_sum, const Vec3* torque_sum) {
  using R = NumberOf<path>;
  const VelocityUpdate u = update;                           // a copy, which no column can lie on: quotients are taken once
  const std::size_t begin = first;
  const Vec3T<R> g{R(u.gravity.x), R(u.gravity.y), R(u.gravity.z)};

  // a of the new force, a~ of the last two; velocity, or spin by the torque.
  const auto advance = [&](Vec3* velocity, Vec3* force, Vec3* previous_force, const Vec3T<R>& f, const R& inertia, const auto& row) {
    const Vec3T<R> now = load<R>(force, row), before = load<R>(previous_force, row);
    store(load<R>(velocity, row) + (R(0.5 * u.time_step) / inertia) * (f - mean(now, before)), velocity, row);
    store(u.time_step > 0 ? now : f, previous_force, row);
    store(f, force, row);
  };
  const auto each = [&](const auto& row, const auto& in_block) {
    R m = u.inertia.mass, radius = u.inertia.radius;
    if constexpr (!Inertia::alike) m = load<R>(u.mass, row);
    if constexpr (!Inertia::alike && rotates) radius = load<R>(u.radius, row);
    advance(u.velocity, u.force, u.previous_force, load<R>(force_sum, in_block) + m * g, m, row);
    if constexpr (rotates) advance(u.spin, u.torque, u.previous_torque, load<R>(torque_sum, in_block), moment_of_sphere(m, radius), row);
  };
  for (; first + lanes<R> <= last; first += lanes<R>) each(FullRange<R>{first}, FullRange<R>{first - begin});
  if (first < last) each(PartOfRange<R>(first, last), PartOfRange<R>(first - begin, last - begin));
}

}  // namespace skred
