// scenes/scene.h - what to simulate: a scene file, read, checked and resolved to SI numbers.
//
// The structs below are the scene file; scenes/schema.* holds the one table of keys, units, ranges, defaults and
// explanations from which the reader, the JSON Schema, `explain` and the resolved scene are made.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>
#include "engine/geometry/shape.h"
#include "engine/material.h"
#include "engine/region.h"
#include "kernels/contact_model.h"
#include "scenes/check/spec.h"
#include "tasks/method.h"

namespace skred {

struct MaterialSpec {
  std::string name;
  Material bulk;
  // Of a contact of the material with itself. A pair that the scene does not list gets the geometric mean of both
  // materials' values: equal values stay, zero stays zero.
  double restitution = 1, friction = 0, rolling_friction = 0;
  double rolling_damping = 0, rolling_damping_at_limit = 0;
  // What only some contact laws need, and then must have.
  std::optional<double> normal_stiffness, damping_time, tangential_damping, rolling_viscosity;
};

// Coefficients of a pair of materials; absent ones follow the rule above.
struct PairSpec {
  std::string first, second;
  std::optional<double> restitution, friction, rolling_friction, rolling_damping, rolling_damping_at_limit;
  std::optional<double> normal_stiffness, damping_time, tangential_damping, rolling_viscosity;
};

struct RadiusSpec { double min = 0, max = 0; };   // [m] uniform in [min, max]; equal for one size

struct CylinderCut { Vec3 point, axis{0, 0, 1}; double radius = 0; };   // spheres must lie inside whole

// Spheres on a cubic lattice. Along each direction floor((max - min - 2 R) / spacing) + 1 spheres fit, the block is centred in
// the box, and each coordinate is moved by a uniform random part of +-jitter * spacing.
struct LatticeFill {
  std::string material;
  RadiusSpec radius;
  Vec3 min, max;                        // [m] the box; spheres lie inside whole before the jitter
  double spacing = 0;                   // [m] > 0
  double jitter = 0;                    // 0 .. 0.5, part of the spacing
  std::optional<CylinderCut> cylinder;  // drop spheres that are not inside
  Vec3 velocity, angular_velocity;
};

struct ParticleSpec { std::string material; double radius = 0; Vec3 position, velocity, angular_velocity; };
struct ParticleList { std::vector<ParticleSpec> particles; };                  // written out in the scene

// CSV (header line names the columns) or HDF5 (datasets of these names): position or x, y, z [m]; optional velocity or vx,
// vy, vz; angular_velocity or wx, wy, wz; radius; material (name, or index into the scene's materials); id.
struct ParticleFile { std::string path; std::string material; std::optional<double> radius; };

using ParticleSource = std::variant<LatticeFill, ParticleList, ParticleFile>;

struct GeometrySpec {
  Shape shape;                 // meshes are loaded
  std::string material;
  Pose local;                  // in the body's frame
  std::string mesh_file;       // absolute path, for the resolved scene
  Vec3 mesh_scale{1, 1, 1};
};

// One piece of a prescribed motion: active for start <= t < end. A body's pieces apply in the order of the list; a
// rotation's point is carried along by later pieces.
struct MotionSpec {
  double start = 0, end = std::numeric_limits<double>::infinity();   // [s]
  Vec3 velocity;                               // [m/s]
  double angular_velocity = 0;                 // [rad/s] about the axis through the point
  Vec3 axis{0, 0, 1}, point;
  double frequency = 0;                        // [Hz] of a swing, whose greatest velocities the above are; 0: steady
  double phase = 0;                            // [rad]
};

enum class BodyMotion { fixed, kinematic, dynamic };

struct BodySpec {
  std::string name;
  BodyMotion motion = BodyMotion::fixed;
  Pose pose;
  std::vector<GeometrySpec> geometries;
  std::vector<MotionSpec> pieces;              // kinematic
  Vec3 velocity, angular_velocity;             // dynamic: at the start
  double mass = 0;                             // dynamic [kg] > 0
  std::optional<Vec3> inertia;                 // dynamic [kg m^2]; default: of the one sphere, box or cylinder it is made of
};

// Particles whose centre is in the region are taken out, at every `interval` (0: every step) from start on, before end.
struct RemoveSpec {
  std::string name;
  Region region;
  double start = 0, end = std::numeric_limits<double>::infinity();   // [s]
  double interval = 0;                                               // [s] >= 0
};

// Particles appear in the region, one of `rate` [1/s] and `mass_rate` [kg/s], where they overlap nothing.
struct InflowSpec {
  std::string name;
  Region region;                               // a box or cylinder
  std::string material;
  RadiusSpec radius;
  std::optional<double> rate, mass_rate;
  std::optional<int> number;                   // most particles
  double start = 0, end = std::numeric_limits<double>::infinity();   // [s]
  Vec3 velocity, angular_velocity;
  std::optional<std::uint64_t> seed;           // empty: the scene's
};

// A region in which statistics are taken, or an area at which crossings are counted.
struct ProbeSpec {
  std::string name;
  std::variant<BoxRegion, CylinderRegion, HalfSpaceRegion, Disc, Rectangle> place;
};

inline const char* method_word(Method m) { return m == Method::ndem ? "ndem" : "sdem"; }
inline const char* method_title(Method m) { return m == Method::ndem ? "nonsmooth DEM" : "smooth DEM"; }

struct PeriodicSpec { bool on = false; double min = 0, max = 0; };

enum class OutOfBounds { stop, report };

struct Scene {
  std::string name;                                  // letters, digits, '-', '_', '.'; default: the file's name
  std::string description;
  std::string file;                                  // where it was read from
  std::map<std::string, double> parameters;          // those that are numbers
  std::optional<CheckSpec> check;                    // what an experiment should show (skred check)
  Method method = Method::sdem;
  double end_time = 0;                               // [s] > 0
  std::optional<double> time_step;                   // [s]; empty: auto
  std::optional<double> expected_speed;              // [m/s] of the fastest impact, for the automatic step; empty: from the scene
  std::uint64_t seed = 1;
  Vec3 gravity{0, 0, -9.81};
  bool all_effects = false;                          // `effects: all` keeps every effect, even where its parameter is zero
  ContactModel contact;
  SolverOptions solver;                              // nonsmooth DEM
  std::optional<std::optional<double>> solver_time_step;   // [s] nonsmooth DEM; empty: time_step; holding an empty one: auto
  double overlap_tolerance = 0.05;                   // nonsmooth DEM: of the diameter, that the automatic step may let impacts reach
  std::array<PeriodicSpec, 3> periodic;
  std::optional<Bounds> bounds;
  OutOfBounds out_of_bounds = OutOfBounds::stop;
  std::vector<MaterialSpec> materials;
  std::vector<PairSpec> pairs;
  std::vector<ParticleSource> particles;
  std::vector<BodySpec> bodies;
  std::vector<RemoveSpec> remove;
  std::vector<InflowSpec> inflow;
  std::vector<ProbeSpec> probes;
  struct Start {
    double overlap_limit = 0.01;                     // of the smaller radius
    bool relax = false;                              // push overlapping particles apart before the first step
  } start;
  struct Limits {
    double overlap = 1.0;                            // of the smaller radius; a run with more stops
  } limits;
  struct SearchSpec {
    std::optional<double> skin, cell_size;           // [m]; empty: chosen by the program. No result depends on them.
    std::optional<int> reorder_every;                // steps; 0 never
  } search;
  struct Output {
    double frame_interval = 0;                       // [s]; 0: first and last frame only
    double statistics_interval = 0;                  // [s]; 0: a hundredth of the end time
    bool contacts = false;                           // contact forces in the frames
    bool orientation = false;                        // particle orientations, integrated only if asked for
    bool energy = false;                             // the energy ledger in the time series
    bool single_precision = true;                    // frames in 32 bits; checkpoints and statistics never
  } output;
};

}  // namespace skred
