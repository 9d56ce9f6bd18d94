#include "scenes/check/run_case.h"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <stdexcept>
#include <fmt/format.h>
#include "scenes/check/observer.h"
#include "scenes/check/series.h"
#include "scenes/errors.h"
#include "scenes/prepare.h"
#include "scenes/read_scene.h"
#include "scenes/watch.h"

namespace skred {
namespace {

struct Stopped {};

bool speaks_of(const Expectation& e, Method m) {
  return e.method == Expectation::Methods::all || (e.method == Expectation::Methods::sdem) == (m == Method::sdem);
}

Reading read(const Expectation& e, std::size_t index, Scope& scope) {
  const auto of = [&](const char* key, const std::string& text) { return Formula(text, scope, fmt::format("expect.{}.{}", index, key))(); };
  Reading r{index, of("value", e.value)};
  if (!e.at_most.empty()) r.expected = of("at_most", e.at_most), r.relation = '<';
  else if (!e.at_least.empty()) r.expected = of("at_least", e.at_least), r.relation = '>';
  else r.expected = of("expected", e.expected);
  std::string tolerance = e.tolerance;
  const bool relative = tolerance.ends_with('%');
  if (relative) tolerance.pop_back();
  r.tolerance = of("tolerance", tolerance) * (relative ? 0.01 * std::abs(r.expected) : 1);
  return r;
}

bool counts(const Expectation& e, std::size_t index, Scope& scope) {
  return e.when.empty() || Formula(e.when, scope, fmt::format("expect.{}.when", index))() != 0;
}

// Runs the scene to its end; throws what a run throws.
void simulate(const Scene& scene, const std::function<bool()>& stop, CaseRun& out) {
  const CheckSpec& spec = *scene.check;
  Prepared p = prepare(scene, spec.force);
  const std::int64_t steps = steps_in(scene.end_time, p.model.time_step);
  const std::int64_t every = spec.track_interval > 0 ? steps_in(spec.track_interval, p.model.time_step) : std::max<std::int64_t>(1, steps / 200);
  Simulation sim(std::move(p.world), std::move(p.model), out.threads);
  sim.start();
  Observer see(scene, sim);
  see.sample();
  while (sim.steps_done() < steps) {
    const std::int64_t n = sim.steps_done() + 1;
    const bool looks = n % every == 0 || n == steps;
    sim.step(Execution::graph, looks ? Look::now : Look::later);
    check_trouble(scene, sim);
    if (looks) see.sample();
    if (stop()) throw Stopped{};
  }
  out.state_hash = sim.state_hash();
  out.particles = std::int64_t(std::get<Particles>(sim.world()).rows());
  out.steps = sim.steps_done();
  out.series = see.scope.series;

  see.look();
  for (const NamedFormula& f : spec.values) {
    const double value = Formula(f.formula, see.scope, "values." + f.name)();
    out.values[f.name] = see.scope.numbers[f.name] = value;
  }
  for (std::size_t e = 0; e < spec.expect.size(); ++e) {
    const Expectation& x = spec.expect[e];
    if ((x.of == Expectation::Of::run || x.of == Expectation::Of::seeds) && speaks_of(x, out.method) && counts(x, e, see.scope))
      out.readings.push_back(read(x, e, see.scope));
  }
}

std::string label_of_row(const CheckSpec& spec, std::size_t row) {
  return spec.vary.empty() ? "" : fmt::format("{} = {}", spec.vary.front().first, spec.vary.front().second[row]);
}

std::string label_of(const CheckSpec& spec, std::size_t row, std::uint64_t seed) {
  std::string label = label_of_row(spec, row);
  if (spec.seeds > 1) label += fmt::format("{}seed {}", label.empty() ? "" : ", ", seed);
  return label;
}

std::vector<CaseRun> planned_runs(const CheckCase& c) {
  const CheckSpec& spec = c.spec();
  const std::size_t rows = spec.vary.empty() ? 1 : spec.vary.front().second.size();
  std::vector<CaseRun> runs;
  for (const Method m : spec.methods)
    for (std::size_t row = 0; row < rows; ++row)
      for (int seed = 0; seed < spec.seeds; ++seed)
        for (const int threads : spec.threads) {
          CaseRun r;
          r.method = m, r.row = row, r.seed = c.scene.seed + std::uint64_t(seed), r.threads = threads;
          r.label = label_of(spec, row, r.seed);
          runs.push_back(std::move(r));
        }
  return runs;
}

void run_one(const CheckCase& c, const std::function<bool()>& stop, CaseRun& r) {
  const auto begin = std::chrono::steady_clock::now();
  ReadOptions options;
  options.method = method_word(r.method);
  options.seed = std::to_string(r.seed);
  for (const auto& [parameter, column] : c.spec().vary) options.overrides.emplace_back(parameter, column[r.row]);
  try {
    const Scene scene = parse_scene(c.text, c.path, options);
    r.parameters = scene.parameters;
    simulate(scene, stop, r);
  } catch (const std::exception& e) {
    r.failure = e.what();
  }
  r.wall_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// The verdicts -----------------------------------------------------------------------------------------------------------

Verdict verdict_of(const CheckSpec& spec, const Reading& reading, const std::string& method, const std::string& label) {
  return {reading, spec.expect[reading.expectation].what, method, label, "", 0, 1};
}

Verdict failure_of(std::size_t expectation, const std::string& what, const std::string& method, const std::string& label, const std::string& why) {
  Verdict v{Reading{.expectation = expectation}, what, method, label, why, 0, 1};
  return v;
}

void judge_runs_that_failed(const CheckSpec& spec, CaseResult& result) {
  for (const CaseRun& r : result.runs)
    if (!r.failure.empty()) result.verdicts.push_back(failure_of(spec.expect.size(), "runs to its end", method_word(r.method), r.label, r.failure));
}

void judge_bits(const CheckSpec& spec, CaseResult& result) {
  if (spec.threads.size() < 2) return;
  for (const Method m : spec.methods) {
    Verdict v{Reading{.expectation = spec.expect.size(), .measured = 1, .expected = 1}, "", method_word(m), "", "", 0, 0};
    std::string all;
    for (const int t : spec.threads) all += (all.empty() ? "" : ", ") + std::to_string(t);
    v.what = fmt::format("same bits at {} threads [1]", all);
    std::map<std::pair<std::size_t, std::uint64_t>, std::uint64_t> hash;
    for (const CaseRun& r : result.runs) {
      if (r.method != m || !r.failure.empty()) continue;
      ++v.count;
      const auto [first, is_new] = hash.try_emplace({r.row, r.seed}, r.state_hash);
      if (first->second != r.state_hash) v.reading.measured = 0, v.label = r.label;
    }
    result.verdicts.push_back(std::move(v));
  }
}

bool first_threads(const CheckSpec& spec, const CaseRun& r) { return r.threads == spec.threads.front() && r.failure.empty(); }

void judge_single_runs(const CheckSpec& spec, std::size_t e, CaseResult& result) {
  for (const CaseRun& r : result.runs)
    for (const Reading& reading : r.readings)
      if (reading.expectation == e && first_threads(spec, r)) result.verdicts.push_back(verdict_of(spec, reading, method_word(r.method), r.label));
}

void judge_seeds(const CheckSpec& spec, std::size_t e, CaseResult& result) {
  std::map<std::pair<Method, std::size_t>, std::vector<std::pair<const CaseRun*, Reading>>> groups;
  for (const CaseRun& r : result.runs)
    for (const Reading& reading : r.readings)
      if (reading.expectation == e && first_threads(spec, r)) groups[{r.method, r.row}].push_back({&r, reading});
  for (const auto& [key, group] : groups) {
    std::vector<double> measured;
    for (const auto& [run, reading] : group) measured.push_back(reading.measured);
    Reading mean = group.front().second;
    mean.measured = mean_of(measured);
    Verdict v = verdict_of(spec, mean, method_word(key.first), label_of_row(spec, key.second));
    v.confidence = confidence_of(measured);
    v.count = measured.size();
    result.verdicts.push_back(std::move(v));
  }
}

void judge_all_runs(const CheckCase& c, std::size_t e, CaseResult& result) {
  const Expectation& x = c.spec().expect[e];
  for (const Method m : c.spec().methods) {
    if (!speaks_of(x, m)) continue;
    Scope scope;
    scope.numbers = c.scene.parameters;
    std::size_t count = 0;
    for (const CaseRun& r : result.runs) {
      if (r.method != m || !first_threads(c.spec(), r)) continue;
      Scope own;
      own.numbers = r.parameters;
      own.numbers.insert(r.values.begin(), r.values.end());
      if (!counts(x, e, own)) continue;
      ++count;
      for (const auto& [name, value] : own.numbers) scope.runs[name].push_back(value);
    }
    if (count == 0) throw std::invalid_argument(fmt::format("expect.{}: there is no run to speak of", e));
    Verdict v = verdict_of(c.spec(), read(x, e, scope), method_word(m), "");
    v.count = count;
    result.verdicts.push_back(std::move(v));
  }
}

// The methods' values are those of a row of `vary`: means over the seeds.
void judge_methods(const CheckSpec& spec, std::size_t e, CaseResult& result) {
  struct Values { const CaseRun* first = nullptr; std::map<std::string, std::vector<double>> smooth, nonsmooth; };
  std::map<std::size_t, Values> rows;
  for (const CaseRun& run : result.runs) {
    if (!first_threads(spec, run)) continue;
    Values& row = rows[run.row];
    if (!row.first) row.first = &run;
    for (const auto& [name, value] : run.values) (run.method == Method::sdem ? row.smooth : row.nonsmooth)[name].push_back(value);
  }
  const Expectation& x = spec.expect[e];
  for (const auto& [number, row] : rows) {
    Scope scope;
    scope.numbers = row.first->parameters;
    for (const auto& [name, values] : row.smooth)
      if (const auto other = row.nonsmooth.find(name); other != row.nonsmooth.end()) scope.methods[name] = {mean_of(values), mean_of(other->second)};
    if (counts(x, e, scope)) result.verdicts.push_back(verdict_of(spec, read(x, e, scope), "both", label_of_row(spec, number)));
  }
}

void judge(const CheckCase& c, CaseResult& result) {
  const CheckSpec& spec = c.spec();
  judge_runs_that_failed(spec, result);
  for (std::size_t e = 0; e < spec.expect.size(); ++e) {
    const std::size_t before = result.verdicts.size();
    try {
      switch (spec.expect[e].of) {
        case Expectation::Of::run: judge_single_runs(spec, e, result); break;
        case Expectation::Of::seeds: judge_seeds(spec, e, result); break;
        case Expectation::Of::runs: judge_all_runs(c, e, result); break;
        case Expectation::Of::methods: judge_methods(spec, e, result); break;
      }
      const bool all_came = std::all_of(result.runs.begin(), result.runs.end(), [](const CaseRun& r) { return r.failure.empty(); });
      if (result.verdicts.size() == before && all_came) throw std::invalid_argument("its `when` holds for no run");
    } catch (const std::invalid_argument& error) {
      result.verdicts.push_back(failure_of(e, spec.expect[e].what, "", "", error.what()));
    }
  }
  judge_bits(spec, result);
}

}  // namespace

double Verdict::strain() const {
  const double room = reading.tolerance, off = reading.measured - reading.expected;
  const double excess = (reading.relation == '<' ? off : reading.relation == '>' ? -off : std::abs(off)) + confidence;
  if (excess <= 0) return 0;
  return room > 0 ? excess / room : std::numeric_limits<double>::infinity();
}

bool CaseResult::passed() const {
  return std::all_of(verdicts.begin(), verdicts.end(), [](const Verdict& v) { return v.passed(); });
}

CaseResult run_case(const CheckCase& c, const std::function<bool()>& stop) {
  const auto begin = std::chrono::steady_clock::now();
  CaseResult result{planned_runs(c), {}, 0};
  try {
    for (CaseRun& r : result.runs) run_one(c, stop, r);
  } catch (const Stopped&) {
    return {};
  }
  judge(c, result);
  result.wall_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace skred
