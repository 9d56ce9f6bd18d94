#include "scenes/watch.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include "scenes/errors.h"
#include "tasks/rigid_checks.h"

namespace skred {
namespace {

std::string likely_cause(const Simulation& sim) {
  return fmt::format("likely causes: a time step that is too large ({:g} s), particles that overlapped or were squeezed far beyond the "
                     "elastic range, a body that moves too fast", sim.model().time_step);
}

std::string when(const Simulation& sim) { return fmt::format("t = {:g} s, step {}", sim.time(), sim.steps_done()); }

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
  check_bodies(scene, sim);
  const Search& s = std::get<Search>(sim.world());
  if (s.trouble.data[0] == Trouble::none) return;
  const Particles& p = std::get<Particles>(sim.world());
  const Index id = s.culprit.data[0];
  const auto row = std::size_t(std::find(p.id.data.begin(), p.id.data.end(), id) - p.id.data.begin());
  const Vec3 x = p.position.data[row], v = p.velocity.data[row];
  const std::string where = fmt::format("{}, particle {} at ({:g}, {:g}, {:g}) m with ({:g}, {:g}, {:g}) m/s", when(sim), id, x.x, x.y, x.z,
                                        v.x, v.y, v.z);
  switch (s.trouble.data[0]) {
    case Trouble::not_finite: throw NumericalFailure(where + ": not a number; " + likely_cause(sim));
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
  if (!std::isfinite(m.kinetic_energy + m.rotational_energy))   // what the last step did, no later one sees
    throw NumericalFailure(fmt::format("{}: the kinetic energy is not a number; {}", when(sim), likely_cause(sim)));
}

}  // namespace skred
