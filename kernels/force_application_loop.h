// kernels/force_application_loop.h - from the sum of forces on a particle to its velocity (kernels/force_application.h).
#pragma once
#include "engine/pack_flat.h"
#include "kernels/force_application.h"
#include "kernels/integrate.h"

namespace skred {

template <class R> Flat<R> mean(const Flat<R>& a, const Flat<R>& b) { return 0.5 * (a + b); }

// Of the particles of these rows.
template <class R, class Update> R mass_of(const Update& u, const auto& row) {
  if constexpr (Update::alike) return R(u.inertia.mass);
  else return load<R>(u.mass, row);
}
template <class R, class Update> R radius_of(const Update& u, const auto& row) {
  if constexpr (Update::alike) return R(u.inertia.radius);
  else return load<R>(u.radius, row);
}
template <class R, class Update> R moment_of(const Update& u, const auto& row) { return moment_of_sphere(mass_of<R>(u, row), radius_of<R>(u, row)); }

// As many whole turns as there are; returns where it ended. The sums begin with that of particle `begin`.
template <class R, class Update>
std::size_t update_rows(const Update& u, std::size_t begin, std::size_t first, std::size_t last, const Vec3* force_sum, const Vec3* torque_sum) {
  const Flat<R> g = repeated<R>(u.gravity);
  // a of the new force, a~ of the last two; velocity, or spin by the torque.
  const auto advance = [&](Vec3* velocity, Vec3* force, Vec3* previous_force, const Flat<R>& f, const R& inertia, std::size_t row) {
    const Flat<R> now = load_flat<R>(force, row), before = load_flat<R>(previous_force, row);
    store_flat(load_flat<R>(velocity, row) + spread(R(0.5 * u.time_step) / inertia) * (f - mean(now, before)), velocity, row);
    store_flat(u.time_step > 0 ? now : f, previous_force, row);
    store_flat(f, force, row);
  };
  for (; first + lanes<R> <= last; first += lanes<R>) {
    const FullRange<R> row{first};
    const R m = mass_of<R>(u, row);
    advance(u.velocity, u.force, u.previous_force, load_flat<R>(force_sum, first - begin) + spread(m) * g, m, first);
    if constexpr (Update::rotates)
      advance(u.spin, u.torque, u.previous_torque, load_flat<R>(torque_sum, first - begin), moment_of<R>(u, row), first);
  }
  return first;
}

template <bool rotates, class Inertia> template <VectorPath path> [[gnu::flatten]]
void VelocityUpdate<rotates, Inertia>::run(const VelocityUpdate& update, std::size_t first, std::size_t last, const Vec3* force_sum, const Vec3* torque_sum) {
  const VelocityUpdate u = update;                           // a copy, which no column can lie on: quotients are taken once
  const std::size_t begin = first;
  first = update_rows<NumberOf<path>>(u, begin, first, last, force_sum, torque_sum);
  update_rows<double>(u, begin, first, last, force_sum, torque_sum);
}

}  // namespace skred
