// tests/engine/geometry/nearest_on_triangle_test.cpp - the nearest place of a triangle against minimisation by search.
#include "engine/geometry/nearest_on_triangle.h"
#include <gtest/gtest.h>
#include "tests/engine/geometry/some_meshes.h"

using namespace skred;

namespace {

const Triangle corners{0, 1, 2};

Vec3 normal_of(const std::array<Vec3, 3>& v) { return normalized(cross(v[1] - v[0], v[2] - v[0])); }

// The least of a convex function on [0, 1], by ternary search.
template <class F> double least(const F& f) {
  double low = 0, high = 1;
  for (int n = 0; n < 70; ++n) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (f(a) < f(b)) high = b;
    else low = a;
  }
  return f(0.5 * (low + high));
}

// Least distance to the chords of the triangle parallel to the side opposite to corner 0: convex along and across them.
double searched_distance(const Vec3& point, const std::array<Vec3, 3>& v) {
  return std::sqrt(least([&](double a) {
    const Vec3 begin = v[0] + a * (v[1] - v[0]), chord = a * (v[2] - v[1]);
    return least([&](double b) {
      const Vec3 d = begin + b * chord - point;
      return dot(d, d);
    });
  }));
}

}  // namespace

TEST(NearestOnTriangle, EqualsSearchForRandomTriangles) {
  Random random(1);
  for (int n = 0; n < 200; ++n) {
    const std::array<Vec3, 3> v{random.in_box(1), random.in_box(1), random.in_box(1)};
    const Vec3 p = random.in_box(1.5);
    const TrianglePlace place = nearest_on_triangle(p, corners, v, normal_of(v));
    ASSERT_NEAR(place.distance, searched_distance(p, v), 1e-7) << n;
    ASSERT_NEAR(norm(place.normal), 1, 1e-14);
    ASSERT_NEAR(searched_distance(p - place.distance * place.normal, v), 0, 1e-6) << n;
  }
}

TEST(NearestOnTriangle, FeaturesOfAKnownTriangle) {
  const std::array<Vec3, 3> v{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
  const struct { Vec3 point; Feature feature; double distance; } rows[] = {
      {{0.2, 0.2, 0.5}, Feature::face, 0.5},     {{0.2, 0.2, -0.5}, Feature::face, 0.5},
      {{0.5, -3, 4}, Feature::edge0, 5},         {{1, 1, 0}, Feature::edge1, std::sqrt(0.5)},
      {{-3, 0.5, 4}, Feature::edge2, 5},         {{-3, -4, 0}, Feature::corner0, 5},
      {{4, 0, 4}, Feature::corner1, 5},          {{0, 4, -4}, Feature::corner2, 5},
      {{0.5, 0, 2}, Feature::face, 2},           {{0, 0, 2}, Feature::face, 2},
  };
  for (const auto& row : rows) {
    const TrianglePlace place = nearest_on_triangle(row.point, corners, v, {0, 0, 1});
    EXPECT_EQ(place.feature, row.feature) << row.point.x << ' ' << row.point.y << ' ' << row.point.z;
    EXPECT_DOUBLE_EQ(place.distance, row.distance);
    EXPECT_GE(dot(place.normal, row.point), 0);
  }
}

// Beyond an obtuse corner the nearest point may lie on an edge whose line is not the nearest.
TEST(NearestOnTriangle, ObtuseAndSliverTriangles) {
  Random random(2);
  for (int n = 0; n < 200; ++n) {
    const double thin = std::pow(10, random.uniform(-4, 0));
    const std::array<Vec3, 3> v{Vec3{-1, 0, 0}, Vec3{1, 0, 0}, Vec3{random.uniform(-1.5, 1.5), thin, 0}};
    const Vec3 p = random.in_box(2);
    EXPECT_NEAR(nearest_on_triangle(p, corners, v, {0, 0, 1}).distance, searched_distance(p, v), 1e-7);
  }
}

TEST(NearestOnTriangle, SharedEdgesGiveTheSameBits) {
  Random random(3);
  int on_edge = 0;
  for (int n = 0; n < 5000; ++n) {
    const std::array<Vec3, 4> v{random.in_box(1), random.in_box(1), random.in_box(1), random.in_box(1)};
    const Triangle left{0, 1, 2}, right{1, 0, 3};
    const Vec3 p = random.in_box(2);
    const auto normal = [&](const Triangle& t) { return normalized(cross(v[t[1]] - v[t[0]], v[t[2]] - v[t[0]])); };
    const TrianglePlace a = nearest_on_triangle(p, left, v, normal(left)), b = nearest_on_triangle(p, right, v, normal(right));
    if (a.feature != Feature::edge0 || b.feature != Feature::edge0) continue;
    ++on_edge;
    EXPECT_EQ(a.distance, b.distance);
    EXPECT_EQ(a.normal, b.normal);
  }
  EXPECT_GT(on_edge, 100);
}

TEST(NearestOnTriangle, APointOnTheTriangleHasTheFaceNormal) {
  const std::array<Vec3, 3> v{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
  for (const Vec3& p : {Vec3{0.2, 0.2, 0}, Vec3{0.5, 0, 0}, Vec3{0.5, 0.5, 0}, Vec3{1, 0, 0}, Vec3{0, 0, 0}}) {
    const TrianglePlace place = nearest_on_triangle(p, corners, v, {0, 0, 1});
    EXPECT_EQ(place.distance, 0);
    EXPECT_EQ(place.normal, (Vec3{0, 0, 1}));
  }
}
