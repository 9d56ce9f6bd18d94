#include "tasks/rigid_checks.h"
#include <algorithm>
#include <set>
#include "engine/geometry/solid.h"
#include "tasks/simulation.h"
#include "tasks/steps.h"

namespace skred {

std::vector<UnsupportedPair> unsupported_pairs(const World& w, const Model& m) {
  if (!decide_effects(w, m).rigid_contacts) return {};
  const Geometries& g = std::get<Geometries>(w);
  const auto& motion = std::get<Bodies>(w).motion.data;
  const std::vector<Solid> solids(g.shape.data.begin(), g.shape.data.end());
  std::vector<UnsupportedPair> out;
  std::set<std::pair<Index, Index>> told;
  for (std::size_t k = 0; k < solids.size(); ++k)
    for (std::size_t l = k + 1; l < solids.size(); ++l) {
      const Index a = g.body.data[k], b = g.body.data[l];
      if (a == b || (motion[a] != Motion::dynamic && motion[b] != Motion::dynamic)) continue;
      if (const auto why = why_not(solids[k], solids[l]); why && told.insert({a, b}).second) out.push_back({a, b, *why});
    }
  return out;
}

RigidOverlap greatest_rigid_overlap(const World& w) {
  const RigidContacts& c = std::get<RigidContacts>(w);
  const Geometries& g = std::get<Geometries>(w);
  RigidOverlap greatest;
  for (std::size_t k = 0; k < c.rows(); ++k) {
    const Index a = c.geometry_a.data[k], b = c.geometry_b.data[k];
    const double ratio = c.overlap.data[k] / std::min(outer_radius(g.shape.data[a]), outer_radius(g.shape.data[b]));
    if (ratio > greatest.ratio) greatest = {ratio, g.body.data[a], g.body.data[b]};
  }
  return greatest;
}

RigidOverlap rigid_overlap_at_start(const World& world, const Model& model) {
  Simulation sim(world, model, 1);
  if (!sim.effects().rigid_contacts) return {};
  sim.inside([&] {
    Task task(sim.world(), sim.timeline());
    add_rigid_collision(task, sim.world(), sim.effects(), 0, false);
    task.step_serial();
  });
  return greatest_rigid_overlap(sim.world());
}

}  // namespace skred
