// tasks/guard.h - before the run: will this step, this solver and this material carry this scene?
//
// Estimates from the particles as they stand, each with a number and the limit that it should keep. They are rough - the weight
// of a bed is spread over the ground that its particles cover, arching at walls is left out - and meant to be on the safe side of
// what makes a run unstable or wrong, not of what merely costs accuracy.
#pragma once
#include <string>
#include <vector>
#include "tasks/time_step.h"

namespace skred {

struct Finding {
  enum class Verdict { fine, warning, unknown };
  std::string quantity;          // what was estimated
  std::string value, limit;      // with units; empty where it cannot be estimated
  Verdict verdict = Verdict::fine;
  std::string why;               // of a warning: what will go wrong and what helps; of the unknown: what is missing
};

// For the model's method and time step. `speed` [m/s]: of the fastest impact; `overlap_limit`: of the smaller radius, at which a run stops.
std::vector<Finding> guard(const World&, const Model&, double speed, double overlap_limit);

// The heap or bed that the particles will be, by their weight.
struct Bed {
  double ground = 0;             // [m^2] that the particles cover, at right angles to gravity
  double layers = 0;             // particles above one another: N d^2 / ground, of a column its number
  double pressure = 0;           // [Pa] weight / ground
  double force = 0;              // [N] between two particles at the bottom: pressure d^2, of a column its weight
  double overlap = 0;            // [m] of the softest pair under that force, Hertz 1882
  double radius = 0;             // [m] mean of the particles
};
Bed bed_of(const World&, const Model&);

}  // namespace skred
