// tests/physics/lab.h - small experiments written out in code: particles, walls, one material.
#pragma once
#include <cmath>
#include <functional>
#include <random>
#include "engine/geometry/mesh.h"
#include "kernels/restitution.h"
#include "tasks/sampling.h"
#include "tasks/simulation.h"

namespace skred::lab {

// The thesis's pellets (Pettersson 2015, table 4.1); Poisson's ratio is ours.
inline constexpr double pellet_radius = 6.36665e-3;     // [m]
inline constexpr double pellet_density = 3700;          // [kg/m^3]
inline constexpr double thesis_step = 5e-5;             // [s]
inline const Material pellet{pellet_density, 6.1684e6, 0.25};

inline double sphere_mass(double radius, double density = pellet_density) { return density * 4.0 / 3.0 * M_PI * radius * radius * radius; }

inline PairTable one_pair(double restitution, double friction, double rolling_friction, const Material& m = pellet) {
  PairTable t;
  t.values[0] = elastic_pair(m, m);
  t.values[0].restitution = restitution;
  t.values[0].friction = friction;
  t.values[0].rolling_friction = rolling_friction;
  return t;
}

struct Lab {
  World world;
  Model model;

  Lab(double restitution, double friction, double rolling_friction) {
    model.pairs = one_pair(restitution, friction, rolling_friction);
    model.gravity = {};
    model.time_step = thesis_step;
  }
  Particles& particles() { return std::get<Particles>(world); }
  Bodies& bodies() { return std::get<Bodies>(world); }

  void sphere(Vec3 x, Vec3 v = {}, Vec3 spin = {}, double radius = pellet_radius, double mass = 0) {
    Particles& p = particles();
    p.position.data.push_back(x);
    p.velocity.data.push_back(v);
    p.angular_velocity.data.push_back(spin);
    p.radius.data.push_back(radius);
    p.mass.data.push_back(mass > 0 ? mass : sphere_mass(radius));
    p.material.data.push_back(0);
  }
  // A body of one geometry; returns its row.
  Index body(Shape shape, Pose pose = {}, Motion motion = Motion::fixed, double mass = 0, Vec3 inertia = {}) {
    Bodies& b = bodies();
    const auto row = static_cast<Index>(b.rows());
    b.motion.data.push_back(motion);
    b.pose.data.push_back(pose);
    b.velocity.data.push_back({});
    b.angular_velocity.data.push_back({});
    b.mass.data.push_back(mass);
    b.inertia.data.push_back(inertia);
    geometry(row, std::move(shape));
    return row;
  }
  void geometry(Index row, Shape shape, Pose local = {}) {
    Geometries& g = std::get<Geometries>(world);
    g.body.data.push_back(row);
    g.shape.data.push_back(std::move(shape));
    g.local.data.push_back(local);
    g.material.data.push_back(0);
  }
  std::unique_ptr<Simulation> build(int threads = 1) const { return std::make_unique<Simulation>(world, model, threads); }
};

// Particle columns by id.
template <class V> std::vector<V> by_id(const Simulation& s, Column<V> Particles::* column) {
  const Particles& p = std::get<Particles>(s.world());
  std::vector<V> out;
  for (const Index r : rows_by_id(p)) out.push_back((p.*column).data[r]);
  return out;
}
inline Vec3 position(const Simulation& s, Index id) { return by_id(s, &Particles::position)[id]; }
inline Vec3 velocity(const Simulation& s, Index id) { return by_id(s, &Particles::velocity)[id]; }
inline Vec3 spin(const Simulation& s, Index id) { return by_id(s, &Particles::angular_velocity)[id]; }

// A loose cloud of spheres of several sizes in a cube, falling towards each other and spinning: a stir of contacts.
inline void add_cloud(Lab& lab, int edge, double spacing, unsigned seed, double speed, bool sizes = true) {
  std::mt19937_64 random(seed);
  const auto u = [&] { return 2.0 * double(random() >> 11) * 0x1p-53 - 1.0; };
  for (int k = 0; k < edge * edge * edge; ++k) {
    const Vec3 site{double(k % edge), double(k / edge % edge), double(k / (edge * edge))};
    const Vec3 centre = 0.5 * (edge - 1.0) * Vec3{1, 1, 1};
    const Vec3 x = spacing * (site - centre) + 0.05 * spacing * Vec3{u(), u(), u()};
    const double radius = pellet_radius * (sizes ? 0.85 + 0.1 * u() : 0.9);
    lab.sphere(x, -(speed / (edge * spacing)) * x + 0.3 * speed * Vec3{u(), u(), u()}, 20.0 * Vec3{u(), u(), u()}, radius);
  }
}

}  // namespace skred::lab
