// kernels/integrate.h - positions of the next time, and a prediction of the velocities there.
//
// Velocity Verlet with predicted velocities, second order in the step:
//   x(n+1) = x(n) + h v(n) + h^2/2 a(n)                     here
//   v*     = v(n) + h/2 a(n) + h/2 a~,  a~ = (a(n) + a(n-1)) / 2     here: the velocity that the dashpots at n+1 see
//   a(n+1) = a(x(n+1), v*)                                  the force kernels
//   v(n+1) = v(n) + h/2 (a(n) + a(n+1)) = v* + h/2 (a(n+1) - a~)     kernels/force_application.h
// Positions, velocities and forces then belong to the same time, and a step starts from (x, v, a, a(n-1), history) alone: the
// state that a restart needs. Half-step velocities in the dashpots, as in LAMMPS and LIGGGHTS, bias e = 0.18 to 0.177 at 40
// steps per contact, and a restart from full-step velocities would not be exact [Vyas et al. 2024, arXiv 2410.14798].
// The mean a~ and not a(n): with a(n) dashpots of rate lambda (largest eigenvalue of M^-1 C) make forces flip sign every step
// from h lambda = 1 on, which a dense bed of pellets reaches at 40 us; with the mean the bound is h lambda < 2
// (characteristic equation 4 l^3 - 4 l^2 + h lambda (5 l^2 - 1) = 0, |l| < 1).
//
// Nonsmooth DEM has solved for v(n+1) when it gets here: x(n+1) = x(n) + h v(n+1), symplectic Euler.
#pragma once
#include "engine/access.h"
#include "kernels/inertia.h"

namespace skred {

enum class Scheme { velocity_verlet, symplectic_euler };

template <class R> constexpr Vec3T<R> mean(const Vec3T<R>& a, const Vec3T<R>& b) { return R(0.5) * (a + b); }

template <Scheme scheme, bool rotates, bool oriented, class Space, class Inertia> struct Integrate {
  static constexpr const char* name = "integrate";
  static constexpr std::size_t grain = 1024;

  Space space;
  double time_step;   // h [s]
  Inertia inertia;

  static constexpr bool by_force = scheme == Scheme::velocity_verlet;

  void operator()(Rows<Particles> rows, If<by_force && !Inertia::alike, Read<&Particles::mass>> mass,
                  If<by_force, Read<&Particles::force>> force, If<by_force, Read<&Particles::previous_force>> previous_force,
                  If<by_force && rotates && !Inertia::alike, Read<&Particles::radius>> radius,
                  If<by_force && rotates, Read<&Particles::torque>> torque,
                  If<by_force && rotates, Read<&Particles::previous_torque>> previous_torque, Update<&Particles::position> position,
                  Update<&Particles::velocity> velocity, If<rotates, Update<&Particles::angular_velocity>> spin,
                  If<oriented, Update<&Particles::orientation>> orientation) const {
    const double h = time_step;
    const Inertia of = inertia;                              // a copy, which no column can lie on: quotients are taken once
    for (std::size_t p = rows.first; p < rows.last; ++p) {
      if constexpr (by_force) {
        const double m = of.mass_of(mass, p);
        const Vec3 a = (1 / m) * force[p];
        position[p] = space.wrap(position[p] + h * velocity[p] + (0.5 * h * h) * a);
        velocity[p] += (0.5 * h / m) * (force[p] + mean(force[p], previous_force[p]));
        if constexpr (rotates) {
          const double moment = of.moment_of(mass, radius, p);
          const Vec3 alpha = (1 / moment) * torque[p];
          if constexpr (oriented)
            orientation[p] = normalized(rotation_by(h * spin[p] + (0.5 * h * h) * alpha) * orientation[p]);
          spin[p] += (0.5 * h / moment) * (torque[p] + mean(torque[p], previous_torque[p]));
        }
      } else {
        position[p] = space.wrap(position[p] + h * velocity[p]);
        if constexpr (oriented) orientation[p] = normalized(rotation_by(h * spin[p]) * orientation[p]);
      }
    }
  }
};

}  // namespace skred
