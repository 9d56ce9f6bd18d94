// kernels/integrate_loop.h - positions of the next time, and velocities predicted there (kernels/integrate.h).
#pragma once
#include "engine/pack_flat.h"
#include "kernels/force_application_loop.h"
#include "kernels/integrate.h"

namespace skred {

// The walls of a space, and of the region where particles may be, for vectors in the order of memory.
template <class R, class Space> struct FlatSpace {
  explicit FlatSpace(const Space&) {}
  Flat<R> wrap(const Flat<R>& x) const { return x; }
};
template <class R> struct FlatSpace<R, PeriodicSpace> {
  Flat<R> min, length;
  explicit FlatSpace(const PeriodicSpace& s) : min(repeated<R>(s.min)), length(repeated<R>(s.length)) {}
  Flat<R> wrap(const Flat<R>& x) const {
    const auto part = [&](int k) { return PeriodicSpace::wrap(x.part[k], min.part[k], length.part[k]); };
    return {part(0), part(1), part(2)};
  }
};
template <class R> struct FlatBounds {
  Flat<R> min, max;
  explicit FlatBounds(const Bounds& b) : min(repeated<R>(b.min)), max(repeated<R>(b.max)) {}
  auto hold(const Flat<R>& x) const {
    const auto part = [&](int k) { return (x.part[k] >= min.part[k]) & (x.part[k] <= max.part[k]); };
    return part(0) & part(1) & part(2);
  }
};

// As many whole turns as there are; returns where it ended.
template <class R, class Step> std::size_t integrate_rows(const Step& s, std::size_t first, std::size_t last, AllOf& all) {
  const double h = s.time_step;
  const FlatSpace<R, decltype(s.space)> space(s.space);
  const FlatBounds<R> bounds(s.bounds);
  auto in_margin = R(0) == R(0), well = in_margin;           // no branch while all is well
  for (; first + lanes<R> <= last; first += lanes<R>) {
    const FullRange<R> row{first};
    const R m = mass_of<R>(s, row);

    const Flat<R> f = load_flat<R>(s.force, first), v = load_flat<R>(s.velocity, first);
    const Flat<R> x = space.wrap(load_flat<R>(s.position, first) + h * v + (0.5 * h * h) * (spread(R(1) / m) * f));
    store_flat(x, s.position, first);
    const Flat<R> predicted = v + spread(R(0.5 * h) / m) * (f + mean(f, load_flat<R>(s.previous_force, first)));
    store_flat(predicted, s.velocity, first);
    if constexpr (Step::rotates) {
      const Flat<R> t = load_flat<R>(s.torque, first);
      store_flat(load_flat<R>(s.spin, first) + spread(R(0.5 * h) / moment_of<R>(s, row)) * (t + mean(t, load_flat<R>(s.previous_torque, first))),
                 s.spin, first);
    }

    const Vec3T<R> moved = s.space.shortest(by_component(x - load_flat<R>(s.listed, first)));
    const R margin = load<R>(s.list_margin, row);
    in_margin = in_margin & (dot(moved, moved) <= margin * margin);
    well = well & is_sound_speed(by_component(predicted), radius_of<R>(s, row), h) & bounds.hold(x);
  }
  using stdx::all_of;
  all.in_margin &= all_of(in_margin), all.well &= all_of(well);
  return first;
}

template <bool rotates, class Space, class Inertia> template <VectorPath path> [[gnu::flatten]]
AllOf VerletStep<rotates, Space, Inertia>::run(const VerletStep& step, std::size_t first, std::size_t last) {
  const VerletStep s = step;                                 // a copy, which no column can lie on: quotients are taken once
  AllOf all{true, true};
  first = integrate_rows<NumberOf<path>>(s, first, last, all);
  integrate_rows<double>(s, first, last, all);
  return all;
}

}  // namespace skred
