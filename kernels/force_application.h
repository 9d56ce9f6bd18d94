// kernels/force_application.h - sums of the contact forces, and the velocities that follow from them.
//
// Each particle gathers its own contacts by ascending id of the partner, then its bodies by geometry: a fixed order, so the
// sums have the same bits for any number of threads, any skin and any order of the rows. Contacts that do not touch add zeros.
// The last line of the integration (kernels/integrate.h) is here because both forces are at hand.
#pragma once
#include "engine/access.h"
#include "kernels/integrate.h"

namespace skred {

// What contacts hold beside their force.
struct Moments {
  bool torque = false;      // the force turns particles
  bool rolling = false;     // and there is rolling resistance
  bool arm_ratio = false;   // and the two arms of a contact differ
};

template <bool contacts, bool body_contacts, Moments moments> struct ForceApplicationParticle {
  static constexpr const char* name = "force_application_particle";
  static constexpr std::size_t grain = 1024;
  static constexpr bool rotates = moments.torque;

  Vec3 gravity;       // [m/s^2]
  double time_step;   // h [s]; 0: forces only

  void operator()(Rows<Particles> rows, If<contacts, Read<&Incidence::first>> first,
                  If<contacts, Read<&Incidence::begin_lower>> begin_lower, If<contacts, Read<&Incidence::end_lower>> end_lower,
                  If<contacts, Read<&Incidence::lower>> lower,
                  If<contacts, Read<&Contacts::force>> pair_force, If<contacts && rotates, Read<&Contacts::torque>> pair_torque,
                  If<contacts && moments.rolling, Read<&Contacts::rolling>> pair_rolling,
                  If<contacts && moments.arm_ratio, Read<&Contacts::arm_ratio>> arm_ratio,
                  If<body_contacts, Read<&BodyIncidence::first>> first_body,
                  If<body_contacts, Read<&BodyContacts::force>> body_force,
                  If<body_contacts && rotates, Read<&BodyContacts::torque>> body_torque, Read<&Particles::mass> mass,
                  If<rotates, Read<&Particles::radius>> radius, Update<&Particles::force> force,
                  Update<&Particles::previous_force> previous_force, If<rotates, Update<&Particles::torque>> torque,
                  If<rotates, Update<&Particles::previous_torque>> previous_torque, Update<&Particles::velocity> velocity,
                  If<rotates, Update<&Particles::angular_velocity>> spin) const {
    for (std::size_t p = rows.first; p < rows.last; ++p) {
      Vec3 f, t;
      if constexpr (contacts) {
        for (Index k = begin_lower[p]; k < end_lower[p]; ++k) {
          const Index c = lower[k];
          f -= pair_force[c];
          if constexpr (moments.arm_ratio) t += arm_ratio[c] * pair_torque[c];
          else if constexpr (rotates) t += pair_torque[c];
          if constexpr (moments.rolling) t -= pair_rolling[c];
        }
        for (Index c = first[p]; c < first[p + 1]; ++c) {
          f += pair_force[c];
          if constexpr (rotates) t += pair_torque[c];
          if constexpr (moments.rolling) t += pair_rolling[c];
        }
      }
      if constexpr (body_contacts)
        for (Index c = first_body[p]; c < first_body[p + 1]; ++c) {
          f += body_force[c];
          if constexpr (rotates) t += body_torque[c];
        }
      f += mass[p] * gravity;

      velocity[p] += (0.5 * time_step / mass[p]) * (f - mean(force[p], previous_force[p]));
      previous_force[p] = time_step > 0 ? force[p] : f;
      force[p] = f;
      if constexpr (rotates) {
        const double inertia = 0.4 * mass[p] * radius[p] * radius[p];
        spin[p] += (0.5 * time_step / inertia) * (t - mean(torque[p], previous_torque[p]));
        previous_torque[p] = time_step > 0 ? torque[p] : t;
        torque[p] = t;
      }
    }
  }
};

}  // namespace skred
