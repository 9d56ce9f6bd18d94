#include "profiling/bench/results.h"
#include <algorithm>
#include <array>
#include <fmt/format.h>
#include "scenes/errors.h"

namespace skred {

namespace {

constexpr std::array<std::pair<const char*, Execution>, 3> executions{
    {{"serial", Execution::serial}, {"list", Execution::list}, {"graph", Execution::graph}}};

std::vector<const Window*> windows_of(const SceneResult& r, int threads, const std::string& execution, bool frame, bool cold = false) {
  std::vector<const Window*> out;
  for (const Window& w : r.windows)
    if (w.threads == threads && w.execution == execution && w.frame == frame && w.cold == cold) out.push_back(&w);
  return out;
}

double rate_of(const Window& w, std::size_t particles) { return double(w.steps) * double(particles) / w.seconds; }

}  // namespace

const char* execution_name(Execution how) {
  for (const auto& [name, e] : executions)
    if (e == how) return name;
  return "";
}

std::optional<Execution> execution_of(const std::string& name) {
  for (const auto& [n, e] : executions)
    if (name == n) return e;
  return {};
}

void check_agreement(const SceneResult& r, std::string Process::* hash, std::int64_t steps) {
  if (r.processes.empty()) return;
  const Process& first = r.processes.front();
  for (const Process& p : r.processes)
    if (p.*hash != first.*hash)
      throw NumericalFailure(
          fmt::format("{}: the state after {} steps depends on the number of threads: hash {} with {}, {} with {}", r.name, steps,
                      first.*hash, first.threads, p.*hash, p.threads));
}

Summary summarize(const SceneResult& r, int threads, const std::string& execution) {
  Summary s{.threads = threads, .execution = execution};
  const auto windows = windows_of(r, threads, execution, false);
  const int fewest = r.threads.empty() ? threads : r.threads.front();
  const auto beside = windows_of(r, fewest, execution, false);
  s.windows = windows.size();
  std::vector<double> rates, steps, contacts, efficiencies;
  for (std::size_t k = 0; k < windows.size(); ++k) {
    const Window& w = *windows[k];
    const double touching = w.pairs + w.wall_contacts;
    rates.push_back(rate_of(w, r.particles()));
    steps.push_back(w.seconds / double(w.steps));
    if (touching > 0) contacts.push_back(1e9 * w.seconds / double(w.steps) / touching);
    if (threads != fewest && k < beside.size())
      efficiencies.push_back(rates.back() * fewest / (threads * rate_of(*beside[k], r.particles())));
    s.steps += w.steps;
    s.searches += w.searches;
    s.listings += w.listings;
    for (const auto& [to, from] : {std::pair{&s.pairs, w.pairs},
                                   {&s.wall_contacts, w.wall_contacts},
                                   {&s.candidates, w.candidates},
                                   {&s.wall_candidates, w.wall_candidates}})
      *to += from / double(windows.size());
    for (const KernelTime& k2 : w.kernels) {
      auto at = std::find_if(s.kernels.begin(), s.kernels.end(), [&](const KernelTime& x) { return x.name == k2.name; });
      if (at == s.kernels.end()) at = s.kernels.insert(at, {k2.name, 0, 0});
      at->total += k2.total;
      at->busy += k2.busy;
    }
  }
  for (KernelTime& k : s.kernels) k.total /= double(s.steps), k.busy /= double(s.steps);
  s.rate = spread_of(rates);
  s.step_seconds = spread_of(steps);
  s.contact_nanoseconds = spread_of(contacts);
  if (!efficiencies.empty()) s.efficiency = spread_of(efficiencies);
  return s;
}

namespace {

double SolverSummary::*stage_of(const std::string& kernel) {
  const auto begins = [&](const char* word) { return kernel.rfind(word, 0) == 0; };
  if (begins("check_motion") || begins("reorder") || begins("broadphase") || begins("contact_listing") || begins("contact_hashing") ||
      begins("contact_geometry"))
    return &SolverSummary::detection;
  if (begins("constraint_setup") || begins("contact_start")) return &SolverSummary::setup;
  if (begins("impact_solve")) return &SolverSummary::impact;
  if (begins("contact_solve")) return &SolverSummary::solve;
  return &SolverSummary::rest;
}

double seconds_in_sweeps(const Window& w) {
  const auto k = std::find_if(w.kernels.begin(), w.kernels.end(), [](const KernelTime& x) { return x.name == "contact_solve"; });
  return k == w.kernels.end() ? 0 : k->total;
}

}  // namespace

SolverSummary summarize_solver(const SceneResult& r, int threads, bool cold) {
  SolverSummary s{.threads = threads, .cold = cold};
  const std::string& execution = r.executions.front();
  const auto windows = windows_of(r, threads, execution, false, cold);
  const auto beside = windows_of(r, r.threads.front(), execution, false, cold);
  const double h = r.processes.front().time_step;
  const auto rate = [](const Window& w) { return seconds_in_sweeps(w) > 0 ? w.solver.contact_sweeps / seconds_in_sweeps(w) : 0; };
  std::vector<double> rates, walls, efficiencies;
  double contact_sweeps = 0, all = 0;
  for (std::size_t k = 0; k < windows.size(); ++k) {
    const Window& w = *windows[k];
    rates.push_back(rate(w));
    walls.push_back(w.seconds / (double(w.steps) * h));
    if (threads != r.threads.front() && k < beside.size() && rate(*beside[k]) > 0)
      efficiencies.push_back(rates.back() * r.threads.front() / (threads * rate(*beside[k])));
    s.steps += w.steps;
    s.unsolved += w.solver.unsolved;
    s.sweeps += double(w.solver.sweeps);
    s.impact_sweeps += double(w.solver.impact_sweeps);
    s.residual = std::max(s.residual, w.solver.residual);
    contact_sweeps += w.solver.contact_sweeps;
    for (const KernelTime& kernel : w.kernels) s.*stage_of(kernel.name) += kernel.total, all += kernel.total;
  }
  s.contacts = s.sweeps > 0 ? contact_sweeps / s.sweeps : 0;
  if (all > 0)
    for (const auto share : {&SolverSummary::detection, &SolverSummary::setup, &SolverSummary::impact, &SolverSummary::solve, &SolverSummary::rest}) s.*share /= all;
  if (s.steps > 0) s.sweeps /= double(s.steps), s.impact_sweeps /= double(s.steps);
  s.rate = spread_of(rates);
  s.seconds_per_second = spread_of(walls);
  if (!efficiencies.empty()) s.efficiency = spread_of(efficiencies);
  return s;
}

std::vector<FrameCost> frame_costs(const SceneResult& r) {
  std::vector<FrameCost> out;
  for (const int threads : r.threads) {
    std::vector<double> extra, step;
    const Window* before = nullptr;          // the window without a frame that ran just before
    for (const Window& w : r.windows) {
      if (w.threads != threads || w.cold || w.execution != r.executions.front()) continue;
      if (w.frame && before) {
        extra.push_back(w.seconds - before->seconds / double(before->steps) * double(w.steps));
        step.push_back(before->seconds / double(before->steps));
      }
      if (!w.frame) before = &w;
    }
    if (extra.empty()) continue;
    FrameCost c{threads, spread_of(extra)};
    c.share_of_1000_steps = c.seconds.median / (1000 * spread_of(step).median);
    out.push_back(c);
  }
  return out;
}

double coordination(const Summary& s, std::size_t particles) { return particles ? 2 * s.pairs / double(particles) : 0; }

}  // namespace skred
