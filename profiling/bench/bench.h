// profiling/bench/bench.h - what `skred bench` does: settles what is not there, then times scene after scene.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>
#include "engine/vector_path.h"
#include "profiling/bench/results.h"
#include "scenes/scene.h"

namespace skred {

class InterruptGuard;

struct BenchOptions {
  std::vector<std::string> scenes;                    // names, or paths of scene files
  std::vector<int> threads;                           // ascending
  std::vector<Execution> executions;                  // the first is the one that rates and shares are of
  std::int64_t warm_up = 0;                           // 0: 100 steps, of nonsmooth DEM 20
  std::int64_t repeats = 5, steps = 0;                // steps of a window; 0: about a second
  VectorPath vector_path = best_vector_path();
  std::string method;                                 // empty: what the scenes say
  std::filesystem::path states;
  bool frames = false, roofline = false;
};

// Throws UsageError for a scene that is neither a name nor a file.
void check_scenes(const BenchOptions&);

void settle_all(const BenchOptions&, const InterruptGuard&);

// Times the scenes and hands over each result when it is there. Throws NumericalFailure if thread counts or ways of execution
// disagree about the state, Interrupted, and what a run throws.
void time_all(const BenchOptions&, const InterruptGuard&, const std::function<void(const SceneResult&)>& done);

// From starting a process of this program to its end, doing nothing [s].
double program_start_seconds();

}  // namespace skred
