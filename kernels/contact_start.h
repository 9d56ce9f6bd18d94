// kernels/contact_start.h - where the contact stage begins: right-hand sides, gravity, and the impulses of the last step (nonsmooth DEM).
//
// Down to half of those impulses where the last sweeps left much of their error: too much of a wrong answer makes a tall stack unstable.
#pragma once
#include "kernels/hub_contacts.h"

namespace skred {

template <bool rolling> struct ContactStart {
  static constexpr const char* name = "contact_start";

  double time_step;              // h [s]
  Vec3 gravity;                  // [m/s^2]
  bool warm_start;
  double trusted_residual;       // of the last step, up to which its impulses are taken whole

  void operator()(Parallel parallel, Read<&Particles::id> id, Read<&ContactBlocks::first_of_colour> first_of_colour,
                  Update<&ContactBlocks::groups> groups, Read<&ContactBlocks::sources> sources, Read<&Contacts::spring> impulse,
                  Read<&BodyContacts::spring> body_impulse, If<rolling, Read<&Contacts::rolling>> rolling_impulse,
                  If<rolling, Read<&BodyContacts::rolling>> body_rolling_impulse, Read<&RigidContacts::spring> rigid_impulse,
                  Update<&HubContacts::contact> hubs, Read<&SolverBodies::inverse_inertia> inertia, Update<&SolverBodies::state> bodies,
                  Read<&Solver::residual> residual, Read<&Solver::error_left> error_left) const;
};

extern template struct ContactStart<true>;
extern template struct ContactStart<false>;

}  // namespace skred
