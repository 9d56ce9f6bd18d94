// tests/engine/geometry/mesh_touch_test.cpp - a flat mesh is a plane; corners, ridges and seams.
#include <gtest/gtest.h>
#include "engine/geometry/mesh.h"
#include "engine/geometry/nearest_on_triangle.h"
#include "tests/engine/geometry/some_meshes.h"

using namespace skred;

namespace {

// Puts spheres at `foot` + height * z of a flat mesh in the plane z = 0 of `pose` and expects the contact of the plane.
void expect_plane(const Mesh& mesh, const Pose& pose, const Vec3& foot, double radius, double height, double tolerance) {
  const Vec3 normal = rotate(pose.orientation, {0, 0, height < 0 ? -1.0 : 1.0});
  const MeshContacts contacts = touch(mesh, to_world(pose, foot + Vec3{0, 0, height}), radius);
  ASSERT_EQ(contacts.count, 1u) << foot.x << ' ' << foot.y << ' ' << height << ' ' << radius;
  ASSERT_NEAR(contacts.at[0].overlap, radius - std::abs(height), tolerance * radius);
  ASSERT_LT(norm(contacts.at[0].normal - normal), tolerance);
}

// Heights on both sides, from deep to barely touching.
double some_height(double radius, Random& random) {
  const double height = radius * (random.uniform(0, 1) < 0.5 ? 1 - std::pow(10, random.uniform(-9, -1)) : random.uniform(0.1, 1));
  return random.uniform(0, 1) < 0.5 ? -height : height;
}

}  // namespace

TEST(MeshTouch, AFlatMeshIsAPlane) {
  Random random(1);
  for (const Pose& pose : {Pose{}, Pose{{3, -2, 1}, random.rotation()}, Pose{{0, 0, 0}, random.rotation()}}) {
    const Mesh mesh = flat_soup(16, 0.3, random).moved(pose).mesh();
    for (const double radius : {0.1, 0.6, 3.0})                       // spheres smaller and larger than the triangles
      for (int n = 0; n < 1500; ++n) {
        const Vec3 foot{random.uniform(-5, 5), random.uniform(-5, 5), 0};
        expect_plane(mesh, pose, foot, radius, some_height(radius, random), 1e-12);
        if (HasFatalFailure()) return;
      }
  }
}

TEST(MeshTouch, AFlatMeshIsAPlaneAboveItsEdgesAndVertices) {
  Random random(2);
  for (const Pose& pose : {Pose{}, Pose{{1, 2, 3}, random.rotation()}}) {
    const Soup flat = flat_soup(12, 0.3, random);
    Soup copy = flat;
    const Mesh mesh = copy.moved(pose).mesh();
    for (std::size_t t = 0; t < flat.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const Vec3 a = flat.vertices[flat.triangles[t][k]], b = flat.vertices[flat.triangles[t][(k + 1) % 3]];
        for (const double part : {0.0, 0.5, random.uniform(0, 1), 1e-15, 1 - 1e-15}) {
          const Vec3 foot = a + part * (b - a);
          if (std::max(std::abs(foot.x), std::abs(foot.y)) > 5) continue;
          const double radius = random.uniform(0.05, 2);
          expect_plane(mesh, pose, foot, radius, some_height(radius, random), 1e-12);
          if (HasFatalFailure()) return;
        }
      }
  }
}

// Squares of side 1 beside squares of side 1/3: their common line has vertices in the middle of edges.
TEST(MeshTouch, SeamsWithoutCommonVerticesAreHarmless) {
  Soup soup;
  for (int j = -4; j < 4; ++j)
    for (int i = -4; i < 0; ++i) soup.add({i + 0., j + 0., 0}, {i + 1., j + 0., 0}, {i + 1., j + 1., 0}, {i + 0., j + 1., 0});
  const double s = 1.0 / 3;
  for (int j = -12; j < 12; ++j)
    for (int i = 0; i < 12; ++i)
      soup.add({i * s, j * s, 0}, {(i + 1) * s, j * s, 0}, {(i + 1) * s, (j + 1) * s, 0}, {i * s, (j + 1) * s, 0});
  Random random(3);
  for (const Pose& pose : {Pose{}, Pose{{1, 2, 3}, random.rotation()}}) {
    Soup copy = soup;
    const Mesh exact = copy.moved(pose).mesh();
    for (Vec3& v : copy.vertices) v = in_single_precision(v);
    const Mesh rounded = copy.mesh();
    for (int n = 0; n < 4000; ++n) {
      const double radius = random.uniform(0.05, 1);
      const Vec3 foot{n % 4 == 0 ? 0 : random.uniform(-0.3, 0.3), random.uniform(-2, 2), 0};
      const double height = some_height(radius, random);
      expect_plane(exact, pose, foot, radius, height, 1e-7);
      if (radius - std::abs(height) > 1e-4 * radius) expect_plane(rounded, pose, foot, radius, height, 5e-3);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(MeshTouch, ACornerOfTwoWallsTouchesTwice) {
  Random random(4);
  Soup soup = flat_soup(10, 0, random);                                // floor; its middle line y = 0 carries the wall
  Soup wall = flat_soup(10, 0, random).moved({{0, 0, 5}, rotation_by({std::numbers::pi / 2, 0, 0})});
  for (Vec3& v : wall.vertices) v = {std::round(v.x), 0, std::round(v.z)};
  for (const Triangle& t : wall.triangles) soup.add(wall.vertices[t[0]], wall.vertices[t[1]], wall.vertices[t[2]]);
  const Mesh mesh = soup.mesh();
  for (int n = 0; n < 2000; ++n) {
    const double radius = random.uniform(0.2, 2);
    const Vec3 overlap{0, radius * random.uniform(1e-6, 0.1), radius * random.uniform(1e-6, 0.1)};
    const MeshContacts c = touch(mesh, {random.uniform(-2, 2), radius - overlap.y, radius - overlap.z}, radius);
    ASSERT_EQ(c.count, 2u);
    const int floor = overlap.z > overlap.y ? 0 : 1;                   // the deepest first
    EXPECT_NEAR(c.at[floor].overlap, overlap.z, 1e-14);
    EXPECT_NEAR(c.at[1 - floor].overlap, overlap.y, 1e-14);
    EXPECT_LT(norm(c.at[floor].normal - Vec3{0, 0, 1}), 1e-14);
    EXPECT_LT(norm(c.at[1 - floor].normal - Vec3{0, 1, 0}), 1e-14);
  }
}

TEST(MeshTouch, ABoxTouchesOnceOutsideAndThriceInItsCorner) {
  Soup soup;
  const auto corner = [](int k) { return Vec3{k & 1 ? 1. : -1., k & 2 ? 1. : -1., k & 4 ? 1. : -1.}; };
  for (const auto& f : {std::array{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}})
    soup.add(corner(f[0]), corner(f[1]), corner(f[2]), corner(f[3]));
  const Mesh mesh = soup.mesh();
  Random random(5);
  int touching = 0;
  for (int n = 0; n < 10000; ++n) {
    const Vec3 p = random.in_box(1.5);
    const Nearest exact = nearest(BoxShape{{1, 1, 1}}, p);
    if (exact.distance <= 0) continue;
    const MeshContacts c = touch(mesh, p, 0.3);
    ASSERT_EQ(c.count, exact.distance < 0.3 ? 1u : 0u);
    if (c.count == 0) continue;
    ++touching;
    ASSERT_NEAR(c.at[0].overlap, 0.3 - exact.distance, 1e-14);
    ASSERT_LT(norm(c.at[0].normal - exact.normal), 1e-12);
  }
  EXPECT_GT(touching, 2000);

  const MeshContacts c = touch(mesh, {0.71, -0.72, 0.73}, 0.3);
  ASSERT_EQ(c.count, 3u);
  EXPECT_NEAR(c.at[0].overlap, 0.03, 1e-15);
  EXPECT_NEAR(c.at[2].overlap, 0.01, 1e-15);
  EXPECT_EQ(c.at[0].normal, (Vec3{0, 0, -1}));
  EXPECT_EQ(c.at[1].normal, (Vec3{0, 1, 0}));
}

TEST(MeshTouch, ASheetHasTwoSidesAndAnEdge) {
  const Mesh sheet({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
  EXPECT_EQ(touch(sheet, {0.5, 0.5, 0.1}, 0.2).at[0].normal, (Vec3{0, 0, 1}));
  EXPECT_EQ(touch(sheet, {0.5, 0.5, -0.1}, 0.2).at[0].normal, (Vec3{0, 0, -1}));
  const MeshContacts edge = touch(sheet, {0.5, -0.15, 0}, 0.2), vertex = touch(sheet, {1.03, 1.04, 0}, 0.2);
  ASSERT_EQ(edge.count, 1u);
  EXPECT_EQ(edge.at[0].normal, (Vec3{0, -1, 0}));
  EXPECT_NEAR(edge.at[0].overlap, 0.05, 1e-15);
  ASSERT_EQ(vertex.count, 1u);
  EXPECT_LT(norm(vertex.at[0].normal - Vec3{0.6, 0.8, 0}), 1e-14);
  EXPECT_EQ(touch(sheet, {0.5, 0.5, 0.2}, 0.2).count, 0u);             // an overlap of 0 is no contact
}

TEST(MeshTouch, KeepsTheFourDeepestOfASteepPit) {
  Soup soup;
  for (int k = 0; k < 6; ++k) {
    const double a = std::numbers::pi / 3 * k, b = a + std::numbers::pi / 3, r = 1 + 0.01 * k;
    soup.add({r * std::cos(a), r * std::sin(a), -2}, {r * std::cos(b), r * std::sin(b), -2},
             {1.4 * r * std::cos(b), 1.4 * r * std::sin(b), 2}, {1.4 * r * std::cos(a), 1.4 * r * std::sin(a), 2});
  }
  const MeshContacts c = touch(soup.mesh(), {0, 0, 0}, 1.2);
  ASSERT_EQ(c.count, max_mesh_contacts);
  for (std::size_t k = 0; k < 4; ++k) {                                // sides 0 .. 3 are the nearest, in this order
    const double middle = std::numbers::pi / 3 * (k + 0.5);
    const Vec3 inwards = normalized(Vec3{-c.at[k].normal.x, -c.at[k].normal.y, 0});
    EXPECT_LT(norm(inwards - Vec3{std::cos(middle), std::sin(middle), 0}), 1e-2);
    if (k > 0) {
      EXPECT_LT(c.at[k].overlap, c.at[k - 1].overlap);
    }
  }
}

// On rough ground: the deepest overlap is the sphere's radius minus its distance from the mesh, normals keep apart, and
// triangles out of reach change no bit.
TEST(MeshTouch, RoughGround) {
  Random random(6);
  Soup soup = flat_soup(16, 0.3, random);
  for (Vec3& v : soup.vertices) v.z = 0.6 * std::sin(3 * v.x + 1.7 * v.y) * std::cos(2.1 * v.y);
  const Mesh mesh = soup.mesh();
  std::vector<std::uint32_t> all(mesh.triangles().size());
  for (std::uint32_t t = 0; t < all.size(); ++t) all[t] = t;
  int several = 0;
  for (int n = 0; n < 3000; ++n) {
    const Vec3 p{random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(-1, 2)};
    const double radius = random.uniform(0.1, 1.5);
    double distance = 1e300;
    for (const Triangle& t : mesh.triangles()) {
      const auto corner = [&](int k) { return mesh.vertices()[t[k]]; };
      const Vec3 normal = normalized(cross(corner(1) - corner(0), corner(2) - corner(0)));
      distance = std::min(distance, nearest_on_triangle(p, t, mesh.vertices(), normal).distance);
    }
    const MeshContacts near = touch(mesh, p, radius), whole = mesh.touch(p, radius, all);
    ASSERT_EQ(near.count > 0, distance < radius);
    ASSERT_EQ(near.count, whole.count);
    if (near.count == 0) continue;
    ASSERT_DOUBLE_EQ(near.at[0].overlap, radius - distance);
    for (std::size_t k = 0; k < near.count; ++k) {
      ASSERT_EQ(near.at[k].overlap, whole.at[k].overlap);
      ASSERT_EQ(near.at[k].normal, whole.at[k].normal);
      ASSERT_GT(near.at[k].overlap, 0);
      ASSERT_LE(near.at[k].overlap, near.at[0].overlap);
    }
    several += near.count > 1;
  }
  EXPECT_GT(several, 100);
}
