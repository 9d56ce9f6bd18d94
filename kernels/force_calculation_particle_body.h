// kernels/force_calculation_particle_body.h - force and torque of every contact of a particle with a rigid body (smooth DEM).
//
// The body is a partner of infinite mass unless it is dynamic; the curvature of its surface enters R_eff.
#pragma once
#include <algorithm>
#include <vector>
#include "engine/access.h"
#include "kernels/chosen_law.h"
#include "kernels/contact_history.h"
#include "kernels/contact_law.h"

namespace skred {

template <class Law> struct ForceCalculationParticleBody {
  static constexpr const char* name = "force_calculation_particle_body";
  static constexpr std::size_t grain = 512;

  Law law;
  std::size_t materials;
  std::vector<typename Law::Coefficients> coefficients;   // row-major table of pairs of materials
  double time_step;                            // h [s]; 0 leaves the history as it is

  void operator()(Rows<BodyContacts> rows, Read<&BodyContacts::particle> particle, Read<&BodyContacts::geometry> geometry,
                  Read<&BodyContacts::overlap> overlap, Read<&BodyContacts::normal> normal,
                  Read<&BodyContacts::curvature> curvature, Read<&Particles::position> position,
                  Read<&Particles::velocity> velocity, If<Law::rotates, Read<&Particles::angular_velocity>> spin,
                  Read<&Particles::radius> radius, Read<&Particles::mass> mass, Read<&Particles::material> material,
                  Read<&Geometries::body> body, Read<&Geometries::material> wall_material, Read<&Bodies::motion> motion,
                  Read<&Bodies::pose> pose, Read<&Bodies::velocity> body_velocity,
                  Read<&Bodies::angular_velocity> body_spin, Read<&Bodies::mass> body_mass, Write<&BodyContacts::force> force,
                  If<Law::rotates, Write<&BodyContacts::torque>> torque,
                  If<Law::has_rolling, Write<&BodyContacts::rolling_torque>> rolling_torque,
                  If<Law::keeps_spring, Update<&BodyContacts::spring>> spring,
                  If<Law::keeps_rolling, Update<&BodyContacts::rolling>> rolling,
                  If<Law::remembers, Update<&BodyContacts::memory>> memory) const {
    for (std::size_t c = rows.first; c < rows.last; ++c) {
      const Index later = particle[std::min(c + 8, rows.last - 1)];   // asked for early: which particles touch walls, no processor guesses
      __builtin_prefetch(&position[later]), __builtin_prefetch(&velocity[later]);
      if constexpr (Law::rotates) __builtin_prefetch(&spin[later]);
      __builtin_prefetch(&radius[later]), __builtin_prefetch(&mass[later]), __builtin_prefetch(&material[later]);
      if (!(overlap[c] > 0)) {
        clear_all(c, force, torque, rolling_torque, spring, rolling, memory);
        continue;
      }
      const Index p = particle[c], g = geometry[c], w = body[g];
      const auto& k = coefficients[material[p] * materials + wall_material[g]];
      ContactState<double> s;
      s.overlap = overlap[c];
      s.normal = normal[c];
      s.radius_eff = radius[p] / (1 + radius[p] * curvature[c]);
      const double mass_eff = motion[w] == Motion::dynamic ? mass[p] * body_mass[w] / (mass[p] + body_mass[w]) : mass[p];
      s.contact_radius = std::sqrt(s.radius_eff * s.overlap);
      s.damping_scale = std::sqrt(s.contact_radius * mass_eff);

      const double arm = radius[p] - 0.5 * s.overlap;
      const Vec3 point = position[p] - arm * s.normal;
      Vec3 u = velocity[p] - (body_velocity[w] + cross(body_spin[w], point - pose[w].position));
      s.normal_velocity = dot(u, s.normal);
      if constexpr (Law::rotates) {
        u -= cross(arm * spin[p], s.normal);
        s.tangential_velocity = u - s.normal_velocity * s.normal;
        s.rolling_velocity = in_tangent_plane(spin[p] - body_spin[w], s.normal);
      }
      ContactForce<double> f;
      if constexpr (Law::chosen) {
        ChosenContact contact{s, mass_eff, 1.4 * mass[p] * radius[p] * radius[p], {}};
        if constexpr (Law::has_rolling) contact.rolling_slip = radius[p] * s.rolling_velocity;
        ContactMemory none;
        f = evaluate(law, contact, k, time_step, entry(memory, c, none));
      } else {
        Vec3 none;
        f = evaluate(law, s, k, time_step, entry(spring, c, none), entry(rolling, c, none));
      }
      force[c] = f.force;
      if constexpr (Law::rotates) torque[c] = f.rolling - arm * f.couple;
      if constexpr (Law::has_rolling) rolling_torque[c] = f.rolling;
    }
  }
};

}  // namespace skred
