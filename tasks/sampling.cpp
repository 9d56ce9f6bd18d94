#include "tasks/sampling.h"
#include <algorithm>
#include <cmath>
#include <limits>

namespace skred {

namespace {

// Visits every pair that touches, by ascending (id of i, id of j): visit(contact, overlap, normal).
template <class Visit> void for_each_touching_pair(const Simulation& sim, const std::vector<Index>& rows, Visit visit) {
  const World& w = sim.world();
  const Particles& p = std::get<Particles>(w);
  const Contacts& c = std::get<Contacts>(w);
  const auto& first = std::get<Incidence>(w).first.data;
  const auto& space = sim.model().periodic;
  for (const Index r : rows)
    for (Index k = first[r]; k < first[r + 1]; ++k) {
      const Index q = c.j.data[k];
      Vec3 branch = p.position.data[r] - p.position.data[q];
      if (space) branch = space->shortest(branch);
      const double distance = norm(branch), overlap = p.radius.data[r] + p.radius.data[q] - distance;
      if (overlap > 0) visit(k, overlap, distance > 0 ? (1 / distance) * branch : Vec3{0, 0, 1});
    }
}

template <class Visit> void for_each_touching_body(const Simulation& sim, const std::vector<Index>& rows, Visit visit) {
  const BodyContacts& c = std::get<BodyContacts>(sim.world());
  const auto& first = std::get<BodyIncidence>(sim.world()).first.data;
  for (const Index r : rows)
    for (Index k = first[r]; k < first[r + 1]; ++k)
      if (c.overlap.data[k] > 0) visit(k, r);
}

std::vector<BodyLoad> loads_on_bodies(const World& w) {
  const Particles& p = std::get<Particles>(w);
  const BodyContacts& bc = std::get<BodyContacts>(w);
  const RigidContacts& rc = std::get<RigidContacts>(w);
  const auto& body = std::get<Geometries>(w).body.data;
  const auto& pose = std::get<Bodies>(w).pose.data;
  auto loads = body_loads(bc.particle.data, bc.geometry.data, bc.overlap.data, bc.normal.data, bc.force.data, bc.rolling_torque.data,
                          p.id.data, p.position.data, p.radius.data, body, pose);
  add_rigid_loads(loads, rc.geometry_a.data, rc.geometry_b.data, rc.point.data, rc.force.data, body, pose);
  return loads;
}

}  // namespace

Measures measure(const Simulation& sim) {
  const World& w = sim.world();
  const Particles& p = std::get<Particles>(w);
  const Contacts& c = std::get<Contacts>(w);
  const BodyContacts& bc = std::get<BodyContacts>(w);
  const Vec3 g = sim.model().gravity;
  const Vec3 up = g == Vec3{} ? Vec3{0, 0, 1} : -normalized(g);
  const std::vector<Index> rows = rows_by_id(p);

  Measures m;
  m.highest = rows.empty() ? 0 : -std::numeric_limits<double>::infinity();
  for (const Index r : rows) {
    const double mass = p.mass.data[r], v2 = dot(p.velocity.data[r], p.velocity.data[r]), speed = std::sqrt(v2);
    const double inertia = 0.4 * mass * p.radius.data[r] * p.radius.data[r];
    m.kinetic_energy += 0.5 * mass * v2;
    m.rotational_energy += 0.5 * inertia * dot(p.angular_velocity.data[r], p.angular_velocity.data[r]);
    m.potential_energy -= mass * dot(g, p.position.data[r]);
    m.mean_speed += speed;
    m.max_speed = std::max(m.max_speed, speed);
    m.highest = std::max(m.highest, dot(up, p.position.data[r]));
  }
  const auto see_overlap = [&](double ratio, Index id) {
    if (ratio > m.max_overlap_ratio) m.max_overlap_ratio = ratio, m.max_overlap_particle = id;
  };
  for_each_touching_pair(sim, rows, [&](Index k, double overlap, const Vec3& n) {
    ++m.contacts;
    m.normal_force += std::abs(dot(c.force.data[k], n));
    see_overlap(overlap / std::min(p.radius.data[c.i.data[k]], p.radius.data[c.j.data[k]]), p.id.data[c.i.data[k]]);
  });
  for_each_touching_body(sim, rows, [&](Index k, Index r) {
    ++m.body_contacts;
    m.body_normal_force += std::abs(dot(bc.force.data[k], bc.normal.data[k]));
    see_overlap(bc.overlap.data[k] / p.radius.data[r], p.id.data[r]);
  });
  if (!rows.empty()) {
    m.mean_speed /= double(rows.size());
    m.coordination_number = double(2 * m.contacts + m.body_contacts) / double(rows.size());
  }
  m.loads = loads_on_bodies(w);
  return m;
}

Frame make_frame(const Simulation& sim, const FrameOptions& options) {
  const World& w = sim.world();
  const Particles& p = std::get<Particles>(w);
  const Contacts& c = std::get<Contacts>(w);
  const BodyContacts& bc = std::get<BodyContacts>(w);
  const Bodies& b = std::get<Bodies>(w);
  const std::vector<Index> rows = rows_by_id(p);

  Frame f;
  f.step = sim.steps_done();
  f.time = sim.time();
  for (auto* column : {&f.position, &f.velocity, &f.angular_velocity, &f.force}) column->reserve(rows.size());
  f.orientation.reserve(p.orientation.data.size());
  for (const Index r : rows) {
    f.position.push_back(p.position.data[r]);
    f.velocity.push_back(p.velocity.data[r]);
    f.angular_velocity.push_back(p.angular_velocity.data[r]);
    f.force.push_back(p.force.data[r]);
    if (!p.orientation.data.empty()) f.orientation.push_back(p.orientation.data[r]);
  }
  f.coordination.assign(rows.size(), 0);
  for_each_touching_pair(sim, rows, [&](Index k, double, const Vec3&) {
    const Index i = p.id.data[c.i.data[k]], j = c.partner.data[k];
    ++f.coordination[i];
    ++f.coordination[j];
    if (options.contacts) f.contacts.push_back({i, j, c.force.data[k]});
  });
  for_each_touching_body(sim, rows, [&](Index k, Index r) {
    ++f.coordination[p.id.data[r]];
    if (!options.contacts) return;
    const Vec3 point = p.position.data[r] - (p.radius.data[r] - 0.5 * bc.overlap.data[k]) * bc.normal.data[k];
    f.body_contacts.push_back({p.id.data[r], std::get<Geometries>(w).body.data[bc.geometry.data[k]], point, bc.force.data[k]});
  });
  const auto loads = loads_on_bodies(w);
  for (std::size_t k = 0; k < b.rows(); ++k)
    f.bodies.push_back({b.pose.data[k], b.velocity.data[k], b.angular_velocity.data[k], loads[k].force, loads[k].torque});
  return f;
}

double solver_error(const World& w) {
  const Solver& s = std::get<Solver>(w);
  if (s.sweeps.data[0] == 0 || s.residual.data[0] == 0) return 0;
  const double left = std::max(s.error_left.data[0], std::numeric_limits<double>::min());
  const double ratio = std::pow(left, 1 / double(s.sweeps.data[0]));
  return s.residual.data[0] * ratio / (1 - ratio);
}

}  // namespace skred
