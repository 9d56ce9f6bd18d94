#include <algorithm>
#include <nlohmann/json.hpp>
#include "profiling/bench/report.h"

namespace skred {

using nlohmann::json;

namespace {

json json_of(const Spread& s) { return {{"median", s.median}, {"min", s.least}, {"max", s.most}}; }

json json_of(const Summary& s, const SceneResult& r) {
  const auto n = double(std::max<std::size_t>(1, r.particles()));
  double busy = 0;
  for (const KernelTime& k : s.kernels) busy += k.busy;
  json kernels = json::array();
  for (const KernelTime& k : s.kernels)
    kernels.push_back({{"name", k.name},
                       {"seconds_per_step", k.total},
                       {"busy_seconds_per_step", k.busy},
                       {"share", busy > 0 ? k.busy / busy : 0}});
  json out{{"threads", s.threads}, {"execution", s.execution}, {"windows", s.windows}, {"steps", s.steps},
           {"particle_steps_per_second", json_of(s.rate)}, {"seconds_per_step", json_of(s.step_seconds)},
           {"ns_per_contact_and_step", json_of(s.contact_nanoseconds)}, {"contacts_per_particle", coordination(s, r.particles())},
           {"wall_contacts_per_particle", s.wall_contacts / n}, {"candidates_per_particle", s.candidates / n},
           {"wall_candidates_per_particle", s.wall_candidates / n}, {"searches", s.searches},
           {"steps_per_search", s.searches ? json(double(s.steps) / double(s.searches)) : json()}, {"listings", s.listings},
           {"steps_per_listing", s.listings ? json(double(s.steps) / double(s.listings)) : json()}, {"kernels", kernels}};
  out["efficiency"] = s.efficiency ? json_of(*s.efficiency) : json();
  return out;
}

json json_of(const SolverSummary& s) {
  return {{"threads", s.threads},
          {"warm_start", !s.cold},
          {"contact_sweeps_per_second", json_of(s.rate)},
          {"efficiency", s.efficiency ? json_of(*s.efficiency) : json()},
          {"wall_seconds_per_simulated_second", json_of(s.seconds_per_second)},
          {"contacts", s.contacts},
          {"sweeps_per_step", s.sweeps},
          {"impact_sweeps_per_step", s.impact_sweeps},
          {"residual", s.residual},
          {"steps", s.steps},
          {"steps_unsolved", s.unsolved},
          {"shares", {{"detection", s.detection}, {"setup", s.setup}, {"impact", s.impact}, {"solve", s.solve}, {"rest", s.rest}}}};
}

json json_of(const Process& p) {
  const auto n = double(std::max<std::size_t>(1, p.particles));
  return {{"threads", p.threads},
          {"seconds_to_read", p.read_seconds},
          {"seconds_to_first_step", p.first_step_seconds},
          {"memory_before_reading", p.memory_before},
          {"memory", p.memory},
          {"peak_memory", p.peak_memory},
          {"peak_bytes_per_particle", (p.peak_memory - p.memory_before) / n},
          {"bytes_per_particle", (p.memory - p.memory_before) / n},
          {"state_hash", p.hash},
          {"last_state_hash", p.last_hash}};
}

json json_of(const Window& w) {
  return {{"threads", w.threads}, {"warm_start", !w.cold}, {"execution", w.execution}, {"frame", w.frame}, {"steps", w.steps}, {"seconds", w.seconds},
          {"searches", w.searches}, {"listings", w.listings}, {"pairs", w.pairs}, {"wall_contacts", w.wall_contacts}};
}

json json_of(const Roofline& f) {
  json kernels = json::array();
  for (const KernelBound& k : f.kernels)
    kernels.push_back({{"name", k.name},
                       {"bytes", k.bytes},
                       {"flops", k.flops},
                       {"roots", k.roots},
                       {"memory_seconds", k.memory_seconds},
                       {"arithmetic_seconds", k.arithmetic_seconds},
                       {"predicted_seconds", std::max(k.memory_seconds, k.arithmetic_seconds)},
                       {"measured_seconds", k.measured_seconds},
                       {"bound", k.memory_seconds > k.arithmetic_seconds ? "memory" : "arithmetic"}});
  json bandwidth = json::array();
  for (const Bandwidth& b : f.limits.bandwidth) bandwidth.push_back({{"bytes", b.bytes}, {"bytes_per_second", b.rate}});
  return {{"threads", f.threads},
          {"bandwidth", bandwidth},
          {"flops_per_second", f.limits.flops},
          {"roots_per_second", f.limits.roots},
          {"kernels", kernels}};
}

template <class T> json list_of(const std::vector<T>& all) {
  json out = json::array();
  for (const T& x : all) out.push_back(json_of(x));
  return out;
}

json json_of(const SceneResult& r) {
  json summaries = json::array(), frames = json::array();
  for (const int threads : r.threads)
    for (const std::string& e : r.executions) summaries.push_back(json_of(summarize(r, threads, e), r));
  for (const FrameCost& c : frame_costs(r))
    frames.push_back({{"threads", c.threads}, {"seconds", json_of(c.seconds)}, {"share_of_1000_steps", c.share_of_1000_steps}});
  json out{{"name", r.name},
           {"what", r.what},
           {"method", r.nonsmooth() ? "ndem" : "sdem"},
           {"particles", r.particles()},
           {"warm_up", r.warm_up},
           {"steps_per_window", r.steps},
           {"load_average_before", r.load_before},
           {"load_average_after", r.load_after},
           {"state_hash", r.processes.empty() ? "" : r.processes.front().hash},
           {"timings", summaries},
           {"frames", frames},
           {"processes", list_of(r.processes)},
           {"windows", list_of(r.windows)}};
  if (r.nonsmooth()) {
    out["time_step"] = r.processes.front().time_step;
    out["solver"] = json::array();
    for (const int threads : r.threads)
      for (const bool cold : {false, true}) out["solver"].push_back(json_of(summarize_solver(r, threads, cold)));
  }
  if (!r.rooflines.empty()) out["roofline"] = list_of(r.rooflines);
  return out;
}

}  // namespace

json json_of(const BenchMachine& m, const BenchOptions& o, const std::vector<SceneResult>& results, bool interrupted) {
  json scenes = json::array();
  for (const SceneResult& r : results) scenes.push_back(json_of(r));
  const bool nonsmooth = std::any_of(results.begin(), results.end(), [](const SceneResult& r) { return r.nonsmooth(); });
  return {{"software", m.version},      {"commit", m.commit},
          {"method", nonsmooth ? "ndem" : "sdem"}, {"processor", m.processor},
          {"processors", m.processors}, {"compiler", m.compiler},
          {"flags", m.flags},           {"build_type", m.build},
          {"vector_path", m.vector_path}, {"program_start_seconds", m.program_start},
          {"threads", o.threads},       {"repeats", o.repeats},
          {"interrupted", interrupted}, {"scenes", scenes}};
}

}  // namespace skred
