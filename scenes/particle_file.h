// scenes/particle_file.h - particles from CSV and HDF5 files.
//
// Columns, all SI: x, y, z (needed); vx, vy, vz; wx, wy, wz (angular velocity); radius; material (a name, or an index from
// 0); id (unique integers: the particles are ordered by them). HDF5 may have position, velocity and angular_velocity of
// shape n x 3 instead of single columns; its other datasets are ignored, a CSV's unknown column is an error.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>
#include "scenes/diagnostic.h"
#include "scenes/fill.h"
#include "scenes/scene.h"

namespace skred {

// Appends the particles of a file. Throws SceneError naming file, line and column of everything that is wrong.
void read_particle_file(const Scene&, const ParticleFile&, ParticleSet&);

// What a file says, before its rows are put in order. Columns that are not in the file are not in the map, or empty.
struct ParticleColumns {
  std::map<std::string, std::vector<double>> numbers;   // x, ..., radius
  std::vector<std::string> materials;                   // names or indices
  std::vector<std::int64_t> ids;
  std::vector<std::size_t> lines;                       // of each row in a text file, counted from 1; empty for HDF5
  std::size_t rows = 0;
};

inline const std::vector<std::string> particle_number_columns = {"x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz", "radius"};

// A loader adds an error for every cell that is not what its column holds; the rest is checked for all formats alike.
ParticleColumns load_particle_csv(const std::string& path, std::vector<Diagnostic>& errors);
ParticleColumns load_particle_hdf5(const std::string& path, std::vector<Diagnostic>& errors);

}  // namespace skred
