// kernels/force_calculation_particle_particle.h - force and torque of every pair of particles (smooth DEM).
//
// One fused kernel for the normal, tangential and rolling parts: they share their loads [Pettersson 2015, sec. 3.3]. Force and
// velocities belong to the same time: velocities are the integrator's prediction (kernels/integrate.h). The loop itself is in
// force_calculation_loop.h, compiled once per set of vector instructions.
#pragma once
#include <algorithm>
#include <vector>
#include "engine/access.h"
#include "engine/quad.h"
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

// The columns that the loop works on; null where the law does not need them, or nobody reads them.
struct PairColumns {
  const Index *i, *j, *place_of_j;
  const Index* material;
  Vec3 *force, *spring, *rolling;
  ContactMemory* memory = nullptr;
  Vec3* moment = nullptr;
};

// What a contact needs to know of a particle. A block's contacts meet theirs in the order of chance: their rows are gathered here
// before, where one lies on two cache lines in place of five, and near the core.
struct SeenParticle { Quad position, velocity, spin; };      // and beside them, unless all are alike: radius, mass, nothing

// The particles of a block, and behind them its guests.
struct PairBlock {
  Index first_particle;        // of the block
  const SeenParticle* seen;
  PairSum* sum;                // of what the contacts do to them
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

  // Computes the contacts [first, last), and adds what they do to the sums.
  template <VectorPath path> static void run(const PairForces&, const PairColumns&, std::size_t first, std::size_t last, const PairBlock&);
};

template <class P> using PairLoop = void (*)(const P&, const PairColumns&, std::size_t first, std::size_t last, const PairBlock&);
template <class P> PairLoop<P> pair_loop(VectorPath path) {
  if constexpr (P::Law::chosen) return &P::template run<VectorPath::scalar>;   // the same for every path (kernels/chosen_law.h)
  else return for_path(path, []<VectorPath p>() -> PairLoop<P> { return &P::template run<p>; });
}

template <class Law, class Kinds, class Space> struct ForceCalculationParticleParticle {
  static constexpr const char* name = "force_calculation_particle_particle";
  static constexpr bool various = !Kinds::alike;

  PairForces<Law, Kinds, Space> pairs;
  PairLoop<PairForces<Law, Kinds, Space>> loop;
  bool nobody_looks = false;   // at this step's contacts: their forces need not be written down, unless it is in trouble

  void operator()(Parallel parallel, Read<&Incidence::first> first, Read<&HaloIncidence::guests> first_guest,
                  Read<&Guests::particle> guest, Read<&Guests::halo_row> halo_row, Read<&Contacts::i> i, Read<&Contacts::j> j,
                  Read<&Contacts::place_of_j> place_of_j, Read<&Particles::position> position,
                  Read<&Particles::velocity> velocity, If<Law::rotates, Read<&Particles::angular_velocity>> spin,
                  If<various, Read<&Particles::radius>> radius, If<various, Read<&Particles::mass>> mass,
                  If<various, Read<&Particles::material>> material, Write<&Contacts::force> force,
                  If<Law::keeps_spring, Update<&Contacts::spring>> spring,
                  If<Law::keeps_rolling, Update<&Contacts::rolling>> rolling,
                  If<Law::remembers, Update<&Contacts::memory>> memory, If<Law::keeps_moment, Write<&Contacts::moment>> moment,
                  Write<&Halo::sum> halo_sum, Write<&ContactSums::force> force_sum,
                  If<Law::rotates, Write<&ContactSums::torque>> torque_sum, Read<&Search::trouble> trouble) const {
    const bool unread = nobody_looks && trouble[0] == Trouble::none;
    const PairColumns columns{i.data(), j.data(), place_of_j.data(), pointer(material), unread ? nullptr : force.data(), pointer(spring), pointer(rolling),
                              pointer(memory), pointer(moment)};
    parallel.chunks(position.size(), contact_block, [&](std::size_t block, std::size_t begin, std::size_t end) {
      const std::size_t from = first_guest[block], guests = first_guest[block + 1] - from;
      thread_local Buffer<SeenParticle> seen;                // small enough for the caches beside a core
      thread_local Buffer<PairSum> sums;
      seen.resize(contact_block + guests);
      sums.assign(contact_block + guests, PairSum{});

      const auto look_at = [&](std::size_t p, SeenParticle& s) {
        s.position.v = position[p], s.velocity.v = velocity[p];
        if constexpr (Law::rotates) s.spin.v = spin[p];
        if constexpr (various) s.position.s = radius[p], s.velocity.s = mass[p];
      };
      for (std::size_t p = begin; p < end; ++p) look_at(p, seen[p - begin]);
      for (std::size_t k = 0; k < guests; ++k) look_at(guest[from + k], seen[contact_block + k]);

      loop(pairs, columns, first[begin], first[end], {static_cast<Index>(begin), seen.data(), sums.data()});

      for (std::size_t p = begin; p < end; ++p) {
        force_sum[p] = vector(sums[p - begin].force);
        if constexpr (Law::rotates) torque_sum[p] = vector(sums[p - begin].torque);
      }
      for (std::size_t k = 0; k < guests; ++k) halo_sum[halo_row[from + k]] = sums[contact_block + k];
    });
  }
};

}  // namespace skred
