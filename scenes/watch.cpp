#include "scenes/watch.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include "scenes/errors.h"
#include "tasks/failed_contact.h"
#include "tasks/rigid_checks.h"

namespace skred {
namespace {

std::string likely_cause(const Simulation& sim) {
  return fmt::format("likely causes: a time step that is too large ({:g} s), particles that overlapped or were squeezed far beyond the "
                     "elastic range, a body that moves too fast", sim.model().time_step);
}

std::string when(const Simulation& sim) { return fmt::format("t = {:g} s, step {}", sim.time(), sim.steps_done()); }

std::size_t row_with_id(const Particles& p, Index id) {
  return std::size_t(std::find(p.id.data.begin(), p.id.data.end(), id) - p.id.data.begin());
}

// "contact of particle 3 (radius 0.01 m, mass 0.004 kg) and body 'floor'"; empty where no contact failed.
std::string failed_contact_text(const Scene& scene, const Simulation& sim) {
  const auto failed = failed_contact(sim.world());
  if (!failed) return "";
  const Particles& p = std::get<Particles>(sim.world());
  const auto particle = [&](Index id) {
    const std::size_t row = row_with_id(p, id);
    return fmt::format("particle {} (radius {:g} m, mass {:g} kg)", id, p.radius.data[row], p.mass.data[row]);
  };
  const auto body = [&](Index b) { return "body '" + scene.bodies[b].name + "'"; };
  std::string text = "contact of " + (failed->particle != no_index ? particle(failed->particle) : body(failed->body)) + " and " +
                     (failed->partner != no_index ? particle(failed->partner) : body(failed->particle != no_index ? failed->body : failed->other_body));
  if (failed->others > 0) text += fmt::format(", and {} more contact{}", failed->others, failed->others == 1 ? "" : "s");
  return text;
}

std::string not_a_number_text(const Simulation& sim) {
  return "not a number; likely causes: masses, radii, stiffnesses or speeds so extreme that their products overflow, or " +
         likely_cause(sim).substr(std::string_view("likely causes: ").size());
}

// The contact at which a step ceased to have numbers.
void check_contacts(const Scene& scene, const Simulation& sim) {
  const bool unsolved = !std::isfinite(std::get<Solver>(sim.world()).residual.data[0]);   // never in smooth DEM
  if (!unsolved && std::get<Search>(sim.world()).trouble.data[0] != Trouble::not_finite) return;
  const std::string contact = failed_contact_text(scene, sim);
  if (!contact.empty()) throw NumericalFailure(fmt::format("{}, {}: {}", when(sim), contact, not_a_number_text(sim)));
  if (unsolved) throw NumericalFailure(fmt::format("{}, what the solver found is {}", when(sim), not_a_number_text(sim)));
}

// Dynamic bodies go where forces take them, like particles. Throws NumericalFailure.
void check_bodies(const Scene& scene, const Simulation& sim) {
  const Bodies& b = std::get<Bodies>(sim.world());
  for (std::size_t k = 0; k < b.rows(); ++k) {
    if (b.motion.data[k] != Motion::dynamic) continue;
    const Vec3 x = b.pose.data[k].position, v = b.velocity.data[k];
    const auto fail = [&](const std::string& what) {
      throw NumericalFailure(fmt::format("{}, body '{}' at ({:g}, {:g}, {:g}) m with ({:g}, {:g}, {:g}) m/s: {}; likely causes: a mass or "
                                         "inertia too small for the time step ({:g} s), or a start that is too fast",
                                         when(sim), scene.bodies[k].name, x.x, x.y, x.z, v.x, v.y, v.z, what, sim.model().time_step));
    };
    if (!is_finite(x) || !is_finite(v) || !is_finite(b.angular_velocity.data[k])) fail("not a number");
    if (const double radius = smallest_radius(sim.world(), sim.model()); radius > 0 && !(norm(v) * sim.model().time_step <= radius))
      fail(fmt::format("in one step it moves more than the smallest particle's radius ({:g} m), and through particles", radius));
  }
}

}  // namespace

void check_trouble(const Scene& scene, const Simulation& sim) {
  check_contacts(scene, sim);
  check_bodies(scene, sim);
  const Search& s = std::get<Search>(sim.world());
  if (s.trouble.data[0] == Trouble::none) return;
  const Particles& p = std::get<Particles>(sim.world());
  const Index id = s.culprit.data[0];
  const std::size_t row = row_with_id(p, id);
  const Vec3 x = p.position.data[row], v = p.velocity.data[row];
  const std::string where = fmt::format("{}, particle {} at ({:g}, {:g}, {:g}) m with ({:g}, {:g}, {:g}) m/s", when(sim), id, x.x, x.y, x.z,
                                        v.x, v.y, v.z);
  switch (s.trouble.data[0]) {
    case Trouble::not_finite: throw NumericalFailure(where + ": " + not_a_number_text(sim));
    case Trouble::too_fast:
      if (scene.method == Method::ndem)
        throw NumericalFailure(where + ": it goes so far in one step that it could meet two images of another particle; " + likely_cause(sim));
      throw NumericalFailure(where + fmt::format(": it moves more than half its radius ({:g} m) in one step; ", p.radius.data[row]) + likely_cause(sim));
    default:
      throw NumericalFailure(where + ": it left the bounds of the scene; likely causes: a gap between walls, a wall that ends too low, "
                                     "or a particle pressed through one (`bounds: {action: report}` goes on)");
  }
}

void check_measures(const Scene& scene, const Simulation& sim, const Measures& m) {
  if (m.max_overlap_ratio > scene.limits.overlap)
    throw NumericalFailure(fmt::format("{}, particle {}: overlap of {:.3g} of the radius, allowed {:g} (limits.overlap); {}", when(sim),
                                       m.max_overlap_particle, m.max_overlap_ratio, scene.limits.overlap, likely_cause(sim)));
  if (const RigidOverlap o = greatest_rigid_overlap(sim.world()); o.ratio > scene.limits.overlap)
    throw NumericalFailure(fmt::format("{}, bodies '{}' and '{}': overlap of {:.3g} of the smaller outer radius, allowed {:g} (limits.overlap); {}",
                                       when(sim), scene.bodies[o.body_a].name, scene.bodies[o.body_b].name, o.ratio,
                                       scene.limits.overlap, likely_cause(sim)));
  if (!std::isfinite(m.kinetic_energy + m.rotational_energy)) {   // what the last step did, no later one sees
    const std::string contact = failed_contact_text(scene, sim);
    throw NumericalFailure(fmt::format("{}{}: the kinetic energy is {}", when(sim), contact.empty() ? "" : ", " + contact, not_a_number_text(sim)));
  }
}

}  // namespace skred
