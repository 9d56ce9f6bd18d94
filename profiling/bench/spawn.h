// profiling/bench/spawn.h - where the pellets of the benchmark's columns and beds are dropped.
//
// A cubic lattice of pellets with this much friction does not collapse but stands, at three contacts per particle. So layers
// are square lattices that are turned or shifted at random, each by itself; the other codes are timed from such a start too.
#pragma once
#include <cstddef>
#include <vector>
#include "engine/vec3.h"

namespace skred {

// Around the z axis, from z = 0 upwards, `count` spheres. `inside` > 2 radii is the radius of the cylinder's inner surface.
std::vector<Vec3> spawn_column(std::size_t count, double inside, double sphere_radius);

// nx * ny * nz spheres in the box [0, nx s) x [0, ny s), periodic, with s = spawn_spacing(radius); from z = 0 upwards.
std::vector<Vec3> spawn_bed(std::size_t nx, std::size_t ny, std::size_t nz, double sphere_radius);

// Copies of a periodic bed of lengths (x, y), side by side.
std::vector<Vec3> tiled(const std::vector<Vec3>& bed, double x, double y, std::size_t tiles_x, std::size_t tiles_y);

constexpr double spawn_spacing(double sphere_radius) { return 2.06 * sphere_radius; }

}  // namespace skred
