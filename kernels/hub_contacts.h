// kernels/hub_contacts.h - contacts of dynamic rigid bodies, with particles and with each other (nonsmooth DEM).
//
// The rows are those of engine/contact_rows.h, but the effective mass across the normal is a 2 x 2 matrix and not a number
// [Mirtich 1996], and the normal row moves the friction row.
#pragma once
#include <span>
#include "kernels/constraint_setup.h"
#include "kernels/contact_sweep.h"

namespace skred {

struct ConstraintSetupBody {
  static constexpr const char* name = "constraint_setup_body";

  RowOptions options;
  std::size_t materials;
  std::vector<RowCoefficients> coefficients;   // row-major table of pairs of materials

  void operator()(Read<&Particles::id> id, Read<&Particles::position> position, Read<&Particles::radius> radius,
                  Read<&Particles::material> material, Read<&BodyContacts::particle> particle, Read<&BodyContacts::geometry> geometry,
                  Read<&BodyContacts::overlap> overlap, Read<&BodyContacts::normal> normal, Read<&BodyContacts::curvature> curvature,
                  Read<&RigidContacts::geometry_a> geometry_a, Read<&RigidContacts::geometry_b> geometry_b, Read<&RigidContacts::point> point,
                  Read<&RigidContacts::normal> rigid_normal, Read<&RigidContacts::overlap> rigid_overlap,
                  Read<&RigidContacts::radius_eff> rigid_radius, Read<&Geometries::body> body, Read<&Geometries::material> body_material,
                  Read<&Bodies::motion> motion, Read<&Bodies::pose> pose, Read<&Bodies::inertia> inertia,
                  Update<&SolverBodies::state> bodies, Write<&SolverBodies::inverse_inertia> inverse_inertia, Resize<HubContacts> hubs) const;
};

// The right-hand sides of the contact stage, from the velocities before gravity.
void set_hub_biases(std::span<HubContact>, std::span<const SolverBody>, double time_step);

// Starts from these impulses: of a row of BodyContacts, or of RigidContacts.
void warm_start_hubs(std::span<HubContact>, std::span<SolverBody>, std::span<const InverseInertia>, double share, std::span<const Vec3> body_impulse,
                     std::span<const Vec3> body_rolling_impulse, std::span<const Vec3> rigid_impulse);

// One sweep, in order. Adds to `change`.
void sweep_hubs(std::span<HubContact>, std::span<SolverBody>, std::span<const InverseInertia>, const SweepKind&, double separation_speed, SweepChange& change);

// What the solver found goes back to bodies and contacts.
struct ImpulseApplicationBody {
  static constexpr const char* name = "impulse_application_body";

  double time_step;   // h [s] > 0

  void operator()(Read<&HubContacts::contact> hubs, Read<&SolverBodies::state> state, Read<&Bodies::motion> motion,
                  Update<&Bodies::velocity> velocity, Update<&Bodies::angular_velocity> spin, Update<&BodyContacts::force> body_force,
                  Update<&BodyContacts::spring> body_impulse, Update<&BodyContacts::rolling> body_rolling_impulse,
                  Update<&BodyContacts::rolling_torque> body_rolling_torque, Write<&RigidContacts::force> rigid_force,
                  Write<&RigidContacts::spring> rigid_impulse) const;
};

}  // namespace skred
