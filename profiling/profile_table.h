// profiling/profile_table.h - what the kernels cost, as the table at the end of every run and as JSON for its summary.
#pragma once
#include <string>
#include <nlohmann/json_fwd.hpp>
#include "profiling/timeline.h"

namespace skred {

// A line per kernel, the costliest first, then the whole and what measuring cost. Shares are of the busy time of all kernels;
// efficiency is busy / (threads * total); idle is the time that threads spent without work while the kernel ran.
// Ends with a newline. `threads`: of the arena, at least 1.
std::string profile_table(const Timeline::Totals& totals, int threads);

// [{name, count, total, mean, median, p95, max, share, efficiency, idle, rows}] in seconds, in the order of the step.
nlohmann::json profile_json(const Timeline::Totals& totals);

}  // namespace skred
