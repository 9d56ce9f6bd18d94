// kernels/force_application.h - sums of all forces on each particle, and the velocities that follow from them.
//
// The force calculation has added up the contacts with particles block by block; to these come the halo's sums, what other blocks'
// contacts do, by ascending block, then the bodies by geometry, then gravity: a fixed order, so the sums have the same bits for any number of
// threads. Contacts that do not touch add zeros.
// The last line of the integration (kernels/integrate.h) is here because both forces are at hand.
#pragma once
#include "engine/access.h"
#include "kernels/integrate.h"

namespace skred {

template <bool contacts, bool body_contacts, bool rotates, class Inertia> struct ForceApplicationParticle {
  static constexpr const char* name = "force_application_particle";

  Vec3 gravity;       // [m/s^2]
  double time_step;   // h [s]; 0: forces only
  Inertia inertia;

  void operator()(Parallel parallel, If<contacts, Read<&HaloIncidence::halo>> first_halo, If<contacts, Read<&Halo::particle>> halo_particle,
                  If<contacts, Read<&Halo::sum>> halo_sum, If<contacts, Update<&ContactSums::force>> force_sum,
                  If<contacts && rotates, Update<&ContactSums::torque>> torque_sum, If<body_contacts, Read<&BodyIncidence::first>> first_body,
                  If<body_contacts, Read<&BodyContacts::force>> body_force,
                  If<body_contacts && rotates, Read<&BodyContacts::torque>> body_torque, If<!Inertia::alike, Read<&Particles::mass>> mass,
                  If<rotates && !Inertia::alike, Read<&Particles::radius>> radius, Update<&Particles::force> force,
                  Update<&Particles::previous_force> previous_force, If<rotates, Update<&Particles::torque>> torque,
                  If<rotates, Update<&Particles::previous_torque>> previous_torque, Update<&Particles::velocity> velocity,
                  If<rotates, Update<&Particles::angular_velocity>> spin) const {
    const std::size_t n = force.size();
    const Inertia of = inertia;                              // a copy, which no column can lie on: quotients are taken once
    parallel.chunks(n, contact_block, [&](std::size_t block, std::size_t begin, std::size_t end) {
      if constexpr (contacts)
        for (Index row = first_halo[block]; row < first_halo[block + 1]; ++row) {
          const Index p = halo_particle[row];
          force_sum[p] += vector(halo_sum[row].force);
          if constexpr (rotates) torque_sum[p] += vector(halo_sum[row].torque);
        }
      for (std::size_t p = begin; p < end; ++p) {
        Vec3 f, t;
        if constexpr (contacts) f = force_sum[p];
        if constexpr (contacts && rotates) t = torque_sum[p];
        if constexpr (body_contacts)
          for (Index c = first_body[p]; c < first_body[p + 1]; ++c) {
            f += body_force[c];
            if constexpr (rotates) t += body_torque[c];
          }
        const double m = of.mass_of(mass, p);
        f += m * gravity;

        velocity[p] += (0.5 * time_step / m) * (f - mean(force[p], previous_force[p]));
        previous_force[p] = time_step > 0 ? force[p] : f;
        force[p] = f;
        if constexpr (rotates) {
          spin[p] += (0.5 * time_step / of.moment_of(mass, radius, p)) * (t - mean(torque[p], previous_torque[p]));
          previous_torque[p] = time_step > 0 ? torque[p] : t;
          torque[p] = t;
        }
      }
    });
  }
};

}  // namespace skred
