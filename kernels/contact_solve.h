// kernels/contact_solve.h - the velocities at the end of the step: sweeps of projected Gauss-Seidel until little changes (nonsmooth DEM).
//
// impact_solve   contacts that close faster than v_imp are turned round at once, u_n+ = -e u_n- [Newton's law; Moreau 1988], while
//                others resist what that presses on them (impact_bias in kernels/constraint_setup.h, give_of in kernels/contact_sweep.h).
// contact_solve  the rows of engine/contact_rows.h, from where kernels/contact_start.h begins.
#pragma once
#include "engine/access.h"
#include "kernels/hub_contacts.h"

namespace skred {

// Whether a sweep that changes so small a part of all impulses, `ratio` times that of the sweep before, has left nothing but rounding.
// That is one of velocities: where a few spheres barely touch as they fall, it is far more than one of their impulses, and no longer falls.
constexpr bool is_rounding(double residual, double ratio) { return residual <= 1e-14 || (residual <= 1e-10 && ratio >= 1); }

struct SweepOptions {
  int most = 1;                  // sweeps, >= 1
  double tolerance = 0;          // stop when a sweep changes less than this part of all impulses ...
  double error_tolerance = 0;    // ... and the changes to come, which fall as the last ones did, add up to less than this; 0: never
  double separation_speed = 0;   // [m/s] see SweepKind::limited
  SweepKind kind;                // of the contacts of dynamic bodies
  SweepGroups sweep = nullptr, measured_sweep = nullptr;
};

struct ImpactSolve {
  static constexpr const char* name = "impact_solve";

  SweepOptions sweeps;

  void operator()(Parallel parallel, Read<&ContactBlocks::first_of_colour> first_of_colour, Read<&ContactBlocks::impacts> impacts_of_block,
                  Read<&ContactBlocks::neighbours> neighbours, Update<&ContactBlocks::groups> groups,
                  Update<&ContactBlocks::sources> sources, Update<&ContactBlocks::change> change, Update<&HubContacts::contact> hubs,
                  Read<&SolverBodies::inverse_inertia> inertia, Update<&SolverBodies::state> bodies, Write<&Solver::impacts> impacts,
                  Write<&Solver::impact_sweeps> sweeps_done, Write<&Solver::impact_residual> residual,
                  Update<&Solver::impacts_unsolved> unsolved) const;
};

struct ContactSolve {
  static constexpr const char* name = "contact_solve";

  SweepOptions sweeps;

  void operator()(Parallel parallel, Read<&ContactBlocks::first_of_colour> first_of_colour,
                  Read<&ContactBlocks::contacts> contacts_of_block, Update<&ContactBlocks::groups> groups,
                  Update<&ContactBlocks::change> change, Update<&HubContacts::contact> hubs, Read<&SolverBodies::inverse_inertia> inertia,
                  Update<&SolverBodies::state> bodies, Write<&Solver::contacts> contacts, Write<&Solver::sweeps> sweeps_done,
                  Write<&Solver::residual> residual, Write<&Solver::error_left> error_left, Update<&Solver::unsolved> unsolved) const;
};

}  // namespace skred
