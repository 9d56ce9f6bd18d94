// scenes/errors.h - the ways a run can fail, and the exit code of each.
#pragma once
#include <stdexcept>

namespace skred {

enum ExitCode { exit_ok = 0, exit_usage = 2, exit_scene = 3, exit_numerical = 4, exit_io = 5, exit_check = 6, exit_interrupted = 130 };

struct UsageError : std::runtime_error { using std::runtime_error::runtime_error; };
// The scene reads well but cannot be run as it is (time step too large, overlaps at the start, ...).
struct SceneRefused : std::runtime_error { using std::runtime_error::runtime_error; };
// The run became unphysical.
struct NumericalFailure : std::runtime_error { using std::runtime_error::runtime_error; };

}  // namespace skred
