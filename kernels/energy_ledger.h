// kernels/energy_ledger.h - what every step does to the energy (engine/energy.h). Read and written by nobody else: the motion is
// the same with it and without it.
//
// A contact takes -F.u - M.w from the motion of its partners and its body, u the velocity of the contact point and w the relative spin.
// Of that the springs hold what the laws tell (kernels/contact_energy.h); the rest is lost. Lost to the normal: the power of what of its force
// stores nothing. Lost to friction and to rolling: what of their work the springs do not hold.
//
// Smooth DEM: positions, velocities and forces belong to the same time at the end of a step; powers are integrated by the trapezoidal
// rule. With velocity Verlet the sum over bodies telescopes: kinetic energy and work differ by h^2/8 [F^2/m] between start and
// now, however many steps there were. The ledger closes to second order in h (a prescribed velocity that jumps by dv costs h/2 F dv once;
// so does a hysteretic normal force, where it comes back to its greatest overlap: h/2 of the power that it begins to lose, either way).
//
// Nonsmooth DEM: impulses act at once on all bodies, so that p.(u- + u+)/2 is exactly their work [Moreau 1988], over each stage with the
// velocities u-, u+ before and after it. Gravity moves positions with u+ alone (symplectic Euler): first order in h. That is
// what the ledger does not close by. Of the normal rows' work the potential of Hertz is stored, the rest is their damping: less than
// nothing while contacts have just closed, whose overlap no row has worked for.
//
// A particle that goes carries out its kinetic and potential energy, and what its contacts held; one that comes carries in the former. Smooth DEM
// takes it out between its position and its force: the forces on the others are without it, so it is let go in the middle of the step,
// with the velocity that gravity alone gives it from there on.
//
// Sums run over fixed chunks of rows: the same bits for any number of threads, though not for any skin.
#pragma once
#include <functional>
#include <optional>
#include "engine/access.h"
#include "engine/periodic.h"
#include "kernels/contact_energy.h"
#include "kernels/emit_particles.h"
#include "kernels/remove_particles.h"

namespace skred {

// A contact as the ledger sees it: force and moment on the first partner, and how it moves relative to the second.
struct LedgerContact {
  Index material_a, material_b;
  double overlap, radius_eff;                  // [m]
  Vec3 normal, force, moment;                  // 1, [N], [N m]
  Vec3 velocity, spin;                         // of the contact point [m/s], [rad/s]
  Vec3 spring;                                 // history of the tangential law [m]
  ContactMemory memory;                        // history of laws that are chosen at run time
};

// What the springs of a contact that touches hold, by the scene's law: all that the ledger knows of it.
using StoredByLaw = std::function<StoredInContact(const LedgerContact&)>;

struct LedgerOptions {
  std::optional<PeriodicSpace> space;
  bool falls_for_ever = false;                 // gravity acts along a periodic direction: its work has no potential
  Vec3 gravity;                                // [m/s^2]
  double time_step = 0;                        // h [s]; 0: this is the start
  StoredByLaw stored;                          // nonsmooth DEM: of the normal law alone
  bool removal = false;                        // particles may go: what each contact holds is kept
  double let_go_after = 0;                     // [s] h/2 of smooth DEM: when it is let go
};

// The energy of the state at the end of a step, and the books brought up to date.
template <bool smooth> struct UpdateEnergyLedger {
  static constexpr const char* name = "energy_ledger";

  LedgerOptions options;

  void operator()(Parallel parallel, Read<&Particles::position> position, Read<&Particles::velocity> velocity,
                  Read<&Particles::angular_velocity> spin, Read<&Particles::radius> radius, Read<&Particles::mass> mass,
                  Read<&Particles::material> material, Read<&Contacts::i> i, Read<&Contacts::j> j,
                  If<smooth, Read<&Contacts::force>> pair_force, If<smooth, Read<&Contacts::spring>> pair_spring,
                  If<smooth, Read<&Contacts::rolling>> pair_rolling, If<smooth, Read<&Contacts::memory>> pair_memory,
                  If<smooth, Read<&Contacts::moment>> pair_moment, Read<&BodyContacts::particle> particle,
                  Read<&BodyContacts::geometry> geometry, Read<&BodyContacts::overlap> overlap, Read<&BodyContacts::normal> normal,
                  Read<&BodyContacts::curvature> curvature, If<smooth, Read<&BodyContacts::force>> body_force,
                  If<smooth, Read<&BodyContacts::spring>> body_spring, If<smooth, Read<&BodyContacts::memory>> body_memory,
                  If<smooth, Read<&BodyContacts::rolling_torque>> body_moment,
                  Read<&RigidContacts::geometry_a> geometry_a, Read<&RigidContacts::geometry_b> geometry_b,
                  Read<&RigidContacts::point> point, Read<&RigidContacts::normal> rigid_normal, Read<&RigidContacts::overlap> rigid_overlap,
                  Read<&RigidContacts::radius_eff> rigid_radius, If<smooth, Read<&RigidContacts::force>> rigid_force,
                  If<smooth, Read<&RigidContacts::spring>> rigid_spring, If<smooth, Read<&RigidContacts::memory>> rigid_memory,
                  Read<&Geometries::body> body,
                  Read<&Geometries::material> body_material, Read<&Bodies::motion> motion, Read<&Bodies::pose> pose,
                  Read<&Bodies::velocity> body_velocity, Read<&Bodies::angular_velocity> body_spin, Read<&Bodies::mass> body_mass,
                  Read<&Bodies::inertia> inertia, If<!smooth, Read<&SolverBodies::state>> solved,
                  Resize<EnergyLedger> ledger) const;
};

extern template struct UpdateEnergyLedger<true>;
extern template struct UpdateEnergyLedger<false>;

// The velocities before the solver's stages.
struct EnergyLedgerBefore {
  static constexpr const char* name = "energy_ledger_before";

  void operator()(Parallel parallel, Read<&SolverBodies::state> bodies, Resize<EnergyLedger> ledger) const;
};

// Work of the impulses of the impact stage.
struct EnergyLedgerImpacts {
  static constexpr const char* name = "energy_ledger_impacts";

  void operator()(Parallel parallel, Read<&ContactBlocks::groups> groups, Read<&ContactBlocks::sources> sources,
                  Read<&HubContacts::contact> hubs, Read<&SolverBodies::state> bodies, Read<&Solver::impacts> impacts,
                  Update<&EnergyLedger::before> before, Update<&EnergyLedger::in_step> in_step) const;
};

// Work of the impulses of the contact stage, by row.
struct EnergyLedgerRows {
  static constexpr const char* name = "energy_ledger_rows";

  void operator()(Parallel parallel, Read<&ContactBlocks::groups> groups, Read<&HubContacts::contact> hubs,
                  Read<&SolverBodies::state> bodies, Read<&EnergyLedger::before> before, Update<&EnergyLedger::in_step> in_step) const;
};

// What particles carry out that RemoveParticles is about to take: as in its options.
template <bool smooth> struct EnergyLedgerRemoval {
  static constexpr const char* name = "energy_ledger_removal";

  std::vector<Remover> removers;
  double time_step;                            // h [s]
  int steps_behind;
  Vec3 gravity;                                // [m/s^2]
  bool falls_for_ever;

  void operator()(Parallel parallel, Read<&Clock::step> step, Read<&Particles::position> position, Read<&Particles::velocity> velocity,
                  Read<&Particles::angular_velocity> spin, Read<&Particles::radius> radius, Read<&Particles::mass> mass,
                  If<smooth, Read<&Particles::force>> force, If<smooth, Read<&Particles::previous_force>> previous_force,
                  If<smooth, Read<&Particles::torque>> torque, If<smooth, Read<&Particles::previous_torque>> previous_torque,
                  Read<&Contacts::i> i, Read<&Contacts::j> j, Read<&BodyContacts::particle> particle, Read<&EnergyLedger::of_pairs> of_pairs,
                  Read<&EnergyLedger::of_walls> of_walls, Update<&EnergyLedger::stored> stored, Update<&EnergyLedger::flow> flow) const;
};

extern template struct EnergyLedgerRemoval<true>;
extern template struct EnergyLedgerRemoval<false>;

// What particles carry in that EmitParticles has just created.
struct EnergyLedgerInflow {
  static constexpr const char* name = "energy_ledger_inflow";

  Vec3 gravity;                                // [m/s^2]
  bool falls_for_ever;

  void operator()(Read<&Search::rows_changed> changed, Read<&Particles::previous_row> previous_row, Read<&Particles::position> position,
                  Read<&Particles::velocity> velocity, Read<&Particles::angular_velocity> spin, Read<&Particles::radius> radius,
                  Read<&Particles::mass> mass, Update<&EnergyLedger::flow> flow, Update<&EnergyLedger::power> power) const;
};

}  // namespace skred
