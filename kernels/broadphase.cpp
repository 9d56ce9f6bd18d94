#include "kernels/broadphase.h"
#include <algorithm>
#include <utility>
#include "kernels/cell_grid.h"

namespace skred {

namespace {

// A neighbour, sorted by id: the id in the upper half, the row in the lower.
using Key = std::uint64_t;
Key key(Index id, Index row) { return Key{id} << 32 | row; }
Index row_of(Key k) { return static_cast<Index>(k); }

// Most lists hold less than ten keys.
void sort_short(Key* first, Key* last) {
  if (last - first > 64) return std::sort(first, last);
  for (Key* k = first + (first != last); k < last; ++k) {
    const Key moving = *k;
    Key* to = k;
    for (; to > first && to[-1] > moving; --to) *to = to[-1];
    *to = moving;
  }
}

// Counting sort of the particles by cell.
void sort_into_cells(const Parallel& parallel, const CellLayout& layout, std::span<const Vec3> position, std::span<const double> radius,
                     std::span<const double> margin, CellGrid& grid) {
  const std::size_t n = position.size();
  resize_for_overwrite(grid.cell.data, n);
  resize_for_overwrite(grid.order.data, n);
  resize_for_overwrite(grid.position.data, n + Surroundings<OpenSpace>::room);
  resize_for_overwrite(grid.reach.data, n + Surroundings<OpenSpace>::room);
  parallel(n, 8192, [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) grid.cell.data[p] = static_cast<Index>(layout.cell(position[p]));
  });
  auto& start = grid.start.data;
  start.assign(layout.cells() + 1, 0);
  for (const Index c : grid.cell.data) ++start[c];
  Index sum = 0;
  for (Index& s : start) sum += s, s = sum;                  // the end of each cell; filling from behind makes it the start
  for (std::size_t p = n; p-- > 0;) grid.order.data[--start[grid.cell.data[p]]] = static_cast<Index>(p);
  parallel(n, 8192, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const Index p = grid.order.data[k];
      grid.position.data[k] = position[p];
      grid.reach.data[k] = radius[p] + margin[p];
    }
  });
}

// What a chunk of particles finds: the neighbours of a higher id.
struct Found {
  std::vector<Index> row;
  std::vector<Index> end;                                    // by particle of the chunk
};

}  // namespace

template <class Space>
void Broadphase<Space>::operator()(Parallel parallel, Read<&Search::due> due, Read<&Particles::id> id,
                                   Read<&Particles::position> position, Read<&Particles::radius> radius,
                                   Read<&Particles::search_margin> margin, Resize<CellGrid> grid, Resize<Neighbours> neighbours,
                                   Resize<Neighbourhood> neighbourhood) const {
  if (!due[0]) return;
  const std::size_t n = position.size();
  double widest = 0;                                         // nonsmooth DEM may need margins for a far step
  for (std::size_t p = 0; p < n; ++p) widest = std::max(widest, radius[p] + margin[p]);
  const CellLayout layout = fit_cells(position, std::max(cell, 2 * widest), space);
  sort_into_cells(parallel, layout, position, radius, margin, *grid.table);
  const auto& start = grid->start.data;
  const auto& order = grid->order.data;
  const Surroundings<Space> surroundings{space, grid->position.data.data(), grid->reach.data.data()};

  constexpr std::size_t chunk = 1024;
  std::vector<Found> found((n + chunk - 1) / chunk);
  parallel.chunks(n, chunk, [&](std::size_t k, std::size_t begin, std::size_t end) {
    Found& f = found[k];
    f.end.reserve(end - begin);
    std::vector<Index> near;                                 // places in the grid's order
    std::vector<Key> keys;
    for (std::size_t p = begin; p < end; ++p) {
      const Vec3 x = position[p];
      const double mine = radius[p] + margin[p];
      std::array<Places, 27> around;
      Places* around_end = around.data();
      std::size_t candidates = 0;
      const auto look = [&](std::size_t first_cell, std::size_t last_cell) {
        *around_end = {start[first_cell], start[last_cell + 1]};
        candidates += around_end->last - around_end->first;
        ++around_end;
      };
      std::array<int, 3> xs, ys, zs;
      const int nx = layout.axis[0].neighbours(layout.axis[0].cell(x.x), xs);
      const int ny = layout.axis[1].neighbours(layout.axis[1].cell(x.y), ys);
      const int nz = layout.axis[2].neighbours(layout.axis[2].cell(x.z), zs);
      for (int c = 0; c < nz; ++c)
        for (int b = 0; b < ny; ++b) {
          if (!layout.axis[0].periodic) {                    // cells along x lie side by side in memory
            look(layout.index(xs[0], ys[b], zs[c]), layout.index(xs[nx - 1], ys[b], zs[c]));
          } else {
            for (int a = 0; a < nx; ++a) look(layout.index(xs[a], ys[b], zs[c]), layout.index(xs[a], ys[b], zs[c]));
          }
        }
      if (near.size() < candidates + 4) near.resize(2 * candidates + 4);
      const std::size_t count = loop(surroundings, x, mine, around.data(), around_end, near.data());
      if (keys.size() < count) keys.resize(2 * count);
      Key* end_of_keys = keys.data();
      for (std::size_t s = 0; s < count; ++s) {
        const Index q = order[near[s]];
        *end_of_keys = key(id[q], q);
        end_of_keys += id[q] > id[p];
      }
      sort_short(keys.data(), end_of_keys);
      for (const Key* found_key = keys.data(); found_key < end_of_keys; ++found_key) f.row.push_back(row_of(*found_key));
      f.end.push_back(static_cast<Index>(f.row.size()));
    }
  });

  // 40 bytes per particle that only a search needs.
  const auto release = [](auto& column) { std::exchange(column.data, {}); };
  release(grid->cell), release(grid->order), release(grid->position), release(grid->reach);

  std::vector<Index> offset(found.size() + 1, 0);
  for (std::size_t k = 0; k < found.size(); ++k) offset[k + 1] = offset[k] + static_cast<Index>(found[k].row.size());
  for (auto* c : {&neighbours->row, &neighbours->id}) resize_for_overwrite(c->data, offset.back());
  resize_for_overwrite(neighbourhood->first.data, n + 1);
  neighbourhood->first.data[n] = offset.back();
  parallel.chunks(n, chunk, [&](std::size_t k, std::size_t begin, std::size_t end) {
    const Found& f = found[k];
    for (std::size_t p = begin; p < end; ++p) neighbourhood->first.data[p] = offset[k] + (p > begin ? f.end[p - begin - 1] : 0);
    for (std::size_t e = 0; e < f.row.size(); ++e) {
      neighbours->row.data[offset[k] + e] = f.row[e];
      neighbours->id.data[offset[k] + e] = id[f.row[e]];
    }
  });
}

template struct Broadphase<OpenSpace>;
template struct Broadphase<PeriodicSpace>;

}  // namespace skred
