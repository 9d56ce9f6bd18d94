#include "kernels/emit_particles.h"
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include "engine/geometry/mesh.h"
#include "engine/random.h"

namespace skred {

namespace {

constexpr int trials_in_a_step = 100;                        // for one particle; a place free with 5 % is found with 99.4 %

// What of the k-th particle is due after `elapsed` seconds of flow: it is when the flow has brought all of it.
bool is_due(const Inflow& f, std::int64_t k, double mass_before, double elapsed) {
  constexpr double slack = 1 + 1e-9;                         // of rounding: a rate of 10 /s brings ten in one second
  if (k >= f.number) return false;
  if (f.rate > 0) return double(k + 1) <= f.rate * elapsed * slack;
  return mass_before + mass_of(f, radius_of(f, k)) <= f.mass_rate * elapsed * slack;
}

// Particles that are due and not here: of a mass rate, of the next one's mass.
std::int64_t due_after(const Inflow& f, std::int64_t k, double mass_before, double elapsed) {
  const double behind = f.rate > 0 ? f.rate * elapsed - double(k) : (f.mass_rate * elapsed - mass_before) / mass_of(f, radius_of(f, k));
  return std::clamp<std::int64_t>(std::llround(std::floor(behind * (1 + 1e-9))), 1, f.number - k);
}

bool overlaps(const Shape& shape, const Vec3& x, double radius) {
  return std::visit([&](const auto& s) {
    if constexpr (std::is_same_v<std::decay_t<decltype(s)>, MeshShape>) {
      std::vector<std::uint32_t> near;
      s.mesh->find(x, radius, near);
      return s.mesh->touch(x, radius, near).count > 0;
    } else {
      return nearest(s, x).distance < radius;
    }
  }, shape);
}

struct Ball { Vec3 centre; double radius; };

}  // namespace

double mass_of(const Inflow& f, double radius) { return f.density * (4.0 / 3.0 * std::numbers::pi) * radius * radius * radius; }
double radius_of(const Inflow& f, std::int64_t k) {
  const double radius = f.radius_min + (f.radius_max - f.radius_min) * uniform(f.seed, f.stream, std::uint64_t(k), 0);
  return std::min(radius, f.radius_max);
}

template <class Space>
void EmitParticles<Space>::operator()(Parallel parallel, Read<&Clock::step> step, Read<&Geometries::body> body,
    Read<&Geometries::shape> shape, Read<&Geometries::local> local, Read<&Bodies::pose> pose, Update<&Search::rows_changed> changed,
    Update<&Population::next_id> next_id, Update<&Created::count> count, Update<&Created::mass> mass, Update<&Created::trials> trials,
    Update<&Created::waiting> waiting, Resize<Particles> particles, Resize<Incidence> incidence, Resize<BodyIncidence> body_incidence) const {
  const double time = double(step[0] - steps_behind) * time_step;
  Particles& p = *particles.table;
  const std::size_t before = p.rows();
  bool sound_known = false;

  for (std::size_t i = 0; i < inflows.size(); ++i) {
    const Inflow& f = inflows[i];
    waiting[i] = 0;
    const double elapsed = std::min(time, f.end) - f.start;
    if (!(elapsed > 0) || !is_due(f, count[i], mass[i], elapsed)) continue;
    if (!sound_known)                                        // where something is not a number the run ends in this step (check_motion)
      for (std::size_t k = 0; k < before; ++k)
        if (!is_finite(p.position.data[k]) || !is_finite(p.velocity.data[k])) return;
    sound_known = true;

    // What a new particle could touch: balls near the region.
    const Bounds box = bounds(f.region);
    const Vec3 centre = 0.5 * (box.min + box.max), half = 0.5 * (box.max - box.min);
    constexpr std::size_t chunk = 4096;
    std::vector<std::vector<Ball>> found((p.rows() + chunk - 1) / chunk);
    parallel.chunks(p.rows(), chunk, [&](std::size_t k, std::size_t begin, std::size_t end) {
      for (std::size_t q = begin; q < end; ++q) {
        const Vec3 d = space.shortest(p.position.data[q] - centre);
        const double r = p.radius.data[q];
        if (std::abs(d.x) < half.x + r && std::abs(d.y) < half.y + r && std::abs(d.z) < half.z + r)
          found[k].push_back({p.position.data[q], r});
      }
    });
    std::vector<Ball> near;
    for (const auto& list : found) near.insert(near.end(), list.begin(), list.end());

    const auto is_free = [&](const Vec3& x, double radius) {
      for (const Ball& b : near) {
        const Vec3 d = space.shortest(x - b.centre);
        const double reach = radius + b.radius;
        if (dot(d, d) < reach * reach) return false;
      }
      for (std::size_t g = 0; g < shape.size(); ++g)
        if (overlaps(shape[g], to_local(pose[body[g]] * local[g], x), radius)) return false;
      return true;
    };
    while (is_due(f, count[i], mass[i], elapsed)) {
      const double radius = radius_of(f, count[i]), m = mass_of(f, radius);
      const Region centres = shrunk(f.region, radius);
      bool placed = false;
      Vec3 x;
      for (int t = 0; t < trials_in_a_step && !placed; ++t) {
        const auto random = [&](std::uint64_t draw) { return uniform(f.seed, f.stream, std::uint64_t(trials[i]), draw); };
        x = space.wrap(place_in(centres, random(1), random(2), random(3)));
        ++trials[i];
        placed = is_free(x, radius);
      }
      if (!placed) {
        waiting[i] = due_after(f, count[i], mass[i], elapsed);
        break;
      }
      if (next_id[0] == no_index) throw std::runtime_error("inflow: the ids of particles, 4294967295 of them, are used up");
      near.push_back({x, radius});
      p.id.data.push_back(next_id[0]++);
      p.position.data.push_back(x);
      p.velocity.data.push_back(f.velocity);
      p.angular_velocity.data.push_back(f.angular_velocity);
      if (oriented) p.orientation.data.push_back({});
      for (auto* column : {&p.force, &p.previous_force}) column->data.push_back(m * gravity);   // as if it had always been in free fall
      for (auto* column : {&p.torque, &p.previous_torque}) column->data.push_back({});
      p.radius.data.push_back(radius);
      p.mass.data.push_back(m);
      p.material.data.push_back(f.material);
      for (auto* column : {&p.searched, &p.listed}) column->data.push_back(x);
      for (auto* column : {&p.search_margin, &p.list_margin}) column->data.push_back(0);
      if (counted) p.before.data.push_back(x);
      ++count[i];
      mass[i] += m;
    }
  }
  if (p.rows() == before) return;

  auto& previous = p.previous_row.data;
  previous.resize(before);
  if (!changed[0]) std::iota(previous.begin(), previous.end(), Index{0});
  previous.resize(p.rows(), no_index);
  changed[0] = 1;
  // Where no kernel lists contacts of a kind, nobody else makes room for the new rows.
  for (auto* first : {&incidence->first.data, &body_incidence->first.data})
    if (first->size() < p.rows() + 1) first->resize(p.rows() + 1, first->empty() ? 0 : first->back());
}

template struct EmitParticles<OpenSpace>;
template struct EmitParticles<PeriodicSpace>;

}  // namespace skred
