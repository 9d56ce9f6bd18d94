// kernels/initial_forces.h - the contact forces of a state that nonsmooth DEM has not solved for yet: the elastic force of Hertz.
#pragma once
#include "kernels/constraint_setup.h"

namespace skred {

template <class Space, bool rolling> struct InitialForces {
  static constexpr const char* name = "initial_forces";

  Space space;
  std::size_t materials;
  std::vector<RowCoefficients> coefficients;   // row-major table of pairs of materials

  void operator()(Read<&Particles::position> position, Read<&Particles::radius> radius, Read<&Particles::material> material,
                  Read<&Contacts::i> i, Read<&Contacts::j> j, Read<&BodyContacts::particle> particle, Read<&BodyContacts::geometry> geometry,
                  Read<&BodyContacts::overlap> overlap, Read<&BodyContacts::normal> normal, Read<&BodyContacts::curvature> curvature,
                  Read<&Geometries::material> wall_material, Write<&Contacts::force> pair_force, Write<&BodyContacts::force> body_force,
                  If<rolling, Write<&BodyContacts::rolling_torque>> body_rolling_torque) const {
    const auto hertz = [](const RowCoefficients& k, double radius_eff, double depth) {
      return depth > 0 ? k.hertz * std::sqrt(radius_eff * depth) * depth : 0.0;
    };
    for (std::size_t c = 0; c < i.size(); ++c) {
      const Index p = i[c], q = j[c];
      const Vec3 branch = space.shortest(position[p] - position[q]);
      const double distance = norm(branch);
      const double f = hertz(coefficients[material[p] * materials + material[q]], radius[p] * radius[q] / (radius[p] + radius[q]),
                             radius[p] + radius[q] - distance);
      pair_force[c] = f * (distance > 0 ? (1 / distance) * branch : Vec3{0, 0, 1});
    }
    for (std::size_t c = 0; c < particle.size(); ++c) {
      const Index p = particle[c];
      body_force[c] = hertz(coefficients[material[p] * materials + wall_material[geometry[c]]], radius[p] / (1 + radius[p] * curvature[c]),
                            overlap[c]) * normal[c];
      if constexpr (rolling) body_rolling_torque[c] = {};
    }
  }
};

}  // namespace skred
