// tests/physics/nonsmooth_lab.h - small experiments with nonsmooth DEM, solved as exactly as may be.
#pragma once
#include <gtest/gtest.h>
#include "tests/physics/lab.h"

namespace skred::lab {

inline constexpr double R = pellet_radius, g = 9.81;
inline const double m = sphere_mass(R);

struct NonsmoothLab : Lab {
  NonsmoothLab(double restitution, double friction, double rolling_friction, double step = 1e-3) : Lab(restitution, friction, rolling_friction) {
    model.method = Method::ndem;
    model.time_step = step;
    model.solver.tolerance = 1e-12;
    model.solver.iterations = 20000;
  }
  void under_gravity(Vec3 direction = {0, 0, -1}) { model.gravity = g * direction; }
  void floor() { body(PlaneShape{}); }
};

inline void run(Simulation& s, double time) {
  s.start();
  while (s.time() < time - 1e-9) s.step(Execution::list);
}

// k of the Hertz force k overlap^(3/2) [N/m^1.5]; R_eff is R against a wall and R/2 of two equal spheres.
inline double hertz(const Lab& lab, double radius_eff) { return 4.0 / 3.0 * lab.model.pairs.values[0].young_eff * std::sqrt(radius_eff); }

inline std::vector<double> pair_forces(const Simulation& s) {  // by id of the lower particle: a column
  std::vector<double> out;
  const Contacts& c = std::get<Contacts>(s.world());
  const auto& first = std::get<Incidence>(s.world()).first.data;
  for (const Index r : rows_by_id(std::get<Particles>(s.world())))
    for (Index k = first[r]; k < first[r + 1]; ++k) out.push_back(norm(c.force.data[k]));
  return out;
}

// How far the floor's force on spheres of a given weight [N] is off after so many sweeps of one step, relative to it.
inline double floor_error(NonsmoothLab& lab, int sweeps, double weight) {
  lab.model.solver.iterations = sweeps;
  auto s = lab.build();
  s->start();
  s->step();
  return std::abs(measure(*s).body_normal_force / weight - 1);
}

// The least number of sweeps, up to `most`, that brings it down to 1e-3.
inline int sweeps_needed(NonsmoothLab& lab, int most, double weight) {
  int low = 1, high = most;
  while (high - low > 1) (floor_error(lab, (low + high) / 2, weight) > 1e-3 ? low : high) = (low + high) / 2;
  return high;
}

// Heights at which a column of n equal spheres on a floor is at rest.
inline std::vector<double> column_at_rest(const Lab& lab, int n) {
  std::vector<double> z;
  double top = 0;
  for (int k = 0; k < n; ++k) {
    const double overlap = std::pow((n - k) * m * g / hertz(lab, k == 0 ? R : R / 2), 2.0 / 3.0);
    z.push_back(top + (k == 0 ? R : 2 * R) - overlap);
    top = z.back();
  }
  return z;
}

}  // namespace skred::lab
