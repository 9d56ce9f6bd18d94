// kernels/emit_particles.h - creates particles in a region at a given rate.
//
// A particle appears where it overlaps nothing: places are tried one after the other, from a seed and a counter, so that neither threads
// nor the order of rows leave a trace. What finds no room in a step waits for the next, and those behind it too: the sizes come in
// their order.
#pragma once
#include <limits>
#include <vector>
#include "engine/access.h"
#include "engine/periodic.h"
#include "engine/region.h"

namespace skred {

struct Inflow {
  Region region;                       // a box or cylinder; spheres lie inside whole
  double rate = 0, mass_rate = 0;      // [1/s], [kg/s]; one of them > 0
  double start = 0, end = std::numeric_limits<double>::infinity();   // [s]
  std::int64_t number = std::numeric_limits<std::int64_t>::max();    // most particles
  double radius_min = 0, radius_max = 0;                             // [m] uniform between them
  double density = 0;                  // [kg/m^3]
  Index material = 0;
  Vec3 velocity, angular_velocity;     // [m/s], [rad/s] at the start
  std::uint64_t seed = 0, stream = 0;  // of its random numbers
};

double radius_of(const Inflow&, std::int64_t k);       // [m] of its k-th particle, counted from 0
double mass_of(const Inflow&, double radius);          // [kg]

template <class Space> struct EmitParticles {
  static constexpr const char* name = "emit_particles";

  Space space;
  std::vector<Inflow> inflows;
  double time_step;                 // h [s]
  int steps_behind;                 // of the state, behind the clock: 1 where the step begins with this kernel
  Vec3 gravity;                     // [m/s^2]
  bool oriented, counted;           // which columns particles have (Particles::orientation, before)

  void operator()(Parallel parallel, Read<&Clock::step> step, Read<&Geometries::body> body, Read<&Geometries::shape> shape,
                  Read<&Geometries::local> local, Read<&Bodies::pose> pose, Update<&Search::rows_changed> changed,
                  Update<&Population::next_id> next_id, Update<&Created::count> count, Update<&Created::mass> mass,
                  Update<&Created::trials> trials, Update<&Created::waiting> waiting, Resize<Particles> particles,
                  Resize<Incidence> incidence, Resize<BodyIncidence> body_incidence) const;
};

extern template struct EmitParticles<OpenSpace>;
extern template struct EmitParticles<PeriodicSpace>;

}  // namespace skred
