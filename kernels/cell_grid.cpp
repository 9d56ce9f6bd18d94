#include "kernels/cell_grid.h"

namespace skred {

namespace {

struct Extent { double low, high; };

// The range of one coordinate; with `trim`, of all but the outermost half per cent on either side.
Extent extent(std::span<const Vec3> x, double Vec3::* along, bool trim) {
  std::vector<double> sample;
  const std::size_t stride = trim ? std::max<std::size_t>(1, x.size() / 20000) : 1;
  Extent e{x[0].*along, x[0].*along};
  for (std::size_t p = 0; p < x.size(); p += stride) {
    const double v = x[p].*along;
    e = {std::min(e.low, v), std::max(e.high, v)};
    if (trim) sample.push_back(v);
  }
  if (!trim) return e;
  const std::size_t cut = sample.size() / 200;
  std::nth_element(sample.begin(), sample.begin() + cut, sample.end());
  e.low = sample[cut];
  std::nth_element(sample.begin(), sample.end() - 1 - cut, sample.end());
  e.high = sample[sample.size() - 1 - cut];
  return e;
}

CellLayout fit(std::span<const Vec3> x, double edge, const Vec3& low, const Vec3& length) {
  CellLayout layout;
  if (x.empty()) return layout;
  const std::array along{&Vec3::x, &Vec3::y, &Vec3::z};
  const double most = 64 + 4.0 * double(x.size());
  for (const bool trim : {false, true}) {
    std::array<Extent, 3> range;
    for (int a = 0; a < 3; ++a)
      range[a] = std::isfinite(length.*along[a]) ? Extent{low.*along[a], low.*along[a] + length.*along[a]} : extent(x, along[a], trim);
    for (double width = edge;; width *= 1.26) {              // 1.26^3 = 2: half the cells at each try
      double total = 1;
      for (int a = 0; a < 3; ++a) {
        CellAxis& c = layout.axis[a];
        const double size = range[a].high - range[a].low;
        c.periodic = std::isfinite(length.*along[a]);
        const double count = c.periodic ? std::max(1.0, std::floor(size / width)) : std::floor(size / width) + 1;
        total *= count;
        c.count = static_cast<int>(std::min(count, 1e6));
        c.low = range[a].low;
        c.inverse_width = c.periodic ? c.count / size : 1 / width;
      }
      if (total <= most) return layout;
      if (!trim) break;                                      // first leave out the few that are far away
    }
  }
  return layout;
}

constexpr double infinite = std::numeric_limits<double>::infinity();

}  // namespace

CellLayout fit_cells(std::span<const Vec3> position, double edge, const OpenSpace&) {
  return fit(position, edge, {}, {infinite, infinite, infinite});
}
CellLayout fit_cells(std::span<const Vec3> position, double edge, const PeriodicSpace& space) {
  return fit(position, edge, space.min, space.length);
}

}  // namespace skred
