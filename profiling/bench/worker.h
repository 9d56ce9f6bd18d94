// profiling/bench/worker.h - runs a scene in a process of its own and tells how long its steps take.
#pragma once
#include <chrono>
#include <filesystem>
#include <functional>
#include "engine/vector_path.h"
#include "profiling/bench/child.h"
#include "profiling/bench/results.h"
#include "scenes/scene.h"

namespace skred {

struct WorkerJob {
  std::string name;                                   // of the scene
  std::function<Scene()> read;
  int threads = 1;
  bool cold = false;                                  // nonsmooth DEM without warm start
  VectorPath vector_path = VectorPath::scalar;
  std::vector<Execution> executions;                  // of the warm-up, in turn
  std::filesystem::path frames;                       // folder for frames; it is gone afterwards
  std::chrono::steady_clock::time_point started;      // just before the fork
};

// The process of a job, and what can be asked of it, in this order: start, warm_up, windows, finish.
class Worker {
 public:
  Worker(const WorkerJob&, const InterruptGuard&);

  Process start();                                    // reads the scene and does its first step
  // Steps in all ways of execution by turns, up to `step` since the start: whatever ran them, the hash of the state must be the
  // same. Returns the seconds of a step.
  double warm_up(std::int64_t step);
  Window window(Execution, std::int64_t steps, bool frame);
  void finish();

  const Process& process() const { return process_; }

 private:
  Process process_;
  Child child_;
};

}  // namespace skred
