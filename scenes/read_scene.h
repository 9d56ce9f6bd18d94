// scenes/read_scene.h - from a scene file and the options of the command line to a Scene.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>
#include "scenes/diagnostic.h"
#include "scenes/scene.h"

namespace skred {

// What the command line changes. Values are text, read as if they stood in the file: "10", "50 us", "[0, 0, -1]".
struct ReadOptions {
  // --set path=value, in order. A path is dotted: keys, and indexes (from 0) or names of list items; a parameter's name
  // alone is enough: {"a", "10"}, {"materials.pellet.friction", "0"}, {"bodies.drum.pieces.0.velocity", "[1, 0, 0]"}.
  std::vector<std::pair<std::string, std::string>> overrides;
  std::optional<std::string> method, time_step, end_time, seed;   // --method, --time-step, --end-time, --seed
};

// Reads, checks and resolves a scene. Meshes are loaded, particle files only looked for. Throws SceneError with every error.
Scene read_scene(const std::string& path, const ReadOptions& options = {});

// The same for a scene in memory; `path` names it in errors and is where relative paths start.
Scene parse_scene(const std::string& text, const std::string& path, const ReadOptions& options = {});

}  // namespace skred
