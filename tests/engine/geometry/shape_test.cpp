// tests/engine/geometry/shape_test.cpp - nearest places of analytic shapes against FCL and against their own definition.
#include "engine/geometry/shape.h"
#include <fcl/narrowphase/collision.h>
#include <gtest/gtest.h>
#include "tests/engine/geometry/some_meshes.h"

using namespace skred;

namespace {

// Overlap and normal of a sphere that touches an FCL shape, by FCL (these pairs are closed forms there).
struct FclContact { double overlap; Vec3 normal; };
FclContact fcl_contact(const fcl::CollisionGeometryd& shape, const Vec3& centre, double radius) {
  const fcl::Sphered sphere(radius);
  fcl::Transform3d at = fcl::Transform3d::Identity();
  at.translation() = fcl::Vector3d(centre.x, centre.y, centre.z);
  const fcl::CollisionRequestd request(1, true);
  fcl::CollisionResultd result;
  fcl::collide<double>(&shape, fcl::Transform3d::Identity(), &sphere, at, request, result);
  if (result.numContacts() == 0) return {0, {}};
  const auto& c = result.getContact(0);
  return {c.penetration_depth, {c.normal.x(), c.normal.y(), c.normal.z()}};
}

template <class S> void compare(const S& shape, const fcl::CollisionGeometryd& oracle, double size, unsigned seed) {
  Random random(seed);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p = random.in_box(2 * size);
    const Nearest mine = nearest(shape, p);
    const double radius = std::max(mine.distance, 0.0) + random.uniform(0.01, 1) * size;
    const FclContact theirs = fcl_contact(oracle, p, radius);
    ASSERT_NEAR(theirs.overlap, radius - mine.distance, 1e-12 * size) << p.x << ' ' << p.y << ' ' << p.z;
    ASSERT_LT(norm(theirs.normal - mine.normal), 1e-7) << p.x << ' ' << p.y << ' ' << p.z;
    ASSERT_TRUE(mine.distance <= 0 || fcl_contact(oracle, p, 0.999 * mine.distance).overlap == 0);
  }
}

// The distance is that to the surface in the direction of the normal, is 0 there and grows by 1 per metre along the normal.
template <class S> void check_definition(const S& shape, double size, unsigned seed) {
  Random random(seed);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p = random.in_box(1.5 * size);
    const Nearest at = nearest(shape, p);
    ASSERT_NEAR(norm(at.normal), 1, 1e-14);
    ASSERT_NEAR(nearest(shape, p - at.distance * at.normal).distance, 0, 1e-13 * size);
    const double step = 1e-6 * size;
    if (std::abs(at.distance) < 10 * step) continue;                  // a step may cross the surface's edge
    ASSERT_NEAR(nearest(shape, p + step * at.normal).distance, at.distance + step, 1e-12 * size);
    ASSERT_LE(std::abs(nearest(shape, p + step * random.direction()).distance - at.distance), step * (1 + 1e-9));
  }
}

// At places where a direction is undefined the normal is some unit vector and the distance is exact.
template <class S> void check_special(const S& shape, const Vec3& point, double distance) {
  const Nearest at = nearest(shape, point);
  EXPECT_DOUBLE_EQ(at.distance, distance);
  EXPECT_DOUBLE_EQ(norm(at.normal), 1);
}

}  // namespace

TEST(Shape, PlaneEqualsFcl) { compare(PlaneShape{}, fcl::Halfspaced(fcl::Vector3d(0, 0, 1), 0), 1, 1); }
TEST(Shape, SphereEqualsFcl) { compare(SphereShape{0.7}, fcl::Sphered(0.7), 0.7, 2); }
TEST(Shape, BoxEqualsFcl) { compare(BoxShape{{0.3, 0.5, 0.8}}, fcl::Boxd(0.6, 1.0, 1.6), 0.8, 3); }
TEST(Shape, CylinderEqualsFcl) { compare(CylinderShape{0.4, 1.6}, fcl::Cylinderd(0.4, 1.6), 0.8, 4); }

TEST(Shape, HollowCylinderOutsideEqualsFclCylinder) {
  const HollowCylinderShape hollow{0.5, 1, 0.1};
  const fcl::Cylinderd solid(0.6, 1);
  Random random(5);
  int count = 0;
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p = random.in_box(1.2);
    const Nearest mine = nearest(hollow, p);
    if (std::hypot(p.x, p.y) < 0.55 || mine.distance < 0) continue;
    const double radius = mine.distance + 0.1;
    ASSERT_NEAR(fcl_contact(solid, p, radius).overlap, 0.1, 1e-12);
    ++count;
  }
  EXPECT_GT(count, 10000);
}

TEST(Shape, HollowCylinderIsNearestToItsSampledSection) {
  const HollowCylinderShape hollow{0.5, 1, 0.2};
  Random random(6);
  for (int n = 0; n < 300; ++n) {
    const Vec3 p{random.uniform(0, 1), 0, random.uniform(-1, 1)};
    const bool inside = p.x > 0.5 && p.x < 0.7 && std::abs(p.z) < 0.5;
    double sampled = 10;
    for (int k = 0; k <= 2000; ++k) {
      const double s = k / 2000.0;
      const double z = s - 0.5, x = 0.5 + 0.2 * s;
      for (const Vec3& q : {Vec3{0.5, 0, z}, Vec3{0.7, 0, z}, Vec3{x, 0, -0.5}, Vec3{x, 0, 0.5}})
        sampled = std::min(sampled, norm(p - q));
    }
    const double distance = nearest(hollow, p).distance;
    EXPECT_EQ(distance < 0, inside);
    EXPECT_NEAR(std::abs(distance), sampled, 3e-4);
  }
}

TEST(Shape, DistancesMeetTheirDefinition) {
  check_definition(PlaneShape{}, 1, 11);
  check_definition(SphereShape{0.7}, 1, 12);
  check_definition(BoxShape{{0.3, 0.5, 0.8}}, 1, 13);
  check_definition(CylinderShape{0.4, 1.2}, 1, 14);
  check_definition(HollowCylinderShape{0.5, 1, 0.2}, 1, 15);
}

TEST(Shape, AxesCentresCornersAndSurfaces) {
  check_special(SphereShape{2}, {0, 0, 0}, -2);
  check_special(BoxShape{{1, 2, 3}}, {0, 0, 0}, -1);
  check_special(BoxShape{{1, 2, 3}}, {1, 2, 3}, 0);
  check_special(BoxShape{{1, 1, 1}}, {2, 2, 2}, std::sqrt(3.0));
  check_special(BoxShape{{1, 1, 1}}, {0.5, -0.5, 0.5}, -0.5);
  check_special(CylinderShape{1, 6}, {0, 0, 0}, -1);
  check_special(CylinderShape{1, 1}, {0, 0, 0}, -0.5);
  check_special(CylinderShape{1, 2}, {0, 0, 4}, 3);
  check_special(CylinderShape{1, 2}, {0, 1, 1}, 0);
  check_special(HollowCylinderShape{1, 2, 0.5}, {0, 0, 0}, 1);
  check_special(HollowCylinderShape{1, 2, 0.5}, {0, 0, -1}, 1);
  check_special(HollowCylinderShape{1, 2, 0.5}, {1, 0, 0}, 0);
  check_special(HollowCylinderShape{1, 2, 0.5}, {0, 1.25, 0}, -0.25);
  check_special(HollowCylinderShape{3, 4, 0.5}, {0, 0, 6}, 5);
}

TEST(Shape, ParticlesInAHollowCylinderArePushedToTheAxis) {
  const Nearest at = nearest(HollowCylinderShape{0.2, 0.1, 0.01}, {0.12, -0.09, 0.02});
  EXPECT_NEAR(at.distance, 0.05, 1e-16);
  EXPECT_NEAR(norm(at.normal - Vec3{-0.8, 0.6, 0}), 0, 1e-15);
}

TEST(Shape, OnlySpheresAreCurved) {
  EXPECT_EQ(nearest(SphereShape{0.25}, {1, 0, 0}).curvature, 4);
  EXPECT_EQ(nearest(BoxShape{{1, 1, 1}}, {2, 2, 0}).curvature, 0);
  EXPECT_EQ(nearest(CylinderShape{1, 1}, {2, 2, 0}).curvature, 0);
  EXPECT_EQ(nearest(HollowCylinderShape{1, 1, 1}, {0.1, 0, 0}).curvature, 0);
  EXPECT_EQ(nearest(PlaneShape{}, {2, 2, 0}).curvature, 0);
}

TEST(Shape, BoundsRadiiAndNames) {
  const std::vector<Vec3> corners{{0, 0, 0}, {2, 0, 0}, {0, -3, 1}};
  const auto mesh = std::make_shared<const Mesh>(corners, std::vector<Triangle>{{0, 1, 2}});
  const struct { Shape shape; Vec3 min, max; double radius; const char* name; } rows[] = {
      {SphereShape{2}, {-2, -2, -2}, {2, 2, 2}, 2, "sphere"},
      {BoxShape{{2, 3, 6}}, {-2, -3, -6}, {2, 3, 6}, 7, "box"},
      {CylinderShape{3, 8}, {-3, -3, -4}, {3, 3, 4}, 5, "cylinder"},
      {HollowCylinderShape{2, 8, 1}, {-3, -3, -4}, {3, 3, 4}, 5, "hollow_cylinder"},
      {MeshShape{mesh}, {0, -3, 0}, {2, 0, 1}, std::sqrt(10.0), "mesh"},
  };
  for (const auto& row : rows) {
    EXPECT_EQ(bounds(row.shape).min, row.min) << row.name;
    EXPECT_EQ(bounds(row.shape).max, row.max) << row.name;
    EXPECT_DOUBLE_EQ(outer_radius(row.shape), row.radius) << row.name;
    EXPECT_STREQ(shape_name(row.shape), row.name);
  }
  EXPECT_TRUE(std::isinf(outer_radius(PlaneShape{})));
  EXPECT_TRUE(std::isinf(bounds(PlaneShape{}).max.x) && std::isinf(bounds(PlaneShape{}).min.z));
  EXPECT_STREQ(shape_name(PlaneShape{}), "plane");
}
