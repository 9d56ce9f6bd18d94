// tests/engine/geometry/mesh_rolling_test.cpp - contacts of a sphere that rolls over a mesh change continuously.
#include <gtest/gtest.h>
#include "engine/geometry/mesh.h"
#include "tests/engine/geometry/some_meshes.h"

using namespace skred;

namespace {

struct Path {
  std::size_t most_contacts = 0, fewest_contacts = 99;
  double overlap_jump = 0, normal_jump = 0;         // between neighbouring positions
  double least_overlap = 1e300, most_overlap = 0;
};

// Follows a sphere along `centre(s)`, s = 0 .. 1.
template <class Centre> Path follow(const Mesh& mesh, double radius, int steps, const Centre& centre) {
  Path path;
  MeshContact before{};
  for (int n = 0; n <= steps; ++n) {
    const MeshContacts c = touch(mesh, centre(static_cast<double>(n) / steps), radius);
    path.most_contacts = std::max(path.most_contacts, c.count);
    path.fewest_contacts = std::min(path.fewest_contacts, c.count);
    if (c.count == 0) continue;
    path.least_overlap = std::min(path.least_overlap, c.at[0].overlap);
    path.most_overlap = std::max(path.most_overlap, c.at[0].overlap);
    if (n > 0) {
      path.overlap_jump = std::max(path.overlap_jump, std::abs(c.at[0].overlap - before.overlap));
      path.normal_jump = std::max(path.normal_jump, norm(c.at[0].normal - before.normal));
    }
    before = c.at[0];
  }
  return path;
}

}  // namespace

// Facets of 1.5 degrees of a drum of radius 0.2 m, inside (concave) and outside (convex), with the pellets of the thesis.
TEST(MeshRolling, AFacetedCylinderIsSmooth) {
  const double drum = 0.2, radius = 6.36665e-3, facet = 2 * std::numbers::pi / 240;
  const auto mesh = read_mesh(SKRED_SOURCE_DIR "/scenes/meshes/cylinder.obj", {drum, drum, 0.2});
  ASSERT_EQ(mesh->triangles().size(), 480u);
  const double sagitta = drum * facet * facet / 8;                     // between a facet's middle and its edges [m]
  for (const double side : {-1.0, 1.0})
    for (const double overlap : {3e-3 * radius, 1e-2 * radius, 5e-2 * radius}) {
      ASSERT_GT(overlap, sagitta);                                     // or it loses touch at the edges
      const double orbit = drum + side * (radius - overlap);
      const int steps = 40000;
      const Path path = follow(*mesh, radius, steps, [&](double s) {
        const double phi = 0.3 + 5 * facet * s;
        return Vec3{orbit * std::cos(phi), orbit * std::sin(phi), 0.08 * s - 0.04};   // across the diagonals too
      });
      EXPECT_EQ(path.fewest_contacts, 1u);
      EXPECT_EQ(path.most_contacts, 1u);
      EXPECT_LT(path.most_overlap - path.least_overlap, 1.01 * sagitta) << side << ' ' << overlap;
      EXPECT_NEAR(0.5 * (path.most_overlap + path.least_overlap), overlap, 0.3 * sagitta);
      // 8000 positions per facet: the overlap changes by at most the slope of a facet, the normal turns by 1.5 degrees in a
      // part of a facet's width. A jump would be of the order of 1 degree.
      EXPECT_LT(path.overlap_jump, 1e-3 * sagitta);
      EXPECT_LT(path.normal_jump, 0.05 * facet) << side << ' ' << overlap;
    }
}

// A concave bend less than merge_angle: the place on the second face fades in and out.
TEST(MeshRolling, AConcaveBendTurnsTheNormalContinuously) {
  for (const double bend : {0.05, 0.2, 0.4})
    for (const double overlap : {1e-3, 1e-2, 0.1}) {
      Soup soup;
      const Vec3 up{2 * std::cos(bend), 0, 2 * std::sin(bend)};
      soup.add({-2, -1, 0}, {0, -1, 0}, {0, 1, 0}, {-2, 1, 0});
      soup.add({0, -1, 0}, up + Vec3{0, -1, 0}, up + Vec3{0, 1, 0}, {0, 1, 0});
      const Mesh mesh = soup.mesh();
      const int steps = 20000;
      // At the same depth in one face, then in the other.
      const double turn = -std::tan(bend / 2) * (1 - overlap);
      const Path path = follow(mesh, 1, steps, [&](double s) {
        const double x = s - 0.5 + turn;
        return x < turn ? Vec3{x, 0.1 * s, 1 - overlap}
                        : Vec3{turn + (x - turn) * std::cos(bend), 0.1 * s, 1 - overlap + (x - turn) * std::sin(bend)};
      });
      EXPECT_EQ(path.fewest_contacts, 1u);
      EXPECT_EQ(path.most_contacts, 1u);
      EXPECT_NEAR(path.least_overlap, overlap, 1e-12);
      EXPECT_NEAR(path.most_overlap, overlap, 1e-12);
      EXPECT_LT(path.normal_jump, 0.05 * bend) << bend << ' ' << overlap;
    }
}

// Over a ridge: face, edge, face. The distance to a convex body is smooth, whatever the angle.
TEST(MeshRolling, AConvexRidgeTouchesOnce) {
  for (const double slope : {0.1, 0.5, 1.2}) {
    Soup soup;
    const double c = 2 * std::cos(slope), s = 2 * std::sin(slope);
    soup.add({0, -1, 0}, {0, 1, 0}, {-c, 1, -s}, {-c, -1, -s});
    soup.add({0, -1, 0}, {c, -1, -s}, {c, 1, -s}, {0, 1, 0});
    const Path path = follow(soup.mesh(), 0.5, 20000, [&](double t) {
      const double angle = (2 * t - 1) * slope, along = 0.2 * (2 * t - 1);
      const Vec3 foot{along * std::cos(slope), 0.1 * t, -std::abs(along) * std::sin(slope)};
      return foot + 0.45 * Vec3{std::sin(angle), 0, std::cos(angle)};
    });
    EXPECT_EQ(path.fewest_contacts, 1u);
    EXPECT_EQ(path.most_contacts, 1u);
    EXPECT_LT(path.overlap_jump, 1e-4);
    EXPECT_LT(path.normal_jump, 1e-3);
  }
}
