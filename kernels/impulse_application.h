// kernels/impulse_application.h - what the solver found goes back to particles and contacts (nonsmooth DEM).
//
// Forces are impulses divided by the step. Contacts keep their impulses as history: the next solve starts from them.
#pragma once
#include <algorithm>
#include "kernels/contact_blocks.h"

namespace skred {

template <bool rolling> struct ImpulseApplication {
  static constexpr const char* name = "impulse_application";

  double time_step;   // h [s] > 0

  void operator()(Parallel parallel, Read<&ContactBlocks::groups> groups, Read<&ContactBlocks::sources> sources, Read<&SolverBodies::state> bodies,
                  Read<&Particles::mass> mass, Update<&Particles::velocity> velocity, Write<&Particles::angular_velocity> spin,
                  Write<&Particles::force> force, Write<&Contacts::force> pair_force, Write<&Contacts::spring> impulse,
                  If<rolling, Write<&Contacts::rolling>> rolling_impulse, Write<&BodyContacts::force> body_force,
                  Write<&BodyContacts::spring> body_impulse, If<rolling, Write<&BodyContacts::rolling>> body_rolling_impulse,
                  If<rolling, Write<&BodyContacts::rolling_torque>> body_rolling_torque) const {
    const double per_step = 1 / time_step;
    parallel(velocity.size(), 4096, [&](std::size_t first, std::size_t last) {
      for (std::size_t p = first; p < last; ++p) {
        force[p] = (mass[p] * per_step) * (bodies[p].linear.v - velocity[p]);
        velocity[p] = bodies[p].linear.v;
        spin[p] = bodies[p].angular.v;
      }
    });
    const auto clear = [&](auto& column) {
      if constexpr (requires { column.size(); })
        parallel(column.size(), 8192, [&](std::size_t first, std::size_t last) { std::fill(column.begin() + first, column.begin() + last, Vec3{}); });
    };
    clear(pair_force), clear(impulse), clear(rolling_impulse);
    clear(body_force), clear(body_impulse), clear(body_rolling_impulse), clear(body_rolling_torque);

    parallel(groups.size(), blocks_at_a_time, [&](std::size_t first, std::size_t last) {
      for (std::size_t b = first; b < last; ++b)
        for (std::size_t k = 0; k < groups[b].size(); ++k) {
          const ContactGroup& g = groups[b][k];
          const GroupSource& s = sources[b][k];
          for (std::size_t l = 0; l < std::size_t(g.count); ++l) {
            const Index c = s.contact[l];
            const Vec3 p = g.normal_impulse[l] * at(g.normal, l) + at(g.friction_impulse, l);
            (s.of_body[l] ? body_force[c] : pair_force[c]) = per_step * (p + s.impact_impulse[l]);
            (s.of_body[l] ? body_impulse[c] : impulse[c]) = p;
            if constexpr (rolling) {
              const Vec3 moment = at(g.rolling_impulse, l);
              (s.of_body[l] ? body_rolling_impulse[c] : rolling_impulse[c]) = moment;
              if (s.of_body[l]) body_rolling_torque[c] = per_step * moment;
            }
          }
        }
    });
  }
};

}  // namespace skred
