// kernels/cell_grid.h - the shape of the grid of cells that the broadphase sorts particles into.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>
#include "engine/periodic.h"
#include "engine/world.h"

namespace skred {

// Cells of one direction. Coordinates outside are clamped to the border cells: two points closer than a cell's width still
// lie in the same or in adjacent cells, so a particle far outside costs time, never a contact.
struct CellAxis {
  double low = 0, inverse_width = 0;
  int count = 1;
  bool periodic = false;

  int cell(double x) const {
    const double c = (x - low) * inverse_width;
    return c > 0 ? static_cast<int>(std::min(c, double(count - 1))) : 0;
  }
  // The cells to look through for a point in cell c: itself and its neighbours, each once.
  int neighbours(int c, std::array<int, 3>& out) const {
    int n = 0;
    for (int d = -1; d <= 1; ++d) {
      int k = c + d;
      if (periodic) k = (k + count) % count;
      else if (k < 0 || k >= count) continue;
      if (std::find(out.begin(), out.begin() + n, k) == out.begin() + n) out[n++] = k;
    }
    return n;
  }
};

struct CellLayout {
  std::array<CellAxis, 3> axis;
  std::size_t cells() const { return std::size_t(axis[0].count) * axis[1].count * axis[2].count; }
  std::size_t index(int x, int y, int z) const { return (std::size_t(z) * axis[1].count + y) * axis[0].count + x; }
  std::size_t cell(const Vec3& p) const { return index(axis[0].cell(p.x), axis[1].cell(p.y), axis[2].cell(p.z)); }
};

// Fits cells of at least `edge` [m] to the particles: at most about four cells per particle, so that memory stays bounded
// however far apart the particles are.
CellLayout fit_cells(std::span<const Vec3> position, double edge, const OpenSpace&);
CellLayout fit_cells(std::span<const Vec3> position, double edge, const PeriodicSpace&);

}  // namespace skred
