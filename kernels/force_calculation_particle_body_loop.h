// kernels/force_calculation_particle_body_loop.h - the loop over contacts of particles with bodies: R, and lanes that do not touch,
// as in force_calculation_loop.h.
#pragma once
#include <algorithm>
#include "engine/pack_vectors.h"
#include "kernels/coefficients_of_lanes.h"
#include "kernels/force_calculation_particle_body.h"

namespace skred {

template <class R, class Law, class Lanes> void press_on_wall(const WallForces<Law>& walls, const WallColumns& w, const Lanes& row) {
  using std::sqrt;
  const auto p = rows_named<R>(w.particle, row), g = rows_named<R>(w.geometry, row), b = rows_named<R>(w.body, g);
  const R overlap = load<R>(w.overlap, row);
  const auto touching = overlap > R(0);

  const R radius = load<R>(w.radius, p), arm = radius - R(0.5) * overlap;
  ContactForce<R> f;
  Vec3T<R> spring, rolling;
  ContactMemory memory;
  if (!none_of(touching)) {
    const R mass_eff = by_lane<R>([&](int k) {
      const double m = w.mass[p[k]], of_body = w.body_mass[b[k]];
      return w.motion[b[k]] == Motion::dynamic ? m * of_body / (m + of_body) : m;
    });
    ContactState<R> s;
    s.overlap = overlap;
    s.normal = load<R>(w.normal, row);
    s.radius_eff = radius / (R(1) + radius * load<R>(w.curvature, row));
    s.contact_radius = sqrt(s.radius_eff * s.overlap);
    s.damping_scale = sqrt(s.contact_radius * mass_eff);

    const auto of_pose = [&](double Vec3::* axis) { return by_lane<R>([&](int k) { return w.pose[b[k]].position.*axis; }); };
    const Vec3T<R> origin{of_pose(&Vec3::x), of_pose(&Vec3::y), of_pose(&Vec3::z)}, body_spin = load<R>(w.body_spin, b);
    const Vec3T<R> point = load<R>(w.position, p) - arm * s.normal;
    Vec3T<R> u = load<R>(w.velocity, p) - (load<R>(w.body_velocity, b) + cross(body_spin, point - origin));
    s.normal_velocity = dot(u, s.normal);
    if constexpr (Law::rotates) {
      const Vec3T<R> spin = load<R>(w.spin, p);
      u -= cross(arm * spin, s.normal);
      s.tangential_velocity = u - s.normal_velocity * s.normal;
      s.rolling_velocity = in_tangent_plane(spin - body_spin, s.normal);
    }
    const auto of_pair = [&](int k) -> const auto& { return walls.coefficients[w.material[p[k]] * walls.materials + w.wall_material[g[k]]]; };
    if constexpr (Law::chosen) {
      ChosenContact contact{s, mass_eff, 1.4 * w.mass[p[0]] * radius * radius, {}};
      if constexpr (Law::has_rolling) contact.rolling_slip = radius * s.rolling_velocity;
      if constexpr (Law::remembers) memory = w.memory[row[0]];
      f = evaluate(walls.law, contact, of_pair(0), walls.time_step, memory);
    } else {
      if constexpr (Law::keeps_spring) spring = load<R>(w.spring, row);
      if constexpr (Law::keeps_rolling) rolling = load<R>(w.rolling, row);
      f = evaluate(walls.law, s, coefficients_of<R>(of_pair), R(walls.time_step), spring, rolling);
    }
  }
  const auto put = [&](const Vec3T<R>& v, Vec3* column) { store(select(touching, v, Vec3T<R>{R(0), R(0), R(0)}), column, row); };
  put(f.force, w.force);                                     // not touching: no force, and the contact forgets
  if constexpr (Law::rotates) put(f.rolling - arm * f.couple, w.torque);
  if constexpr (Law::has_rolling) put(f.rolling, w.rolling_torque);
  if constexpr (Law::keeps_spring) put(spring, w.spring);
  if constexpr (Law::keeps_rolling) put(rolling, w.rolling);
  if constexpr (Law::remembers) w.memory[row[0]] = touching ? memory : ContactMemory{};
}

template <class Law> template <VectorPath path> [[gnu::flatten]]
void WallForces<Law>::run(const WallForces& walls, const WallColumns& w, std::size_t first, std::size_t last) {
  using R = NumberOf<path>;
  for (; first < last; first += lanes<R>) {
    for (std::size_t k = first + 8; k < std::min(first + 8 + lanes<R>, last); ++k) {   // which particles touch walls, no processor guesses
      const Index later = w.particle[k];
      __builtin_prefetch(&w.position[later]), __builtin_prefetch(&w.velocity[later]);
      if constexpr (Law::rotates) __builtin_prefetch(&w.spin[later]);
      __builtin_prefetch(&w.radius[later]), __builtin_prefetch(&w.mass[later]), __builtin_prefetch(&w.material[later]);
    }
    if (first + lanes<R> <= last) press_on_wall<R>(walls, w, FullRange<R>{first});
    else press_on_wall<R>(walls, w, PartOfRange<R>(first, last));
  }
}

}  // namespace skred
