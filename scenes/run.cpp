#include "scenes/run.h"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include "engine/io/io_error.h"
#include "engine/io/state_hash.h"
#include "profiling/chrome_trace.h"
#include "profiling/profile_table.h"
#include "profiling/timeline_svg.h"
#include "profiling/write_file.h"
#include "scenes/errors.h"
#include "scenes/flow_statistics.h"
#include "scenes/interrupt.h"
#include "scenes/machine.h"
#include "scenes/prepare.h"
#include "scenes/progress.h"
#include "scenes/recorder.h"
#include "scenes/schema.h"
#include "scenes/watch.h"

namespace skred {

namespace {

std::string hash_text(std::uint64_t h) { return fmt::format("{:016x}", h); }

std::shared_ptr<spdlog::logger> make_log(const OutputFolder& folder, const RunOptions& o) {
  auto screen = std::make_shared<spdlog::sinks::stderr_color_sink_mt>();
  screen->set_level(o.quiet ? spdlog::level::warn : o.verbose ? spdlog::level::debug : spdlog::level::info);
  screen->set_pattern("%^%v%$");
  auto file = std::make_shared<spdlog::sinks::basic_file_sink_mt>(folder.file("log.txt").string(), true);
  file->set_level(spdlog::level::debug);
  file->set_pattern("%Y-%m-%d %H:%M:%S %L %v");
  auto log = std::make_shared<spdlog::logger>("run", spdlog::sinks_init_list{screen, file});
  log->set_level(spdlog::level::debug);
  log->flush_on(spdlog::level::info);
  log->set_error_handler([](const std::string&) {});         // a full disk is reported by the writers of the results
  return log;
}

// How the solver of nonsmooth DEM did.
struct Sweeps {
  std::int64_t contact = 0, most = 0, impact = 0, contact_sweeps = 0;   // sums over the steps; contact_sweeps: contacts times sweeps
  std::int64_t not_falling = 0;                                          // steps whose changes hardly fell: their error is unknown
  double residual = 0, error = 0, impact_residual = 0;                   // greatest at the end of a step; of the others
  void add(const World& w) {
    const Solver& s = std::get<Solver>(w);
    contact += s.sweeps.data[0], impact += s.impact_sweeps.data[0];
    most = std::max(most, s.sweeps.data[0]);
    contact_sweeps += s.sweeps.data[0] * s.contacts.data[0];
    residual = std::max(residual, s.residual.data[0]);
    if (const double e = solver_error(w); e < 1) error = std::max(error, e);
    else ++not_falling;
    impact_residual = std::max(impact_residual, s.impact_residual.data[0]);
  }
};

// What the run loop works on.
struct Run {
  const Scene& scene;
  const RunOptions& options;
  Simulation& sim;
  Recorder& recorder;
  spdlog::logger& log;
  Progress& progress;
  std::int64_t steps = 0, every_frame = 0, every_row = 0;
  Measures last;
  std::int64_t reported_outside = 0;
  std::int64_t particle_steps = 0;
  Sweeps sweeps;
};

// Tells of particles outside when the first is, and whenever their number has doubled: they may be many.
void report_outside(Run& r) {
  const std::int64_t now = std::get<Search>(r.sim.world()).outside.data[0];
  if (now < std::max<std::int64_t>(1, 2 * r.reported_outside)) return;
  r.reported_outside = now;
  r.progress.finish();
  r.log.warn("t = {:g} s: {} particle{} outside the bounds", r.sim.time(), now, now == 1 ? "" : "s");
}

void take_row(Run& r) {
  r.last = r.recorder.statistics();
  check_measures(r.scene, r.sim, r.last);
}

void count_for_trace(Run& r, const Measures& m) {
  r.sim.timeline().counter("contacts", double(m.contacts + m.body_contacts));
  r.sim.timeline().counter("kinetic energy [J]", m.kinetic_energy + m.rotational_energy);
}

void add_solver(nlohmann::json& summary, const Run& r, const Timeline::Totals& totals) {
  if (r.scene.method != Method::ndem) return;
  const Solver& s = std::get<Solver>(r.sim.world());
  const double steps = std::max<double>(1, double(r.sim.steps_done()));
  double in_sweeps = 0;                                      // [s]
  for (const auto& k : totals.lines)
    if (k.name == "contact_solve") in_sweeps = k.total;
  summary["iterations"] = double(r.sweeps.contact) / steps;
  summary["most_iterations"] = r.sweeps.most;
  summary["impact_iterations"] = double(r.sweeps.impact) / steps;
  summary["residual"] = s.residual.data[0];
  summary["greatest_residual"] = r.sweeps.residual;
  summary["error"] = solver_error(r.sim.world());
  summary["greatest_error"] = r.sweeps.error;
  summary["steps_of_unknown_error"] = r.sweeps.not_falling;
  summary["steps_unsolved"] = s.unsolved.data[0];
  summary["greatest_impact_residual"] = r.sweeps.impact_residual;
  summary["impacts_unsolved"] = s.impacts_unsolved.data[0];
  summary["contact_sweeps"] = r.sweeps.contact_sweeps;
  summary["seconds_per_sweep"] = r.sweeps.contact > 0 ? in_sweeps / double(r.sweeps.contact) : 0;
}

// An inflow that finds no room does not do so in silence.
void warn_of_waiting(const Run& r) {
  const auto& waiting = std::get<Created>(r.sim.world()).waiting.data;
  for (std::size_t k = 0; k < waiting.size(); ++k)
    if (waiting[k] > 0)
      r.log.warn("inflow '{}': {} particle{} due found no room by the end: {} came", r.scene.inflow[k].name, waiting[k],
                 waiting[k] == 1 ? " that was" : "s that were", std::get<Created>(r.sim.world()).count.data[k]);
}

nlohmann::json make_summary(const Run& r, const std::string& outcome, double wall, const Timeline::Totals& totals) {
  const std::size_t particles = std::get<Particles>(r.sim.world()).rows();
  nlohmann::json summary = {{"scene", r.scene.name}, {"method", method_word(r.scene.method)}, {"outcome", outcome}, {"threads", r.sim.threads()},
          {"vector_path", name_of(r.sim.model().vector_path)}, {"particles", particles},
          {"bodies", std::get<Bodies>(r.sim.world()).rows()}, {"steps", r.sim.steps_done()}, {"time_step", r.sim.model().time_step},
          {"simulated_time", r.sim.time()}, {"wall_time", wall},
          {"particle_steps_per_second", wall > 0 ? double(r.particle_steps) / wall : 0.0},
          {"contacts", r.last.contacts + r.last.body_contacts}, {"max_overlap_ratio", r.last.max_overlap_ratio},
          {"kinetic_energy", r.last.kinetic_energy + r.last.rotational_energy}, {"state_hash", hash_text(r.sim.state_hash())},
          {"frames", r.recorder.frames()}, {"searches", std::get<Search>(r.sim.world()).count.data[0]},
          {"listings", std::get<Search>(r.sim.world()).listings.data[0]},
          {"particles_outside_bounds", std::get<Search>(r.sim.world()).outside.data[0]}, {"peak_memory", peak_memory()}, {"profiling_cost", totals.cost},
          {"software", "skred " SKRED_VERSION}, {"processor", processor_name()}, {"compiler", compiler_name()},
          {"load_average", load_average()}, {"kernels", profile_json(totals)}};
  add_solver(summary, r, totals);
  add_flow_summary(r.scene, r.sim, summary);
  if (r.scene.output.energy)
    for (const auto& [name, joules] : energy_columns(std::get<EnergyLedger>(r.sim.world()))) summary["energy"][name] = joules;
  return summary;
}

std::string error_text(const Sweeps& s) {
  if (s.not_falling == 0) return fmt::format("greatest error {:.2g}", s.error);
  const std::string known = s.error > 0 ? fmt::format("greatest error known {:.2g}; ", s.error) : "";
  return known + fmt::format("error unknown in {} steps, whose changes hardly fell from sweep to sweep", s.not_falling);
}

// A solver that stopped before its tolerance does not do so in silence.
std::string solver_text(const Run& r) {
  if (r.scene.method != Method::ndem) return "";
  const std::int64_t unsolved = std::get<Solver>(r.sim.world()).unsolved.data[0];
  const double steps = std::max<double>(1, double(r.sim.steps_done()));
  const std::int64_t impacts_unsolved = std::get<Solver>(r.sim.world()).impacts_unsolved.data[0];
  std::string text = fmt::format(", {:.1f} sweeps a step", double(r.sweeps.contact) / steps);
  if (unsolved > 0)
    text += fmt::format("; {} of {} steps stopped at {} sweeps above the tolerance {:g} (greatest residual {:.2g}) or the error tolerance {:g} "
                        "({})", unsolved, r.sim.steps_done(), r.scene.solver.iterations, r.scene.solver.tolerance, r.sweeps.residual,
                        error_tolerance_of(r.sim.model()), error_text(r.sweeps));
  if (impacts_unsolved > 0)
    text += fmt::format("; the impact stage of {} steps stopped at {} sweeps above the tolerance (greatest residual {:.2g})", impacts_unsolved,
                        r.scene.solver.impact_iterations, r.sweeps.impact_residual);
  return text;
}

void write_pictures(const Run& r) {
  const Timeline& t = r.sim.timeline();
  if (!r.options.trace.empty()) {
    TraceInfo info;
    info.scene = r.scene.name;
    info.method = r.scene.method == Method::ndem ? "NDEM" : "SDEM";
    info.software = "skred " SKRED_VERSION;
    info.processor = processor_name();
    info.other = {{"compiler", compiler_name()}, {"particles", std::to_string(std::get<Particles>(r.sim.world()).rows())}};
    if (t.steps().empty()) r.log.warn("trace: none of the steps asked for was run: the run has {}", r.sim.steps_done());
    write_chrome_trace(r.options.trace, t, info);
    r.log.info("trace: {} ({} steps)", r.options.trace, t.steps().size());
  }
  if (!r.options.timeline.empty()) {
    TimelineCaption c;
    c.scene = r.scene.name;
    c.method = r.scene.method == Method::ndem ? "NDEM" : "SDEM";
    c.processor = processor_name();
    c.particles = std::int64_t(std::get<Particles>(r.sim.world()).rows());
    c.contacts = std::int64_t(r.last.contacts + r.last.body_contacts);
    c.parts = {{"collision detection and hashing", {"count_crossings", "remove_particles", "emit_particles", "check_motion", "reorder", "broadphase", "contact_listing", "contact_hashing",
                                                    "broadphase_body", "contact_hashing_body", "contact_geometry_body",
                                                    "broadphase_body_body", "contact_geometry_body_body"}}};
    if (r.scene.method == Method::ndem)
      c.parts.push_back({"constraints and their solution", {"constraint_setup", "constraint_setup_body", "impact_solve", "contact_start",
                                                            "contact_solve", "impulse_application", "impulse_application_body"}});
    else
      c.parts.push_back({"force calculation and application", {"force_calculation_particle_particle", "force_calculation_particle_body",
                                                               "force_calculation_body_body", "force_application_particle",
                                                               "force_application_body"}});
    write_timeline_svg(r.options.timeline, t, c);
    r.log.info("timeline: {}", r.options.timeline);
  }
}

// Keeps the events of the asked-for steps, or of the last fifty.
void start_trace(const RunOptions& o, Simulation& sim, std::int64_t steps) {
  if (o.trace.empty() && o.timeline.empty()) return;
  constexpr std::int64_t last_steps = 50;
  if (o.trace_steps) sim.timeline().trace(o.trace_steps->first, o.trace_steps->second);
  else sim.timeline().trace(1, steps + 1, last_steps);
}

// The loop over the steps. Returns whether the run reached its end.
bool advance(Run& r, const InterruptGuard& interrupt) {
  const std::int64_t from = r.options.trace_steps ? r.options.trace_steps->first : r.steps - 50;
  const std::int64_t to = r.options.trace_steps ? r.options.trace_steps->second : r.steps + 1;
  const bool traced = !r.options.trace.empty();
  while (r.sim.steps_done() < r.steps) {
    const std::int64_t n = r.sim.steps_done() + 1;
    const bool row = n % r.every_row == 0 || n == r.steps, frame = r.every_frame > 0 && n % r.every_frame == 0;
    const bool counters = traced && n >= from && n < to && (row || n == from || n + 1 == to);   // more would disturb what is traced
    const bool show = r.progress.due(), stop = interrupt.asked();
    r.sim.timeline().begin_step(n);                          // sampling and copying frames are part of the step that does them
    r.sim.step(Execution::graph, row || frame || counters || show || stop ? Look::now : Look::later);
    r.sweeps.add(r.sim.world());
    r.particle_steps += std::int64_t(std::get<Particles>(r.sim.world()).rows());
    report_outside(r);
    check_trouble(r.scene, r.sim);
    if (row) take_row(r);
    if (frame) r.recorder.frame();
    if (counters) count_for_trace(r, measure(r.sim));
    r.sim.timeline().end_step();
    if (show) {
      const Measures m = measure(r.sim);
      r.progress.show({r.sim.time(), m.kinetic_energy, m.max_overlap_ratio, m.contacts + m.body_contacts, n});
    }
    if (stop && n < r.steps) return false;
  }
  return true;
}

// In the output folder files may be written.
bool is_in(const std::string& file, const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  return fs::absolute(file).parent_path().lexically_normal() == (fs::absolute(folder) / "").lexically_normal().parent_path();
}

}  // namespace

int run_scene(const Scene& scene, const RunOptions& options) {
  const std::filesystem::path output = options.output.empty() ? OutputFolder::next_free("results/" + scene.name + "-" + method_word(scene.method))
                                                              : std::filesystem::path(options.output);
  for (const std::string& file : {options.trace, options.timeline, options.summary})
    if (!file.empty() && !is_in(file, output)) check_writable(file);   // before the run rather than after it
  Prepared prepared = prepare(scene, options.force);         // a scene that is refused leaves no folder, and an old one alone
  const OutputFolder folder(output, options.overwrite);
  const auto log_owner = make_log(folder, options);
  spdlog::logger& log = *log_owner;
  const std::vector<std::string> notes = prepared.notes, warnings = prepared.warnings;

  prepared.model.vector_path = options.vector_path;
  Simulation sim(std::move(prepared.world), std::move(prepared.model), options.threads);
  const std::size_t particles = std::get<Particles>(sim.world()).rows();
  log.info("skred {}: scene '{}', {}, {} particles, {} bodies with {} geometries", SKRED_VERSION, scene.name, method_title(scene.method), particles,
           std::get<Bodies>(sim.world()).rows(), std::get<Geometries>(sim.world()).rows());
  const auto with_reason = [](const std::string& reason) { return reason.empty() ? "" : " (auto: " + reason + ")"; };
  log.info("threads {}{}; vector path {}{}", sim.threads(), with_reason(options.threads_reason), name_of(sim.model().vector_path),
           with_reason(options.vector_reason));
  for (const std::string& n : notes) log.info(n);
  for (const std::string& w : warnings) log.warn("warning: {}", w);
  for (const Effects::Reason& e : sim.effects().reasons) log.debug("{}: {}, {}", e.effect, e.in ? "in" : "out", e.why);
  log.info("output folder {}", folder.path().string());
  folder.write_text_atomically("scene.resolved.yaml", resolved_yaml(scene));

  const auto begin = std::chrono::steady_clock::now();
  InterruptGuard interrupt;
  sim.start();
  Recorder recorder(scene, sim, folder);
  Progress progress(scene.end_time, particles, options.quiet, [&](const std::string& line) { log.info(line); });
  Run r{scene, options, sim, recorder, log, progress};
  r.steps = steps_in(scene.end_time, sim.model().time_step);
  r.every_frame = scene.output.frame_interval > 0 ? steps_in(scene.output.frame_interval, sim.model().time_step) : 0;
  r.every_row = scene.output.statistics_interval > 0 ? steps_in(scene.output.statistics_interval, sim.model().time_step)
                                                     : std::max<std::int64_t>(1, r.steps / 100);
  start_trace(options, sim, r.steps);

  int code = exit_ok;
  std::string outcome = "finished";
  const auto failed = [&](int as, const std::string& what, const std::exception& e) {
    progress.finish();
    log.error("error: {}", e.what());
    code = as;
    outcome = what;
  };
  try {
    report_outside(r);
    check_trouble(scene, sim);
    take_row(r);
    recorder.frame();
    if (!advance(r, interrupt)) {
      progress.finish();
      log.warn("interrupted at t = {:g} s after {} steps; writing what there is", sim.time(), sim.steps_done());
      code = exit_interrupted;
      outcome = "interrupted";
    }
  } catch (const NumericalFailure& e) {
    failed(exit_numerical, "numerical failure", e);
  } catch (const std::exception& e) {                        // the disk, or memory
    failed(exit_io, "output error", e);
  }
  progress.finish();
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  try {                                                      // whatever happened, keep what there is
    if (code != exit_io) {
      r.last = recorder.statistics();
      recorder.frame();
      recorder.finish();
    }
  } catch (const std::exception& e) {
    failed(code == exit_numerical ? code : exit_io, code == exit_numerical ? outcome : "output error", e);
  }
  const Timeline::Totals totals = sim.timeline().totals();
  try {
    const std::string summary = make_summary(r, outcome, wall, totals).dump(2) + "\n";
    folder.write_text_atomically("summary.json", summary);
    if (!options.summary.empty()) write_file(options.summary, [&](std::ostream& out) { out << summary; });
    write_pictures(r);
  } catch (const std::exception& e) {
    failed(code == exit_ok ? exit_io : code, outcome, e);
  }
  log.info("\n{}", profile_table(totals, sim.threads()));
  warn_of_waiting(r);
  const double rate = wall > 0 ? double(r.particle_steps) / wall : 0;
  log.info("{} at t = {:g} s: {} steps in {}, {:.2f} million particle-steps per second{}, state hash {}", outcome, sim.time(), sim.steps_done(),
           duration_text(wall), rate * 1e-6, solver_text(r), hash_text(sim.state_hash()));
  return code;
}

}  // namespace skred
