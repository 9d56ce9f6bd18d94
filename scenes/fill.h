// scenes/fill.h - the particles of a scene.
#pragma once
#include <array>
#include <cstdint>
#include <vector>
#include "engine/buffer.h"
#include "scenes/scene.h"

namespace skred {

inline constexpr double max_particles = 4294967294.0;   // ids are 32 bits, and one of them means none

// One entry per particle; its index is the particle's id.
struct ParticleSet {
  Buffer<Vec3> position;            // [m]
  Buffer<Vec3> velocity;            // [m/s]
  Buffer<Vec3> angular_velocity;    // [rad/s]
  Buffer<double> radius;            // [m]
  std::vector<std::uint32_t> material;   // index into scene.materials
  std::size_t size() const { return position.size(); }
};

// Sites of a lattice along x, y, z: floor((max - min - 2 R) / spacing) + 1 with the greatest radius R; 0 if none fits. A
// quotient within 1e-9 of an integer counts as that integer, so that boxes made to measure are filled.
std::array<std::size_t, 3> lattice_sites(const LatticeFill&);

// All particles, sources in order. A lattice runs along x fastest, then y, then z; a file in the order of its ids, or of its
// rows. A lattice's jittered sphere stays whole inside the box. Throws SceneError for what is wrong in a particle file, and
// if there is no particle at all and no inflow.
ParticleSet make_particles(const Scene&);

}  // namespace skred
