// tasks/sampling.h - looking at a simulation without touching it: the numbers of the time series, and frames for the disk.
//
// Sums run in order of id, by chunks of ids, so they have the same bits for any number of threads and any skin.
#pragma once
#include <utility>
#include <vector>
#include "engine/io/frame.h"
#include "kernels/body_forces.h"
#include "tasks/simulation.h"

namespace skred {

struct Measures {
  double kinetic_energy = 0, rotational_energy = 0;   // [J]; translation only, rotation only
  double potential_energy = 0;                        // [J] in the uniform gravity, zero at the origin
  std::size_t contacts = 0, body_contacts = 0;        // that touch (kernels/body_forces.h)
  double coordination_number = 0;                     // contacts per particle, with other particles and with bodies
  double normal_force = 0, body_normal_force = 0;     // [N] sums of magnitudes
  double max_overlap_ratio = 0;                       // greatest overlap / smaller radius
  Index max_overlap_particle = no_index;              // id of a particle in that contact
  double mean_speed = 0, max_speed = 0;               // [m/s]
  double highest = 0;                                 // [m] greatest height of a particle's centre, against gravity (z without gravity)
  std::vector<BodyLoad> loads;                        // by body: from particles and other bodies
};

Measures measure(const Simulation&, Parallel = {});

// Of the particles whose centre is in a region; means are over particles, and 0 where there is none.
struct RegionMeasures {
  std::size_t count = 0;
  double mass = 0;                                    // [kg]
  double solid_fraction = 0;                          // volume of these particles / that of the region; 0 for a half-space
  Vec3 mean_velocity;                                 // [m/s]
  double mean_speed = 0;                              // [m/s]
  double granular_temperature = 0;                    // [m^2/s^2] <|v - <v>|^2> / 3
  double coordination_number = 0;                     // contacts per particle, bodies included
};
std::vector<RegionMeasures> measure_regions(const Simulation&, const std::vector<Region>&);

// The energy ledger by name [J] (engine/energy.h), the error by which it does not close last.
std::vector<std::pair<const char*, double>> energy_columns(const EnergyLedger&);

struct FrameOptions { bool contacts = false; };
Frame make_frame(const Simulation&, const FrameOptions&);

// What the solver of nonsmooth DEM reckons is left to be changed in its impulses, as part of their sum: its changes fell by some ratio
// from sweep to sweep, and go on so. Infinite where they do not fall, unless they are rounding; 0 in smooth DEM. From 1 on, where they
// hardly fall, it tells nothing but that.
double solver_error(const World&);

}  // namespace skred
