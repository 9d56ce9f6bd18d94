#include "tasks/guard.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include "kernels/restitution.h"

namespace skred {

namespace {

std::string text(const char* format, double a, double b = 0, double c = 0) {
  char out[400];
  std::snprintf(out, sizeof out, format, a, b, c);
  return out;
}

// Limits. Each is where a run becomes wrong rather than inexact; scenes in daily use stay well within them.
constexpr double least_steps_in_contact = 20;      // below, restitution errs by per cents (tests/physics/normal_impact_test.cpp: 0.178 of 0.18 at 25)
constexpr double least_steps_in_swing = 20;        // a step then turns the phase by a third of a radian
constexpr double most_of_springs = 0.5;            // of 2 / omega_max
constexpr double most_of_dashpots = 0.9;           // of 2 / lambda
constexpr double most_bed_overlap = 0.08;          // of the radius: Hertz holds for small strain, a / R = 0.2 here
constexpr double absurd_bed_overlap = 0.2;
constexpr double most_motion_smooth = 0.5;         // of a radius in a step; a run stops there
constexpr double most_motion_nonsmooth = 1;        // of the smallest radius in a step: two pass through each other at d

// The pair whose k = 4/3 E* sqrt(R_eff) is least or greatest counts.
struct Moduli { double softest = std::numeric_limits<double>::infinity(), stiffest = 0; };
Moduli moduli_of(const World& w, const Model& m) {
  std::vector<bool> in_use(m.pairs.count);
  for (const Index k : std::get<Particles>(w).material.data) in_use[k] = true;
  Moduli out;
  for (std::size_t a = 0; a < m.pairs.count; ++a)
    for (std::size_t b = 0; b < m.pairs.count; ++b) {
      if (!in_use[a] || !in_use[b]) continue;
      out.softest = std::min(out.softest, m.pairs(a, b).young_eff);
      out.stiffest = std::max(out.stiffest, m.pairs(a, b).young_eff);
    }
  return out;
}

double hertz_overlap(double force, double young, double radius_eff) { return std::pow(force / (4.0 / 3.0 * young * std::sqrt(radius_eff)), 2.0 / 3.0); }

double mean_mass(const World& w) {
  double sum = 0;
  for (const double m : std::get<Particles>(w).mass.data) sum += m;
  return sum / double(std::get<Particles>(w).rows());
}

double mean_radius(const World& w) {                         // by volume
  double sum = 0;
  for (const double r : std::get<Particles>(w).radius.data) sum += r * r * r;
  return std::cbrt(sum / double(std::get<Particles>(w).rows()));
}

class Guard {
 public:
  Guard(const World& w, const Model& m, double speed, double overlap_limit)
      : w_(w), m_(m), speed_(speed), overlap_limit_(overlap_limit), bed_(bed_of(w, m)) {
    if (m.method == Method::sdem && (std::get<Particles>(w).rows() > 0 || decide_effects(w, m).rigid_contacts)) advice_ = advise_time_step(w, m, speed);
  }

  std::vector<Finding> findings() {
    if (m_.method == Method::sdem) {
      step_against_contact();
      step_against_packing();
      motion_in_a_step(most_motion_smooth, "a run stops there: particles would pass through walls and each other; a smaller time step helps");
      deepest_impact();
    } else {
      motion_in_a_step(most_motion_nonsmooth, "particles pass through each other (not through walls); a smaller time step helps");
      sweeps_against_height();
      impact_speed();
    }
    overlap_of_bed();
    periodic_box();
    swings();
    skin();
    dissipation();
    return out_;
  }

 private:
  void say(const char* quantity, std::string value, std::string limit, bool warns, const std::string& why) {
    out_.push_back({quantity, std::move(value), std::move(limit), warns ? Finding::Verdict::warning : Finding::Verdict::fine, warns ? why : ""});
  }
  void unknown(const char* quantity, const char* why) { out_.push_back({quantity, "", "", Finding::Verdict::unknown, why}); }
  double h() const { return m_.time_step; }
  bool hertz() const { return m_.method == Method::ndem || !is_linear(m_.contact.normal); }
  const char* no_hertz() const { return hertz() ? nullptr : "the scene's normal law is not Hertz's"; }
  const char* no_bed() const {
    return std::get<Particles>(w_).rows() == 0 ? "no particles at the start" : m_.gravity == Vec3{} ? "no gravity" : nullptr;
  }

  void step_against_contact() {
    if (!(advice_.step > 0)) return unknown("steps in the shortest contact", "no particles at the start");
    const double steps = advice_.contact_time / h();
    say("steps in the shortest contact", text("%.3g", steps), text(">= %g", least_steps_in_contact), steps < least_steps_in_contact,
        text("an impact at %.3g m/s lasts %.3g us: restitution will be wrong by per cents; a time step of %.2g us has 40 steps in it", speed_,
             advice_.contact_time * 1e6, advice_.contact_time / 40 * 1e6));
  }

  // With the overlap of the fastest impact or of the bed at rest, whichever is deeper: stiffness grows as its root.
  void step_against_packing() {
    if (!(advice_.step > 0)) return unknown("step / limits of a packing", "no particles at the start");
    const double deeper = hertz() ? std::max(1.0, bed_.overlap / advice_.overlap) : 1;
    const double springs = h() / (advice_.stability_limit / std::pow(deeper, 0.25)), dashpots = h() / (advice_.damping_limit / std::pow(deeper, 0.25));
    const std::string under = deeper > 1 ? " under the weight of the bed" : "";
    say("step / limit of springs of a packing", text("%.2g", springs), text("<= %g", most_of_springs), springs > most_of_springs,
        "springs" + under + text(" allow 2 / omega_max = %.3g us: the bed will heat up by itself or explode", h() / springs * 1e6));
    say("step / limit of dashpots of a packing", text("%.2g", dashpots), text("<= %g", most_of_dashpots), dashpots > most_of_dashpots,
        "dashpots" + under + text(" allow 2 / lambda = %.3g us: forces will flip sign from step to step", h() / dashpots * 1e6));
  }

  void motion_in_a_step(double limit, const char* why) {
    if (std::get<Particles>(w_).rows() == 0) return unknown("motion in a step / smallest radius", "no particles at the start");
    const double part = speed_ * h() / smallest_radius(w_, m_);
    say("motion in a step / smallest radius", text("%.2g", part), text("<= %g", limit), part > limit, text("at %.3g m/s ", speed_) + why);
  }

  // Of two mean particles of the softest pair, (5 m_eff e v^2 / (4 k))^(2/5): that of the elastic impact, less what the dashpot takes.
  void deepest_impact() {
    if (std::get<Particles>(w_).rows() == 0) return unknown("overlap of the fastest impact / radius", "no particles at the start");
    if (const char* why = no_hertz()) return unknown("overlap of the fastest impact / radius", why);
    double e = 0;
    for (const PairCoefficients& k : m_.pairs.values) e = std::max(e, k.restitution);
    const double radius = mean_radius(w_), stiffness = 4.0 / 3.0 * moduli_of(w_, m_).softest * std::sqrt(radius / 2);
    const double ratio = std::pow(5 * mean_mass(w_) / 2 * e * speed_ * speed_ / (4 * stiffness), 0.4) / radius, limit = 0.5 * overlap_limit_;
    say("overlap of the fastest impact / radius", text("%.2g", ratio), text("<= %.2g", limit), ratio > limit,
        text("at %.3g m/s an impact would be stopped as unphysical, or nearly (limits.overlap %g); a higher youngs_modulus or "
             "`expected_speed` helps", speed_, overlap_limit_));
  }

  void overlap_of_bed() {
    const char* quantity = "overlap under own weight / radius";
    if (const char* why = no_bed()) return unknown(quantity, why);
    if (const char* why = no_hertz()) return unknown(quantity, why);
    const double ratio = bed_.overlap / bed_.radius;
    const std::string load = text("about %.0f particles above one another press with %.3g N: ", bed_.layers, bed_.force);
    const std::string help = text("; youngs_modulus %.2g times as high gives 2 %%", std::pow(ratio / 0.02, 1.5));
    say(quantity, text("%.2g", ratio), text("<= %g", most_bed_overlap), ratio > most_bed_overlap,
        ratio > absurd_bed_overlap ? load + "the particles will be crushed into each other, far outside the theory of Hertz: heights, porosity and "
                                            "forces will be wrong" + help
                                   : load + "the theory of Hertz is for small overlaps; the bed will be too dense and too low" + help);
  }

  // Sweeps that a column needs from nothing: rigid 0.405 n^2 ln(1/tol); compliant ln(1/tol) / (2 ln(1 + sigma/2)), sigma = S m
  // (projected Gauss-Seidel on a chain; tests/physics/nonsmooth_test.cpp measures the rigid one).
  void sweeps_against_height() {
    const char* quantity = "sweeps that the height needs";
    if (const char* why = no_bed()) return unknown(quantity, why);
    if (!(m_.solver.tolerance > 0)) return unknown(quantity, "solver.tolerance is 0: there is nothing to reach");
    const double logarithm = std::max(0.0, std::log(1 / m_.solver.tolerance));
    const double stiffness = 4.0 / 3.0 * moduli_of(w_, m_).stiffest * std::sqrt(bed_.radius / 2);
    const double depth = std::pow(bed_.force / stiffness, 2.0 / 3.0), mass = mean_mass(w_);
    const double sigma = 3.2 / (1 + 4 * m_.solver.damping_steps) * mass / (h() * h() * stiffness * std::sqrt(depth));
    const double rigid = 0.405 * bed_.layers * bed_.layers * logarithm, compliant = logarithm / (2 * std::log1p(sigma / 2));
    const double needed = std::min(rigid, compliant);
    say(quantity, text("%.0f", needed), text("<= %.0f", m_.solver.iterations), needed > m_.solver.iterations,
        text("a column of %.0f needs about %.0f sweeps from nothing to reach solver.tolerance %g: the bed will sag and creep", bed_.layers, needed,
             m_.solver.tolerance) +
            text("; a time step half as long needs %.0f, solver.iterations sets what there is", std::min(rigid, logarithm / (2 * std::log1p(2 * sigma)))));
  }

  void impact_speed() {
    const double slowest = impact_speed_of(m_);
    const bool bounces = std::any_of(m_.pairs.values.begin(), m_.pairs.values.end(), [](const auto& k) { return k.restitution > 0; });
    if (!bounces) return;
    say("slowest impact that rebounds / fastest", text("%.2g", slowest / speed_), "<= 1", slowest > speed_,
        text("no impact, of up to %.3g m/s, is as fast as solver.impact_speed, %.3g m/s: restitution will play no part", speed_, slowest));
  }

  void periodic_box() {
    if (!m_.periodic || m_.method == Method::sdem) return;
    const double widest = step_ahead(w_, m_).widest, motion = speed_ * h();
    say("motion in a step / room in the periodic box", text("%.2g", motion / widest), "<= 0.5", motion > 0.5 * widest,
        text("two particles that go %.3g mm in a step could meet two images of each other, and the run stops; a longer box or a smaller step helps",
             motion * 1e3));
  }

  void swings() {
    double fastest = 0;
    for (const auto& pieces : m_.pieces)
      for (const MotionPiece& p : pieces) fastest = std::max(fastest, p.frequency);
    if (!(fastest > 0)) return;
    const double steps = 1 / (fastest * h());
    say("steps in a swing of a body", text("%.3g", steps), text(">= %g", least_steps_in_swing), steps < least_steps_in_swing,
        text("at %.3g Hz a body jumps from place to place: its blows will be too hard or missed; a time step of %.2g s has 40 steps in it", fastest,
             1 / (40 * fastest)));
  }

  void skin() {
    if (!(m_.skin > 0)) return;                                // chosen by the program
    const double steps = 0.5 * m_.skin / (speed_ * h());
    say("steps between two searches, at the least", text("%.2g", steps), ">= 2", steps < 2,
        text("search.skin %.3g mm lasts less than that at %.3g m/s: nearly every step will search; `skin: auto` chooses", m_.skin * 1e3, speed_));
  }

  void dissipation() {
    if (const char* why = no_bed()) return unknown("something takes energy", why);
    const bool any = m_.method == Method::ndem || std::any_of(m_.pairs.values.begin(), m_.pairs.values.end(), [](const auto& k) {
      return k.restitution < 1 || k.friction > 0 || k.rolling_friction > 0;
    });
    say("something takes energy", any ? "yes" : "no", "yes", !any,
        "restitution is 1 and friction 0 for every pair: nothing ever comes to rest");
  }

  const World& w_;
  const Model& m_;
  double speed_, overlap_limit_;
  Bed bed_;
  TimeStepAdvice advice_;
  std::vector<Finding> out_;
};

}  // namespace

Bed bed_of(const World& w, const Model& m) {
  const Particles& p = std::get<Particles>(w);
  const double g = norm(m.gravity);
  Bed bed;
  if (p.rows() == 0 || g == 0) return bed;
  // The extent of the particles along two directions at right angles to gravity; a periodic one is covered whole.
  const Vec3 down = normalized(m.gravity), other = std::abs(down.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 across = normalized(other - dot(other, down) * down), along = cross(down, across);
  const double weight = mean_mass(w) * double(p.rows()) * g;
  bed.radius = mean_radius(w);
  const auto extent = [&](const Vec3& d) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t k = 0; k < p.rows(); ++k) {
      const double x = dot(d, p.position.data[k]);
      low = std::min(low, x - p.radius.data[k]);
      high = std::max(high, x + p.radius.data[k]);
    }
    const Vec3 box = m.periodic ? m.periodic->length : Vec3{1, 1, 1} * std::numeric_limits<double>::infinity();
    for (const auto& [axis, length] : {std::pair{std::abs(d.x), box.x}, {std::abs(d.y), box.y}, {std::abs(d.z), box.z}})
      if (axis > 0.999 && std::isfinite(length)) return length;
    return high - low;
  };
  const double diameter = 2 * bed.radius;
  bed.ground = std::max(extent(across), diameter) * std::max(extent(along), diameter);
  bed.layers = double(p.rows()) * diameter * diameter / bed.ground;
  bed.pressure = weight / bed.ground;
  bed.force = bed.pressure * diameter * diameter;
  bed.overlap = hertz_overlap(bed.force, moduli_of(w, m).softest, bed.radius / 2);
  return bed;
}

std::vector<Finding> guard(const World& w, const Model& m, double speed, double overlap_limit) {
  if (m.contact.normal == NormalLaw::none) return {};                                // nothing touches anything
  return Guard(w, m, speed, overlap_limit).findings();
}

}  // namespace skred
