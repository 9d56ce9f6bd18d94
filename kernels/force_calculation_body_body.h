// kernels/force_calculation_body_body.h - force at every point where two rigid bodies touch (smooth DEM).
//
// The law of particles, at each point of a patch, without rolling resistance: a patch resists rolling by itself. The effective
// mass is that which the point has for the normal, 1 / m_eff = sum of 1/m + (r x n) . I^-1 (r x n) over the dynamic bodies
// [Mirtich 1996, Impulse-based dynamic simulation]: the reduced mass for spheres, and the share of each corner where a cube lands on a face. So both
// a cube on its face and a sphere rebound with the prescribed restitution.
#pragma once
#include <vector>
#include "engine/access.h"
#include "kernels/chosen_law.h"
#include "kernels/contact_history.h"
#include "kernels/contact_law.h"

namespace skred {

// 1/kg: how readily a point of a body gives way along the unit vector n; r from the centre of mass to the point.
inline double mobility(double mass, const Vec3& inertia, const Quaternion& orientation, const Vec3& r, const Vec3& n) {
  const Vec3 lever = rotate_back(orientation, cross(r, n));
  return 1 / mass + lever.x * lever.x / inertia.x + lever.y * lever.y / inertia.y + lever.z * lever.z / inertia.z;
}

template <class Law> struct ForceCalculationBodyBody {
  static constexpr const char* name = "force_calculation_body_body";
  static constexpr std::size_t grain = 256;

  Law law;
  std::size_t materials;
  std::vector<typename Law::Coefficients> coefficients;   // row-major table of pairs of materials
  double time_step;                            // h [s]; 0 leaves the history as it is

  void operator()(Rows<RigidContacts> rows, Read<&RigidContacts::geometry_a> geometry_a, Read<&RigidContacts::geometry_b> geometry_b,
                  Read<&RigidContacts::point> point, Read<&RigidContacts::normal> normal, Read<&RigidContacts::overlap> overlap,
                  Read<&RigidContacts::radius_eff> radius_eff, Read<&Geometries::body> body, Read<&Geometries::material> material,
                  Read<&Bodies::motion> motion, Read<&Bodies::pose> pose, Read<&Bodies::velocity> velocity,
                  Read<&Bodies::angular_velocity> spin, Read<&Bodies::mass> mass, Read<&Bodies::inertia> inertia,
                  Write<&RigidContacts::force> force, If<Law::keeps_spring, Update<&RigidContacts::spring>> spring,
                  If<Law::remembers, Update<&RigidContacts::memory>> memory) const {
    for (std::size_t c = rows.first; c < rows.last; ++c) {
      if (!(overlap[c] > 0)) {
        clear_all(c, force, spring, memory);
        continue;
      }
      const Index a = body[geometry_a[c]], b = body[geometry_b[c]];
      const auto gives_way = [&](Index k) {
        return motion[k] == Motion::dynamic ? mobility(mass[k], inertia[k], pose[k].orientation, point[c] - pose[k].position, normal[c]) : 0.0;
      };
      const auto moves = [&](Index k) { return velocity[k] + cross(spin[k], point[c] - pose[k].position); };
      ContactState<double> s;
      s.overlap = overlap[c];
      s.normal = normal[c];
      s.radius_eff = radius_eff[c];
      s.contact_radius = std::sqrt(s.radius_eff * s.overlap);
      const double mobility_of_both = gives_way(a) + gives_way(b);
      s.damping_scale = std::sqrt(s.contact_radius / mobility_of_both);
      const Vec3 u = moves(a) - moves(b);
      s.normal_velocity = dot(u, s.normal);
      s.tangential_velocity = u - s.normal_velocity * s.normal;
      const auto& k = coefficients[material[geometry_a[c]] * materials + material[geometry_b[c]]];
      if constexpr (Law::chosen) {
        ContactMemory none;
        force[c] = evaluate(law, ChosenContact{s, 1 / mobility_of_both, 0, {}}, k, time_step, entry(memory, c, none)).force;
      } else {
        Vec3 none, no_moment;
        force[c] = evaluate(law, s, k, time_step, entry(spring, c, none), no_moment).force;
      }
    }
  }
};

}  // namespace skred
