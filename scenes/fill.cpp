// scenes/fill.cpp - lattices, lists and files of particles.
#include "scenes/fill.h"
#include <algorithm>
#include <cmath>
#include "engine/random.h"
#include "scenes/diagnostic.h"
#include "scenes/particle_file.h"

namespace skred {
namespace {

void add(ParticleSet& set, const Vec3& position, const Vec3& velocity, const Vec3& angular_velocity, double radius,
         std::uint32_t material) {
  set.position.push_back(position);
  set.velocity.push_back(velocity);
  set.angular_velocity.push_back(angular_velocity);
  set.radius.push_back(radius);
  set.material.push_back(material);
}

std::uint32_t index_of(const Scene& scene, const std::string& material) {
  const auto found = std::find_if(scene.materials.begin(), scene.materials.end(),
                                  [&](const MaterialSpec& m) { return m.name == material; });
  return std::uint32_t(found - scene.materials.begin());
}

bool inside(const CylinderCut& cut, const Vec3& position, double radius) {
  const Vec3 arm = position - cut.point;
  return norm(arm - dot(arm, cut.axis) * cut.axis) + radius <= cut.radius;
}

// One lattice; `source` keeps the random numbers of several lattices apart.
void fill(const Scene& scene, const LatticeFill& f, std::uint64_t source, ParticleSet& set) {
  const auto sites = lattice_sites(f);
  const std::uint32_t material = index_of(scene, f.material);
  const Vec3 block = f.spacing * Vec3{double(sites[0]) - 1, double(sites[1]) - 1, double(sites[2]) - 1};
  const Vec3 first = 0.5 * (f.min + f.max - block);
  std::uint64_t site = 0;
  for (std::size_t k = 0; k < sites[2]; ++k)
    for (std::size_t j = 0; j < sites[1]; ++j)
      for (std::size_t i = 0; i < sites[0]; ++i, ++site) {
        const auto random = [&](std::uint64_t draw) { return uniform(scene.seed, source, site, draw); };
        const double radius = std::min(f.radius.max, f.radius.min + (f.radius.max - f.radius.min) * random(0));
        const auto coordinate = [&](double start, std::size_t n, double low, double high, std::uint64_t draw) {
          const double moved = start + f.spacing * (double(n) + f.jitter * (2 * random(draw) - 1));
          return std::min(std::max(moved, low + radius), high - radius);
        };
        const Vec3 position{coordinate(first.x, i, f.min.x, f.max.x, 1), coordinate(first.y, j, f.min.y, f.max.y, 2),
                            coordinate(first.z, k, f.min.z, f.max.z, 3)};
        if (!f.cylinder || inside(*f.cylinder, position, radius))
          add(set, position, f.velocity, f.angular_velocity, radius, material);
      }
}

}  // namespace

std::array<std::size_t, 3> lattice_sites(const LatticeFill& f) {
  const auto along = [&](double low, double high) {
    const double room = high - low - 2 * f.radius.max;
    if (room < -1e-9 * f.spacing) return std::size_t(0);
    return std::size_t(std::floor(std::min(std::max(room, 0.0) / f.spacing + 1e-9, 1e15))) + 1;
  };
  return {along(f.min.x, f.max.x), along(f.min.y, f.max.y), along(f.min.z, f.max.z)};
}

ParticleSet make_particles(const Scene& scene) {
  ParticleSet set;
  for (std::size_t s = 0; s < scene.particles.size(); ++s) {
    const ParticleSource& source = scene.particles[s];
    if (const auto* lattice = std::get_if<LatticeFill>(&source)) fill(scene, *lattice, s, set);
    if (const auto* list = std::get_if<ParticleList>(&source))
      for (const ParticleSpec& p : list->particles)
        add(set, p.position, p.velocity, p.angular_velocity, p.radius, index_of(scene, p.material));
    if (const auto* file = std::get_if<ParticleFile>(&source)) read_particle_file(scene, *file, set);
  }
  if (set.size() == 0 && scene.inflow.empty()) throw SceneError({{scene.file, "the scene has no particles: every source is empty", "", 0}});
  if (double(set.size()) > max_particles) throw SceneError({{scene.file, "more than 4294967294 particles", "", 0}});
  return set;
}

}  // namespace skred
