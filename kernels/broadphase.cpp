#include "kernels/broadphase.h"
#include <algorithm>
#include <utility>
#include "kernels/cell_grid.h"

namespace skred {

namespace {

struct Partner { Index id, row; };

// Counting sort of the particles by cell.
void sort_into_cells(const Parallel& parallel, const CellLayout& layout, std::span<const Vec3> position, CellGrid& grid) {
  const std::size_t n = position.size();
  grid.cell.data.resize(n);
  grid.order.data.resize(n);
  grid.position.data.resize(n);
  parallel(n, 8192, [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) grid.cell.data[p] = static_cast<Index>(layout.cell(position[p]));
  });
  auto& start = grid.start.data;
  start.assign(layout.cells() + 1, 0);
  for (const Index c : grid.cell.data) ++start[c + 1];
  for (std::size_t c = 1; c < start.size(); ++c) start[c] += start[c - 1];
  for (std::size_t p = n; p-- > 0;) grid.order.data[--start[grid.cell.data[p] + 1]] = static_cast<Index>(p);
  start.erase(start.begin());                                // now start[c] is the first of cell c ...
  start.push_back(static_cast<Index>(n));                    // ... and the last entry closes the last cell
  parallel(n, 8192, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) grid.position.data[k] = position[grid.order.data[k]];
  });
}

// Contacts in which each particle is the partner, by ascending id of the other.
void list_lower_contacts(const Parallel& parallel, std::span<const Index> id, const Contacts& contacts, Incidence& incidence) {
  const std::size_t n = id.size();
  auto& first = incidence.first_lower.data;
  auto& lower = incidence.lower.data;
  first.assign(n + 1, 0);
  lower.resize(contacts.rows());
  for (const Index j : contacts.j.data) ++first[j + 1];
  for (std::size_t p = 0; p < n; ++p) first[p + 1] += first[p];
  std::vector<Index> next(first.begin(), first.end() - 1);
  for (Index c = 0; c < contacts.rows(); ++c) lower[next[contacts.j.data[c]]++] = c;
  const auto by_id = [&](Index a, Index b) { return id[contacts.i.data[a]] < id[contacts.i.data[b]]; };
  parallel(n, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) std::sort(lower.begin() + first[p], lower.begin() + first[p + 1], by_id);
  });
}

}  // namespace

template <class Space>
void Broadphase<Space>::operator()(Parallel parallel, Read<&Search::due> due, Read<&Particles::id> id,
                                   Read<&Particles::position> position, Read<&Particles::radius> radius,
                                   Resize<CellGrid> grid,
                                   Resize<Contacts> contacts, Resize<PreviousContacts> previous,
                                   Resize<Incidence> incidence) const {
  if (!due[0]) return;
  const std::size_t n = position.size();
  const CellLayout layout = fit_cells(position, cell, space);
  sort_into_cells(parallel, layout, position, *grid.table);
  const auto& start = grid->start.data;
  const auto& order = grid->order.data;
  const auto& cell_position = grid->position.data;

  // Partners of each chunk of particles, and where the partners of each particle end in its chunk's list.
  constexpr std::size_t chunk = 1024;
  std::vector<std::vector<Partner>> found((n + chunk - 1) / chunk);
  std::vector<Index> end_in_chunk(n);
  parallel.chunks(n, chunk, [&](std::size_t k, std::size_t begin, std::size_t end) {
    auto& list = found[k];
    list.reserve(4 * (end - begin));
    for (std::size_t p = begin; p < end; ++p) {
      const Vec3 x = position[p];
      const double far = radius[p] + largest_radius + skin;
      const std::size_t mine = list.size();
      const auto look = [&](std::size_t first_cell, std::size_t last_cell) {
        for (Index s = start[first_cell]; s < start[last_cell + 1]; ++s) {
          const Vec3 d = space.shortest(cell_position[s] - x);
          const double distance2 = dot(d, d);
          if (!(distance2 < far * far)) continue;
          const Index q = order[s];
          const double near = radius[p] + radius[q] + skin;
          if (id[q] > id[p] && distance2 < near * near) list.push_back({id[q], q});
        }
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
      std::sort(list.begin() + mine, list.end(), [](const Partner& a, const Partner& b) { return a.id < b.id; });
      end_in_chunk[p] = static_cast<Index>(list.size());
    }
  });

  // The old contacts step back: contact_hashing takes their history from there.
  std::swap(previous->first.data, incidence->first.data);
  std::swap(previous->partner.data, contacts->partner.data);
  std::swap(previous->spring.data, contacts->spring.data);
  std::swap(previous->rolling.data, contacts->rolling.data);

  std::vector<std::size_t> offset(found.size() + 1, 0);
  for (std::size_t k = 0; k < found.size(); ++k) offset[k + 1] = offset[k] + found[k].size();
  const std::size_t total = offset.back();
  for (auto* c : {&contacts->i, &contacts->j, &contacts->partner}) c->data.resize(total);
  contacts->force.data.resize(total);
  contacts->torque_i.data.resize(columns.torque ? total : 0);
  contacts->torque_j.data.resize(columns.torque ? total : 0);
  contacts->spring.data.resize(columns.spring ? total : 0);
  contacts->rolling.data.resize(columns.rolling ? total : 0);
  incidence->first.data.resize(n + 1);
  incidence->first.data[n] = static_cast<Index>(total);
  parallel.chunks(n, chunk, [&](std::size_t k, std::size_t begin, std::size_t end) {
    std::size_t from = 0;
    for (std::size_t p = begin; p < end; ++p) {
      incidence->first.data[p] = static_cast<Index>(offset[k] + from);
      for (; from < end_in_chunk[p]; ++from) {
        const std::size_t c = offset[k] + from;
        contacts->i.data[c] = static_cast<Index>(p);
        contacts->j.data[c] = found[k][from].row;
        contacts->partner.data[c] = found[k][from].id;
      }
    }
  });
  list_lower_contacts(parallel, id, *contacts.table, *incidence.table);
}

template struct Broadphase<OpenSpace>;
template struct Broadphase<PeriodicSpace>;

}  // namespace skred
