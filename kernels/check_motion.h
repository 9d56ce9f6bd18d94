// kernels/check_motion.h - are the lists of neighbours and contacts still good, and is every particle still where it can be?
//
// When contacts are listed every particle gets a margin, a distance that it may go before the next listing: more for a fast one,
// so that a few of them do not make everyone list anew. A pair is listed if it is nearer than its radii and both margins. The
// neighbours that listings are made from have wider margins of the same kind, and are searched for when a particle's next margin
// would end outside. Nothing else depends on margins: no result does (tests/tasks).
#pragma once
#include <limits>
#include <vector>
#include "engine/access.h"
#include "engine/periodic.h"
#include "kernels/motion_watch.h"

namespace skred {

// Margins of the two lists [m]: what a particle goes in so many steps at its present speed, and something for those at rest.
struct Margins {
  double list_steps, list_rest;
  double search_steps, search_rest;
  double largest;                // [m] > 0 no margin is wider, but one that the step ahead needs
  double walls;                  // [m] of the surfaces of moving bodies, at the search
};

// What a step needs to know of the motion that it is about to make. Smooth DEM: nothing, it has moved already.
struct StepAhead {
  bool watched = false;          // lists must hold at the end of the step too
  double fall = 0;               // [m] that gravity adds, h^2 |g|
  double widest = std::numeric_limits<double>::infinity();   // [m] widest margin that the space allows
};

// By body: how far its surface reaches from the body's origin [m]; infinite for a plane, negative without geometry.
std::vector<double> extent_of_bodies(const Bodies&, const Geometries&);

template <class Space> struct CheckMotion {
  static constexpr const char* name = "check_motion";

  Space space;
  Margins margins;
  double time_step;              // h [s]
  bool bounded;
  Bounds bounds;                 // [m]
  bool stop_outside;             // a particle outside is trouble
  StepAhead ahead;
  int reorder_every;             // steps: then a search is due too (kernels/reorder.h)
  std::vector<double> extent;    // of the bodies
  bool watched_by_integrate = false;   // it has raised the flags left_margin and unwell: particles are looked at only if it did

  void operator()(Parallel parallel, Read<&Clock::step> step, Read<&Particles::id> id, Read<&Particles::position> position, Read<&Particles::velocity> velocity,
                  Read<&Particles::radius> radius, Update<&Particles::searched> searched, Update<&Particles::search_margin> search_margin,
                  Update<&Particles::listed> listed, Update<&Particles::list_margin> list_margin, Read<&Bodies::motion> motion,
                  Read<&Bodies::pose> pose, Read<&Bodies::velocity> wall_velocity, Read<&Bodies::angular_velocity> wall_spin,
                  Read<&Bodies::searched> pose_searched, Update<&Search::due> due, Read<&Search::rows_changed> rows_changed,
                  Update<&Search::left_margin> left_margin, Update<&Search::unwell> unwell, Write<&Search::list_due> list_due,
                  Update<&Search::count> count, Update<&Search::listings> listings, Update<&Search::reach> reach,
                  Write<&Search::trouble> trouble, Write<&Search::culprit> culprit, Write<&Search::outside> outside) const;
};

extern template struct CheckMotion<OpenSpace>;
extern template struct CheckMotion<PeriodicSpace>;

}  // namespace skred
