// tests/scenes/scene_text.h - small scenes for the tests of their reader.
#pragma once
#include <filesystem>
#include <fstream>
#include <string>
#include "engine/io/temporary_folder.h"
#include "scenes/diagnostic.h"
#include "scenes/read_scene.h"

namespace skred {

inline const std::string head =
    "end_time: 1\n"
    "materials:\n"
    "  - {name: pellet, density: 3700, youngs_modulus: 6e6}\n";
inline const std::string one_particle = "particles: [{list: [{radius: 0.01, position: [0, 0, 0]}]}]\n";

// A lattice with `lines`, two blanks deeper than its key, in place of the usual ones.
inline std::string lattice(const std::string& lines) { return head + "particles:\n  - lattice:\n" + lines; }

// What the reader says about a scene called "s.yaml"; "" if it is well.
inline std::string errors_of(const std::string& text, const ReadOptions& options = {}, const std::string& path = "s.yaml") {
  try {
    parse_scene(text, path, options);
    return "";
  } catch (const SceneError& e) {
    return e.what();
  }
}

// A folder for the files of one test, gone afterwards.
struct SceneFolder : TemporaryFolder {
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path / name, std::ios::binary) << text;
    return (path / name).string();
  }
};

}  // namespace skred
