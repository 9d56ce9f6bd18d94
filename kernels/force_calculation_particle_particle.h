// kernels/force_calculation_particle_particle.h - force and torque of every pair of particles (smooth DEM).
//
// One fused kernel for the normal, tangential and rolling parts: they share their loads [Pettersson 2015, sec. 3.3]. Force and
// velocities belong to the same time: velocities are the integrator's prediction (kernels/integrate.h).
#pragma once
#include <vector>
#include "engine/access.h"
#include "kernels/contact_history.h"
#include "kernels/contact_law.h"

namespace skred {

// Where every particle is alike, what the pair needs is worked out once ...
struct AlikeParticles {
  static constexpr bool alike = true;
  double radius, mass;
  LawCoefficients coefficients;
};
// ... else it is looked up per contact: row-major table of pairs of materials.
struct VariousParticles {
  static constexpr bool alike = false;
  std::size_t materials;
  std::vector<LawCoefficients> coefficients;
};

template <class Law, class Kinds, class Space> struct ForceCalculationParticleParticle {
  static constexpr const char* name = "force_calculation_particle_particle";
  static constexpr std::size_t grain = 512;
  static constexpr bool various = !Kinds::alike;

  Law law;
  Kinds kinds;
  Space space;
  double time_step;            // h [s]; 0 leaves the history as it is

  void operator()(Rows<Contacts> rows, Read<&Contacts::i> i, Read<&Contacts::j> j, Read<&Particles::position> position,
                  Read<&Particles::velocity> velocity, If<Law::rotates, Read<&Particles::angular_velocity>> spin,
                  If<various, Read<&Particles::radius>> radius, If<various, Read<&Particles::mass>> mass,
                  If<various, Read<&Particles::material>> material, Write<&Contacts::force> force,
                  If<Law::rotates, Write<&Contacts::torque_i>> torque_i, If<Law::rotates, Write<&Contacts::torque_j>> torque_j,
                  If<Law::has_tangential, Update<&Contacts::spring>> spring,
                  If<Law::has_rolling, Update<&Contacts::rolling>> rolling) const {
    for (std::size_t c = rows.first; c < rows.last; ++c) {
      const Index a = i[c], b = j[c];
      double radius_a, radius_b, mass_a, mass_b;
      const LawCoefficients* k;
      if constexpr (Kinds::alike) {
        radius_a = radius_b = kinds.radius;
        mass_a = mass_b = kinds.mass;
        k = &kinds.coefficients;
      } else {
        radius_a = radius[a], radius_b = radius[b];
        mass_a = mass[a], mass_b = mass[b];
        k = &kinds.coefficients[material[a] * kinds.materials + material[b]];
      }
      const Vec3 branch = space.shortest(position[a] - position[b]);
      const double distance2 = dot(branch, branch), touch = radius_a + radius_b;
      if (!(distance2 < touch * touch)) {                    // not touching: the contact forgets
        clear_all(c, force, torque_i, torque_j, spring, rolling);
        continue;
      }
      const double distance = std::sqrt(distance2);
      ContactState<double> s;
      s.overlap = touch - distance;                          // g = R_i + R_j - |x_i - x_j|   eq (2.8)
      s.normal = distance > 0 ? (1 / distance) * branch : Vec3{0, 0, 1};
      s.radius_eff = radius_a * radius_b / touch;
      s.mass_eff = mass_a * mass_b / (mass_a + mass_b);
      s.contact_radius = std::sqrt(s.radius_eff * s.overlap);
      s.young_eff = k->young_eff, s.shear_eff = k->shear_eff, s.damping = k->damping;
      s.friction = k->friction, s.rolling_friction = k->rolling_friction;

      Vec3 u = velocity[a] - velocity[b];
      const double arm_a = radius_a - 0.5 * s.overlap, arm_b = radius_b - 0.5 * s.overlap;
      s.normal_velocity = dot(u, s.normal);                  // spin adds nothing along n
      if constexpr (Law::rotates) {
        u -= cross(arm_a * spin[a] + arm_b * spin[b], s.normal);
        s.tangential_velocity = u - s.normal_velocity * s.normal;
        s.rolling_velocity = in_tangent_plane(spin[a] - spin[b], s.normal);
      }
      Vec3 none;
      const ContactForce<double> f = evaluate(law, s, time_step, entry(spring, c, none), entry(rolling, c, none));
      force[c] = f.force;
      if constexpr (Law::rotates) {
        torque_i[c] = f.rolling - arm_a * f.couple;
        torque_j[c] = -f.rolling - arm_b * f.couple;
      }
    }
  }
};

}  // namespace skred
