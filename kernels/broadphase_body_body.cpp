#include "kernels/broadphase_body_body.h"
#include <algorithm>
#include <array>
#include <cmath>

namespace skred {

namespace {

struct Extent { Index geometry, body; bool dynamic; std::array<double, 3> low, high; };

// The box in the world around the box of a shape; a plane has none that ends.
Extent extent_of(const Shape& shape, const Pose& pose, double margin) {
  const Bounds box = bounds(shape);
  Extent e{};
  const Vec3 half = 0.5 * (box.max - box.min);
  const Vec3 middle = std::isfinite(half.x) ? to_world(pose, 0.5 * (box.max + box.min)) : pose.position;
  const Vec3 x = rotate(pose.orientation, {1, 0, 0}), y = rotate(pose.orientation, {0, 1, 0}), z = rotate(pose.orientation, {0, 0, 1});
  const auto along = [&](double Vec3::* c) {
    return std::isfinite(half.x) ? std::abs(x.*c) * half.x + std::abs(y.*c) * half.y + std::abs(z.*c) * half.z : half.x;
  };
  const std::array<double, 3> at{middle.x, middle.y, middle.z}, reach{along(&Vec3::x), along(&Vec3::y), along(&Vec3::z)};
  for (int a = 0; a < 3; ++a) e.low[a] = at[a] - reach[a] - 0.5 * margin, e.high[a] = at[a] + reach[a] + 0.5 * margin;
  return e;
}

// The direction in which the dynamic bodies are spread most.
int widest_direction(const std::vector<Extent>& extents) {
  std::array<double, 3> spread{};
  for (int a = 0; a < 3; ++a) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Extent& e : extents)
      if (e.dynamic) low = std::min(low, e.low[a]), high = std::max(high, e.low[a]);
    spread[a] = high - low;
  }
  return static_cast<int>(std::max_element(spread.begin(), spread.end()) - spread.begin());
}

}  // namespace

void BroadphaseBodyBody::operator()(Read<&Geometries::body> body, Read<&Geometries::shape> shape, Read<&Geometries::local> local,
                                    Read<&Bodies::motion> motion, Read<&Bodies::pose> pose, Resize<RigidPairs> pairs) const {
  std::vector<Extent> extents;
  for (Index g = 0; g < shape.size(); ++g) {
    extents.push_back(extent_of(shape[g], pose[body[g]] * local[g], margin));
    extents.back().geometry = g;
    extents.back().body = body[g];
    extents.back().dynamic = motion[body[g]] == Motion::dynamic;
  }
  const int sweep = widest_direction(extents);
  std::sort(extents.begin(), extents.end(), [&](const Extent& a, const Extent& b) {
    return a.low[sweep] != b.low[sweep] ? a.low[sweep] < b.low[sweep] : a.geometry < b.geometry;
  });
  std::vector<std::pair<Index, Index>> found;
  for (auto e = extents.begin(); e != extents.end(); ++e)
    for (auto f = e + 1; f != extents.end() && f->low[sweep] <= e->high[sweep]; ++f) {
      bool apart = e->body == f->body || (!e->dynamic && !f->dynamic);
      for (int a = 0; a < 3 && !apart; ++a) apart = e->low[a] > f->high[a] || f->low[a] > e->high[a];
      if (!apart) found.push_back(std::minmax(e->geometry, f->geometry));
    }
  std::sort(found.begin(), found.end());
  pairs->a.data.clear();
  pairs->b.data.clear();
  for (const auto& [a, b] : found) {
    pairs->a.data.push_back(a);
    pairs->b.data.push_back(b);
  }
}

}  // namespace skred
