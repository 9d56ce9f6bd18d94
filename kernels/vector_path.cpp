// The hot loops for one set of vector instructions: compiled once per path, with SKRED_PATH its name and the
// compiler flags that go with it (CMakeLists.txt). Nothing here may be used by other translation units but run<SKRED_PATH>.
#include "kernels/contact_sweep_loop.h"
#include "kernels/force_calculation_loop.h"
#include "engine/periodic.h"
#include "kernels/laws.h"

namespace skred {

#define SKRED_INSTANTIATE(...) \
  template void PairForces<__VA_ARGS__>::run<VectorPath::SKRED_PATH>(const PairForces&, const PairColumns&, std::size_t, std::size_t, const PairBlock&);
#define SKRED_INSTANTIATE_LAW(LAW) \
  SKRED_INSTANTIATE(LAW, AlikeParticles, OpenSpace) SKRED_INSTANTIATE(LAW, AlikeParticles, PeriodicSpace) \
  SKRED_INSTANTIATE(LAW, VariousParticles, OpenSpace) SKRED_INSTANTIATE(LAW, VariousParticles, PeriodicSpace)

SKRED_FOR_EACH_LAW(SKRED_INSTANTIATE_LAW)

#define SKRED_INSTANTIATE_SWEEP(...) \
  template void ContactSweep<SweepKind{__VA_ARGS__, false}>::run<VectorPath::SKRED_PATH>(std::span<ContactGroup>, std::span<const ContactGroup>, SolverBody*, double, SweepChange&); \
  template void ContactSweep<SweepKind{__VA_ARGS__, true}>::run<VectorPath::SKRED_PATH>(std::span<ContactGroup>, std::span<const ContactGroup>, SolverBody*, double, SweepChange&);
SKRED_INSTANTIATE_SWEEP(true, false, false, false)           // impact, friction, rolling, limited
SKRED_INSTANTIATE_SWEEP(true, false, true, false)
SKRED_INSTANTIATE_SWEEP(true, true, false, false)
SKRED_INSTANTIATE_SWEEP(true, true, true, false)
SKRED_INSTANTIATE_SWEEP(false, false, false, false)
SKRED_INSTANTIATE_SWEEP(false, false, false, true)
SKRED_INSTANTIATE_SWEEP(false, false, true, false)
SKRED_INSTANTIATE_SWEEP(false, false, true, true)
SKRED_INSTANTIATE_SWEEP(false, true, false, false)
SKRED_INSTANTIATE_SWEEP(false, true, false, true)
SKRED_INSTANTIATE_SWEEP(false, true, true, false)
SKRED_INSTANTIATE_SWEEP(false, true, true, true)

}  // namespace skred
