#include "scenes/check/observer.h"
#include <algorithm>
#include "scenes/check/spec.h"
#include "scenes/recorder.h"
#include "scenes/watch.h"

namespace skred {
namespace {

std::string variable_of(std::string column) {         // '-' would be a minus
  std::replace(column.begin(), column.end(), '-', '_');
  return column;
}

}  // namespace

Observer::Observer(const Scene& scene, const Simulation& sim) : scene_(scene), sim_(sim) {
  scope.sim = &sim;
  scope.numbers = scene.parameters;
  scope.numbers["time_step"] = sim.model().time_step;
  look();
  for (const NamedFormula& f : scene.check->track) {
    followed_.emplace_back(&scope.series[f.name], Formula(f.formula, scope, "track." + f.name));
    const auto names = names_in(f.formula);
    statistics_ = statistics_ || std::any_of(names.begin(), names.end(), [&](const std::string& n) { return columns_.contains(n); });
  }
}

void Observer::look() { update(true); }

void Observer::sample() {
  update(statistics_);
  for (auto& [series, formula] : followed_) {
    series->time.push_back(sim_.time());
    series->value.push_back(formula());
  }
}

void Observer::update(bool statistics) {
  scope.rows = rows_by_id(std::get<Particles>(sim_.world()));
  scope.numbers["t"] = sim_.time();
  scope.numbers["step"] = double(sim_.steps_done());
  if (!statistics) return;
  const Measures m = measure(sim_);
  check_measures(scene_, sim_, m);
  for (const StatisticsRow::Value& v : statistics_row(scene_, sim_, m).values) {
    if (v.name == "time" || v.name == "step") continue;
    columns_.insert(variable_of(v.name));
    scope.numbers[variable_of(v.name)] = v.value;
  }
}

}  // namespace skred
