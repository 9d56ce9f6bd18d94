// tests/engine/geometry/mesh_test.cpp - joining of vertices, the search for triangles, and meshes that are refused.
#include "engine/geometry/mesh.h"
#include <gmock/gmock.h>
#include "engine/geometry/nearest_on_triangle.h"
#include "tests/engine/geometry/some_meshes.h"

using namespace skred;
using testing::HasSubstr;

namespace {

std::string refusal(std::vector<Vec3> vertices, std::vector<Triangle> triangles, std::size_t triangle = MeshError::no_triangle) {
  try {
    Mesh(std::move(vertices), std::move(triangles));
  } catch (const MeshError& e) {
    EXPECT_EQ(e.triangle, triangle);
    return e.what();
  }
  return "accepted";
}

const std::vector<Vec3> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

}  // namespace

TEST(Mesh, JoinsEqualVerticesAndDropsUnusedOnes) {
  const Mesh mesh({{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-0.0, 0, -0.0}, {1, 1, 0}, {0, 1, 0}}, {{1, 2, 3}, {4, 5, 6}});
  EXPECT_THAT(mesh.vertices(), testing::ElementsAreArray(square));
  EXPECT_THAT(mesh.triangles(), testing::ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
  EXPECT_EQ(mesh.bounds().max, (Vec3{1, 1, 0}));
  EXPECT_DOUBLE_EQ(mesh.outer_radius(), std::sqrt(2.0));
}

TEST(Mesh, FindEqualsTryingEveryTriangle) {
  Random random(1);
  Soup soup;
  for (int n = 0; n < 3000; ++n) {
    const Vec3 at = random.in_box(1);
    const double size = std::pow(10, random.uniform(-3, 0));
    soup.add(at + random.in_box(size), at + random.in_box(size), at + random.in_box(size));
  }
  const Mesh mesh = soup.mesh();
  ASSERT_EQ(mesh.triangles().size(), 3000u);
  std::size_t found = 0;
  for (int n = 0; n < 300; ++n) {
    const Vec3 p = random.in_box(1.5);
    const double reach = std::pow(10, random.uniform(-3, 0.3));
    std::vector<std::uint32_t> expected{7}, actual{7};              // find() appends
    for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t) {
      const auto corner = [&](int k) { return mesh.vertices()[mesh.triangles()[t][k]]; };
      const Vec3 normal = normalized(cross(corner(1) - corner(0), corner(2) - corner(0)));
      if (nearest_on_triangle(p, mesh.triangles()[t], mesh.vertices(), normal).distance <= reach) expected.push_back(t);
    }
    mesh.find(p, reach, actual);
    ASSERT_EQ(actual, expected);
    found += actual.size();
  }
  EXPECT_GT(found, 10000u);
}

// Sizes that shrink by half each: FCL's tree is then nearly a list, about 60 deep.
TEST(Mesh, FindInAVeryDeepTree) {
  Soup soup;
  for (int k = 250; k > -250; --k) {
    const double x = std::pow(2.0, k);
    soup.add({x, 0, 0}, {1.5 * x, 0, 0}, {x, 0.5 * x, 0});
  }
  const Mesh mesh = soup.mesh();
  std::vector<std::uint32_t> found;
  mesh.find({0, 0, 0}, std::pow(2.0, 252), found);
  EXPECT_EQ(found.size(), 500u);
  found.clear();
  mesh.find({0.25, 0, 0}, 0.01, found);
  EXPECT_THAT(found, testing::ElementsAre(252u));
}

TEST(Mesh, FindsNothingForWhatIsNotANumber) {
  const Mesh mesh(square, {{0, 1, 2}});
  std::vector<std::uint32_t> found;
  mesh.find({std::nan(""), 0, 0}, 1, found);
  mesh.find({0, 0, 0}, std::nan(""), found);
  EXPECT_TRUE(found.empty());
  const std::uint32_t first[] = {0};
  EXPECT_EQ(mesh.touch({std::nan(""), 0, 0}, 1, first).count, 0u);
}

TEST(Mesh, RefusesWhatIsNoMesh) {
  EXPECT_EQ(refusal({}, {}), "the mesh has no triangles");
  EXPECT_EQ(refusal(square, {}), "the mesh has no triangles");
  EXPECT_EQ(refusal(square, {{0, 1, 2}, {0, 2, 4}}, 1),
            "triangle 2: index 4 is out of range: there are 4 vertices, counted from 0");
  EXPECT_EQ(refusal({{0, 0, 0}, {1, NAN, 0}, {0, 1, 0}}, {{0, 1, 2}}), "vertex 2: (1, nan, 0) is not finite");
  EXPECT_EQ(refusal({{0, 0, 0}, {1, 0, 0}, {0, INFINITY, 0}}, {{0, 1, 2}}), "vertex 3: (0, inf, 0) is not finite");
}

TEST(Mesh, RefusesDegenerateTriangles) {
  EXPECT_EQ(refusal({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0, 0}}, {{0, 1, 2}, {0, 3, 1}}, 1),
            "triangle 2: degenerate, its corners (0, 0, 0), (0.5, 0, 0) and (1, 0, 0) lie on a line");
  EXPECT_THAT(refusal(square, {{0, 1, 1}}, 0), HasSubstr("triangle 1: degenerate"));
  EXPECT_THAT(refusal({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}, {{0, 1, 2}}, 0), HasSubstr("triangle 1: degenerate"));
  EXPECT_THAT(refusal({{0, 0, 0}, {1, 0, 0}, {0.3, 1e-11, 0}}, {{0, 1, 2}}, 0), HasSubstr("degenerate"));
  // Thin or small is not degenerate.
  EXPECT_EQ(refusal({{0, 0, 0}, {1, 0, 0}, {0.3, 1e-9, 0}}, {{0, 1, 2}}), "accepted");
  EXPECT_EQ(refusal({{0, 0, 0}, {1e-9, 0, 0}, {0, 1e-9, 0}}, {{0, 1, 2}}), "accepted");
}
