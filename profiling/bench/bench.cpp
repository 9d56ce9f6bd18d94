#include "profiling/bench/bench.h"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <fmt/format.h>
#include "profiling/bench/bench_scenes.h"
#include "profiling/bench/roofline.h"
#include "profiling/bench/settle.h"
#include "profiling/bench/worker.h"
#include "scenes/diagnostic.h"
#include "scenes/errors.h"
#include "scenes/machine.h"
#include "scenes/read_scene.h"

namespace skred {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Bandwidth, bytes, rate)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Limits, bandwidth, flops, roots)

namespace {

ReadOptions read_options(const BenchOptions& o) {
  ReadOptions r;
  if (!o.method.empty()) r.method = o.method;
  return r;
}

std::function<Scene()> reader_of(const BenchOptions& o, const std::string& name) {
  if (const BenchScene* s = find_bench_scene(name)) {
    BenchScene::Settings more;
    if (!o.method.empty()) more.emplace_back("method", o.method);
    return [=, state = state_file(o.states, *s)] { return read_bench_scene(*s, state, more); };
  }
  return [=, options = read_options(o)] { return read_scene(name, options); };
}

// Steps that take about a second with the fewest threads.
std::int64_t steps_of_window(const BenchOptions& o, double step_seconds, bool nonsmooth) {
  constexpr double duration = 1;             // [s]
  const std::int64_t least = nonsmooth ? 5 : 20;
  return o.steps ? o.steps : std::max(least, std::int64_t(std::lround(duration / std::max(step_seconds, 1e-9))));
}

// Tells a terminal that something goes on.
struct Waiting {
  std::string scene;
  std::int64_t repeats;
  bool terminal = isatty(STDERR_FILENO);
  Waiting(const std::string& name, std::int64_t n) : scene(name), repeats(n) { show(0); }
  void show(std::int64_t done) const {
    if (terminal) std::fprintf(stderr, "\r\x1b[2Ktiming %s: %lld of %lld", scene.c_str(), (long long)done, (long long)repeats);
  }
  ~Waiting() { if (terminal) std::fprintf(stderr, "\r\x1b[2K"); }
};

void add_rooflines(SceneResult& r, const InterruptGuard& interrupt) {
  for (const int threads : r.threads) {
    const Summary s = summarize(r, threads, r.executions.front());
    const double bytes = largest_working_set(s, r.particles());
    Child child([&] { return [&](const nlohmann::json&) { return nlohmann::json(measure_limits(threads, bytes)); }; }, interrupt);
    r.rooflines.push_back(roofline(s, r.particles(), child.ask().get<Limits>()));
  }
}

SceneResult time_scene(const BenchOptions& o, const std::string& name, const InterruptGuard& interrupt) {
  const BenchScene* known = find_bench_scene(name);
  SceneResult r{.name = name, .what = known ? known->what : "scene file, from its start", .threads = o.threads};
  for (const Execution e : o.executions) r.executions.push_back(execution_name(e));
  r.load_before = load_average();

  // A process per thread count, so that peak memory is that of the scene. They take turns: the machine's speed drifts, and only
  // windows side by side can be compared. All do the same steps, so their states stay the same.
  using Team = std::vector<std::unique_ptr<Worker>>;
  const auto start = [&](bool cold) {
    Team team;
    for (const int threads : o.threads) {
      const WorkerJob job{name, reader_of(o, name), threads, cold, o.vector_path, o.executions, o.states / fmt::format("frames-{}", getpid()),
                          std::chrono::steady_clock::now()};
      team.push_back(std::make_unique<Worker>(job, interrupt));
      team.back()->start();
    }
    return team;
  };
  const auto take_processes = [&](const Team& team) {
    r.processes.clear();
    for (const auto& w : team) r.processes.push_back(w->process());
  };
  Team workers = start(false);
  const bool nonsmooth = workers.front()->process().nonsmooth;
  Team cold = nonsmooth ? start(true) : Team{};              // what the warm start is worth
  r.warm_up = o.warm_up ? o.warm_up : nonsmooth ? 20 : 100;
  for (Team* team : {&cold, &workers}) {
    for (auto& w : *team) {
      const double step_seconds = w->warm_up(r.warm_up);
      if (w == workers.front()) r.steps = steps_of_window(o, step_seconds, nonsmooth);
    }
    take_processes(*team);
    check_agreement(r, &Process::hash, r.warm_up);
  }

  Waiting waiting(name, o.repeats);
  for (std::int64_t k = 0; k < o.repeats; waiting.show(++k)) {
    for (const Execution e : o.executions)
      for (const bool frame : {false, true})
        if (!frame || (o.frames && e == o.executions.front()))
          for (auto& w : workers) r.windows.push_back(w->window(e, r.steps, frame));
    for (auto& w : cold) r.windows.push_back(w->window(o.executions.front(), r.steps, false));
  }

  for (Team* team : {&cold, &workers}) {
    for (auto& w : *team) w->finish();
    take_processes(*team);
    const auto steps = std::count_if(r.windows.begin(), r.windows.end(),
                                     [&](const Window& w) { return w.threads == o.threads.front() && w.cold == (team == &cold); });
    check_agreement(r, &Process::last_hash, r.warm_up + std::int64_t(steps) * r.steps);
    team->clear();
  }
  r.load_after = load_average();
  if (o.roofline) add_rooflines(r, interrupt);
  return r;
}

}  // namespace

void check_scenes(const BenchOptions& o) {
  std::vector<std::string> names;
  for (const BenchScene& s : bench_scenes()) names.push_back(s.name);
  for (const std::string& name : o.scenes) {
    if (find_bench_scene(name)) continue;
    std::error_code ignored;
    if (std::filesystem::exists(name, ignored)) read_scene(name, read_options(o));     // its errors now, not in minutes
    else
      throw UsageError(
          fmt::format("--scene: '{}' is neither a scene of the benchmark nor a file{}", name, suggestion(name, names)));
  }
}

void settle_all(const BenchOptions& o, const InterruptGuard& interrupt) {
  for (const std::string& name : o.scenes)
    if (const BenchScene* s = find_bench_scene(name)) ensure_state(*s, o.states, o.threads.back(), interrupt);
}

void time_all(const BenchOptions& o, const InterruptGuard& interrupt, const std::function<void(const SceneResult&)>& done) {
  for (const std::string& name : o.scenes) done(time_scene(o, name, interrupt));
}

double program_start_seconds() {
  const auto begin = std::chrono::steady_clock::now();
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  posix_spawn_file_actions_addopen(&quiet, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  char name[] = "skred", option[] = "--version";
  char* const words[] = {name, option, nullptr};
  pid_t process = 0;
  const bool started = ::posix_spawn(&process, "/proc/self/exe", &quiet, nullptr, words, environ) == 0;
  posix_spawn_file_actions_destroy(&quiet);
  if (!started) return 0;
  ::waitpid(process, nullptr, 0);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace skred
