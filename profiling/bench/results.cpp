#include "profiling/bench/results.h"
#include <algorithm>
#include <array>
#include <fmt/format.h>
#include "scenes/errors.h"

namespace skred {

namespace {

constexpr std::array<std::pair<const char*, Execution>, 3> executions{
    {{"serial", Execution::serial}, {"list", Execution::list}, {"graph", Execution::graph}}};

std::vector<const Window*> windows_of(const SceneResult& r, int threads, const std::string& execution, bool frame) {
  std::vector<const Window*> out;
  for (const Window& w : r.windows)
    if (w.threads == threads && w.execution == execution && w.frame == frame) out.push_back(&w);
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

std::vector<FrameCost> frame_costs(const SceneResult& r) {
  std::vector<FrameCost> out;
  for (const int threads : r.threads) {
    std::vector<double> extra, step;
    const Window* before = nullptr;          // the window without a frame that ran just before
    for (const Window& w : r.windows) {
      if (w.threads != threads || w.execution != r.executions.front()) continue;
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
