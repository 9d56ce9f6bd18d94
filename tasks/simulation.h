// tasks/simulation.h - a world, the task that advances it, and the threads it runs on.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>
#include "tasks/model.h"
#include "tasks/task.h"

namespace skred {

enum class Execution { graph, list, serial };
enum class Look { now, later };

class Simulation {
 public:
  // `threads` >= 1. The world's particles, bodies and geometries are filled in; everything else is made here.
  Simulation(World world, Model model, int threads);
  Simulation(const Simulation&) = delete;         // the task points into the world
  Simulation& operator=(const Simulation&) = delete;

  void start();                                     // contacts and forces of the state at step 0; call once, first
  // Look::later: nobody reads the state before the next step, which may have begun already. In trouble it has not.
  void step(Execution = Execution::graph, Look = Look::now);
  void step_in_order(std::span<const std::size_t> order);

  std::int64_t steps_done() const { return std::get<Clock>(world_).step.data[0]; }
  double time() const { return double(steps_done()) * model_.time_step; }   // [s]

  const World& world() const { return world_; }
  World& world() { return world_; }
  const Model& model() const { return model_; }
  const Effects& effects() const { return effects_; }
  Task& task() { return *tasks_[false][false]; }
  Timeline& timeline() { return timeline_; }
  int threads() const { return threads_; }

  // Runs f in the arena of this simulation, so that its parallel loops use the same threads.
  template <class F> auto inside(F&& f) { return arena_.execute(std::forward<F>(f)); }

  // 64-bit hash over the state that determines everything to come, in order of id: equal hashes, equal trajectories.
  std::uint64_t state_hash() const;

 private:
  World world_;
  Model model_;
  Effects effects_;
  int threads_;
  tbb::global_control limit_;
  tbb::task_arena arena_;
  Timeline timeline_;
  std::unique_ptr<Task> tasks_[2][2];             // [moved][moves on] (tasks/steps.h)
  bool moved_ = false;                            // positions and velocities are on their way to the next step
};

// Rows of the particles in the order of their ids, which have gaps where particles were removed.
std::vector<Index> rows_by_id(const Particles&);

// Threads that `auto` means: those of the affinity mask, or fewer if the control group's processor quota says so.
struct ThreadChoice { int threads; std::string reason; };
ThreadChoice automatic_threads();

}  // namespace skred
