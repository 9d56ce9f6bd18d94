// kernels/force_application.h - sums of the contact forces, and the velocities that follow from them.
//
// Each particle gathers its own contacts by ascending id of the partner, then its bodies by geometry: a fixed order, so the
// sums have the same bits for any number of threads, any skin and any order of the rows. Contacts that do not touch add zeros.
// The last line of the integration (kernels/integrate.h) is here because both forces are at hand.
#pragma once
#include <algorithm>
#include "engine/access.h"
#include "engine/vector_path.h"
#include "kernels/integrate.h"

namespace skred {

// What contacts hold beside their force.
struct Moments {
  bool torque = false;      // the force turns particles
  bool rolling = false;     // and there is rolling resistance
  bool arm_ratio = false;   // and the two arms of a contact differ
};

// Sums of the contacts of a block of particles, x y z and a number of no use.
struct ContactSums { Four force[incidence_block], torque[incidence_block]; };

// The columns that the sums are made of; null where the effect is out.
struct SumColumns {
  const Index *first, *begin_lower, *end_lower, *lower, *lower_of, *i;
  const Vec3 *force, *torque, *rolling;
  const double* arm_ratio;
};
using SumContacts = void (*)(const SumColumns&, std::size_t first, std::size_t last, ContactSums&);

// Sums for the particles [first, last) of one block (kernels/force_application_loop.h).
template <Moments moments> struct ContactSummation {
  template <VectorPath path> static void run(const SumColumns&, std::size_t first, std::size_t last, ContactSums&);
};

template <Moments moments> SumContacts contact_summation(VectorPath path) {
  return for_path(path, []<VectorPath p>() -> SumContacts { return &ContactSummation<moments>::template run<p>; });
}

template <bool contacts, bool body_contacts, Moments moments> struct ForceApplicationParticle {
  static constexpr const char* name = "force_application_particle";
  static constexpr std::size_t grain = 4 * incidence_block;
  static constexpr bool rotates = moments.torque;

  Vec3 gravity;       // [m/s^2]
  double time_step;   // h [s]; 0: forces only
  SumContacts sum;

  void operator()(Rows<Particles> rows, If<contacts, Read<&Incidence::first>> first,
                  If<contacts, Read<&Incidence::begin_lower>> begin_lower, If<contacts, Read<&Incidence::end_lower>> end_lower,
                  If<contacts, Read<&Incidence::lower>> lower, If<contacts, Read<&Incidence::lower_of>> lower_of,
                  If<contacts, Read<&Contacts::i>> i,
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
    ContactSums sums;
    for (std::size_t p = rows.first; p < rows.last; ++p) {
      Vec3 f, t;
      if constexpr (contacts) {
        const std::size_t in_block = p % incidence_block;
        if (in_block == 0)
          sum({pointer(first), pointer(begin_lower), pointer(end_lower), pointer(lower), pointer(lower_of), pointer(i),
               pointer(pair_force), pointer(pair_torque), pointer(pair_rolling), pointer(arm_ratio)},
              p, std::min(p + incidence_block, rows.last), sums);
        const Four a = sums.force[in_block], b = sums.torque[in_block];
        f = {a[0], a[1], a[2]};
        if constexpr (rotates) t = {b[0], b[1], b[2]};
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
