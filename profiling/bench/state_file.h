// profiling/bench/state_file.h - settled states on disk: HDF5 files that a scene's `particles: - file:` reads.
//
// Datasets position, velocity, angular_velocity (n x 3) and radius (n), float64, SI, row = id; attributes scene, steps,
// time_step, software. A file is whole or not there.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>
#include "engine/vec3.h"
#include "tasks/simulation.h"

namespace skred {

struct State {
  std::string scene;
  std::int64_t steps = 0;                  // since it was dropped
  double time_step = 0;                    // [s]
  std::vector<Vec3> position, velocity, angular_velocity;
  std::vector<double> radius;              // [m]
};

State state_of(const Simulation&, const std::string& scene);
State read_state(const std::filesystem::path&);                       // throws IoError
void write_state(const std::filesystem::path&, const State&);         // throws IoError

// Makes the folder, and finds out whether files can be written there. Throws IoError.
void make_states_folder(const std::filesystem::path&);

}  // namespace skred
