#include "tasks/sampling.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include "kernels/contact_solve.h"

namespace skred {

namespace {

// Visits every pair that touches, by ascending (id of i, id of j): visit(contact, overlap, normal).
template <class Visit> void for_each_touching_pair(const Simulation& sim, std::span<const Index> rows, Visit visit) {
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
      if (touches(overlap, c.force.data[k])) visit(k, overlap, distance > 0 ? (1 / distance) * branch : Vec3{0, 0, 1});
    }
}

template <class Visit> void for_each_touching_body(const Simulation& sim, std::span<const Index> rows, Visit visit) {
  const BodyContacts& c = std::get<BodyContacts>(sim.world());
  const auto& first = std::get<BodyIncidence>(sim.world()).first.data;
  for (const Index r : rows)
    for (Index k = first[r]; k < first[r + 1]; ++k)
      if (touches(c.overlap.data[k], c.force.data[k])) visit(k, r);
}

// Touching contacts of each particle, bodies included, by row.
std::vector<std::uint32_t> coordination_of(const Simulation& sim, const std::vector<Index>& rows) {
  const Contacts& c = std::get<Contacts>(sim.world());
  std::vector<std::uint32_t> out(rows.size(), 0);
  for_each_touching_pair(sim, rows, [&](Index k, double, const Vec3&) { ++out[c.i.data[k]], ++out[c.j.data[k]]; });
  for_each_touching_body(sim, rows, [&](Index, Index r) { ++out[r]; });
  return out;
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

// Of the particles in these rows, and of the contacts that are listed with them. Speeds and coordination are sums as yet.
Measures sums_over(const Simulation& sim, std::span<const Index> rows, const Vec3& up) {
  const World& w = sim.world();
  const Particles& p = std::get<Particles>(w);
  const Contacts& c = std::get<Contacts>(w);
  const BodyContacts& bc = std::get<BodyContacts>(w);
  const Vec3 g = sim.model().gravity;

  Measures m;
  m.highest = -std::numeric_limits<double>::infinity();
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
  return m;
}

void add(Measures& m, const Measures& part) {
  m.kinetic_energy += part.kinetic_energy;
  m.rotational_energy += part.rotational_energy;
  m.potential_energy += part.potential_energy;
  m.contacts += part.contacts;
  m.body_contacts += part.body_contacts;
  m.normal_force += part.normal_force;
  m.body_normal_force += part.body_normal_force;
  if (part.max_overlap_ratio > m.max_overlap_ratio) m.max_overlap_ratio = part.max_overlap_ratio, m.max_overlap_particle = part.max_overlap_particle;
  m.mean_speed += part.mean_speed;
  m.max_speed = std::max(m.max_speed, part.max_speed);
  m.highest = std::max(m.highest, part.highest);
}

}  // namespace

Measures measure(const Simulation& sim, Parallel parallel) {
  constexpr std::size_t chunk = 4096;                        // ids; whoever sums them, chunks are added in order
  const Vec3 g = sim.model().gravity, up = g == Vec3{} ? Vec3{0, 0, 1} : -normalized(g);
  const std::vector<Index> rows = rows_by_id(std::get<Particles>(sim.world()));
  const std::size_t n = rows.size();

  Measures m;
  if (n > 0) {
    std::vector<Measures> part((n + chunk - 1) / chunk);
    parallel.chunks(n, chunk, [&](std::size_t k, std::size_t first, std::size_t last) {
      part[k] = sums_over(sim, std::span(rows).subspan(first, last - first), up);
    });
    m = part[0];
    for (std::size_t k = 1; k < part.size(); ++k) add(m, part[k]);
    m.mean_speed /= double(n);
    m.coordination_number = double(2 * m.contacts + m.body_contacts) / double(n);
  }
  m.loads = loads_on_bodies(sim.world());
  return m;
}

std::vector<RegionMeasures> measure_regions(const Simulation& sim, const std::vector<Region>& regions) {
  std::vector<RegionMeasures> out(regions.size());
  if (regions.empty()) return out;
  const Particles& p = std::get<Particles>(sim.world());
  const std::vector<Index> rows = rows_by_id(p);
  const std::vector<std::uint32_t> coordination = coordination_of(sim, rows);
  for (std::size_t k = 0; k < regions.size(); ++k) {
    RegionMeasures& m = out[k];
    std::vector<Index> inside;
    for (const Index r : rows)
      if (contains(regions[k], p.position.data[r])) inside.push_back(r);
    m.count = inside.size();
    if (inside.empty()) continue;
    const double n = double(inside.size());
    double spheres = 0, contacts = 0, speed = 0, agitation = 0;
    Vec3 velocity;
    for (const Index r : inside) {
      const double radius = p.radius.data[r];
      m.mass += p.mass.data[r];
      spheres += 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
      velocity += p.velocity.data[r];
      speed += norm(p.velocity.data[r]);
      contacts += coordination[r];
    }
    m.mean_velocity = (1 / n) * velocity;
    for (const Index r : inside) {
      const Vec3 own = p.velocity.data[r] - m.mean_velocity;
      agitation += dot(own, own);
    }
    m.mean_speed = speed / n;
    m.granular_temperature = agitation / (3 * n);
    m.coordination_number = contacts / n;
    m.solid_fraction = spheres / volume(regions[k]);
  }
  return out;
}

std::vector<std::pair<const char*, double>> energy_columns(const EnergyLedger& l) {
  const StoredEnergy& now = l.stored.data[0];
  const EnergyFlow& flow = l.flow.data[0];
  return {{"energy_translation", now.translation}, {"energy_rotation", now.rotation}, {"energy_gravity", now.gravity},
          {"energy_elastic_normal", now.elastic_normal}, {"energy_elastic_tangential", now.elastic_tangential},
          {"energy_elastic_rolling", now.elastic_rolling}, {"lost_to_normal_damping", flow.normal}, {"lost_to_friction", flow.tangential},
          {"lost_to_rolling", flow.rolling}, {"lost_to_impacts", flow.impacts}, {"work_of_bodies", flow.bodies},
          {"carried_in", flow.carried_in}, {"carried_out", flow.carried_out},
          {"energy_error", energy_error(now, l.at_start.data[0], flow)}};
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
  if (sim.effects().removal || sim.effects().inflow)
    for (const Index r : rows) {
      f.id.push_back(p.id.data[r]);
      f.radius.push_back(p.radius.data[r]);
      f.mass.push_back(p.mass.data[r]);
      f.material.push_back(p.material.data[r]);
    }
  const std::vector<std::uint32_t> coordination = coordination_of(sim, rows);
  for (const Index r : rows) f.coordination.push_back(coordination[r]);
  if (options.contacts) for_each_touching_pair(sim, rows, [&](Index k, double, const Vec3&) {
    f.contacts.push_back({p.id.data[c.i.data[k]], c.partner.data[k], c.force.data[k]});
  });
  if (options.contacts) for_each_touching_body(sim, rows, [&](Index k, Index r) {
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
  const double residual = s.residual.data[0], left = std::max(s.error_left.data[0], std::numeric_limits<double>::min());
  if (s.sweeps.data[0] == 0) return 0;
  const double ratio = std::pow(left, 1 / double(s.sweeps.data[0]));
  return is_rounding(residual, ratio) ? residual : residual * ratio / (1 - ratio);
}

}  // namespace skred
