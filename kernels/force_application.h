// kernels/force_application.h - sums of all forces on each particle, and the velocities that follow from them.
//
// The force calculation has added up the contacts with particles block by block; to these come the halo's sums, what other blocks'
// contacts do, by ascending block, then the bodies by geometry, then gravity: a fixed order, so the sums have the same bits for any number of
// threads. Contacts that do not touch add zeros. Chunks of rows are whole blocks.
// The last line of the integration (kernels/integrate.h) is here because both forces are at hand.
#pragma once
#include <algorithm>
#include "engine/access.h"
#include "engine/vector_path.h"
#include "kernels/inertia.h"

namespace skred {

// What turns the sums of a block into velocities: one loop, compiled once per set of vector instructions
// (kernels/force_application_loop.h).
template <bool rotates_, class Inertia> struct VelocityUpdate {
  static constexpr bool rotates = rotates_, alike = Inertia::alike;
  Vec3 gravity;       // [m/s^2]
  double time_step;   // h [s]; 0: forces only
  Inertia inertia;
  const double *mass = nullptr, *radius = nullptr;           // of each, unless all are alike
  Vec3 *velocity = nullptr, *force = nullptr, *previous_force = nullptr;
  Vec3 *spin = nullptr, *torque = nullptr, *previous_torque = nullptr;

  // Of particles [first, last); the sums begin with that of `first`.
  template <VectorPath path> static void run(const VelocityUpdate&, std::size_t first, std::size_t last, const Vec3* force_sum, const Vec3* torque_sum);
};
template <class V> using VelocityLoop = void (*)(const V&, std::size_t first, std::size_t last, const Vec3* force_sum, const Vec3* torque_sum);
template <class V> VelocityLoop<V> velocity_loop(VectorPath path) {
  return for_path(path, []<VectorPath p>() -> VelocityLoop<V> { return &V::template run<p>; });
}

template <bool contacts, bool body_contacts, bool rotates, class Inertia> struct ForceApplicationParticle {
  static constexpr const char* name = "force_application_particle";
  static constexpr std::size_t grain = contact_block;

  VelocityUpdate<rotates, Inertia> update;
  VelocityLoop<VelocityUpdate<rotates, Inertia>> loop;

  void operator()(Rows<Particles> rows, If<contacts, Read<&HaloIncidence::halo>> first_halo, If<contacts, Read<&Halo::particle>> halo_particle,
                  If<contacts, Read<&Halo::sum>> halo_sum, If<contacts, Read<&ContactSums::force>> force_sum,
                  If<contacts && rotates, Read<&ContactSums::torque>> torque_sum, If<body_contacts, Read<&BodyIncidence::first>> first_body,
                  If<body_contacts, Read<&BodyContacts::particle>> body_contact_of, If<body_contacts, Read<&BodyContacts::force>> body_force,
                  If<body_contacts && rotates, Read<&BodyContacts::torque>> body_torque, If<!Inertia::alike, Read<&Particles::mass>> mass,
                  If<rotates && !Inertia::alike, Read<&Particles::radius>> radius, Update<&Particles::force> force,
                  Update<&Particles::previous_force> previous_force, If<rotates, Update<&Particles::torque>> torque,
                  If<rotates, Update<&Particles::previous_torque>> previous_torque, Update<&Particles::velocity> velocity,
                  If<rotates, Update<&Particles::angular_velocity>> spin) const {
    VelocityUpdate<rotates, Inertia> of_all = update;
    of_all.mass = pointer(mass), of_all.radius = pointer(radius);
    of_all.velocity = velocity.data(), of_all.force = force.data(), of_all.previous_force = previous_force.data();
    of_all.spin = pointer(spin), of_all.torque = pointer(torque), of_all.previous_torque = pointer(previous_torque);
    thread_local Buffer<Vec3> f, t;                          // of a block's particles, beside the core
    for (std::size_t begin = rows.first; begin < rows.last; begin += contact_block) {
      const std::size_t block = begin / contact_block, end = std::min(rows.last, begin + contact_block);
      if constexpr (contacts) {
        f.assign(force_sum.begin() + begin, force_sum.begin() + end);
        if constexpr (rotates) t.assign(torque_sum.begin() + begin, torque_sum.begin() + end);
        for (Index row = first_halo[block]; row < first_halo[block + 1]; ++row) {
          f[halo_particle[row] - begin] += vector(halo_sum[row].force);
          if constexpr (rotates) t[halo_particle[row] - begin] += vector(halo_sum[row].torque);
        }
      } else {
        f.assign(end - begin, Vec3{});
        if constexpr (rotates) t.assign(end - begin, Vec3{});
      }
      if constexpr (body_contacts)
        for (Index c = first_body[begin]; c < first_body[end]; ++c) {
          f[body_contact_of[c] - begin] += body_force[c];
          if constexpr (rotates) t[body_contact_of[c] - begin] += body_torque[c];
        }
      loop(of_all, begin, end, f.data(), t.data());
    }
  }
};

}  // namespace skred
