// engine/world.h - the state of a simulation: a few tables, each a plain struct of named columns.
//
// Every table lists its columns in `columns()`, so that reordering, memory accounts and output are written once.
#pragma once
#include <array>
#include <cstdint>
#include <tuple>
#include "engine/column.h"
#include "engine/contact_rows.h"
#include "engine/energy.h"
#include "engine/geometry/shape.h"
#include "engine/vec3.h"
#include "engine/vector_path.h"

namespace skred {

// One row per sphere. Rows are re-sorted in space now and then; `id` stays.
struct Particles {
  Column<Index>      id{"id", "1"};                                // unique; 0 .. count-1 until particles are removed
  Column<Vec3>       position{"position", "m"};
  Column<Vec3>       velocity{"velocity", "m/s"};
  Column<Vec3>       angular_velocity{"angular_velocity", "rad/s"};
  Column<Quaternion> orientation{"orientation", "1"};              // empty unless the output asks for it
  Column<Vec3>       force{"force", "N"};                          // total, gravity included
  Column<Vec3>       torque{"torque", "N m"};
  Column<Vec3>       previous_force{"previous_force", "N"};        // of the step before: the velocity prediction needs both
  Column<Vec3>       previous_torque{"previous_torque", "N m"};
  Column<double>     radius{"radius", "m"};                        // > 0
  Column<double>     mass{"mass", "kg"};                           // > 0; moment of inertia 2/5 m R^2
  Column<Index>      material{"material", "1"};                    // row of the pair table
  Column<Vec3>       searched{"position_at_search", "m"};          // where it was when neighbours were last searched for ...
  Column<double>     search_margin{"search_margin", "m"};          // ... and how far from there it may go before the next search
  Column<Vec3>       listed{"position_at_listing", "m"};           // where it was when contacts were last listed ...
  Column<double>     list_margin{"list_margin", "m"};              // ... and how far from there it may go before the next listing
  Column<Index>      previous_row{"row_before_reorder", "1"};      // its row before the rows last changed; no_index: it is new
  Column<Vec3>       before{"position_before", "m"};               // in the step before; empty unless crossings are counted
  std::size_t rows() const { return position.data.size(); }
  static constexpr auto columns() {
    return std::tuple{&Particles::id, &Particles::position, &Particles::velocity, &Particles::angular_velocity,
                      &Particles::orientation, &Particles::force, &Particles::torque,
                      &Particles::previous_force, &Particles::previous_torque, &Particles::radius,
                      &Particles::mass, &Particles::material, &Particles::searched, &Particles::search_margin,
                      &Particles::listed, &Particles::list_margin, &Particles::previous_row, &Particles::before};
  }
};

// The neighbour list [Verlet 1967]: pairs of particles that may touch before the next search, each with the particle of the lower
// id, as neighbours [first, first_next) of it by ascending id. Contacts are listed from these, much more often.
struct Neighbours {
  Column<Index> row{"neighbour", "1"};                             // row of Particles
  Column<Index> id{"neighbour_id", "1"};
  std::size_t rows() const { return row.data.size(); }
  static constexpr auto columns() { return std::tuple{&Neighbours::row, &Neighbours::id}; }
};

// Neighbours [first[p], first[p+1]) belong to particle p. One row per particle and one more at the end.
struct Neighbourhood {
  Column<Index> first{"first_neighbour", "1"};
  std::size_t rows() const { return first.data.size(); }
  static constexpr auto columns() { return std::tuple{&Neighbourhood::first}; }
};

// History of a contact whose law is chosen at run time (kernels/chosen_law.h); what its law does not remember stays zero.
struct ContactMemory {
  double greatest_overlap = 0;   // [m], of a hysteretic normal law
  Vec3 tangential;               // displacement of the spring [m], or force of Walton & Braun's law [N]
  Vec3 reversal;                 // force at which the slip last turned round, as part of mu F_n [1]
  Vec3 rolling;                  // elastic rolling moment [N m]
  friend bool operator==(const ContactMemory&, const ContactMemory&) = default;
};

// Pairs of particles that may touch before the next listing, id[i] < id[j]; sorted by the row i, then by id[j].
struct Contacts {
  Column<Index>  i{"i", "1"}, j{"j", "1"};                         // rows of Particles
  Column<Index>  partner{"partner", "1"};                          // id[j]
  Column<Index>  place_of_j{"place_of_j", "1"};                    // in the block of i, or contact_block + place among its guests
  Column<Vec3>   force{"contact_force", "N"};                      // on i, -force on j; zero where the pair does not touch
  Column<Vec3>   spring{"tangential_spring", "m"};                 // history: displacement in the tangent plane
  Column<Vec3>   rolling{"rolling_moment", "N m"};                 // on i, the opposite on j; history where it is elastic
  Column<ContactMemory> memory{"contact_memory", "m, N, N m"};     // history
  Column<Vec3>   moment{"whole_rolling_moment", "N m"};            // on i, with its dashpot: for the energy ledger, of a chosen law
  std::size_t rows() const { return i.data.size(); }
  static constexpr auto columns() {
    return std::tuple{&Contacts::i, &Contacts::j, &Contacts::partner, &Contacts::place_of_j, &Contacts::force,
                      &Contacts::spring, &Contacts::rolling, &Contacts::memory, &Contacts::moment};
  }
};

// History of the contacts before the last listing, by particle row at that time.
struct PreviousContacts {
  Column<Index> first{"previous_first_contact", "1"};
  Column<Index> partner{"previous_partner", "1"};
  Column<Vec3>  spring{"previous_tangential_spring", "m"};
  Column<Vec3>  rolling{"previous_rolling_moment", "N m"};
  Column<ContactMemory> memory{"previous_contact_memory", "m, N, N m"};
  std::size_t rows() const { return partner.data.size(); }
  static constexpr auto columns() {
    return std::tuple{&PreviousContacts::first, &PreviousContacts::partner, &PreviousContacts::spring, &PreviousContacts::rolling,
                      &PreviousContacts::memory};
  }
};

// Contacts [first[p], first[p+1]) have particle p as i. One row per particle and one more at the end.
struct Incidence {
  Column<Index> first{"first_contact", "1"};
  std::size_t rows() const { return first.data.size(); }
  static constexpr auto columns() { return std::tuple{&Incidence::first}; }
};

// Smooth DEM adds up the forces of contacts while it calculates them, block by block of particles: rows [k, k + 1) times this. A
// block's contacts are those whose i lies in it. Fixed, so that sums have the same bits for any number of threads.
inline constexpr std::size_t contact_block = 512;
inline constexpr std::size_t blocks_of(std::size_t particles) { return (particles + contact_block - 1) / contact_block; }

// What the contacts of its block do to particle p.
struct ContactSums {
  Column<Vec3> force{"sum_of_contact_forces", "N"};
  Column<Vec3> torque{"sum_of_contact_torques", "N m"};            // about the particle's centre
  std::size_t rows() const { return force.data.size(); }
  static constexpr auto columns() { return std::tuple{&ContactSums::force, &ContactSums::torque}; }
};

// What contacts do to a particle, on a cache line of its own.
struct alignas(64) PairSum { Four force, torque; };                // x y z [N], [N m], and a number of no use
inline Vec3 vector(const Four& row) { return {row[0], row[1], row[2]}; }

// Particles of other blocks that the contacts of a block meet: one row each, by block, then in the order in which they are met.
struct Guests {
  Column<Index> particle{"guest", "1"};                            // row of Particles
  Column<Index> halo_row{"halo_row", "1"};                         // its row of Halo
  std::size_t rows() const { return particle.data.size(); }
  static constexpr auto columns() { return std::tuple{&Guests::particle, &Guests::halo_row}; }
};
// The same, by the block in which they are at home, then as in Guests: what contacts of other blocks do to its particles.
struct Halo {
  Column<Index> particle{"halo_particle", "1"};                    // row of Particles
  Column<PairSum> sum{"halo_sum", "N, N m"};
  std::size_t rows() const { return particle.data.size(); }
  static constexpr auto columns() { return std::tuple{&Halo::particle, &Halo::sum}; }
};
// One row per block and one more: contacts of block k meet rows [guests[k], guests[k + 1]) of Guests, and rows
// [halo[k], halo[k + 1]) of Halo are of its particles.
struct HaloIncidence {
  Column<Index> guests{"first_guest", "1"}, halo{"first_halo_row", "1"};
  std::size_t rows() const { return guests.data.size(); }
  static constexpr auto columns() { return std::tuple{&HaloIncidence::guests, &HaloIncidence::halo}; }
};

// Places where a particle may touch a geometry of a rigid body before the next search; sorted by particle row, geometry,
// slot. An analytic shape has one slot, a mesh has several: a sphere in a corner touches it more than once.
struct BodyContacts {
  Column<Index>  particle{"particle", "1"};                        // row of Particles
  Column<Index>  geometry{"geometry", "1"};                        // row of Geometries
  Column<Index>  slot{"slot", "1"};                                // 0 for analytic shapes, 0 .. max_mesh_contacts - 1 for meshes
  Column<Index>  first_triangle{"first_triangle", "1"};            // mesh only: candidates [first, first + count) of Triangles
  Column<Index>  triangle_count{"triangle_count", "1"};
  Column<double> overlap{"overlap", "m"};                          // > 0 in contact
  Column<Vec3>   normal{"normal", "1"};                            // unit, from the body to the particle
  Column<double> curvature{"curvature", "1/m"};                    // of the body's surface: R_eff = 1 / (1/R + curvature)
  Column<Vec3>   force{"contact_force", "N"};                      // on the particle, -force on the body
  Column<Vec3>   torque{"contact_torque", "N m"};                  // on the particle
  Column<Vec3>   rolling_torque{"contact_rolling_torque", "N m"};  // its rolling part: the body gets the opposite
  Column<Vec3>   spring{"tangential_spring", "m"};                 // history
  Column<Vec3>   rolling{"rolling_moment", "N m"};                 // history
  Column<ContactMemory> memory{"contact_memory", "m, N, N m"};     // history
  std::size_t rows() const { return particle.data.size(); }
  static constexpr auto columns() {
    return std::tuple{&BodyContacts::particle, &BodyContacts::geometry, &BodyContacts::slot, &BodyContacts::first_triangle,
                      &BodyContacts::triangle_count, &BodyContacts::overlap, &BodyContacts::normal, &BodyContacts::curvature,
                      &BodyContacts::force, &BodyContacts::torque, &BodyContacts::rolling_torque, &BodyContacts::spring,
                      &BodyContacts::rolling, &BodyContacts::memory};
  }
};

// History of the body contacts before the last search, by particle row at that time.
struct PreviousBodyContacts {
  Column<Index>  first{"previous_first_body_contact", "1"};
  Column<Index>  geometry{"previous_geometry", "1"};
  Column<double> overlap{"previous_overlap", "m"};
  Column<Vec3>   normal{"previous_normal", "1"};
  Column<Vec3>   spring{"previous_tangential_spring", "m"};
  Column<Vec3>   rolling{"previous_rolling_moment", "N m"};
  Column<ContactMemory> memory{"previous_contact_memory", "m, N, N m"};
  std::size_t rows() const { return geometry.data.size(); }
  static constexpr auto columns() {
    return std::tuple{&PreviousBodyContacts::first, &PreviousBodyContacts::geometry, &PreviousBodyContacts::overlap,
                      &PreviousBodyContacts::normal, &PreviousBodyContacts::spring, &PreviousBodyContacts::rolling,
                      &PreviousBodyContacts::memory};
  }
};

// BodyContacts [first[p], first[p+1]) belong to particle p. One row per particle and one more at the end.
struct BodyIncidence {
  Column<Index> first{"first_body_contact", "1"};
  std::size_t rows() const { return first.data.size(); }
  static constexpr auto columns() { return std::tuple{&BodyIncidence::first}; }
};

// Candidate triangles of the mesh contacts, ascending within each contact.
struct Triangles {
  Column<Index> triangle{"triangle", "1"};
  std::size_t rows() const { return triangle.data.size(); }
  static constexpr auto columns() { return std::tuple{&Triangles::triangle}; }
};

enum class Motion : std::uint8_t { fixed, kinematic, dynamic };

// One row per rigid body; the origin of a dynamic body's frame is its centre of mass, its axes are principal axes.
struct Bodies {
  Column<Motion> motion{"motion", "1"};
  Column<Pose>   pose{"pose", "m, 1"};
  Column<Vec3>   velocity{"velocity", "m/s"};                      // of the origin of its frame
  Column<Vec3>   angular_velocity{"angular_velocity", "rad/s"};
  Column<Vec3>   force{"force", "N"};                              // of all contacts
  Column<Vec3>   torque{"torque", "N m"};                          // of all contacts, about the origin of its frame
  Column<Vec3>   acceleration{"acceleration", "m/s^2"};            // dynamic bodies
  Column<Vec3>   angular_acceleration{"angular_acceleration", "rad/s^2"};
  Column<Vec3>   previous_acceleration{"previous_acceleration", "m/s^2"};
  Column<Vec3>   previous_angular_acceleration{"previous_angular_acceleration", "rad/s^2"};
  Column<double> mass{"mass", "kg"};                               // dynamic bodies
  Column<Vec3>   inertia{"inertia", "kg m^2"};                     // dynamic bodies: principal moments
  Column<Pose>   searched{"pose_at_search", "m, 1"};
  std::size_t rows() const { return motion.data.size(); }
  static constexpr auto columns() {
    return std::tuple{&Bodies::motion, &Bodies::pose, &Bodies::velocity, &Bodies::angular_velocity, &Bodies::force,
                      &Bodies::torque,
                      &Bodies::acceleration, &Bodies::angular_acceleration, &Bodies::previous_acceleration,
                      &Bodies::previous_angular_acceleration, &Bodies::mass, &Bodies::inertia, &Bodies::searched};
  }
};

// One row per geometry of a rigid body; sorted by body.
struct Geometries {
  Column<Index> body{"body", "1"};                                 // row of Bodies
  Column<Shape> shape{"shape", "1"};
  Column<Pose>  local{"pose_in_body", "m, 1"};
  Column<Index> material{"material", "1"};
  std::size_t rows() const { return body.data.size(); }
  static constexpr auto columns() {
    return std::tuple{&Geometries::body, &Geometries::shape, &Geometries::local, &Geometries::material};
  }
};

// Pairs of geometries of different bodies, one of them dynamic, that may touch in this step: a < b, sorted.
struct RigidPairs {
  Column<Index> a{"geometry_a", "1"}, b{"geometry_b", "1"};        // rows of Geometries
  std::size_t rows() const { return a.data.size(); }
  static constexpr auto columns() { return std::tuple{&RigidPairs::a, &RigidPairs::b}; }
};

// Points where two rigid bodies touch or nearly do, made anew in every step: sorted by geometry_a, geometry_b, slot.
struct RigidContacts {
  Column<Index>  geometry_a{"geometry_a", "1"}, geometry_b{"geometry_b", "1"};   // rows of Geometries, a < b
  Column<Index>  slot{"slot", "1"};                                // 0, 1, ... within the pair
  Column<Index>  previous{"row_before", "1"};                      // the row of the last step that this one continues, or no_index
  Column<Vec3>   point{"contact_point", "m"};                      // halfway between the surfaces
  Column<Vec3>   normal{"normal", "1"};                            // unit, from b to a
  Column<double> overlap{"overlap", "m"};                          // > 0 in contact
  Column<double> radius_eff{"effective_radius", "m"};              // > 0: k = 4/3 E* sqrt(radius_eff) for this point
  Column<Vec3>   anchor_a{"anchor_a", "m"}, anchor_b{"anchor_b", "m"};   // the point in the frames of the bodies
  Column<Vec3>   force{"contact_force", "N"};                      // on a, at the point; -force on b
  Column<Vec3>   spring{"tangential_spring", "m"};                 // history: displacement in the tangent plane
  Column<ContactMemory> memory{"contact_memory", "m, N, N m"};     // history
  std::size_t rows() const { return geometry_a.data.size(); }
  static constexpr auto columns() {
    return std::tuple{&RigidContacts::geometry_a, &RigidContacts::geometry_b, &RigidContacts::slot, &RigidContacts::previous,
                      &RigidContacts::point, &RigidContacts::normal, &RigidContacts::overlap, &RigidContacts::radius_eff,
                      &RigidContacts::anchor_a, &RigidContacts::anchor_b, &RigidContacts::force, &RigidContacts::spring,
                      &RigidContacts::memory};
  }
};

// Particles sorted by the cell of a grid: cell c holds order[start[c] .. start[c+1]).
struct CellGrid {
  Column<Index> cell{"cell", "1"};                                 // of each particle
  Column<Index> start{"cell_start", "1"};
  Column<Index> order{"cell_order", "1"};                          // rows of Particles
  Column<Vec3>  position{"cell_position", "m"};                    // in that order, to be read in a stream
  Column<double> reach{"cell_reach", "m"};                         // in that order: radius + search_margin
  std::size_t rows() const { return cell.data.size(); }
  static constexpr auto columns() {
    return std::tuple{&CellGrid::cell, &CellGrid::start, &CellGrid::order, &CellGrid::position, &CellGrid::reach};
  }
};

// What the solver of nonsmooth DEM moves: a row per particle, one per row of BodyContacts - the place of the body that is
// touched - and one per rigid body.
struct SolverBodies {
  Column<SolverBody>     state{"solver_state", "m/s, 1/kg, rad/s, 1/(kg m^2)"};
  Column<InverseInertia> inverse_inertia{"inverse_inertia", "1/(kg m^2)"};   // by body; empty where none is dynamic
  std::size_t rows() const { return state.data.size(); }
  static constexpr auto columns() { return std::tuple{&SolverBodies::state, &SolverBodies::inverse_inertia}; }
};

// The contacts of dynamic rigid bodies: with particles by ascending (id, geometry, slot), then with bodies as in RigidContacts.
struct HubContacts {
  Column<HubContact> contact{"hub_contact", "1"};
  std::size_t rows() const { return contact.data.size(); }
  static constexpr auto columns() { return std::tuple{&HubContacts::contact}; }
};

// Cubes of space with the contacts of the particles in them, by colour: those of colour c are the blocks
// [first_of_colour[c], first_of_colour[c+1]) and have no particle in common (kernels/constraint_setup.h).
inline constexpr std::size_t block_colours = 8;
using BlockNeighbours = std::array<Index, 26>;                     // no_index where there is no block
struct ContactBlocks {
  Column<Buffer<ContactGroup>> groups{"contact_groups", "1"};
  Column<Buffer<GroupSource>>  sources{"group_sources", "1"};
  Column<SweepChange>          change{"sweep_change", "N s"};
  Column<Index>                contacts{"contacts_of_block", "1"};
  Column<Index>                impacts{"impacts_of_block", "1"};   // contacts that the impact stage turns round
  Column<BlockNeighbours>      neighbours{"neighbour_blocks", "1"};   // filled where there is an impact stage
  Column<Index>                first_of_colour{"first_of_colour", "1"};
  std::size_t rows() const { return groups.data.size(); }
  static constexpr auto columns() {
    return std::tuple{&ContactBlocks::groups, &ContactBlocks::sources, &ContactBlocks::change, &ContactBlocks::contacts,
                      &ContactBlocks::impacts, &ContactBlocks::neighbours, &ContactBlocks::first_of_colour};
  }
};

// One row: how the solver did.
struct Solver {
  Column<std::int64_t> contacts{"contacts_solved", "1", {0}};      // with rows in this step
  Column<std::int64_t> impacts{"impacts", "1", {0}};               // of them turned round by the impact stage
  Column<std::int64_t> sweeps{"sweeps", "1", {0}};                 // of the contact stage in this step ...
  Column<double>       residual{"residual", "1", {0}};             // ... and what its last one still changed, of all impulses
  Column<double>       error_left{"error_left", "1", {0}};         // part of a slow error that its sweeps leave
  Column<std::int64_t> impact_sweeps{"impact_sweeps", "1", {0}};
  Column<double>       impact_residual{"impact_residual", "1", {0}};
  Column<std::int64_t> unsolved{"steps_unsolved", "1", {0}};       // steps so far whose contact stage did not reach the tolerance ...
  Column<std::int64_t> impacts_unsolved{"impacts_unsolved", "1", {0}};   // ... and whose impact stage did not
  std::size_t rows() const { return 1; }
  static constexpr auto columns() {
    return std::tuple{&Solver::contacts, &Solver::impacts, &Solver::sweeps, &Solver::residual, &Solver::error_left, &Solver::impact_sweeps,
                      &Solver::impact_residual, &Solver::unsolved, &Solver::impacts_unsolved};
  }
};

// One row: the energy ledger, where the output asks for it (kernels/energy_ledger.h).
struct EnergyLedger {
  Column<StoredEnergy> stored{"stored_energy", "J", {StoredEnergy{}}};
  Column<StoredEnergy> at_start{"stored_energy_at_start", "J", {StoredEnergy{}}};
  Column<EnergyFlow>   flow{"energy_flow", "J", {EnergyFlow{}}};             // since the start
  Column<EnergyFlow>   power{"power", "W", {EnergyFlow{}}};                  // smooth DEM: of the state
  Column<EnergyFlow>   in_step{"energy_flow_in_step", "J", {EnergyFlow{}}};  // nonsmooth DEM: of the impulses
  Column<SolverBody>   before{"solver_state_before", "m/s, 1/kg, rad/s, 1/(kg m^2)"};   // nonsmooth DEM: the solver's stage
  Column<HeldEnergy>   of_pairs{"held_by_pairs", "J"};                       // by row of Contacts; empty unless particles are removed
  Column<HeldEnergy>   of_walls{"held_at_bodies", "J"};                      // the same of BodyContacts
  std::size_t rows() const { return 1; }
  static constexpr auto columns() {
    return std::tuple{&EnergyLedger::stored, &EnergyLedger::at_start, &EnergyLedger::flow, &EnergyLedger::power, &EnergyLedger::in_step,
                      &EnergyLedger::before, &EnergyLedger::of_pairs, &EnergyLedger::of_walls};
  }
};

// One row: the clock. Time is an integer times the time step, never a sum.
struct Clock {
  Column<std::int64_t> step{"step", "1", {0}};
  std::size_t rows() const { return 1; }
  static constexpr auto columns() { return std::tuple{&Clock::step}; }
};

// Bits that a step may set and the run loop reads.
enum class Trouble : std::uint32_t { none = 0, not_finite, too_fast, out_of_bounds };

// One row: the state of the search for candidates, and what watching the motion found.
struct Search {
  Column<char>         due{"search_due", "1", {1}};                // neighbours must be searched for in this step
  Column<char>         list_due{"listing_due", "1", {1}};          // contacts must be listed anew in this step
  Column<char>         left_margin{"left_margin", "1", {0}};       // seen by `integrate`: some particle left its margin ...
  Column<char>         unwell{"unwell", "1", {0}};                 // ... is out of bounds, too fast or no number
  Column<char>         rows_changed{"rows_changed", "1", {0}};     // particles came or went since the rows were last looked at
  Column<char>         reordered{"reordered", "1", {0}};           // in this step particles came or went, or their rows were sorted
  Column<std::int64_t> count{"searches", "1", {0}};                // searches so far, this one included
  Column<std::int64_t> listings{"listings", "1", {0}};             // of contacts, this one included
  Column<double>       reach{"reach", "m", {0}};                   // greatest distance of a particle from the origin at the last search
  Column<Trouble>      trouble{"trouble", "1", {Trouble::none}};
  Column<Index>        culprit{"culprit", "1", {no_index}};        // id of the particle in trouble
  Column<std::int64_t> outside{"outside", "1", {0}};               // particles outside the bounds
  std::size_t rows() const { return 1; }
  static constexpr auto columns() {
    return std::tuple{&Search::due, &Search::list_due, &Search::left_margin, &Search::unwell, &Search::rows_changed, &Search::reordered, &Search::count, &Search::listings,
                      &Search::reach, &Search::trouble, &Search::culprit, &Search::outside};
  }
};

// What was taken out so far: one row per remover (kernels/remove_particles.h).
struct Removed {
  Column<std::int64_t> count{"removed", "1"};
  Column<double>       mass{"removed_mass", "kg"};
  std::size_t rows() const { return count.data.size(); }
  static constexpr auto columns() { return std::tuple{&Removed::count, &Removed::mass}; }
};

// What was created so far: one row per inflow (kernels/emit_particles.h).
struct Created {
  Column<std::int64_t> count{"created", "1"};
  Column<double>       mass{"created_mass", "kg"};
  Column<std::int64_t> trials{"trial_places", "1"};                // places that were tried
  Column<std::int64_t> waiting{"waiting", "1"};                    // particles that are due and have found no room yet
  std::size_t rows() const { return count.data.size(); }
  static constexpr auto columns() { return std::tuple{&Created::count, &Created::mass, &Created::trials, &Created::waiting}; }
};

// What crossed an area so far, along its normal less against it: one row per area (kernels/count_crossings.h).
struct Crossed {
  Column<std::int64_t> count{"crossed", "1"};
  Column<double>       mass{"crossed_mass", "kg"};
  std::size_t rows() const { return count.data.size(); }
  static constexpr auto columns() { return std::tuple{&Crossed::count, &Crossed::mass}; }
};

// One row: ids are given once.
struct Population {
  Column<Index> next_id{"next_id", "1", {0}};
  std::size_t rows() const { return 1; }
  static constexpr auto columns() { return std::tuple{&Population::next_id}; }
};

using World = std::tuple<Particles, Neighbours, Neighbourhood, Contacts, PreviousContacts, Incidence, ContactSums, Guests, Halo,
                         HaloIncidence, BodyContacts, PreviousBodyContacts, BodyIncidence, Triangles,
                         Bodies, Geometries, RigidPairs, RigidContacts, CellGrid, SolverBodies, ContactBlocks, HubContacts, Solver, EnergyLedger, Clock, Search,
                         Removed, Created, Crossed, Population>;

}  // namespace skred
