#include "scenes/build.h"
#include <cmath>
#include <limits>
#include <numbers>
#include "scenes/pairs.h"

namespace skred {

namespace {

Index material_index(const Scene& scene, const std::string& name) {
  for (Index k = 0; k < scene.materials.size(); ++k)
    if (scene.materials[k].name == name) return k;
  return 0;                                         // the reader has checked every name
}

Motion motion_of(BodyMotion m) {
  return m == BodyMotion::fixed ? Motion::fixed : m == BodyMotion::kinematic ? Motion::kinematic : Motion::dynamic;
}

// Principal moments of the one solid shape that a body is made of [kg m^2]. The reader asks for explicit values elsewhere.
Vec3 solid_inertia(const BodySpec& body) {
  const double m = body.mass;
  if (body.geometries.empty()) return {};
  const Shape& shape = body.geometries.front().shape;
  if (const auto* s = std::get_if<SphereShape>(&shape)) {
    const double i = 0.4 * m * s->radius * s->radius;
    return {i, i, i};
  }
  if (const auto* b = std::get_if<BoxShape>(&shape)) {
    const Vec3 h = b->half_size;
    return (m / 3) * Vec3{h.y * h.y + h.z * h.z, h.x * h.x + h.z * h.z, h.x * h.x + h.y * h.y};
  }
  if (const auto* c = std::get_if<CylinderShape>(&shape)) {
    const double across = m * (3 * c->radius * c->radius + c->length * c->length) / 12;
    return {across, across, 0.5 * m * c->radius * c->radius};
  }
  return {};
}

Inflow inflow_of(const Scene& scene, const InflowSpec& spec, std::size_t which) {
  Inflow f;
  f.region = spec.region;
  f.rate = spec.rate.value_or(0);
  f.mass_rate = spec.mass_rate.value_or(0);
  f.start = spec.start;
  f.end = spec.end;
  if (spec.number) f.number = *spec.number;
  f.radius_min = spec.radius.min;
  f.radius_max = spec.radius.max;
  f.material = material_index(scene, spec.material);
  f.density = scene.materials[f.material].bulk.density;
  f.velocity = spec.velocity;
  f.angular_velocity = spec.angular_velocity;
  f.seed = spec.seed.value_or(scene.seed);
  f.stream = (std::uint64_t{1} << 32) + which;      // beside those of the lattices (scenes/fill.cpp)
  return f;
}

}  // namespace

std::optional<Region> region_of(const ProbeSpec& probe) {
  return std::visit([](const auto& place) -> std::optional<Region> {
    if constexpr (std::is_constructible_v<Region, decltype(place)>) return Region{place};
    else return {};
  }, probe.place);
}
std::optional<Area> area_of(const ProbeSpec& probe) {
  return std::visit([](const auto& place) -> std::optional<Area> {
    if constexpr (std::is_constructible_v<Area, decltype(place)>) return Area{place};
    else return {};
  }, probe.place);
}

World build_world(const Scene& scene, const ParticleSet& set) {
  World w;
  Particles& p = std::get<Particles>(w);
  p.position.data = set.position;
  p.velocity.data = set.velocity;
  p.angular_velocity.data = set.angular_velocity;
  p.radius.data = set.radius;
  for (std::size_t k = 0; k < set.size(); ++k) {
    const double r = set.radius[k], density = scene.materials[set.material[k]].bulk.density;
    p.mass.data.push_back(density * (4.0 / 3.0 * std::numbers::pi) * r * r * r);
    p.material.data.push_back(set.material[k]);
  }
  if (const auto space = build_model(scene).periodic)
    for (Vec3& x : p.position.data) x = space->wrap(x);

  Bodies& b = std::get<Bodies>(w);
  Geometries& g = std::get<Geometries>(w);
  for (Index k = 0; k < scene.bodies.size(); ++k) {
    const BodySpec& body = scene.bodies[k];
    b.motion.data.push_back(motion_of(body.motion));
    b.pose.data.push_back(body.pose);
    b.velocity.data.push_back(body.velocity);
    b.angular_velocity.data.push_back(body.angular_velocity);
    b.mass.data.push_back(body.mass);
    b.inertia.data.push_back(body.inertia.value_or(solid_inertia(body)));
    for (const GeometrySpec& part : body.geometries) {
      g.body.data.push_back(k);
      g.shape.data.push_back(part.shape);
      g.local.data.push_back(part.local);
      g.material.data.push_back(material_index(scene, part.material));
    }
  }
  return w;
}

Model build_model(const Scene& scene) {
  Model m;
  m.method = scene.method;
  m.solver = scene.solver;
  m.gravity = scene.gravity;
  m.pairs = resolve_pairs(scene);
  m.contact = scene.contact;
  m.all_effects = scene.all_effects;
  m.orientation = scene.output.orientation;
  m.energy = scene.output.energy;
  if (scene.periodic[0].on || scene.periodic[1].on || scene.periodic[2].on) {
    const auto low = [&](int a) { return scene.periodic[a].on ? scene.periodic[a].min : std::numeric_limits<double>::lowest(); };   // nothing is below
    const auto length = [&](int a) {
      return scene.periodic[a].on ? scene.periodic[a].max - scene.periodic[a].min : std::numeric_limits<double>::infinity();
    };
    m.periodic = PeriodicSpace{{low(0), low(1), low(2)}, {length(0), length(1), length(2)}};
  }
  m.bounds = scene.bounds;
  m.stop_outside = scene.out_of_bounds == OutOfBounds::stop;
  m.skin = scene.search.skin.value_or(0);
  m.cell = scene.search.cell_size.value_or(0);
  m.reorder_every = scene.search.reorder_every.value_or(m.method == Method::ndem ? 50 : m.reorder_every);
  for (const BodySpec& body : scene.bodies) {
    m.bodies_at_start.push_back(body.pose);
    auto& pieces = m.pieces.emplace_back();
    for (const MotionSpec& s : body.pieces)
      pieces.push_back({s.start, s.end, s.velocity, s.angular_velocity * s.axis, s.point, s.frequency, s.phase});
  }
  for (const RemoveSpec& r : scene.remove) m.removers.push_back({r.region, r.start, r.end, r.interval});
  for (const InflowSpec& f : scene.inflow) m.inflows.push_back(inflow_of(scene, f, m.inflows.size()));
  for (const ProbeSpec& p : scene.probes)
    if (const auto area = area_of(p)) m.areas.push_back(*area);
  return m;
}

}  // namespace skred
