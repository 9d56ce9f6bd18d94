#include "profiling/bench/worker.h"
#include <algorithm>
#include "engine/io/output_folder.h"
#include "profiling/bench/trouble.h"
#include "scenes/machine.h"
#include "scenes/prepare.h"
#include "scenes/recorder.h"
#include "tasks/sampling.h"

namespace skred {

using nlohmann::json;

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(KernelTime, name, total, busy)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SolverWork, sweeps, impact_sweeps, unsolved, contact_sweeps, residual)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Window, threads, cold, execution, frame, steps, searches, listings, seconds, pairs, wall_contacts,
                                   candidates, wall_candidates, kernels, solver)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Process, threads, nonsmooth, time_step, particles, read_seconds, first_step_seconds, memory_before, memory,
                                   peak_memory, hash, last_hash)

namespace {

using SteadyClock = std::chrono::steady_clock;
double seconds_since(SteadyClock::time_point t) { return std::chrono::duration<double>(SteadyClock::now() - t).count(); }

struct Touching { double pairs, walls; };
Touching touching(const Simulation& sim) {
  const Measures m = measure(sim);
  return {double(m.contacts), double(m.body_contacts)};
}

struct RemovedFolder {
  std::filesystem::path path;
  ~RemovedFolder() { std::error_code ignored; std::filesystem::remove_all(path, ignored); }
};

// The child's side.
class Runner {
 public:
  explicit Runner(const WorkerJob& job) : job_(job) {
    process_.threads = job.threads;
    process_.memory_before = resident_memory();
    scene_ = job.read();
    if (job.cold) scene_.solver.warm_start = false;
    Prepared prepared = prepare(scene_, false);
    prepared.model.vector_path = job.vector_path;
    process_.read_seconds = seconds_since(job.started);
    sim_ = std::make_unique<Simulation>(std::move(prepared.world), std::move(prepared.model), job.threads);
    process_.particles = std::get<Particles>(sim_->world()).rows();
    process_.nonsmooth = scene_.method == Method::ndem;
    process_.time_step = sim_->model().time_step;
    sim_->start();
    step(job.executions.front());
    process_.first_step_seconds = seconds_since(job.started);
  }

  json answer(const json& request) {
    const std::string what = request["do"];
    if (what == "warm_up") return warm_up(request["step"]);
    if (what == "window") return window(*execution_of(request["execution"]), request["steps"], request["frame"]);
    if (what == "finish") return finish();
    return process_;
  }

 private:
  // As the loop of a run does it, kernels and the time between them.
  void step(Execution how, Look look = Look::now) {
    sim_->timeline().begin_step(sim_->steps_done() + 1);
    sim_->step(how, look);
    sim_->timeline().end_step();
    check_sound(*sim_, job_.name);
    const Solver& s = std::get<Solver>(sim_->world());       // zeros in smooth DEM
    solver_.sweeps += s.sweeps.data[0];
    solver_.impact_sweeps += s.impact_sweeps.data[0];
    solver_.contact_sweeps += double(s.sweeps.data[0]) * double(s.contacts.data[0]);
    solver_.residual = std::max(solver_.residual, s.residual.data[0]);
  }

  json warm_up(std::int64_t last) {
    const auto begin = SteadyClock::now();
    const std::int64_t first = sim_->steps_done();
    while (sim_->steps_done() < last) {
      const std::int64_t n = sim_->steps_done() + 1;
      step(job_.executions[std::size_t(n - 1) % job_.executions.size()], n < last ? Look::later : Look::now);
    }
    const double seconds = seconds_since(begin);
    process_.hash = hash();
    return {{"step_seconds", seconds / double(std::max<std::int64_t>(1, sim_->steps_done() - first))}, {"hash", process_.hash}};
  }

  json window(Execution how, std::int64_t steps, bool frame) {
    Window w{.threads = job_.threads, .cold = job_.cold, .execution = execution_name(how), .frame = frame, .steps = steps};
    const Search& search = std::get<Search>(sim_->world());
    const Touching first = touching(*sim_);
    const std::int64_t searches = search.count.data[0], listings = search.listings.data[0];
    const Column<std::int64_t>& unsolved = std::get<Solver>(sim_->world()).unsolved;
    const std::int64_t unsolved_before = unsolved.data[0];
    solver_ = {};
    const Timeline::Totals before = sim_->timeline().totals();
    w.seconds = frame ? timed_steps_with_frame(how, steps) : timed_steps(how, steps);
    const Timeline::Totals after = sim_->timeline().totals();
    w.solver = solver_;
    w.solver.unsolved = unsolved.data[0] - unsolved_before;
    const Touching last = touching(*sim_);
    w.searches = search.count.data[0] - searches;
    w.listings = search.listings.data[0] - listings;
    w.pairs = 0.5 * (first.pairs + last.pairs);
    w.wall_contacts = 0.5 * (first.walls + last.walls);
    w.candidates = double(std::get<Contacts>(sim_->world()).rows());
    w.wall_candidates = double(std::get<BodyContacts>(sim_->world()).rows());
    for (const Timeline::Line& l : after.lines) {
      const auto same =
          std::find_if(before.lines.begin(), before.lines.end(), [&](const Timeline::Line& b) { return b.name == l.name; });
      const Timeline::Line old = same == before.lines.end() ? Timeline::Line{} : *same;
      if (!l.writer && l.count > old.count) w.kernels.push_back({l.name, l.total - old.total, l.busy - old.busy});
    }
    return w;
  }

  // Nobody looks at any state but the last.
  void run(Execution how, std::int64_t steps) {
    for (std::int64_t k = 1; k <= steps; ++k) step(how, k < steps ? Look::later : Look::now);
  }

  double timed_steps(Execution how, std::int64_t steps) {
    const auto begin = SteadyClock::now();
    run(how, steps);
    return seconds_since(begin);
  }

  // With the copy of the frame, and until it is on its way to the disk. Making the file is not timed: a run does that once.
  double timed_steps_with_frame(Execution how, std::int64_t steps) {
    const RemovedFolder folder{job_.frames};
    Recorder recorder(scene_, *sim_, OutputFolder(folder.path, true));
    const auto begin = SteadyClock::now();
    recorder.frame();
    run(how, steps);
    recorder.finish();
    return seconds_since(begin);
  }

  json finish() {
    process_.last_hash = hash();
    process_.memory = resident_memory();
    process_.peak_memory = skred::peak_memory();
    return process_;
  }

  std::string hash() const {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(sim_->state_hash()));
    return text;
  }

  WorkerJob job_;
  Scene scene_;
  Process process_;
  SolverWork solver_;                                        // since a window began
  std::unique_ptr<Simulation> sim_;
};

}  // namespace

Worker::Worker(const WorkerJob& job, const InterruptGuard& interrupt)
    : child_([&job] { return [runner = std::make_shared<Runner>(job)](const json& request) { return runner->answer(request); }; },
             interrupt) {}

Process Worker::start() { return process_ = child_.ask({{"do", "start"}}).get<Process>(); }

double Worker::warm_up(std::int64_t step) {
  const json answer = child_.ask({{"do", "warm_up"}, {"step", step}});
  process_.hash = answer["hash"];
  return answer["step_seconds"];
}

Window Worker::window(Execution how, std::int64_t steps, bool frame) {
  return child_.ask({{"do", "window"}, {"execution", execution_name(how)}, {"steps", steps}, {"frame", frame}}).get<Window>();
}

void Worker::finish() { process_ = child_.ask({{"do", "finish"}}).get<Process>(); }

}  // namespace skred
