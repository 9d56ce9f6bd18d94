// profiling/bench/bench_scenes.h - what `skred bench` times: the scenes, and how each one's settled state comes about.
//
// Materials and geometry are in scene files that `skred run` runs too. Their texts are in the program (bench_scenes.cpp.in), so
// it needs no file beside it and works from any folder.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>
#include "engine/vec3.h"
#include "scenes/scene.h"

namespace skred {

inline constexpr double pellet_radius = 6.36665e-3;      // [m] Pettersson 2015, table 4.1; the scene files say it too

struct BenchScene {
  using Settings = std::vector<std::pair<std::string, std::string>>;   // as for --set

  std::string name;
  std::string what;                         // in words, for --list
  std::string file;                         // of the scene, from the root of the sources
  std::size_t particles = 0;
  Settings settings;                        // of every run of it
  Settings settling;                        // only while it settles
  std::int64_t settling_steps = 0;
  std::function<std::vector<Vec3>()> spawn; // positions that settling starts from; empty: those of the scene file
  std::string tile;                         // made of another scene's state, this many times along x and y
  std::size_t tiles_x = 1, tiles_y = 1;
  bool by_default = true;                   // timed unless scenes are named
};

const std::vector<BenchScene>& bench_scenes();
const BenchScene* find_bench_scene(const std::string& name);   // null: none of that name

// Where the state is kept. The version counts changes of the scenes and of the physics that make old states useless.
inline constexpr int states_version = 1;
std::filesystem::path state_file(const std::filesystem::path& states, const BenchScene&);

// The scene with its particles from a file of positions, velocities and spins.
Scene read_bench_scene(const BenchScene&, const std::filesystem::path& state, const BenchScene::Settings& more);
// The scene with the particles of its scene file.
Scene read_bench_scene(const BenchScene&, const BenchScene::Settings& more);

}  // namespace skred
