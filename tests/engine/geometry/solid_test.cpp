// Where shapes touch: against FCL's GJK (do they?), against supports in many directions (how deep?), and against known patches.
#include "engine/geometry/solid.h"
#include <fcl/narrowphase/collision.h>
#include <gtest/gtest.h>
#include "engine/geometry/patch.h"
#include "tests/engine/geometry/some_meshes.h"

using namespace skred;

namespace {

Soup triangles_of(const Polyhedron& p) {
  Soup s;
  for (const auto& f : p.faces)
    for (std::size_t k = 2; k < f.corners.size(); ++k) s.add(p.vertices[f.corners[0]], p.vertices[f.corners[k - 1]], p.vertices[f.corners[k]]);
  return s;
}

Solid solid_of(const Soup& s) { return Solid(MeshShape{std::make_shared<Mesh>(s.vertices, s.triangles)}); }

std::vector<Vec3> on_sphere(int count, Random& random) {
  std::vector<Vec3> x;
  for (int k = 0; k < count; ++k) x.push_back(random.direction());
  return x;
}

Solid stone(Random& random) {
  return solid_of(triangles_of(convex_hull(on_sphere(14, random))));
}

// The farthest point of a convex solid in a direction of the world.
Vec3 support(const Solid& s, const Pose& pose, const Vec3& direction) {
  if (const auto* c = std::get_if<CylinderShape>(&s.shape)) return Roll(pose, c->radius, c->length).support(direction);
  return to_world(pose, s.hull.support(rotate_back(pose.orientation, direction)));
}

fcl::CollisionObjectd fcl_object(const Solid& s, const Pose& pose) {
  std::shared_ptr<fcl::CollisionGeometryd> g;
  if (const auto* c = std::get_if<CylinderShape>(&s.shape)) {
    g = std::make_shared<fcl::Cylinderd>(c->radius, c->length);
  } else {
    auto points = std::make_shared<std::vector<fcl::Vector3d>>();
    for (const Vec3& v : s.hull.vertices) points->emplace_back(v.x, v.y, v.z);
    auto faces = std::make_shared<std::vector<int>>();
    for (const auto& f : s.hull.faces) {
      faces->push_back(int(f.corners.size()));
      faces->insert(faces->end(), f.corners.begin(), f.corners.end());
    }
    g = std::make_shared<fcl::Convexd>(points, int(s.hull.faces.size()), faces);
  }
  const auto& q = pose.orientation;
  fcl::Transform3d t = fcl::Transform3d::Identity();
  t.linear() = fcl::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix();
  t.translation() = fcl::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  return fcl::CollisionObjectd(g, t);
}

bool fcl_says_they_touch(const Solid& a, const Pose& pa, const Solid& b, const Pose& pb) {
  fcl::CollisionRequestd request;
  fcl::CollisionResultd result;
  auto x = fcl_object(a, pa), y = fcl_object(b, pb);
  return fcl::collide(&x, &y, request, result) > 0;
}

double deepest(const std::vector<Touch>& touches) {
  double d = -1;
  for (const Touch& t : touches) d = std::max(d, t.overlap);
  return d;
}

// Overlap along n, from b to a.
double overlap_along(const Vec3& n, const Solid& a, const Pose& pa, const Solid& b, const Pose& pb) {
  return dot(n, support(b, pb, n) - support(a, pa, -n));
}

struct Tally { int touching = 0, wrong = 0, too_deep = 0, lopsided = 0; };

// Pairs at random, most of them just touching: moved together until they overlap by a little.
Tally compare(const Solid& a, const Solid& b, unsigned seed, int trials) {
  Random random(seed);
  Tally tally;
  for (int k = 0; k < trials; ++k) {
    Pose pa{{}, random.rotation()}, pb{{}, random.rotation()};
    const Vec3 away = random.direction();
    double low = 0, high = 5;                                // by bisection: the distance at which FCL lets go
    for (int step = 0; step < 40; ++step) {
      pa.position = 0.5 * (low + high) * away;
      (fcl_says_they_touch(a, pa, b, pb) ? low : high) = 0.5 * (low + high);
    }
    std::vector<Touch> touches;
    pa.position = (high + 1e-4) * away;
    touch(a, pa, b, pb, 0, touches);
    if (!touches.empty()) ++tally.wrong;
    touches.clear();
    pa.position = (high - 0.01) * away;
    touch(a, pa, b, pb, 0, touches);
    const double depth = deepest(touches);
    if (!(depth > 0)) { ++tally.wrong; continue; }
    ++tally.touching;
    double least = depth;
    for (int d = 0; d < 400; ++d) {                          // near the normal, where a better one would be
      const Vec3 n = normalized(touches[0].normal + random.uniform(0, 0.3) * random.direction());
      least = std::min(least, overlap_along(n, a, pa, b, pb));
    }
    for (int d = 0; d < 400; ++d) least = std::min(least, overlap_along(random.direction(), a, pa, b, pb));
    if (depth > 1.1 * least + 1e-9) ++tally.too_deep;
    std::vector<Touch> other;
    touch(b, pb, a, pa, 0, other);
    if (std::abs(deepest(other) - depth) > 0.02 * depth || norm(other[0].normal + touches[0].normal) > 0.2) ++tally.lopsided;
  }
  return tally;
}

TEST(Solids, BoxesAndStonesTouchWhereTheyShould) {
  Random random(5);
  const Solid box(BoxShape{{1, 0.7, 0.4}}), rock = stone(random), other = stone(random);
  for (const auto& [a, b] : {std::pair{&box, &box}, {&box, &rock}, {&rock, &other}}) {
    const Tally t = compare(*a, *b, 1, 400);
    EXPECT_EQ(t.wrong, 0);
    EXPECT_EQ(t.too_deep, 0);
    EXPECT_LE(t.lopsided, 4);                                // two axes nearly alike: each order may take its own
    EXPECT_GT(t.touching, 390);
  }
}

TEST(Solids, CylindersTouchWhereTheyShould) {
  Random random(6);
  const Solid roll(CylinderShape{0.6, 1.6}), coin(CylinderShape{0.9, 0.3}), box(BoxShape{{1, 0.7, 0.4}}), rock = stone(random);
  for (const auto& [a, b] : {std::pair{&roll, &box}, {&coin, &rock}, {&roll, &coin}, {&roll, &roll}}) {
    const Tally t = compare(*a, *b, 2, 300);
    EXPECT_EQ(t.wrong, 0);
    EXPECT_EQ(t.too_deep, 0);
    EXPECT_LE(t.lopsided, 3);
    EXPECT_GT(t.touching, 290);
  }
}

std::vector<Touch> touches_of(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb, double margin = 0) {
  std::vector<Touch> out;
  touch(Solid(a), pa, Solid(b), pb, margin, out);
  return out;
}

void expect_patch(const std::vector<Touch>& touches, std::size_t count, double overlap, const Vec3& normal, double stiffness) {
  ASSERT_EQ(touches.size(), count);
  double weight = 0;
  for (const Touch& t : touches) {
    EXPECT_NEAR(t.overlap, overlap, 1e-9);
    EXPECT_LT(norm(t.normal - normal), 1e-9);
    weight += t.weight;
  }
  EXPECT_NEAR(weight, stiffness, 1e-6);
}

TEST(Solids, PatchesOfFacesOnFaces) {
  const Vec3 up{0, 0, 1};
  const BoxShape box{{0.5, 0.5, 0.5}};
  const Pose turned{{0, 0, 0.99}, rotation_by({0, 0, M_PI / 4})}, lying{{0, 0, 0.49}, rotation_by({M_PI / 2, 0, 0})};
  expect_patch(touches_of(box, {{0, 0, 0.49}, {}}, PlaneShape{}, {}), 4, 0.01, up, 4);
  expect_patch(touches_of(box, {{0, 0, 0.99}, {}}, box, {}), 4, 0.01, up, 4);
  expect_patch(touches_of(box, turned, box, {}), 8, 0.01, up, 4);               // an octagon is as stiff as the square
  expect_patch(touches_of(box, {{0.4, 0.4, 0.99}, {}}, box, {}), 4, 0.01, up, 4);
  expect_patch(touches_of(PlaneShape{}, {}, box, {{0, 0, 0.49}, {}}), 4, 0.01, -up, 4);
  expect_patch(touches_of(CylinderShape{0.5, 1}, {{0, 0, 0.49}, {}}, PlaneShape{}, {}), 4, 0.01, up, 4);
  expect_patch(touches_of(CylinderShape{0.5, 2}, lying, PlaneShape{}, {}), 2, 0.01, up, 2);
  expect_patch(touches_of(CylinderShape{0.5, 1}, {{0, 0, 0.99}, {}}, box, {}), 4, 0.01, up, 4);
  expect_patch(touches_of(box, {{0, 0, 0.99}, {}}, CylinderShape{2, 1}, {}), 4, 0.01, up, 4);
  expect_patch(touches_of(CylinderShape{0.5, 1}, {{0, 0, 0.99}, {}}, CylinderShape{2, 1}, {}), 4, 0.01, up, 4);
  expect_patch(touches_of(CylinderShape{0.5, 1}, {{0.99, 0, 0.2}, {}}, CylinderShape{0.5, 1}, {}), 2, 0.01, {1, 0, 0}, 2);
  expect_patch(touches_of(SphereShape{0.5}, {{0, 0, 0.99}, {}}, box, {}), 1, 0.01, up, 1);
  // In a drum: corners of a box, rims of a cylinder.
  const HollowCylinderShape drum{1, 4, 0.1};
  expect_patch(touches_of(CylinderShape{0.5, 1}, {{0.51, 0, 0}, {}}, drum, {}), 2, 0.01, {-1, 0, 0}, 2);
  const auto corners = touches_of(BoxShape{{0.1, 0.1, 0.1}}, {{0.9051, 0, 0}, {}}, drum, {});
  ASSERT_EQ(corners.size(), 4u);
  for (const Touch& t : corners) EXPECT_NEAR(t.overlap, std::hypot(1.0051, 0.1) - 1, 1e-9);
}

TEST(Solids, NearPointsWithinTheMargin) {
  const BoxShape box{{0.5, 0.5, 0.5}};
  expect_patch(touches_of(box, {{0, 0, 1.01}, {}}, box, {}, 0.02), 4, -0.01, {0, 0, 1}, 4);
  EXPECT_TRUE(touches_of(box, {{0, 0, 1.03}, {}}, box, {}, 0.02).empty());
  expect_patch(touches_of(SphereShape{0.5}, {{0, 0, 0.51}, {}}, PlaneShape{}, {}, 0.02), 1, -0.01, {0, 0, 1}, 1);
}

TEST(ConvexHull, OfPointsOnASphereAndOfACubeOfManyTriangles) {
  Random random(3);
  const std::vector<Vec3> points = on_sphere(200, random);
  const Polyhedron ball = convex_hull(points);
  EXPECT_EQ(ball.vertices.size(), 200u);
  EXPECT_EQ(ball.vertices.size() + ball.faces.size(), ball.edges.size() + 2);   // Euler
  for (const auto& f : ball.faces)
    for (const Vec3& p : points) EXPECT_LE(dot(p - ball.vertices[f.corners[0]], f.normal), 1e-8);
  std::vector<Vec3> grid;
  for (int k = 0; k < 125; ++k) grid.push_back({double(k % 5), double(k / 5 % 5), double(k / 25)});
  std::shuffle(grid.begin(), grid.end(), random.engine);
  const Polyhedron cube = convex_hull(grid);
  EXPECT_EQ(cube.vertices.size(), 8u);
  EXPECT_EQ(cube.faces.size(), 6u);
  EXPECT_EQ(cube.edges.size(), 12u);
  EXPECT_NEAR(cube.volume(), 64, 1e-9);
  EXPECT_TRUE(convex_hull(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}).faces.empty());
}

TEST(Solids, WhatIsNotSupportedIsNamed) {
  Soup valley;                                               // an open mesh
  valley.add({-1, -1, 1}, {0, -1, 0}, {0, 1, 0}, {-1, 1, 1});
  valley.add({0, -1, 0}, {1, -1, 1}, {1, 1, 1}, {0, 1, 0});
  const Solid open = solid_of(valley), box(BoxShape{{1, 1, 1}}), ball(SphereShape{1}), plane(PlaneShape{}),
      drum(HollowCylinderShape{1, 1, 0.1});
  EXPECT_FALSE(open.convex);
  EXPECT_FALSE(why_not(open, ball) || why_not(plane, open) || why_not(box, drum) || why_not(box, box));
  EXPECT_NE(why_not(box, open)->find("a box and a mesh that is not convex"), std::string::npos);
  EXPECT_NE(why_not(drum, drum)->find("hollow"), std::string::npos);
  EXPECT_EQ(radius_eff(ball, box), 1);
  EXPECT_NEAR(radius_eff(box, plane), std::cbrt(3 * 8 / (4 * M_PI)), 1e-12);
  Random random(1);
  EXPECT_TRUE(stone(random).convex);
}

}  // namespace
