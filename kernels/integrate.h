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
// While a particle is at hand, smooth DEM also watches its motion for check_motion.
//
// Nonsmooth DEM has solved for v(n+1) when it gets here: x(n+1) = x(n) + h v(n+1), symplectic Euler.
#pragma once
#include "engine/access.h"
#include "engine/vector_path.h"
#include "kernels/inertia.h"
#include "kernels/motion_watch.h"

namespace skred {

template <class R> constexpr Vec3T<R> mean(const Vec3T<R>& a, const Vec3T<R>& b) { return R(0.5) * (a + b); }

// What the watch found of all particles of a range.
struct AllOf { bool in_margin, well; };

// The first two lines above, and the watch: one loop, compiled once per set of vector instructions (kernels/integrate_loop.h).
template <bool rotates_, class Space, class Inertia> struct VerletStep {
  static constexpr bool rotates = rotates_, alike = Inertia::alike;
  Space space;
  double time_step;              // h [s]
  Inertia inertia;
  Bounds bounds;                 // [m] where particles may be
  const double *mass = nullptr, *radius = nullptr;           // of each, unless all are alike
  const double* list_margin = nullptr;
  const Vec3 *force = nullptr, *previous_force = nullptr, *torque = nullptr, *previous_torque = nullptr, *listed = nullptr;
  Vec3 *position = nullptr, *velocity = nullptr, *spin = nullptr;

  // Of particles [first, last).
  template <VectorPath path> static AllOf run(const VerletStep&, std::size_t first, std::size_t last);
};
template <class V> using VerletLoop = AllOf (*)(const V&, std::size_t first, std::size_t last);
template <class V> VerletLoop<V> verlet_loop(VectorPath path) {
  return for_path(path, []<VectorPath p>() -> VerletLoop<V> { return &V::template run<p>; });
}

// `ahead`: for the next step, at the end of one that nobody looks at. Not if that is in trouble: then somebody will.
template <bool rotates, bool oriented, class Space, class Inertia, bool ahead = false> struct Integrate {
  static constexpr const char* name = "integrate";
  static constexpr std::size_t grain = 1024;
  using Step = VerletStep<rotates, Space, Inertia>;

  Step step;
  VerletLoop<Step> loop;

  void operator()(Rows<Particles> rows, If<!Inertia::alike, Read<&Particles::mass>> mass, If<!Inertia::alike, Read<&Particles::radius>> radius,
                  Read<&Particles::force> force, Read<&Particles::previous_force> previous_force,
                  If<rotates, Read<&Particles::torque>> torque, If<rotates, Read<&Particles::previous_torque>> previous_torque,
                  Update<&Particles::position> position, Update<&Particles::velocity> velocity,
                  If<rotates, Update<&Particles::angular_velocity>> spin, If<oriented, Update<&Particles::orientation>> orientation,
                  Read<&Particles::listed> listed, Read<&Particles::list_margin> list_margin, Raise<&Search::left_margin> left_margin,
                  Raise<&Search::unwell> unwell, If<ahead, Read<&Search::trouble>> trouble) const {
    if constexpr (ahead)
      if (trouble[0] != Trouble::none) return;
    if constexpr (oriented)
      for (std::size_t p = rows.first; p < rows.last; ++p) {
        const double h = step.time_step;
        const Vec3 alpha = (1 / step.inertia.moment_of(mass, radius, p)) * torque[p];
        orientation[p] = normalized(rotation_by(h * spin[p] + (0.5 * h * h) * alpha) * orientation[p]);
      }
    Step s = step;
    s.mass = pointer(mass), s.radius = pointer(radius), s.listed = listed.data(), s.list_margin = list_margin.data();
    s.force = force.data(), s.previous_force = previous_force.data();
    s.torque = pointer(torque), s.previous_torque = pointer(previous_torque);
    s.position = position.data(), s.velocity = velocity.data(), s.spin = pointer(spin);
    const AllOf all = loop(s, rows.first, rows.last);
    left_margin(!all.in_margin);
    unwell(!all.well);
  }
};

// Of nonsmooth DEM.
template <bool oriented, class Space> struct IntegrateSymplectic {
  static constexpr const char* name = "integrate";
  static constexpr std::size_t grain = 1024;

  Space space;
  double time_step;              // h [s]

  void operator()(Rows<Particles> rows, Read<&Particles::velocity> velocity, Update<&Particles::position> position,
                  If<oriented, Read<&Particles::angular_velocity>> spin, If<oriented, Update<&Particles::orientation>> orientation) const {
    const double h = time_step;
    for (std::size_t p = rows.first; p < rows.last; ++p) {
      position[p] = space.wrap(position[p] + h * velocity[p]);
      if constexpr (oriented) orientation[p] = normalized(rotation_by(h * spin[p]) * orientation[p]);
    }
  }
};

}  // namespace skred
