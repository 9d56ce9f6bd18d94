#include "scenes/prepare.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include "kernels/restitution.h"
#include "scenes/build.h"
#include "scenes/errors.h"
#include "scenes/fill.h"
#include "tasks/relax.h"
#include "tasks/rigid_checks.h"

namespace skred {

namespace {

void check_restitution(const Scene& scene, const Model& model) {
  if (scene.method == Method::ndem) return;         // impacts are turned round at once, with any restitution
  if (scene.contact.normal == NormalLaw::kuwabara_kono) return;
  const std::size_t n = model.pairs.count;
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = a; b < n; ++b)
      if (model.pairs(a, b).restitution < least_restitution)
        throw SceneRefused(fmt::format("materials '{}' and '{}': restitution {:g} is out of range for smooth DEM: {:g} .. 1 "
                                       "(a lower one needs a dashpot that no step can resolve)",
                                       scene.materials[a].name, scene.materials[b].name, model.pairs(a, b).restitution, least_restitution));
}

// Parameters that the scene gives and its laws do not use; laws that its method does not have.
void note_laws(const Scene& scene, Prepared& p) {
  const ContactModel& c = scene.contact;
  const std::string laws = fmt::format("normal: {}, tangential: {}, rolling: {}", word_of(c.normal), word_of(c.tangential), word_of(c.rolling)) + (c.pull ? ", pull: true" : "");
  const bool nonsmooth = scene.method == Method::ndem;
  const auto other_than = [](auto law, auto one) { return law != one && law != decltype(law)::none; };
  if (nonsmooth && (other_than(c.normal, NormalLaw::hertz) || other_than(c.tangential, TangentialLaw::spring) ||
                    other_than(c.rolling, RollingLaw::spring) || c.pull))
    p.warnings.push_back(fmt::format("contact: {{{}}} are laws of smooth DEM; nonsmooth DEM has the compliance of Hertz, Coulomb friction and a "
                                     "constant limit of the rolling moment", laws));
  const bool normal = c.normal != NormalLaw::none, viscous = c.tangential == TangentialLaw::viscous || c.tangential == TangentialLaw::haff_werner;
  const bool friction = c.tangential != TangentialLaw::none && (nonsmooth || c.tangential != TangentialLaw::viscous);
  const bool rolling = c.rolling != RollingLaw::none && (nonsmooth || c.rolling != RollingLaw::viscous);
  const bool spring = !nonsmooth && c.rolling == RollingLaw::spring;
  std::string unused;
  const auto look = [&](const char* name, bool used, auto own, auto of_pair, auto none) {
    const bool given = std::any_of(scene.materials.begin(), scene.materials.end(), [&](const auto& m) { return m.*own != none; }) ||
                       std::any_of(scene.pairs.begin(), scene.pairs.end(), [&](const auto& k) { return (k.*of_pair).has_value(); });
    if (given && !(normal && used)) unused += (unused.empty() ? "" : ", ") + std::string(name);
  };
  using M = MaterialSpec;
  using P = PairSpec;
  const std::optional<double> absent;
  look("restitution", nonsmooth || c.normal != NormalLaw::kuwabara_kono, &M::restitution, &P::restitution, 1.0);
  look("friction", friction, &M::friction, &P::friction, 0.0);
  look("rolling_friction", rolling, &M::rolling_friction, &P::rolling_friction, 0.0);
  look("rolling_damping", spring, &M::rolling_damping, &P::rolling_damping, 0.0);
  look("rolling_damping_at_limit", spring, &M::rolling_damping_at_limit, &P::rolling_damping_at_limit, 0.0);
  look("normal_stiffness", !nonsmooth && is_linear(c.normal), &M::normal_stiffness, &P::normal_stiffness, absent);
  look("damping_time", !nonsmooth && c.normal == NormalLaw::kuwabara_kono, &M::damping_time, &P::damping_time, absent);
  look("tangential_damping", !nonsmooth && viscous, &M::tangential_damping, &P::tangential_damping, absent);
  look("rolling_viscosity", !nonsmooth && c.rolling == RollingLaw::viscous, &M::rolling_viscosity, &P::rolling_viscosity, absent);
  if (!unused.empty())
    p.notes.push_back(fmt::format("given, but not used by {}: {}", nonsmooth ? "nonsmooth DEM" : "contact: {" + laws + "}", unused));
}

void check_periodic(const Scene& scene, const World& world, const Model& model) {
  const double least = 2 * (2 * largest_radius(world, model) + 2 * margins_of(world, model).largest);
  for (int a = 0; a < 3; ++a)
    if (const PeriodicSpec& p = scene.periodic[a]; p.on && p.max - p.min < least)
      throw SceneRefused(fmt::format("periodic: {}: a length of {:g} m is too short: at least {:g} m, twice the reach of a particle "
                                     "(two diameters and the search skin), or a particle meets two images of another",
                                     "xyz"[a], p.max - p.min, least));
}

constexpr double most_steps = 1e15;                 // of a run: centuries, and exact in a double

ExpectedSpeed speed_of(const Scene& scene, const Prepared& p) {
  return scene.expected_speed ? ExpectedSpeed{*scene.expected_speed, "given as expected_speed"} : expected_speed(p.world, p.model);
}

void choose_time_step(const Scene& scene, bool force, Prepared& p) {
  const ExpectedSpeed speed = speed_of(scene, p);
  p.advice = scene.method == Method::ndem ? advise_nonsmooth_time_step(p.world, p.model, speed.value, scene.overlap_tolerance)
                                          : advise_time_step(p.world, p.model, speed.value);
  if (!std::isfinite(p.advice.step) || !(p.advice.step > 0) || !std::isfinite(p.advice.limit))
    throw SceneRefused(fmt::format("time_step: none can be found: {}; radii, speeds, gravity or moduli (in SI units) are beyond what "
                                   "numbers can hold", p.advice.reason));
  const bool own = scene.method == Method::ndem && scene.solver_time_step;
  const std::optional<double> given = own ? *scene.solver_time_step : scene.time_step;
  const std::string from = fmt::format("{:.3g} m/s is {}", speed.value, speed.reason);
  if (!given) {
    p.model.time_step = std::min(p.advice.step, scene.end_time);
    p.notes.push_back(fmt::format("time step {:g} s (auto): {}; {}", p.model.time_step, p.advice.reason, from));
    return;
  }
  p.model.time_step = *given;
  if (p.model.time_step <= p.advice.limit) {
    p.notes.push_back(fmt::format("time step {:g} s (given; auto would be {:g} s, the limit is {:.2g} s)", p.model.time_step,
                                  p.advice.step, p.advice.limit));
    return;
  }
  const std::string why = fmt::format("{}: {:g} s is too large: at most {:.3g} s ({}), recommended {:g} s ({}); {}", own ? "solver.time_step" : "time_step",
                                      p.model.time_step, p.advice.limit, p.advice.limit_reason, p.advice.step, p.advice.reason, from);
  if (!force) throw SceneRefused(why + "; --force runs it all the same, and `expected_speed` tells of slower impacts");
  p.warnings.push_back(why + "; forced");
}

void check_end_time(const Scene& scene, const Prepared& p) {
  if (const double steps = scene.end_time / p.model.time_step; !(steps <= most_steps))
    throw SceneRefused(fmt::format("end_time: {:g} s takes {:.3g} steps of {:g} s, allowed {:g}", scene.end_time, steps,
                                   p.model.time_step, most_steps));
}

// "particle 3 and particle 7", "particle 3 and body 'floor'"
std::string pair_text(const Scene& scene, const StartOverlap& s) {
  const std::string other = s.body == no_index ? fmt::format("particle {}", s.partner)
                                               : fmt::format("body '{}'", scene.bodies[s.body].name);
  return fmt::format("particle {} and {}", s.particle, other);
}

void check_start(const Scene& scene, Prepared& p) {
  const StartOverlap found = start_overlap(p.world, p.model);
  if (found.ratio <= scene.start.overlap_limit) return;
  if (scene.method == Method::ndem && !scene.start.relax) {
    p.notes.push_back(fmt::format("overlap at the start: {} by {:.3g} of the smaller radius; nonsmooth DEM pushes them apart "
                                  "(solver.separation_speed bounds how fast)", pair_text(scene, found), found.ratio));
    return;
  }
  if (!scene.start.relax)
    throw SceneRefused(fmt::format("overlap at the start: {} by {:.3g} of the smaller radius, allowed {:.3g} "
                                   "(start.overlap_limit); `start: {{relax: true}}` pushes particles apart first",
                                   pair_text(scene, found), found.ratio, scene.start.overlap_limit));
  const Relaxation r = relax(p.world, p.model, scene.start.overlap_limit);
  if (r.overlap_after > scene.start.overlap_limit)
    throw SceneRefused(fmt::format("particles overlap at the start, and {} sweeps of relaxation brought the greatest overlap only from "
                                   "{:.3g} to {:.3g} of the smaller radius, allowed {:.3g}: there may be no room for them",
                                   r.sweeps, r.overlap_before, r.overlap_after, scene.start.overlap_limit));
  p.notes.push_back(fmt::format("relaxed the start in {} sweeps: greatest overlap {:.3g} -> {:.3g} of the smaller radius, "
                                "longest shift {:.3g} mm", r.sweeps, r.overlap_before, r.overlap_after, r.longest_shift * 1e3));
}

// Before contacts are looked for: touch() knows nothing of these.
void check_shapes(const Scene& scene, const Prepared& p) {
  std::string all;
  for (const UnsupportedPair& u : unsupported_pairs(p.world, p.model))
    all += fmt::format("{}bodies '{}' and '{}' may touch: {}", all.empty() ? "" : "\n", scene.bodies[u.body_a].name, scene.bodies[u.body_b].name, u.why);
  if (!all.empty()) throw SceneRefused(all);
}

void check_bodies_at_start(const Scene& scene, const Prepared& p) {
  const RigidOverlap found = rigid_overlap_at_start(p.world, p.model);
  if (found.ratio > scene.start.overlap_limit)
    throw SceneRefused(fmt::format("overlap at the start: bodies '{}' and '{}' by {:.3g} of the smaller outer radius, allowed {:.3g} "
                                   "(start.overlap_limit)", scene.bodies[found.body_a].name, scene.bodies[found.body_b].name, found.ratio,
                                   scene.start.overlap_limit));
}

void check_bounds(const Scene& scene, const World& world) {
  if (!scene.bounds || scene.out_of_bounds != OutOfBounds::stop) return;
  const auto& x = std::get<Particles>(world).position.data;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const Bounds& b = *scene.bounds;
    if (x[k].x < b.min.x || x[k].x > b.max.x || x[k].y < b.min.y || x[k].y > b.max.y || x[k].z < b.min.z || x[k].z > b.max.z)
      throw SceneRefused(fmt::format("particle {} starts at ({:g}, {:g}, {:g}) m, outside the bounds", k, x[k].x, x[k].y, x[k].z));
  }
}

void look_ahead(const Scene& scene, Prepared& p) {
  p.findings = guard(p.world, p.model, speed_of(scene, p).value, scene.limits.overlap);
  for (const Finding& f : p.findings)
    if (f.verdict == Finding::Verdict::warning) p.warnings.push_back(fmt::format("{}: {}, should be {}: {}", f.quantity, f.value, f.limit, f.why));
}

}  // namespace

std::string findings_table(const std::vector<Finding>& findings) {
  if (findings.empty()) return "";
  const auto line = [](std::string_view quantity, std::string_view value, std::string_view limit, std::string_view verdict) {
    return fmt::format("  {:<44} {:>8}  {:<8} {}\n", quantity, value, limit, verdict);
  };
  std::string out = line("estimated before the run", "value", "limit", "");
  for (const Finding& f : findings)
    out += f.verdict == Finding::Verdict::unknown ? line(f.quantity, "-", "", "cannot be estimated: " + f.why)
                                                  : line(f.quantity, f.value, f.limit, f.verdict == Finding::Verdict::fine ? "ok" : "WARNING");
  return out;
}

std::int64_t steps_in(double interval, double time_step) {
  return std::max<std::int64_t>(1, std::llround(std::min(interval / time_step, most_steps)));
}

Prepared prepare(const Scene& scene, bool force_time_step) {
  const ParticleSet set = make_particles(scene);
  Prepared p{build_world(scene, set), build_model(scene), {}, {}, {}, {}};
  check_restitution(scene, p.model);
  note_laws(scene, p);
  check_shapes(scene, p);
  check_periodic(scene, p.world, p.model);
  check_bounds(scene, p.world);
  choose_time_step(scene, force_time_step, p);
  check_end_time(scene, p);
  if (p.model.contact.normal != NormalLaw::none) check_start(scene, p);
  check_bodies_at_start(scene, p);
  look_ahead(scene, p);
  return p;
}

}  // namespace skred
