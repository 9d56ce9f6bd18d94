// The loops over particles, and over their contacts with walls, for one set of vector instructions, like those over contacts in kernels/vector_path.cpp.
#include "engine/periodic.h"
#include "kernels/broadphase_loop.h"
#include "kernels/force_application_loop.h"
#include "kernels/force_calculation_particle_body_loop.h"
#include "kernels/integrate_loop.h"
#include "kernels/laws.h"

namespace skred {

template std::size_t Surroundings<OpenSpace>::near<VectorPath::SKRED_PATH>(const Surroundings&, const Vec3&, double, const Places*, const Places*, Index*);
template std::size_t Surroundings<PeriodicSpace>::near<VectorPath::SKRED_PATH>(const Surroundings&, const Vec3&, double, const Places*, const Places*, Index*);

#define SKRED_INSTANTIATE_VERLET(...) \
  template AllOf VerletStep<__VA_ARGS__>::run<VectorPath::SKRED_PATH>(const VerletStep&, std::size_t, std::size_t);
#define SKRED_INSTANTIATE_VERLET_IN(SPACE) \
  SKRED_INSTANTIATE_VERLET(true, SPACE, Inertia<true>) SKRED_INSTANTIATE_VERLET(true, SPACE, Inertia<false>) \
  SKRED_INSTANTIATE_VERLET(false, SPACE, Inertia<true>) SKRED_INSTANTIATE_VERLET(false, SPACE, Inertia<false>)
SKRED_INSTANTIATE_VERLET_IN(OpenSpace)
SKRED_INSTANTIATE_VERLET_IN(PeriodicSpace)

#define SKRED_INSTANTIATE_VELOCITY(...) \
  template void VelocityUpdate<__VA_ARGS__>::run<VectorPath::SKRED_PATH>(const VelocityUpdate&, std::size_t, std::size_t, const Vec3*, const Vec3*);
#define SKRED_INSTANTIATE_WALLS(LAW) \
  template void WallForces<LAW>::run<VectorPath::SKRED_PATH>(const WallForces&, const WallColumns&, std::size_t, std::size_t);
SKRED_FOR_EACH_LAW(SKRED_INSTANTIATE_WALLS)
SKRED_INSTANTIATE_VELOCITY(true, Inertia<true>)
SKRED_INSTANTIATE_VELOCITY(true, Inertia<false>)
SKRED_INSTANTIATE_VELOCITY(false, Inertia<true>)
SKRED_INSTANTIATE_VELOCITY(false, Inertia<false>)

}  // namespace skred
