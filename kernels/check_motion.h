// kernels/check_motion.h - is the list of candidates still good, and is every particle still where it can be?
//
// A pair listed with a skin s may be used until two particles have moved s in sum; a particle-body pair until the particle and
// the body's surface have. Nothing else depends on the skin: no result does (tests/tasks).
#pragma once
#include <limits>
#include "engine/access.h"
#include "engine/periodic.h"

namespace skred {

template <class Space> struct CheckMotion {
  static constexpr const char* name = "check_motion";

  Space space;
  double skin;                   // [m]
  double time_step;              // h [s]
  bool bounded;
  Bounds bounds;                 // [m]
  bool stop_outside;             // a particle outside is trouble

  void operator()(Parallel parallel, Read<&Particles::id> id, Read<&Particles::position> position,
                  Read<&Particles::velocity> velocity, Read<&Particles::radius> radius, Read<&Particles::searched> searched,
                  Read<&Bodies::motion> motion, Read<&Bodies::pose> pose, Read<&Bodies::searched> pose_searched,
                  Read<&Geometries::body> body, Read<&Geometries::shape> shape, Read<&Geometries::local> local,
                  Update<&Search::due> due, Update<&Search::count> count, Read<&Search::reach> reach,
                  Write<&Search::trouble> trouble, Write<&Search::culprit> culprit, Write<&Search::outside> outside) const;
};

extern template struct CheckMotion<OpenSpace>;
extern template struct CheckMotion<PeriodicSpace>;

}  // namespace skred
