#include "tasks/time_step.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <stdexcept>
#include "engine/geometry/solid.h"
#include "kernels/chosen_law.h"
#include "kernels/restitution.h"

namespace skred {

namespace {

double two_digits_down(double h) {
  const double unit = std::pow(10.0, std::floor(std::log10(h)) - 1);
  return std::floor(h / unit * (1 + 1e-12)) * unit;
}

std::string number(const char* format, double a, double b = 0, double c = 0, double d = 0) {
  char text[256];
  std::snprintf(text, sizeof text, format, a, b, c, d);
  return text;
}

// The worst of all pairs of materials under the scene's laws: the stiffest, and the one with the strongest dashpots.
struct WorstPair {
  NormalLaw law;
  double young = 0, beta = 0;                 // E* [Pa]; gamma = beta sqrt(S m_eff)
  double loading = 0, unloading = 0;          // [N/m] of linear laws
  double damping_time = 0;                    // [s] of Kuwabara & Kono's law: gamma = A S
  double viscosity = 0, rolling_viscosity = 0;   // [N s/m], [s/m] of viscous friction and rolling resistance

  explicit WorstPair(const Model& m) : law(m.contact.normal) {
    const TangentialLaw t = m.contact.tangential;
    for (const PairCoefficients& k : m.pairs.values) {
      const double e = std::max(k.restitution, least_restitution);
      young = std::max(young, k.young_eff);
      beta = std::max(beta, (is_linear(law) ? 2 : std::sqrt(10.0 / 3.0)) * damping_ratio_of(e));
      loading = std::max(loading, k.normal_stiffness);
      unloading = std::max(unloading, law == NormalLaw::walton_braun ? k.normal_stiffness / (e * e) : k.normal_stiffness);
      damping_time = std::max(damping_time, k.damping_time);
      if (t == TangentialLaw::viscous || t == TangentialLaw::haff_werner) viscosity = std::max(viscosity, k.tangential_damping);
      if (m.contact.rolling == RollingLaw::viscous) rolling_viscosity = std::max(rolling_viscosity, k.rolling_viscosity);
    }
  }
  // [m] of an elastic impact.
  double overlap(double radius_eff, double mass_eff, double speed) const {
    if (is_linear(law)) return speed * std::sqrt(mass_eff / loading);
    return std::pow(5 * mass_eff * speed * speed / (4 * (4.0 / 3.0 * young * std::sqrt(radius_eff))), 0.4);
  }
  // [s] of one with this overlap; half a period of the loading spring and half of the unloading one, each for its half of the time.
  double contact_time(double overlap, double mass_eff, double speed) const {
    if (is_linear(law)) return std::numbers::pi / 2 * (std::sqrt(mass_eff / loading) + std::sqrt(mass_eff / unloading));
    return 2.9432 * overlap / speed;
  }
  // [N/m] the greatest dF_n/dg up to this overlap.
  double stiffness(double radius_eff, double overlap) const { return is_linear(law) ? unloading : 2 * young * std::sqrt(radius_eff * overlap); }
  // [N s/m] of so many dashpots; the force that a rolling resistance goes with is that of an impact.
  double dashpots(double number, double stiffness, double mass_eff, double overlap) const {
    const double own = law == NormalLaw::kuwabara_kono ? number * damping_time * stiffness
                       : number * beta * std::sqrt((is_linear(law) ? loading : stiffness) * mass_eff);
    return own + number * (viscosity + rolling_viscosity * stiffness * overlap);
  }
};

// Largest eigenvalue of M^-1 C over the dashpots of a packing, rotation included, in units of beta sqrt(S_n m_eff) / m at the
// overlap reckoned with. Measured: 25 100 /s in a bed of 20 000 pellets at rest in a silo, whose fill reckons with 4.7 m/s.
constexpr double dashpots_of_a_packing = 12.5;

// A light dynamic body lies on many particles at once: its mass per contact [kg].
double lightest_share_of_a_body(const World& w, double radius) {
  const Bodies& b = std::get<Bodies>(w);
  const Geometries& g = std::get<Geometries>(w);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < g.rows(); ++k) {
    const Index body = g.body.data[k];
    if (b.motion.data[body] != Motion::dynamic) continue;
    const double across = outer_radius(g.shape.data[k]) / (2 * radius);
    least = std::min(least, b.mass.data[body] / std::max(1.0, std::numbers::pi * across * across));
  }
  return least;
}

struct Limits { double overlap, contact_time, springs, dashpots; };   // [m], [s]

// The lightest of the particles, and of those that an inflow may bring.
struct Lightest { double mass = std::numeric_limits<double>::infinity(), radius = 0; };
Lightest lightest_particle(const World& w, const Model& m) {
  const Particles& p = std::get<Particles>(w);
  Lightest l;
  for (std::size_t k = 0; k < p.rows(); ++k)
    if (p.mass.data[k] < l.mass) l = {p.mass.data[k], p.radius.data[k]};
  for (const Inflow& f : m.inflows)
    if (const double mass = mass_of(f, f.radius_min); mass < l.mass) l = {mass, f.radius_min};
  return l;
}

Limits limits_of_particles(const World& w, const Model& m, const WorstPair& pair, double speed) {
  // The lightest particle against another like it has the shortest contact: for Hertz t_c ~ (m^2 / (R E*^2 v))^(1/5).
  const auto [lightest, radius] = lightest_particle(w, m);
  const double mass = std::min(lightest, lightest_share_of_a_body(w, radius)), mass_eff = mass / 2;
  const double overlap = pair.overlap(radius / 2, mass_eff, speed), stiffness = pair.stiffness(radius / 2, overlap);
  return {overlap, pair.contact_time(overlap, mass_eff, speed), 2 / std::sqrt(8 * stiffness / mass),
          2 / (pair.dashpots(dashpots_of_a_packing, stiffness, mass_eff, overlap) / mass)};   // infinite for e = 1
}

// What a dynamic body is to others: the radius of its points of contact, and the greatest mobility of one [1/kg]
// (kernels/force_calculation_body_body.h), from the corners of the boxes around its geometries.
struct Touching { double radius = 0, mobility = 0; };
std::vector<Touching> touching_bodies(const World& w) {
  const Bodies& b = std::get<Bodies>(w);
  const Geometries& g = std::get<Geometries>(w);
  std::vector<Touching> out(b.rows());
  for (std::size_t k = 0; k < g.rows(); ++k) {
    const Index body = g.body.data[k];
    if (b.motion.data[body] != Motion::dynamic) continue;
    const Bounds box = bounds(g.shape.data[k]);
    const Vec3 i = b.inertia.data[body];
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 x = to_world(g.local.data[k], {corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                                corner & 4 ? box.max.z : box.min.z});
      const double turning = std::max({(x.y * x.y + x.z * x.z) / i.x, (x.x * x.x + x.z * x.z) / i.y, (x.x * x.x + x.y * x.y) / i.z});
      out[body].mobility = std::max(out[body].mobility, 1 / b.mass.data[body] + turning);
    }
    out[body].radius = std::max(out[body].radius, Solid(g.shape.data[k]).radius);
  }
  return out;
}

// Of the contacts of bodies with each other: a corner of each against a wall; its overlap is that of the whole mass on one point.
// A block between two others has eight points with springs and dashpots in both directions.
Limits limits_of_bodies(const World& w, const WorstPair& pair, double speed) {
  constexpr double points = 8, dashpots = 8;
  constexpr double never = std::numeric_limits<double>::infinity();
  const std::vector<Touching> touching = touching_bodies(w);
  Limits least{0, never, never, never};
  for (std::size_t k = 0; k < touching.size(); ++k) {
    const auto [radius, mobility] = touching[k];
    if (!(radius > 0)) continue;
    const double overlap = pair.overlap(radius, std::get<Bodies>(w).mass.data[k], speed), stiffness = pair.stiffness(radius, overlap);
    least.overlap = std::max(least.overlap, overlap);
    least.contact_time = std::min(least.contact_time, pair.contact_time(pair.overlap(radius, 1 / mobility, speed), 1 / mobility, speed));
    least.springs = std::min(least.springs, 2 / std::sqrt(points * stiffness * mobility));
    least.dashpots = std::min(least.dashpots, 2 / (pair.dashpots(dashpots, stiffness, 1 / mobility, overlap) * mobility));
  }
  return least;
}

double step_of(const Limits& l) { return std::min({l.contact_time / 40, l.springs / 10, 0.4 * l.dashpots}); }
double limit_of(const Limits& l) { return std::min({l.contact_time / 10, l.springs / 2, 0.9 * l.dashpots}); }

}  // namespace

ExpectedSpeed expected_speed(const World& w, const Model& m) {
  const Particles& p = std::get<Particles>(w);
  const Vec3 g = m.gravity;
  double fastest = 0, low = std::numeric_limits<double>::infinity(), high = -low;   // where nothing falls: high < low
  const Vec3 up = g == Vec3{} ? Vec3{0, 0, 1} : -normalized(g);
  for (std::size_t k = 0; k < p.rows(); ++k) {
    fastest = std::max(fastest, norm(p.velocity.data[k]));
    const double height = dot(up, p.position.data[k]);
    low = std::min(low, height - p.radius.data[k]);
    high = std::max(high, height);
  }
  for (const Inflow& f : m.inflows) {
    fastest = std::max(fastest, norm(f.velocity));
    const Bounds box = bounds(f.region);
    for (int corner = 0; corner < 8; ++corner) {
      const double height = dot(up, Vec3{corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y, corner & 4 ? box.max.z : box.min.z});
      low = std::min(low, height);
      high = std::max(high, height);
    }
  }
  const Geometries& geometry = std::get<Geometries>(w);
  const Bodies& b = std::get<Bodies>(w);
  for (std::size_t k = 0; k < b.rows(); ++k)
    if (b.motion.data[k] == Motion::dynamic) high = std::max(high, dot(up, b.pose.data[k].position));
  double walls = 0;
  for (std::size_t k = 0; k < geometry.rows(); ++k) {        // how low can something fall?
    const Index body = geometry.body.data[k];
    const Pose pose = b.pose.data[body] * geometry.local.data[k];
    const double size = outer_radius(geometry.shape.data[k]);
    low = std::min(low, dot(up, pose.position) - (std::isfinite(size) ? size : 0));
    for (const MotionPiece& piece : body < m.pieces.size() ? m.pieces[body] : std::vector<MotionPiece>{}) {
      const double lever = norm(geometry.local.data[k].position) + (std::isfinite(size) ? size : high - low);
      walls = std::max(walls, norm(piece.velocity) + norm(piece.angular_velocity) * lever);
    }
    const double turning = std::isfinite(size) ? norm(b.angular_velocity.data[body]) * (norm(geometry.local.data[k].position) + size) : 0;
    walls = std::max(walls, norm(b.velocity.data[body]) + turning);
  }
  const double height = std::max(0.0, high - low), fall = std::sqrt(2 * norm(g) * height);
  const std::string wall = walls > 0 ? number(" onto a wall that moves at %.3g m/s", walls) : "";
  const std::string start = fastest > 0 ? number(" from %.3g m/s", fastest) : "";
  ExpectedSpeed least{1e-3, "the least that is reckoned with: nothing moves or falls"};
  for (const ExpectedSpeed& e : {ExpectedSpeed{2 * fastest, number("that of two particles that meet at %.3g m/s each", fastest)},
                                 ExpectedSpeed{fastest + walls, "that of a particle" + start + wall},
                                 ExpectedSpeed{std::hypot(fastest, fall) + walls, number("that of a fall of %.3g m", height) + start + wall}})
    if (e.value > least.value || std::isnan(e.value)) least = e;
  return least;
}

TimeStepAdvice advise_time_step(const World& w, const Model& m, double speed) {
  TimeStepAdvice a;
  a.speed = speed;
  const WorstPair pair(m);
  std::vector<Limits> limits;
  const bool particles = std::get<Particles>(w).rows() > 0 || !m.inflows.empty();
  if (particles) limits.push_back(limits_of_particles(w, m, pair, speed));
  if (decide_effects(w, m).rigid_contacts) limits.push_back(limits_of_bodies(w, pair, speed));
  if (limits.empty()) throw std::logic_error("nothing touches anything: there is no time step to advise");
  const bool bodies = limits.size() == 2 ? step_of(limits[1]) < step_of(limits[0]) : !particles;
  const Limits& l = bodies ? limits.back() : limits.front();

  a.overlap = l.overlap;
  a.contact_time = l.contact_time;
  a.stability_limit = l.springs;
  a.damping_limit = l.dashpots;
  a.step = two_digits_down(step_of(l));
  const auto lowest = std::min_element(limits.begin(), limits.end(), [](const Limits& x, const Limits& y) { return limit_of(x) < limit_of(y); });
  a.limit = limit_of(*lowest);
  a.limit_reason = a.limit == lowest->contact_time / 10 ? "a tenth of the shortest contact"
                   : a.limit == lowest->springs / 2     ? "half of what springs allow"
                                                        : "0.9 of what dashpots allow";
  const std::string of = bodies ? "bodies on both sides" : "a dense packing";
  a.reason = number("an impact at %.3g m/s overlaps %.3g mm and lasts %.3g ms; ", speed, a.overlap * 1e3, a.contact_time * 1e3);
  if (bodies) a.reason = "of a body against another, " + a.reason;
  if (a.step > 0.9 * l.contact_time / 40) a.reason += "the step is 1/40 of that";
  else if (a.step > 0.9 * l.springs / 10) a.reason += "the step is a tenth of what the springs of " + of + " allow";
  else a.reason += "the step is 0.4 of what the dashpots of " + of + " allow";
  a.reason += number(" (springs: %.2g us, dashpots: %.2g us)", a.stability_limit * 1e6, a.damping_limit * 1e6);
  return a;
}

TimeStepAdvice advise_nonsmooth_time_step(const World& w, const Model& m, double speed, double tolerance) {
  const double radius = smallest_radius(w, m), reach = 2 * tolerance * radius, g = norm(m.gravity);
  TimeStepAdvice a;
  a.speed = speed;
  a.overlap = reach;
  const double by_speed = reach / speed, by_fall = g > 0 ? std::sqrt(2 * reach / g) : by_speed;
  a.step = two_digits_down(std::min(by_speed, by_fall));
  a.limit = std::max(radius / speed, a.step);
  a.limit_reason = number("there a particle at %.3g m/s goes its radius, %.3g mm", speed, a.limit * speed * 1e3);
  a.reason = (by_speed <= by_fall ? number("at %.3g m/s a particle goes %.3g mm in this step, ", speed, a.step * speed * 1e3)
                                  : number("at rest, a particle falls %.3g mm in this step, ", 0.5 * g * a.step * a.step * 1e3)) +
             number("of %.3g mm that overlap_tolerance %.3g allows", reach * 1e3, tolerance);
  return a;
}

}  // namespace skred
