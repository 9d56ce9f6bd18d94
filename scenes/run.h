// scenes/run.h - `skred run`: a scene from its first step to its last, with everything a user sees and keeps of it.
#pragma once
#include <optional>
#include <string>
#include "engine/vector_path.h"
#include "scenes/scene.h"

namespace skred {

struct RunOptions {
  int threads = 1;
  std::string threads_reason;                        // how `auto` came to it; empty if given
  VectorPath vector_path = best_vector_path();
  std::string vector_reason;                         // likewise
  std::string output;                                // folder; empty: results/NAME-METHOD, numbered where taken
  bool overwrite = false, force = false, quiet = false, verbose = false;
  std::string trace, timeline, summary;              // files; empty: none
  std::optional<std::pair<std::int64_t, std::int64_t>> trace_steps;   // [first, last)
};

// Returns the exit code (scenes/errors.h). Throws IoError, SceneError, SceneRefused before the first step; later failures are
// reported, with all that was reached written.
int run_scene(const Scene&, const RunOptions&);

}  // namespace skred
