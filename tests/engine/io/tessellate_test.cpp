// tests/engine/io/tessellate_test.cpp - closed, outward, on the true surface, with the volume of the inscribed polyhedron.
#include "engine/io/tessellate.h"
#include <gtest/gtest.h>
#include <cmath>
#include <map>
#include <numbers>

using namespace skred;

namespace {

constexpr double pi = std::numbers::pi;

// Of the solid inside; negative if the corners run the wrong way.
double volume(const Surface& s) {
  double sum = 0;
  for (const Triangle& t : s.triangles) sum += dot(s.vertices[t[0]], cross(s.vertices[t[1]], s.vertices[t[2]])) / 6;
  return sum;
}

void expect_closed(const Surface& s) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Triangle& t : s.triangles)
    for (int k = 0; k < 3; ++k) ++edges[{t[std::size_t(k)], t[std::size_t((k + 1) % 3)]}];
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(edges.count({edge.second, edge.first})) << "edge " << edge.first << "-" << edge.second << " is open";
  }
}

template <class S> Surface checked(const S& shape) {
  const Surface s = tessellate(shape);
  for (const Vec3& v : s.vertices) EXPECT_NEAR(nearest(shape, v).distance, 0, 1e-12);
  expect_closed(s);
  return s;
}

// Area of a regular polygon of 96 corners over that of its circle.
const double polygon = 96 / (2 * pi) * std::sin(2 * pi / 96);

}  // namespace

TEST(Tessellate, Box) { EXPECT_NEAR(volume(checked(BoxShape{{0.1, 0.2, 0.3}})), 8 * 0.1 * 0.2 * 0.3, 1e-15); }

TEST(Tessellate, Sphere) {
  const double v = volume(checked(SphereShape{0.5})), ball = 4.0 / 3 * pi * 0.125;
  EXPECT_LT(v, ball);
  EXPECT_GT(v, 0.995 * ball);
}

TEST(Tessellate, Cylinder) { EXPECT_NEAR(volume(checked(CylinderShape{0.3, 2})), pi * 0.09 * 2 * polygon, 1e-12); }

TEST(Tessellate, HollowCylinderHasBothWalls) {
  EXPECT_NEAR(volume(checked(HollowCylinderShape{0.3, 2, 0.1})), pi * (0.16 - 0.09) * 2 * polygon, 1e-12);
}

TEST(Tessellate, PlaneFacesUp) {
  const Surface s = tessellate(PlaneShape{}, {1, 2, 0.5});
  ASSERT_EQ(s.triangles.size(), 2u);
  double area = 0;
  for (const Triangle& t : s.triangles) {
    const Vec3 n = cross(s.vertices[t[1]] - s.vertices[t[0]], s.vertices[t[2]] - s.vertices[t[0]]);
    EXPECT_GT(n.z, 0);
    area += 0.5 * norm(n);
  }
  EXPECT_DOUBLE_EQ(area, 1);
  EXPECT_EQ(s.vertices[0], (Vec3{0.5, 1.5, 0}));
}

TEST(Tessellate, MeshIsItself) {
  const auto mesh = std::make_shared<const Mesh>(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                                 std::vector<Triangle>{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
  const Surface s = tessellate(MeshShape{mesh});
  EXPECT_EQ(s.vertices.size(), 4u);
  EXPECT_NEAR(volume(s), 1.0 / 6, 1e-15);
}

TEST(Tessellate, AppendMovesAndRenumbers) {
  Surface whole = tessellate(BoxShape{{1, 1, 1}});
  append(whole, tessellate(BoxShape{{1, 1, 1}}), Pose{{10, 0, 0}, rotation_by({0, 0, pi / 4})});
  EXPECT_EQ(whole.vertices.size(), 16u);
  EXPECT_EQ(whole.triangles.size(), 24u);
  EXPECT_NEAR(volume(whole), 16, 1e-12);
  expect_closed(whole);
}
