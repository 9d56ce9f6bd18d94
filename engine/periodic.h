// engine/periodic.h - the shortest way between two points, with and without periodic directions.
#pragma once
#include "engine/vec3.h"

namespace skred {

// Free space.
struct OpenSpace {
  template <class R> Vec3T<R> shortest(const Vec3T<R>& d) const { return d; }
  template <class R> Vec3T<R> wrap(const Vec3T<R>& x) const { return x; }
};

// A box with one or more periodic directions. Positions lie in [min, min + length) along them; a direction that is not
// periodic has an infinite length.
struct PeriodicSpace {
  Vec3 min, length;            // [m]

  template <class R> Vec3T<R> shortest(const Vec3T<R>& d) const {
    return {shortest(d.x, R(length.x)), shortest(d.y, R(length.y)), shortest(d.z, R(length.z))};
  }
  template <class R> Vec3T<R> wrap(const Vec3T<R>& x) const {
    return {wrap(x.x, R(min.x), R(length.x)), wrap(x.y, R(min.y), R(length.y)), wrap(x.z, R(min.z), R(length.z))};
  }

  template <class R> static R wrap(R x, R lo, R box) {
    x = select(x < lo, x + box, x);
    x = select(x >= lo + box, x - box, x);
    return select(x < lo, lo, x);                          // rounding may leave x a hair below
  }

 private:
  template <class R> static R shortest(R d, R box) {       // |d| < box, so one shift is enough
    const R half = 0.5 * box;
    return select(d > half, d - box, select(d < -half, d + box, d));
  }
};

}  // namespace skred
