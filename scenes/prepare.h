// scenes/prepare.h - everything between reading a scene and its first step: particles, time step, start overlaps.
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "scenes/scene.h"
#include "tasks/guard.h"
#include "tasks/model.h"
#include "tasks/time_step.h"

namespace skred {

struct Prepared {
  World world;
  Model model;
  TimeStepAdvice advice;
  std::vector<std::string> notes;     // what was chosen, and why: for the log
  std::vector<std::string> warnings;
  std::vector<Finding> findings;      // what was estimated beforehand; those that warn are among the warnings
};

// The findings as a table, with a heading; empty if there are none.
std::string findings_table(const std::vector<Finding>&);

// Steps of `time_step` [s] in an interval [s], at least 1.
std::int64_t steps_in(double interval, double time_step);

// Throws SceneError (particles), SceneRefused (what cannot be run). `force_time_step` accepts a step beyond the limit.
Prepared prepare(const Scene&, bool force_time_step);

}  // namespace skred
