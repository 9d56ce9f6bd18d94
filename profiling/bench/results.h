// profiling/bench/results.h - what was measured of a scene, and the numbers that people compare.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include "profiling/bench/limits.h"
#include "profiling/bench/spread.h"
#include "tasks/simulation.h"

namespace skred {

struct KernelTime {
  std::string name;
  double total = 0, busy = 0;               // [s] wall time of its calls; busy time of all threads in them
};

// How the solver of nonsmooth DEM did in some steps.
struct SolverWork {
  std::int64_t sweeps = 0, impact_sweeps = 0, unsolved = 0;   // unsolved: steps that stopped above the tolerance
  double contact_sweeps = 0;                // contacts times sweeps
  double residual = 0;                      // greatest
};

// Some steps without a break.
struct Window {
  int threads = 1;
  bool cold = false;                        // without warm start
  std::string execution;
  bool frame = false;                       // a frame was copied at its start, and written by its end
  std::int64_t steps = 0, searches = 0, listings = 0;
  double seconds = 0;
  double pairs = 0, wall_contacts = 0;      // that touch, mean of both ends
  double candidates = 0, wall_candidates = 0;
  std::vector<KernelTime> kernels;
  SolverWork solver;
};

// A process that ran the scene with so many threads.
struct Process {
  int threads = 1;
  bool nonsmooth = false;
  double time_step = 0;                     // [s]
  std::size_t particles = 0;
  double read_seconds = 0, first_step_seconds = 0;   // since it was started: scene and state read; first step done
  double memory_before = 0, memory = 0, peak_memory = 0;   // [byte] before reading; at the end; greatest
  std::string hash, last_hash;              // of the state after the warm-up; after all windows
};

// Measured rates and what the kernels would need of them (profiling/bench/roofline.h).
struct KernelBound {
  std::string name;
  double bytes = 0, flops = 0,
         roots = 0;  // a step: to and from memory; additions and multiplications; divisions and square roots
  double memory_seconds = 0, arithmetic_seconds = 0, measured_seconds = 0;   // a step
};
struct Roofline {
  int threads = 1;
  Limits limits;
  std::vector<KernelBound> kernels;
};

struct SceneResult {
  std::string name, what;
  std::vector<int> threads;
  std::vector<std::string> executions;      // the first is the one that rates and shares are of
  std::int64_t warm_up = 0, steps = 0;      // steps before the windows, and in each
  double load_before = 0, load_after = 0;
  std::vector<Process> processes;           // by thread count
  std::vector<Window> windows;              // in the order that they ran: of one repeat, all thread counts lie side by side
  std::vector<Roofline> rooflines;          // by thread count, if asked for

  bool nonsmooth() const { return !processes.empty() && processes.front().nonsmooth; }
  std::size_t particles() const { return processes.empty() ? 0 : processes.front().particles; }
};

// Throws NumericalFailure if the processes differ in this hash of the state after so many steps.
void check_agreement(const SceneResult&, std::string Process::* hash, std::int64_t steps);

// Rates of a scene with some threads and an execution. Windows with frames are left out.
struct Summary {
  int threads = 1;
  std::string execution;
  std::size_t windows = 0;
  std::int64_t steps = 0;                   // of all windows
  Spread rate;                              // particle-steps per second
  Spread step_seconds;                      // of a step
  Spread contact_nanoseconds;               // of a step, over the contacts that touch
  std::optional<Spread> efficiency;  // rate / (threads / fewest threads * rate of the window beside it with the fewest threads)
  double pairs = 0, wall_contacts = 0, candidates = 0, wall_candidates = 0;
  std::int64_t searches = 0, listings = 0;
  std::vector<KernelTime> kernels;          // [s] a step
};
Summary summarize(const SceneResult&, int threads, const std::string& execution);

// What the solver of nonsmooth DEM did with some threads.
struct SolverSummary {
  int threads = 1;
  bool cold = false;
  Spread rate;                              // contact sweeps per second: contacts times sweeps, over the time of the sweeps alone
  std::optional<Spread> efficiency;         // as in Summary
  Spread seconds_per_second;                // wall time of a simulated second
  double contacts = 0, sweeps = 0, impact_sweeps = 0;   // of a step
  double residual = 0;                      // greatest
  std::int64_t steps = 0, unsolved = 0;
  double detection = 0, setup = 0, impact = 0, solve = 0, rest = 0;   // shares of the kernels' wall time
};
SolverSummary summarize_solver(const SceneResult&, int threads, bool cold);

// What a frame costs: extra wall time of windows with one, over the windows beside them.
struct FrameCost { int threads = 1; Spread seconds; double share_of_1000_steps = 0; };
std::vector<FrameCost> frame_costs(const SceneResult&);

// Contacts per particle as LAMMPS and LIGGGHTS count them: every pair counts for both of its particles, walls do not count.
double coordination(const Summary&, std::size_t particles);

const char* execution_name(Execution);
std::optional<Execution> execution_of(const std::string& name);

}  // namespace skred
