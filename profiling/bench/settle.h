// profiling/bench/settle.h - makes the state that a scene is timed from, once.
#pragma once
#include <filesystem>
#include "profiling/bench/bench_scenes.h"

namespace skred {

class InterruptGuard;

// Does nothing where the state is there. Tells on standard error what is settled and for how long. Throws what a run throws.
void ensure_state(const BenchScene&, const std::filesystem::path& states, int threads, const InterruptGuard&);

}  // namespace skred
