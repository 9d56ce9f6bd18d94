#include "scenes/check/formula.h"
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>
#include <fmt/format.h>
#include <muParser.h>
#include "scenes/check/series.h"
#include "scenes/diagnostic.h"

namespace skred {
namespace {

[[noreturn]] void fail(const std::string& message) { throw std::invalid_argument(message); }

Scope& scope_of(void* data) { return *static_cast<Scope*>(data); }

// Of what is counted from 0 without gaps.
std::size_t index(double value, std::size_t count, const char* what) {
  if (!(value >= 0) || value != std::floor(value) || value >= double(count))
    fail(count == 0 ? fmt::format("there is no {}", what) : fmt::format("{} {:g}: there are 0 .. {}", what, value, count - 1));
  return static_cast<std::size_t>(value);
}

// Particles and bodies -------------------------------------------------------------------------------------------------

const Simulation& state(void* data) {
  const Scope& s = scope_of(data);
  if (!s.sim) fail("the state of the particles is not known here");
  return *s.sim;
}

Index row_of(void* data, double id) {
  const Scope& s = scope_of(data);
  const Particles& p = std::get<Particles>(state(data).world());
  if (s.rows.size() != p.rows()) fail("the particles' rows are not known here");
  const std::size_t given = std::get<Population>(s.sim->world()).next_id.data[0];   // ids so far
  const auto k = static_cast<Index>(index(id, given, "particle"));
  const auto at = std::lower_bound(s.rows.begin(), s.rows.end(), k, [&](Index row, Index wanted) { return p.id.data[row] < wanted; });
  if (at == s.rows.end() || p.id.data[*at] != k) fail(fmt::format("particle {} was removed", k));
  return *at;
}

template <auto column, auto component> double of_particle(void* data, double id) {
  const Index row = row_of(data, id);
  return (std::get<Particles>(state(data).world()).*column).data[row].*component;
}
template <auto column> double number_of_particle(void* data, double id) {
  const Index row = row_of(data, id);
  return (std::get<Particles>(state(data).world()).*column).data[row];
}
double speed_of(void* data, double id) { return norm(std::get<Particles>(state(data).world()).velocity.data[row_of(data, id)]); }

double overlap_of(void* data, double i, double j) {
  const Particles& p = std::get<Particles>(state(data).world());
  const Index a = row_of(data, i), b = row_of(data, j);
  Vec3 branch = p.position.data[a] - p.position.data[b];
  if (const auto& space = state(data).model().periodic) branch = space->shortest(branch);
  return p.radius.data[a] + p.radius.data[b] - norm(branch);
}

template <auto column, auto component> double of_body(void* data, double k) {
  const Bodies& b = std::get<Bodies>(state(data).world());
  return (b.*column).data[index(k, b.rows(), "body")].*component;
}
template <auto component> double body_position(void* data, double k) {
  const Bodies& b = std::get<Bodies>(state(data).world());
  return b.pose.data[index(k, b.rows(), "body")].position.*component;
}

// Sums over particles by id, so that their bits do not depend on the order of the rows.
template <class Add> void for_each_particle(void* data, Add add) {
  const Particles& p = std::get<Particles>(state(data).world());
  for (const Index row : scope_of(data).rows) add(p, row);
}

template <auto component> double centre(void* data) {
  double sum = 0, mass = 0;
  for_each_particle(data, [&](const Particles& p, Index r) { sum += p.mass.data[r] * (p.position.data[r].*component), mass += p.mass.data[r]; });
  if (!(mass > 0)) fail("there is no particle");
  return sum / mass;
}

template <auto component> double momentum(void* data) {
  double sum = 0;
  for_each_particle(data, [&](const Particles& p, Index r) { sum += p.mass.data[r] * (p.velocity.data[r].*component); });
  return sum;
}

template <auto component> double angular_momentum(void* data) {
  Vec3 sum;
  for_each_particle(data, [&](const Particles& p, Index r) {
    const double mass = p.mass.data[r], radius = p.radius.data[r];
    sum += mass * cross(p.position.data[r], p.velocity.data[r]) + (0.4 * mass * radius * radius) * p.angular_velocity.data[r];
  });
  return sum.*component;
}

double temperature(void* data) {
  const double count = double(scope_of(data).rows.size());
  if (count == 0) fail("there is no particle");
  Vec3 mean;
  double square = 0;
  for_each_particle(data, [&](const Particles& p, Index r) { mean += (1 / count) * p.velocity.data[r]; });
  for_each_particle(data, [&](const Particles& p, Index r) { square += dot(p.velocity.data[r] - mean, p.velocity.data[r] - mean); });
  return square / (3 * count);
}

template <class Of> double sum_in(void* data, double x0, double y0, double z0, double x1, double y1, double z1, Of of) {
  double sum = 0;
  for_each_particle(data, [&](const Particles& p, Index r) {
    const Vec3 x = p.position.data[r];
    if (x.x >= x0 && x.x < x1 && x.y >= y0 && x.y < y1 && x.z >= z0 && x.z < z1) sum += of(p.radius.data[r]);
  });
  return sum;
}
double count_in(void* data, double x0, double y0, double z0, double x1, double y1, double z1) {
  return sum_in(data, x0, y0, z0, x1, y1, z1, [](double) { return 1.0; });
}
double volume_in(void* data, double x0, double y0, double z0, double x1, double y1, double z1) {
  return sum_in(data, x0, y0, z0, x1, y1, z1, [](double radius) { return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius; });
}

// Series and values ------------------------------------------------------------------------------------------------------

const Series& series(void* data, const char* name) {
  const auto& all = scope_of(data).series;
  const auto found = all.find(name);
  if (found == all.end()) {
    std::vector<std::string> known;
    for (const auto& [n, s] : all) known.push_back(n);
    fail(fmt::format("nothing called '{}' is tracked{}", name, suggestion(name, known)));
  }
  return found->second;
}

const std::vector<double>& values(void* data, const std::string& name) {
  const auto& all = scope_of(data).runs;
  const auto found = all.find(name);
  if (found == all.end()) {
    std::vector<std::string> known;
    for (const auto& [n, v] : all) known.push_back(n);
    fail(fmt::format("no value is called '{}'{}", name, suggestion(name, known)));
  }
  return found->second;
}


template <double (*of_series)(const Series&)> double by_name(void* data, const char* name) { return of_series(series(data, name)); }
template <double (*of_series)(const Series&, double)> double by_name_at(void* data, const char* name, double x) { return of_series(series(data, name), x); }
template <double (*of_series)(const Series&, double, double)> double by_name_in(void* data, const char* name, double from, double to) {
  return of_series(series(data, name), from, to);
}
template <double (*of_values)(std::span<const double>)> double over(void* data, const char* name) { return of_values(values(data, name)); }

template <double Line::* member> double of_line(void* data, const char* text) {
  const std::string both = text, word = " against ";
  const auto at = both.find(word);
  if (at == std::string::npos) fail(fmt::format("'{}': expected \"v against w\"", both));
  return straight_line(values(data, both.substr(at + word.size())), values(data, both.substr(0, at))).*member;
}

double of_run(void* data, const char* name, double run) {
  const auto& v = values(data, name);
  return v[index(run, v.size(), "run")];
}

const std::pair<double, double>& both_methods(void* data, const char* name) {
  const auto& all = scope_of(data).methods;
  const auto found = all.find(name);
  if (found == all.end()) fail(fmt::format("no value is called '{}'", name));
  return found->second;
}

void define_functions(mu::Parser& p, Scope& s) {
  p.ClearConst();
  p.EnableOptimizer(false);
  p.DefineNameChars("0123456789_.abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ");   // floor.force_z
  p.DefineConst("pi", std::numbers::pi);
  p.DefineConst("deg", std::numbers::pi / 180);
  p.DefineConst("yes", 1);
  p.DefineConst("no", 0);
  p.DefineFun("floor", +[](double x) { return std::floor(x); });
  p.DefineFun("ceil", +[](double x) { return std::ceil(x); });
  p.DefineFun("round", +[](double x) { return std::round(x); });
  const auto add = [&](const char* name, auto function) { p.DefineFunUserData(name, function, &s, false); };
  add("x", &of_particle<&Particles::position, &Vec3::x>);
  add("y", &of_particle<&Particles::position, &Vec3::y>);
  add("z", &of_particle<&Particles::position, &Vec3::z>);
  add("vx", &of_particle<&Particles::velocity, &Vec3::x>);
  add("vy", &of_particle<&Particles::velocity, &Vec3::y>);
  add("vz", &of_particle<&Particles::velocity, &Vec3::z>);
  add("wx", &of_particle<&Particles::angular_velocity, &Vec3::x>);
  add("wy", &of_particle<&Particles::angular_velocity, &Vec3::y>);
  add("wz", &of_particle<&Particles::angular_velocity, &Vec3::z>);
  add("fx", &of_particle<&Particles::force, &Vec3::x>);
  add("fy", &of_particle<&Particles::force, &Vec3::y>);
  add("fz", &of_particle<&Particles::force, &Vec3::z>);
  add("radius", &number_of_particle<&Particles::radius>);
  add("mass", &number_of_particle<&Particles::mass>);
  add("speed", &speed_of);
  add("overlap", &overlap_of);
  add("body_x", &body_position<&Vec3::x>);
  add("body_y", &body_position<&Vec3::y>);
  add("body_z", &body_position<&Vec3::z>);
  add("body_vx", &of_body<&Bodies::velocity, &Vec3::x>);
  add("body_vy", &of_body<&Bodies::velocity, &Vec3::y>);
  add("body_vz", &of_body<&Bodies::velocity, &Vec3::z>);
  add("body_wx", &of_body<&Bodies::angular_velocity, &Vec3::x>);
  add("body_wy", &of_body<&Bodies::angular_velocity, &Vec3::y>);
  add("body_wz", &of_body<&Bodies::angular_velocity, &Vec3::z>);
  add("centre_x", &centre<&Vec3::x>);
  add("centre_y", &centre<&Vec3::y>);
  add("centre_z", &centre<&Vec3::z>);
  add("momentum_x", &momentum<&Vec3::x>);
  add("momentum_y", &momentum<&Vec3::y>);
  add("momentum_z", &momentum<&Vec3::z>);
  add("angular_momentum_x", &angular_momentum<&Vec3::x>);
  add("angular_momentum_y", &angular_momentum<&Vec3::y>);
  add("angular_momentum_z", &angular_momentum<&Vec3::z>);
  add("temperature", &temperature);
  add("count_in", &count_in);
  add("volume_in", &volume_in);
  add("first", &by_name<first_of>);
  add("last", &by_name<last_of>);
  add("at", &by_name_at<at_time>);
  add("when_above", &by_name_at<when_above>);
  add("when_below", &by_name_at<when_below>);
  add("integral", &by_name_in<integral_over>);
  add("swing", &by_name_in<swing_over>);
  if (s.runs.empty()) {
    add("least", &by_name<least_of>);
    add("greatest", &by_name<greatest_of>);
    add("mean", &by_name_in<mean_over>);
    add("deviation", &by_name_in<deviation_over>);
    add("slope", &by_name_in<slope_over>);
  } else {
    add("least", &over<least>);
    add("greatest", &over<greatest>);
    add("mean", &over<mean_of>);
    add("deviation", &over<deviation_of>);
    add("count", &over<count_of>);
    add("slope", &of_line<&Line::slope>);
    add("offset", &of_line<&Line::offset>);
    add("fit", &of_line<&Line::determination>);
    add("of", &of_run);
  }
  add("sdem", +[](void* data, const char* name) { return both_methods(data, name).first; });
  add("ndem", +[](void* data, const char* name) { return both_methods(data, name).second; });
}

}  // namespace

struct Formula::Parser { mu::Parser mu; };

Formula::Formula(const std::string& text, Scope& scope, std::string what) : parser_(std::make_unique<Parser>()), text_(text), what_(std::move(what)) {
  mu::Parser& p = parser_->mu;
  try {
    define_functions(p, scope);
    for (auto& [name, value] : scope.numbers) p.DefineVar(name, &value);
    p.SetExpr(text);
    for (const auto& [name, variable] : p.GetUsedVar()) {
      if (scope.numbers.contains(name)) continue;
      std::vector<std::string> known;
      for (const auto& [n, value] : scope.numbers) known.push_back(n);
      fail(fmt::format("{}: unknown name '{}' in '{}'{}", what_, name, text, suggestion(name, known)));
    }
  } catch (const mu::Parser::exception_type& e) {
    fail(fmt::format("{}: '{}': {}", what_, text, e.GetMsg()));
  }
}
Formula::Formula(Formula&&) noexcept = default;
Formula::~Formula() = default;

double Formula::operator()() const {
  try {
    const double value = parser_->mu.Eval();
    if (!std::isfinite(value)) fail(fmt::format("gives {}", value));
    return value;
  } catch (const mu::Parser::exception_type& e) {
    fail(fmt::format("{}: '{}': {}", what_, text_, e.GetMsg()));
  } catch (const std::invalid_argument& e) {
    fail(fmt::format("{}: '{}': {}", what_, text_, e.what()));
  }
}

std::vector<std::string> names_in(const std::string& formula) {
  Scope none;
  mu::Parser p;
  std::vector<std::string> out;
  try {
    define_functions(p, none);
    p.SetExpr(formula);
    for (const auto& [name, variable] : p.GetUsedVar()) out.push_back(name);
  } catch (const mu::Parser::exception_type&) {
    return {};                                        // the formula itself will tell
  }
  return out;
}

}  // namespace skred
