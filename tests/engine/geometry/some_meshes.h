// tests/engine/geometry/some_meshes.h - meshes and random numbers for the tests of geometry.
#pragma once
#include <algorithm>
#include <numbers>
#include <random>
#include "engine/geometry/mesh.h"

namespace skred {

struct Random {
  std::mt19937_64 engine;
  explicit Random(unsigned seed) : engine(seed) {}
  double uniform(double min, double max) { return std::uniform_real_distribution<double>(min, max)(engine); }
  Vec3 in_box(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  Vec3 direction() {
    for (;;) {
      const Vec3 v = in_box(1);
      if (const double d = norm(v); d > 0.1 && d < 1) return (1 / d) * v;
    }
  }
  Quaternion rotation() { return rotation_by(uniform(0, std::numbers::pi) * direction()); }
};

// As a file in single precision has it. Volatile, because g++ 12.2 -O2 drops the way to float and back of neighbouring members.
inline Vec3 in_single_precision(const Vec3& v) {
  volatile float x = static_cast<float>(v.x), y = static_cast<float>(v.y), z = static_cast<float>(v.z);
  return {x, y, z};
}

// A mesh while it is being built.
struct Soup {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;

  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto n = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), {a, b, c});
    triangles.push_back({n, n + 1, n + 2});
  }
  // Two triangles; the corners go around.
  void add(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) { add(a, b, c), add(a, c, d); }
  Soup& moved(const Pose& pose) {
    for (Vec3& v : vertices) v = to_world(pose, v);
    return *this;
  }
  Mesh mesh() const { return Mesh(vertices, triangles); }
};

// The square |x|, |y| <= cells / 2 of the plane z = 0: a grid of side 1 with its vertices moved by up to `jitter`, random
// diagonals, random winding, triangles in random order.
inline Soup flat_soup(int cells, double jitter, Random& random) {
  const int n = cells + 1;
  std::vector<Vec3> grid;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      grid.push_back({i - 0.5 * cells + random.uniform(-jitter, jitter), j - 0.5 * cells + random.uniform(-jitter, jitter), 0});
  std::vector<std::array<Vec3, 3>> corners;
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const Vec3 a = grid[j * n + i], b = grid[j * n + i + 1], c = grid[(j + 1) * n + i + 1], d = grid[(j + 1) * n + i];
      if (random.uniform(0, 1) < 0.5) corners.push_back({a, b, c}), corners.push_back({a, c, d});
      else corners.push_back({a, b, d}), corners.push_back({b, c, d});
    }
  std::shuffle(corners.begin(), corners.end(), random.engine);
  Soup soup;
  for (const auto& t : corners)
    if (random.uniform(0, 1) < 0.5) soup.add(t[0], t[1], t[2]);
    else soup.add(t[0], t[2], t[1]);
  return soup;
}

inline MeshContacts touch(const Mesh& mesh, const Vec3& centre, double radius) {
  std::vector<std::uint32_t> near;
  mesh.find(centre, radius, near);
  return mesh.touch(centre, radius, near);
}

}  // namespace skred
