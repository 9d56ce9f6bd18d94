#include "profiling/bench/settle.h"
#include <cstdio>
#include <unistd.h>
#include <fmt/format.h>
#include "profiling/bench/child.h"
#include "profiling/bench/spawn.h"
#include "profiling/bench/state_file.h"
#include "profiling/bench/trouble.h"
#include "profiling/readable.h"
#include "scenes/prepare.h"
#include "scenes/progress.h"
#include "tasks/sampling.h"

namespace skred {

namespace fs = std::filesystem;

namespace {

void write_start(const BenchScene& s, const fs::path& to) {
  State start{.scene = s.name, .position = s.spawn()};
  start.velocity.resize(start.position.size());
  start.angular_velocity.resize(start.position.size());
  start.radius.assign(start.position.size(), pellet_radius);
  write_state(to, start);
}

struct RemovedFile {                                         // at the end, whatever comes between
  fs::path path;
  ~RemovedFile() {                                               // and what a process left unfinished beside it
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(path.parent_path(), ignored))
      if (entry.path().filename().string().starts_with(path.filename().string())) fs::remove(entry.path(), ignored);
  }
};

void run(const BenchScene& s, const Scene& scene, const fs::path& to, int threads) {
  Prepared prepared = prepare(scene, false);
  Simulation sim(std::move(prepared.world), std::move(prepared.model), threads);
  const double end_time = double(s.settling_steps) * sim.model().time_step;
  Progress progress(end_time, s.particles, false,
                    [&](const std::string& line) { std::fprintf(stderr, "%s: %s\n", s.name.c_str(), line.c_str()); });
  sim.start();
  while (sim.steps_done() < s.settling_steps) {
    const bool show = progress.due(), last = sim.steps_done() + 1 == s.settling_steps;
    sim.step(Execution::graph, show || last ? Look::now : Look::later);
    check_sound(sim, s.name);
    if (!show) continue;
    const Measures m = measure(sim);
    progress.show({sim.time(), m.kinetic_energy, m.max_overlap_ratio, m.contacts + m.body_contacts, sim.steps_done()});
  }
  progress.finish();
  write_state(to, state_of(sim, s.name));
}

void tile(const BenchScene& s, const fs::path& from, const fs::path& to) {
  const State one = read_state(from);
  const double side = 40 * spawn_spacing(pellet_radius);     // of bed-32k
  State all{.scene = s.name,
            .steps = one.steps,
            .time_step = one.time_step,
            .position = tiled(one.position, side, side, s.tiles_x, s.tiles_y)};
  for (std::size_t k = 0; k < s.tiles_x * s.tiles_y; ++k) {
    all.velocity.insert(all.velocity.end(), one.velocity.begin(), one.velocity.end());
    all.angular_velocity.insert(all.angular_velocity.end(), one.angular_velocity.begin(), one.angular_velocity.end());
    all.radius.insert(all.radius.end(), one.radius.begin(), one.radius.end());
  }
  write_state(to, all);
}

}  // namespace

void ensure_state(const BenchScene& s, const fs::path& states, int threads, const InterruptGuard& interrupt) {
  const fs::path to = state_file(states, s);
  if (fs::exists(to)) return;
  make_states_folder(states);
  if (!s.tile.empty()) {
    const BenchScene& one = *find_bench_scene(s.tile);
    ensure_state(one, states, threads, interrupt);
    // Like settling, in a process of its own: this one stays small, so that the processes that it forks later do.
    return in_child([&] { tile(s, state_file(states, one), to); }, interrupt);
  }
  std::fprintf(stderr, "settling %s, once: %s particles, %lld steps on %d thread%s\n", s.name.c_str(),
               grouped_digits(std::int64_t(s.particles)).c_str(), static_cast<long long>(s.settling_steps), threads,
               threads == 1 ? "" : "s");
  const RemovedFile start{states / fmt::format("{}-start-{}.h5", s.name, getpid())};
  in_child([&] {
    if (s.spawn) write_start(s, start.path);
    run(s, s.spawn ? read_bench_scene(s, start.path, s.settling) : read_bench_scene(s, s.settling), to, threads);
  }, interrupt);
  std::fprintf(stderr, "%s\n", to.c_str());
}

}  // namespace skred
