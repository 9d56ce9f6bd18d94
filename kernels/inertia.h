// kernels/inertia.h - mass and moment of inertia of particles: of each, or worked out once where all are alike.
#pragma once
#include <cstddef>
#include "engine/vec3.h"

namespace skred {

template <bool are_alike> struct Inertia {
  static constexpr bool alike = are_alike;
  double mass = 0, radius = 0;     // [kg], [m] of all; where they differ: of no use

  double mass_of(const auto& masses, std::size_t p) const {
    if constexpr (alike) return mass;
    else return masses[p];
  }
  // 2/5 m R^2 of a solid sphere [kg m^2].
  double moment_of(const auto& masses, const auto& radii, std::size_t p) const {
    if constexpr (alike) return 0.4 * mass * radius * radius;
    else return 0.4 * masses[p] * radii[p] * radii[p];
  }
};

}  // namespace skred
