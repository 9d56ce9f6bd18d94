// kernels/force_calculation_particle_particle.h - force and torque of every pair of particles (smooth DEM).
//
// One fused kernel for the normal, tangential and rolling parts: they share their loads [Pettersson 2015, sec. 3.3]. Force and
// velocities belong to the same time: velocities are the integrator's prediction (kernels/integrate.h). The loop itself is in
// force_calculation_loop.h, compiled once per set of vector instructions.
#pragma once
#include <algorithm>
#include <vector>
#include "engine/access.h"
#include "engine/vector_path.h"
#include "kernels/chosen_law.h"
#include "kernels/contact_law.h"

namespace skred {

// Where every particle is alike, what the pair needs is worked out once ...
struct AlikeParticles {
  static constexpr bool alike = true;
  double radius, mass;
  LawCoefficients coefficients;
};
// ... else it is looked up per contact: row-major table of pairs of materials.
template <class Coefficients> struct LookedUpParticles {
  static constexpr bool alike = false;
  std::size_t materials;
  std::vector<Coefficients> coefficients;
};
using VariousParticles = LookedUpParticles<LawCoefficients>;
using ChosenParticles = LookedUpParticles<ChosenCoefficients>;

// The columns that the loop works on; null where the law or the kinds of particles do not need them.
struct PairColumns {
  const Index *i, *j;
  const Vec3 *position, *velocity, *spin;
  const double *radius, *mass;
  const Index* material;
  const Index* sum_of_j;
  Vec3 *force, *spring, *rolling;
  ContactMemory* memory = nullptr;
};

// What the contacts of a block do to its particles, and behind those to the particles of other blocks.
struct alignas(64) PairSum { Four force, torque; };          // x y z, and a number of no use
struct BlockSums {
  Index first_particle;        // of the block
  PairSum* sum;
};

// What one loop knows beside its columns.
template <class LawT, class KindsT, class SpaceT> struct PairForces {
  using Law = LawT;
  using Kinds = KindsT;
  using Space = SpaceT;
  Law law;
  Kinds kinds;
  Space space;
  double time_step;            // h [s]; 0 leaves the history as it is

  // Computes the contacts [first, last), and adds what they do to their particles to the sums.
  template <VectorPath path> static void run(const PairForces&, const PairColumns&, std::size_t first, std::size_t last, const BlockSums&);
};

template <class P> using PairLoop = void (*)(const P&, const PairColumns&, std::size_t first, std::size_t last, const BlockSums&);
template <class P> PairLoop<P> pair_loop(VectorPath path) {
  if constexpr (P::Law::chosen) return &P::template run<VectorPath::scalar>;   // the same for every path (kernels/chosen_law.h)
  else return for_path(path, []<VectorPath p>() -> PairLoop<P> { return &P::template run<p>; });
}

template <class Law, class Kinds, class Space> struct ForceCalculationParticleParticle {
  static constexpr const char* name = "force_calculation_particle_particle";
  static constexpr bool various = !Kinds::alike;

  PairForces<Law, Kinds, Space> pairs;
  PairLoop<PairForces<Law, Kinds, Space>> loop;

  void operator()(Parallel parallel, Read<&Incidence::first> first, Read<&HaloIncidence::from> halo_from,
                  Read<&Halo::particle> halo_particle, Read<&Contacts::i> i, Read<&Contacts::j> j,
                  Read<&Contacts::sum_of_j> sum_of_j, Read<&Particles::position> position,
                  Read<&Particles::velocity> velocity, If<Law::rotates, Read<&Particles::angular_velocity>> spin,
                  If<various, Read<&Particles::radius>> radius, If<various, Read<&Particles::mass>> mass,
                  If<various, Read<&Particles::material>> material, Write<&Contacts::force> force,
                  If<Law::keeps_spring, Update<&Contacts::spring>> spring,
                  If<Law::keeps_rolling, Update<&Contacts::rolling>> rolling,
                  If<Law::remembers, Update<&Contacts::memory>> memory, Write<&ContactSums::force> force_sum,
                  If<Law::rotates, Write<&ContactSums::torque>> torque_sum) const {
    const PairColumns columns{i.data(), j.data(), position.data(), velocity.data(), pointer(spin), pointer(radius), pointer(mass),
                              pointer(material), sum_of_j.data(), force.data(), pointer(spring), pointer(rolling), pointer(memory)};
    const std::size_t n = position.size();
    parallel.chunks(n, contact_block, [&](std::size_t block, std::size_t begin, std::size_t end) {
      const std::size_t from = halo_from[block], in_halo = halo_from[block + 1] - from;
      const auto fetch = [&](std::size_t p) {                // before the loop meets them in the order of chance
        __builtin_prefetch(&position[p]), __builtin_prefetch(&velocity[p]);
        if constexpr (Law::rotates) __builtin_prefetch(&spin[p]);
      };
      for (std::size_t p = begin; p < end; ++p) fetch(p);
      for (std::size_t k = 0; k < in_halo; ++k) fetch(halo_particle[from + k]);

      thread_local Buffer<PairSum> sums;                     // small enough for the caches beside a core
      sums.assign(contact_block + in_halo, PairSum{});
      loop(pairs, columns, first[begin], first[end], {static_cast<Index>(begin), sums.data()});
      const auto hand_over = [&](const PairSum* sum, std::size_t to, std::size_t count) {
        for (std::size_t k = 0; k < count; ++k) {
          force_sum[to + k] = {sum[k].force[0], sum[k].force[1], sum[k].force[2]};
          if constexpr (Law::rotates) torque_sum[to + k] = {sum[k].torque[0], sum[k].torque[1], sum[k].torque[2]};
        }
      };
      hand_over(sums.data(), begin, end - begin);
      hand_over(sums.data() + contact_block, n + from, in_halo);
    });
  }
};

}  // namespace skred
