// kernels/swept_test.h - no particle passes through a wall, however far it goes in a step (nonsmooth DEM).
//
// The rows of the contacts ahead stop what flies straight at a wall. What a collision sends elsewhere within the step, they may not
// see. So the path of every particle that goes far is followed from wall to wall, by steps as long as the way is free [sphere tracing: Hart 1996,
// The Visual Computer 12, 527]; where the centre would come nearer to a wall than half a radius, the particle loses the speed that
// takes it there: an inelastic impact. And no particle goes farther than walls were searched for: a light one that others have
// thrown may be much faster than anything was when the step began; it loses the speed beyond that.
#pragma once
#include "engine/access.h"

namespace skred {

template <class Space> struct SweptTest {
  static constexpr const char* name = "swept_test";

  Space space;
  double time_step;   // h [s]

  void operator()(Parallel parallel, Read<&Particles::position> position, Read<&Particles::radius> radius, Read<&Particles::searched> searched,
                  Read<&Particles::search_margin> search_margin, Update<&Particles::velocity> velocity,
                  Read<&BodyIncidence::first> first, Read<&BodyContacts::geometry> geometry, Read<&BodyContacts::slot> slot,
                  Read<&BodyContacts::first_triangle> first_triangle, Read<&BodyContacts::triangle_count> triangle_count,
                  Read<&Triangles::triangle> triangle, Read<&Geometries::body> body, Read<&Geometries::shape> shape,
                  Read<&Geometries::local> local, Read<&Bodies::pose> pose, Read<&Bodies::velocity> body_velocity,
                  Read<&Bodies::angular_velocity> body_spin) const;
};

}  // namespace skred
