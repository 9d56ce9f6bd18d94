// tasks/relax.h - pushes overlapping particles apart before a run starts, where smooth DEM would explode.
#pragma once
#include "tasks/model.h"

namespace skred {

struct Relaxation {
  int sweeps = 0;
  double overlap_before = 0, overlap_after = 0;   // greatest overlap / smaller radius
  double longest_shift = 0;                       // [m] of a particle
};

// Greatest overlap / smaller radius of the state as it stands, the id of a particle in that contact, and the id of its partner
// or the row of the body.
struct StartOverlap { double ratio = 0; Index particle = no_index, partner = no_index, body = no_index; };
StartOverlap start_overlap(const World& world, const Model& model);

// Moves particles - not bodies - by geometry alone, half of each overlap per particle and the whole of it from a body, until no
// overlap exceeds `limit` (of the smaller radius) or `most_sweeps` were made. Deterministic: all shifts of a sweep are
// worked out from the same positions, in order of id.
Relaxation relax(World& world, const Model& model, double limit, int most_sweeps = 20000);

}  // namespace skred
