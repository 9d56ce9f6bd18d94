// kernels/force_calculation_particle_body.h - force and torque of every contact of a particle with a rigid body (smooth DEM).
//
// The body is a partner of infinite mass unless it is dynamic; the curvature of its surface enters R_eff. The loop itself is in
// force_calculation_particle_body_loop.h, compiled once per set of vector instructions.
#pragma once
#include <vector>
#include "engine/access.h"
#include "engine/vector_path.h"
#include "kernels/chosen_law.h"
#include "kernels/contact_law.h"

namespace skred {

// The columns that the loop works on; null where the law does not need them.
struct WallColumns {
  const Index *particle, *geometry;
  const double* overlap;
  const Vec3* normal;
  const double* curvature;

  const Vec3 *position, *velocity, *spin;                    // of particles
  const double *radius, *mass;
  const Index* material;

  const Index *body, *wall_material;                         // of geometries
  const Motion* motion;                                      // of bodies
  const Pose* pose;
  const Vec3 *body_velocity, *body_spin;
  const double* body_mass;

  Vec3 *force, *torque, *rolling_torque, *spring, *rolling;
  ContactMemory* memory;
};

// What the loop knows beside its columns.
template <class LawT> struct WallForces {
  using Law = LawT;
  Law law;
  std::size_t materials;
  std::vector<typename Law::Coefficients> coefficients;      // row-major table of pairs of materials
  double time_step;                                          // h [s]; 0 leaves the history as it is

  // Computes the contacts [first, last).
  template <VectorPath path> static void run(const WallForces&, const WallColumns&, std::size_t first, std::size_t last);
};

template <class Law> using WallLoop = void (*)(const WallForces<Law>&, const WallColumns&, std::size_t first, std::size_t last);
template <class Law> WallLoop<Law> wall_loop(VectorPath path) {
  if constexpr (Law::chosen) return &WallForces<Law>::template run<VectorPath::scalar>;   // the same for every path (kernels/chosen_law.h)
  else return for_path(path, []<VectorPath p>() -> WallLoop<Law> { return &WallForces<Law>::template run<p>; });
}

template <class Law> struct ForceCalculationParticleBody {
  static constexpr const char* name = "force_calculation_particle_body";
  static constexpr std::size_t grain = 512;

  WallForces<Law> walls;
  WallLoop<Law> loop;

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
    loop(walls,
         {particle.data(), geometry.data(), overlap.data(), normal.data(), curvature.data(), position.data(), velocity.data(), pointer(spin),
          radius.data(), mass.data(), material.data(), body.data(), wall_material.data(), motion.data(), pose.data(), body_velocity.data(),
          body_spin.data(), body_mass.data(), force.data(), pointer(torque), pointer(rolling_torque), pointer(spring), pointer(rolling),
          pointer(memory)},
         rows.first, rows.last);
  }
};

}  // namespace skred
