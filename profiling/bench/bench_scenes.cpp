#include "profiling/bench/bench_scenes.h"
#include <algorithm>
#include "profiling/bench/scene_texts.h"
#include "profiling/bench/spawn.h"
#include "scenes/read_scene.h"

namespace skred {

namespace {

BenchScene column(const std::string& name, std::size_t count, std::int64_t steps) {
  return {.name = name, .what = "at rest in a cylinder of 0.4 m, " + std::to_string(steps) + " steps after it was dropped",
          .file = "profiling/bench/scenes/column.yaml", .particles = count, .settling_steps = steps,
          .spawn = [count] { return spawn_column(count, 0.2, pellet_radius); }};
}

BenchScene::Settings bed_size(std::size_t nx, std::size_t ny) {
  return {{"spheres_x", std::to_string(nx)}, {"spheres_y", std::to_string(ny)}};
}

BenchScene bed(const std::string& name, std::size_t nx, std::size_t ny, std::size_t nz) {
  return {.name = name, .what = "periodic bed, 6000 steps after it was dropped, when gravity tilts by 26 degrees",
          .file = "profiling/bench/scenes/bed.yaml", .particles = nx * ny * nz, .settings = bed_size(nx, ny),
          .settling = {{"tilt", "0"}}, .settling_steps = 6000, .spawn = [=] { return spawn_bed(nx, ny, nz, pellet_radius); }};
}

BenchScene tiled_bed(const std::string& name, std::size_t tiles_x, std::size_t tiles_y) {
  return {.name = name,
          .what = std::to_string(tiles_x) + " x " + std::to_string(tiles_y) + " tiles of bed-32k",
          .file = "profiling/bench/scenes/bed.yaml",
          .particles = 32000 * tiles_x * tiles_y,
          .settings = bed_size(40 * tiles_x, 40 * tiles_y),
          .tile = "bed-32k",
          .tiles_x = tiles_x,
          .tiles_y = tiles_y,
          .by_default = false};
}

Scene read(const BenchScene& s, BenchScene::Settings settings, const BenchScene::Settings& more) {
  settings.insert(settings.begin(), s.settings.begin(), s.settings.end());
  settings.insert(settings.end(), more.begin(), more.end());
  Scene scene = parse_scene(scene_text(s.file), s.file, {.overrides = settings});
  scene.name = s.name;
  return scene;
}

std::string quoted(const std::string& text) {        // for YAML
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? "''" : std::string(1, c);
  return out + "'";
}

}  // namespace

const std::vector<BenchScene>& bench_scenes() {
  static const std::vector<BenchScene> scenes = {
      // Dropped pellets bounce: a drum timed before 1.2 s is not dense.
      {.name = "drum", .what = "the thesis's drum at 1.2 s, turning; smooth wall", .file = "scenes/drum.yaml", .particles = 95052,
       .settings = {{"a", "10"}, {"wall", "cylinder"}}, .settling_steps = 24000},
      column("column-11k", 11000, 8000),
      column("column-100k", 100000, 12000),
      bed("bed-1k", 10, 10, 10),
      bed("bed-10k", 25, 20, 20),
      bed("bed-32k", 40, 40, 20),
      tiled_bed("bed-256k", 4, 2),
      tiled_bed("bed-1m", 8, 4),
      tiled_bed("bed-10m", 20, 16),
  };
  return scenes;
}

const BenchScene* find_bench_scene(const std::string& name) {
  const auto& all = bench_scenes();
  const auto found = std::find_if(all.begin(), all.end(), [&](const BenchScene& s) { return s.name == name; });
  return found == all.end() ? nullptr : &*found;
}

std::filesystem::path state_file(const std::filesystem::path& states, const BenchScene& s) {
  return states / (s.name + "-" + std::to_string(states_version) + ".h5");
}

Scene read_bench_scene(const BenchScene& s, const std::filesystem::path& state, const BenchScene::Settings& more) {
  return read(s,
              {{"particles", "[{file: {path: " + quoted(std::filesystem::absolute(state).string()) + ", radius: " +
                                 std::to_string(pellet_radius * 1e3) + " mm, material: pellet}}]"},
               {"start.overlap_limit", "1"}},         // what lies under others is squeezed
              more);
}

Scene read_bench_scene(const BenchScene& s, const BenchScene::Settings& more) { return read(s, {}, more); }

}  // namespace skred
