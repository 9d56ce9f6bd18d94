// tasks/model.h - the choices that shape a step. A scene fills one in; add_sdem and add_ndem read it.
#pragma once
#include <limits>
#include <optional>
#include <string>
#include <vector>
#include "engine/material.h"
#include "engine/motion.h"
#include "engine/periodic.h"
#include "engine/vector_path.h"
#include "engine/world.h"
#include "kernels/check_motion.h"
#include "kernels/contact_model.h"
#include "kernels/emit_particles.h"
#include "kernels/remove_particles.h"
#include "tasks/method.h"

namespace skred {

struct Model {
  Method method = Method::sdem;
  SolverOptions solver;
  double time_step = 0;                            // h [s] > 0
  Vec3 gravity{0, 0, -9.81};                       // [m/s^2]
  PairTable pairs;
  ContactModel contact;                            // smooth DEM; nonsmooth DEM looks for `none` only
  bool all_effects = false;                        // keep every effect, even where its parameter is zero
  bool orientation = false;                        // integrate the orientation of particles
  bool energy = false;                             // keep the energy ledger
  std::optional<PeriodicSpace> periodic;
  std::optional<Bounds> bounds;
  bool stop_outside = true;
  double skin = 0, cell = 0;                       // [m]; 0: chosen from the radii
  VectorPath vector_path = best_vector_path();     // leaves no trace in the results
  int reorder_every = 1000;                        // steps; 0: never
  Buffer<Pose> bodies_at_start;                    // by body
  std::vector<std::vector<MotionPiece>> pieces;    // by body; empty unless kinematic
  std::vector<Remover> removers;                   // take particles out
  std::vector<Inflow> inflows;                     // create them
  std::vector<Area> areas;                         // that they cross and are counted at
};

// Which effects a scene calls for. Decided once, when the task is built; conservative: what can become non-zero stays in.
struct Effects {
  bool contacts, bodies, meshes, moving_bodies, dynamic_bodies, rigid_contacts;
  bool normal, damping, friction, rolling;
  bool impacts;                                    // the impact stage of nonsmooth DEM
  bool rotation, orientation, history;
  bool chosen, memory;                             // smooth DEM: a law chosen at run time, and whether it has a history
  bool alike;                                      // one radius, one mass, one material, worked out once: no law looks them up
  bool periodic;
  bool removal, inflow, crossings;
  bool energy;                                     // the energy ledger

  struct Reason { std::string effect; bool in; std::string why; };
  std::vector<Reason> reasons;                     // for `skred graph`, in order of the list above
};

Effects decide_effects(const World&, const Model&);

// Margins and cell edge that the search uses. Where there is room the skin is wider than the least, in smallest radii.
inline constexpr double least_skin = 0.3;
Margins margins_of(const World&, const Model&);
StepAhead step_ahead(const World&, const Model&);
double impact_speed_of(const Model&);              // v_imp [m/s]
// What is left to be changed is reckoned from how fast the changes of the sweeps fall. Where no pair has friction it falls fast, and forces
// are unique: the tolerance bounds their error. With friction they are not unique: PGS wanders for hundreds of sweeps, by less and
// less, among forces that all but solve the rows; there 10 % only refuses what has hardly begun to converge.
double error_tolerance_of(const Model&);
double wall_speed(const World&, const Model&);     // [m/s] greatest prescribed speed of a body's surface
double cell_of(const World&, const Model&);
double largest_radius(const World&, const Model&);    // [m] of the particles, and of those that may come
double smallest_radius(const World&, const Model&);

}  // namespace skred
