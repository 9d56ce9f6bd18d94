#include "kernels/reorder.h"
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <oneapi/tbb/parallel_sort.h>

namespace skred {

namespace {

// Spreads the low 21 bits of v to every third bit (Morton order).
std::uint64_t spread(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | v << 32) & 0x1f00000000ffff;
  v = (v | v << 16) & 0x1f0000ff0000ff;
  v = (v | v << 8) & 0x100f00f00f00f00f;
  v = (v | v << 4) & 0x10c30c30c30c30c3;
  return (v | v << 2) & 0x1249249249249249;
}

std::uint64_t along(double x, double low, double cell) {
  return static_cast<std::uint64_t>(std::clamp((x - low) / cell, 0.0, double(0x1fffff)));
}

}  // namespace

void Reorder::operator()(Read<&Search::due> due, Read<&Clock::step> step, Update<&Search::rows_changed> changed,
                         Write<&Search::reordered> reordered, Resize<Particles> particles) const {
  const std::size_t n = particles->rows();
  const bool sorts = due[0] && reorders(step[0], every) && n > 0;
  const bool known = changed[0];                             // previous_row tells of an older order already: it is sorted with the rest
  reordered[0] = sorts || known;
  changed[0] = 0;
  if (!sorts) return;

  auto& previous = particles->previous_row.data;
  previous.resize(n);
  if (!known) std::iota(previous.begin(), previous.end(), Index{0});
  const auto& x = particles->position.data;
  Vec3 low = x[0];
  for (const Vec3& p : x) low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
  struct Key { std::uint64_t code; Index id, row; };
  std::vector<Key> keys(n);
  for (Index p = 0; p < n; ++p)
    keys[p] = {spread(along(x[p].x, low.x, cell)) | spread(along(x[p].y, low.y, cell)) << 1 |
                   spread(along(x[p].z, low.z, cell)) << 2,
               particles->id.data[p], p};
  tbb::parallel_sort(keys.begin(), keys.end(),
                     [](const Key& a, const Key& b) { return a.code != b.code ? a.code < b.code : a.id < b.id; });

  const auto permute = [&](auto& column) {
    if (column.data.size() != n) return;                     // an effect that is out leaves its columns empty
    auto sorted = column.data;
    for (std::size_t p = 0; p < n; ++p) sorted[p] = column.data[keys[p].row];
    column.data = std::move(sorted);
  };
  std::apply([&](auto... c) { (permute((*particles.table).*c), ...); }, Particles::columns());
}

}  // namespace skred
