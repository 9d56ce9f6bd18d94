#include "tasks/time_step.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
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

}  // namespace

double expected_speed(const World& w, const Model& m) {
  const Particles& p = std::get<Particles>(w);
  const Vec3 g = m.gravity;
  double fastest = 0, low = 0, high = 0;
  const Vec3 up = g == Vec3{} ? Vec3{0, 0, 1} : -normalized(g);
  for (std::size_t k = 0; k < p.rows(); ++k) {
    fastest = std::max(fastest, norm(p.velocity.data[k]));
    const double height = dot(up, p.position.data[k]);
    low = k == 0 ? height - p.radius.data[k] : std::min(low, height - p.radius.data[k]);
    high = k == 0 ? height : std::max(high, height);
  }
  const Geometries& geometry = std::get<Geometries>(w);
  const Bodies& b = std::get<Bodies>(w);
  double walls = 0;
  for (std::size_t k = 0; k < geometry.rows(); ++k) {        // how low can a particle fall?
    const Index body = geometry.body.data[k];
    const Pose pose = b.pose.data[body] * geometry.local.data[k];
    const double size = outer_radius(geometry.shape.data[k]);
    low = std::min(low, dot(up, pose.position) - (std::isfinite(size) ? size : 0));
    for (const MotionPiece& piece : body < m.pieces.size() ? m.pieces[body] : std::vector<MotionPiece>{}) {
      const double lever = norm(geometry.local.data[k].position) + (std::isfinite(size) ? size : high - low);
      walls = std::max(walls, norm(piece.velocity) + norm(piece.angular_velocity) * lever);
    }
    walls = std::max(walls, norm(b.velocity.data[body]));
  }
  const double fall = std::sqrt(2 * norm(g) * std::max(0.0, high - low));
  return std::max({2 * fastest, fastest + walls, std::hypot(fastest, fall) + walls, 1e-3});
}

TimeStepAdvice advise_time_step(const World& w, const Model& m, double speed) {
  const Particles& p = std::get<Particles>(w);
  TimeStepAdvice a;
  a.speed = speed;
  double young = 0, beta = 0;
  for (const PairCoefficients& k : m.pairs.values) {
    young = std::max(young, k.young_eff);
    beta = std::max(beta, std::sqrt(10.0 / 3.0) * damping_ratio_of(std::max(k.restitution, least_restitution)));
  }
  // The lightest particle against another like it has the shortest contact: t_c ~ (m^2 / (R E*^2 v))^(1/5).
  std::size_t smallest = 0;
  for (std::size_t k = 1; k < p.rows(); ++k)
    if (p.mass.data[k] < p.mass.data[smallest]) smallest = k;
  const double radius = p.radius.data[smallest];
  const double mass = std::min(p.mass.data[smallest], lightest_share_of_a_body(w, radius)), mass_eff = mass / 2;
  const double hertz = 4.0 / 3.0 * young * std::sqrt(radius / 2);
  a.overlap = std::pow(5 * mass_eff * speed * speed / (4 * hertz), 0.4);
  a.contact_time = 2.9432 * a.overlap / speed;
  const double stiffness = 2 * young * std::sqrt(radius / 2 * a.overlap);
  a.stability_limit = 2 / std::sqrt(8 * stiffness / mass);
  a.damping_limit = 2 / (dashpots_of_a_packing * beta * std::sqrt(stiffness * mass_eff) / mass);   // infinite for e = 1
  const double by_contact = a.contact_time / 40, by_packing = a.stability_limit / 10, by_damping = 0.4 * a.damping_limit;
  a.step = two_digits_down(std::min({by_contact, by_packing, by_damping}));
  a.limit = std::min({a.contact_time / 10, a.stability_limit / 2, 0.9 * a.damping_limit});
  a.reason = number("an impact at %.3g m/s overlaps %.3g mm and lasts %.3g ms; ", speed, a.overlap * 1e3, a.contact_time * 1e3);
  if (a.step > 0.9 * by_contact) a.reason += "the step is 1/40 of that";
  else if (a.step > 0.9 * by_packing) a.reason += "the step is a tenth of what the springs of a dense packing allow";
  else a.reason += "the step is 0.4 of what the dashpots of a dense packing allow";
  a.reason += number(" (springs: %.2g us, dashpots: %.2g us)", a.stability_limit * 1e6, a.damping_limit * 1e6);
  return a;
}

TimeStepAdvice advise_nonsmooth_time_step(const World& w, const Model& m, double speed, double tolerance) {
  const double radius = smallest_radius(w), reach = 2 * tolerance * radius, g = norm(m.gravity);
  TimeStepAdvice a;
  a.speed = speed;
  a.overlap = reach;
  const double by_speed = reach / speed, by_fall = g > 0 ? std::sqrt(2 * reach / g) : by_speed;
  a.step = two_digits_down(std::min(by_speed, by_fall));
  a.limit = std::max(radius / speed, a.step);
  a.reason = number("at %.3g m/s a particle goes %.3g mm in this step, ", speed, a.step * speed * 1e3) +
             number("of %.3g mm that overlap_tolerance %.3g allows", reach * 1e3, tolerance);
  return a;
}

}  // namespace skred
