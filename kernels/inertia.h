// kernels/inertia.h - mass and moment of inertia of particles: of each, or worked out once where all are alike.
#pragma once
#include <cstddef>
#include "engine/vec3.h"

namespace skred {

// 2/5 m R^2 of a solid sphere [kg m^2].
template <class R> constexpr R moment_of_sphere(R mass, R radius) { return R(0.4) * mass * radius * radius; }

template <bool are_alike> struct Inertia {
  static constexpr bool alike = are_alike;
  double mass = 0, radius = 0;     // [kg], [m] of all; where they differ: of no use

  double mass_of(const auto& masses, std::size_t p) const {
    if constexpr (alike) return mass;
    else return masses[p];
  }
  double moment_of(const auto& masses, const auto& radii, std::size_t p) const {
    if constexpr (alike) return moment_of_sphere(mass, radius);
    else return moment_of_sphere(masses[p], radii[p]);
  }
};

}  // namespace skred
