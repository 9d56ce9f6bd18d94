// kernels/force_calculation_particle_particle.h - force and torque of every pair of particles (smooth DEM).
//
// One fused kernel for the normal, tangential and rolling parts: they share their loads [Pettersson 2015, sec. 3.3]. Force and
// velocities belong to the same time: velocities are the integrator's prediction (kernels/integrate.h). The loop itself is in
// force_calculation_loop.h, compiled once per set of vector instructions.
#pragma once
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
  Vec3 *force, *torque;
  double* arm_ratio;
  Vec3 *spring, *rolling;
  ContactMemory* memory = nullptr;
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

  // Computes the contacts [first, last).
  template <VectorPath path> static void run(const PairForces&, const PairColumns&, std::size_t first, std::size_t last);
};

template <class P> using PairLoop = void (*)(const P&, const PairColumns&, std::size_t first, std::size_t last);
template <class P> PairLoop<P> pair_loop(VectorPath path) {
  if constexpr (P::Law::chosen) return &P::template run<VectorPath::scalar>;   // the same for every path (kernels/chosen_law.h)
  else return for_path(path, []<VectorPath p>() -> PairLoop<P> { return &P::template run<p>; });
}

template <class Law, class Kinds, class Space> struct ForceCalculationParticleParticle {
  static constexpr const char* name = "force_calculation_particle_particle";
  static constexpr std::size_t grain = 512;
  static constexpr bool various = !Kinds::alike;

  PairForces<Law, Kinds, Space> pairs;
  PairLoop<PairForces<Law, Kinds, Space>> loop;

  void operator()(Rows<Contacts> rows, Read<&Contacts::i> i, Read<&Contacts::j> j, Read<&Particles::position> position,
                  Read<&Particles::velocity> velocity, If<Law::rotates, Read<&Particles::angular_velocity>> spin,
                  If<various, Read<&Particles::radius>> radius, If<various, Read<&Particles::mass>> mass,
                  If<various, Read<&Particles::material>> material, Write<&Contacts::force> force,
                  If<Law::rotates, Write<&Contacts::torque>> torque, If<Law::rotates && various, Write<&Contacts::arm_ratio>> arm_ratio,
                  If<Law::keeps_spring, Update<&Contacts::spring>> spring,
                  If<Law::has_rolling, std::conditional_t<Law::keeps_rolling, Update<&Contacts::rolling>, Write<&Contacts::rolling>>> rolling,
                  If<Law::remembers, Update<&Contacts::memory>> memory) const {
    loop(pairs,
         {i.data(), j.data(), position.data(), velocity.data(), pointer(spin), pointer(radius), pointer(mass), pointer(material),
          force.data(), pointer(torque), pointer(arm_ratio), pointer(spring), pointer(rolling),
          pointer(memory)},
         rows.first, rows.last);
  }
};

}  // namespace skred
