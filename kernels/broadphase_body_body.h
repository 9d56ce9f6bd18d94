// kernels/broadphase_body_body.h - pairs of geometries of different bodies whose boxes overlap.
//
// In every step, by a sweep along the direction in which the bodies are spread most [Baraff 1992; Cohen et al. 1995]: bodies are
// few beside particles, and a list that outlives the step would have to know how far each may go.
#pragma once
#include <memory>
#include "engine/access.h"
#include "engine/geometry/solid.h"

namespace skred {

using Solids = std::shared_ptr<const std::vector<Solid>>;   // by geometry

struct BroadphaseBodyBody {
  static constexpr const char* name = "broadphase_body_body";

  double margin;            // [m] >= 0: how near counts

  void operator()(Read<&Geometries::body> body, Read<&Geometries::shape> shape, Read<&Geometries::local> local,
                  Read<&Bodies::motion> motion, Read<&Bodies::pose> pose, Resize<RigidPairs> pairs) const;
};

}  // namespace skred
