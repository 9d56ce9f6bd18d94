// The loops over particles for one set of vector instructions, like those over contacts in kernels/vector_path.cpp.
#include "engine/periodic.h"
#include "kernels/broadphase_loop.h"
#include "kernels/motion_loop.h"

namespace skred {

template std::size_t Surroundings<OpenSpace>::near<VectorPath::SKRED_PATH>(const Surroundings&, const Vec3&, double, const Places*, const Places*, Index*);
template std::size_t Surroundings<PeriodicSpace>::near<VectorPath::SKRED_PATH>(const Surroundings&, const Vec3&, double, const Places*, const Places*, Index*);
template AllOf MotionWatch<OpenSpace>::run<VectorPath::SKRED_PATH>(const MotionWatch&, std::size_t, std::size_t);
template AllOf MotionWatch<PeriodicSpace>::run<VectorPath::SKRED_PATH>(const MotionWatch&, std::size_t, std::size_t);

}  // namespace skred
