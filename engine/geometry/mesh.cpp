// engine/geometry/mesh.cpp - checks a mesh, joins its vertices, and finds triangles near a point in FCL's tree of boxes.
#include "engine/geometry/mesh.h"
#include <algorithm>
#include <cstdio>
#include <fcl/geometry/bvh/BVH_model.h>
#include <numeric>
#include <tuple>
#include "engine/geometry/nearest_on_triangle.h"

namespace skred {

namespace {

std::string text(const Vec3& v) {
  char s[96];
  std::snprintf(s, sizeof s, "(%.9g, %.9g, %.9g)", v.x, v.y, v.z);
  return s;
}

void check_vertices(const std::vector<Vec3>& vertices) {
  for (std::size_t k = 0; k < vertices.size(); ++k)
    if (!is_finite(vertices[k])) throw MeshError("vertex " + std::to_string(k + 1) + ": " + text(vertices[k]) + " is not finite");
}

void check_indices(const std::vector<Triangle>& triangles, std::size_t vertex_count) {
  if (triangles.empty()) throw MeshError("the mesh has no triangles");
  for (std::size_t k = 0; k < triangles.size(); ++k)
    for (const std::uint32_t v : triangles[k])
      if (v >= vertex_count)
        throw MeshError("triangle " + std::to_string(k + 1) + ": index " + std::to_string(v) + " is out of range: there are " +
                            std::to_string(vertex_count) + " vertices, counted from 0",
                        k);
}

// Joins vertices at equal places and leaves out those without a triangle. The first of equals stays, in its order.
void weld(std::vector<Vec3>& vertices, std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto place = [&](std::uint32_t v) { return std::tie(vertices[v].x, vertices[v].y, vertices[v].z); };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return place(a) != place(b) ? place(a) < place(b) : a < b;
  });
  std::vector<std::uint32_t> first_of(vertices.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    first_of[order[k]] = k > 0 && place(order[k]) == place(order[k - 1]) ? first_of[order[k - 1]] : order[k];

  std::vector<char> used(vertices.size(), 0);
  for (Triangle& t : triangles)
    for (std::uint32_t& v : t) used[v = first_of[v]] = 1;

  std::vector<std::uint32_t> new_index(vertices.size());
  std::uint32_t count = 0;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (!used[v]) continue;
    new_index[v] = count;
    vertices[count++] = vertices[v];
  }
  vertices.resize(count);
  for (Triangle& t : triangles)
    for (std::uint32_t& v : t) v = new_index[v];
}

std::vector<Vec3> unit_normals(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
  constexpr double least_height = 1e-10;   // of the longest edge
  std::vector<Vec3> normals;
  normals.reserve(triangles.size());
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const Vec3 &a = vertices[triangles[k][0]], &b = vertices[triangles[k][1]], &c = vertices[triangles[k][2]];
    const double longest_squared = std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
    const Vec3 twice_area = cross(b - a, c - a);
    if (!(norm(twice_area) > least_height * longest_squared))
      throw MeshError("triangle " + std::to_string(k + 1) + ": degenerate, its corners " + text(a) + ", " + text(b) + " and " +
                          text(c) + " lie on a line",
                      k);
    normals.push_back(normalized(twice_area));
  }
  return normals;
}

}  // namespace

struct Mesh::Tree {
  fcl::BVHModel<fcl::AABBd> model;
};

Mesh::Mesh(std::vector<Vec3> vertices, std::vector<Triangle> triangles)
    : vertices_(std::move(vertices)), triangles_(std::move(triangles)), tree_(std::make_unique<Tree>()) {
  check_vertices(vertices_);
  check_indices(triangles_, vertices_.size());
  weld(vertices_, triangles_);
  face_normals_ = unit_normals(vertices_, triangles_);

  bounds_ = {vertices_[0], vertices_[0]};
  for (const Vec3& v : vertices_) {
    bounds_.min = {std::min(bounds_.min.x, v.x), std::min(bounds_.min.y, v.y), std::min(bounds_.min.z, v.z)};
    bounds_.max = {std::max(bounds_.max.x, v.x), std::max(bounds_.max.y, v.y), std::max(bounds_.max.z, v.z)};
    outer_radius_ = std::max(outer_radius_, norm(v));
  }

  std::vector<fcl::Vector3d> points;
  std::vector<fcl::Triangle> corners;
  for (const Vec3& v : vertices_) points.emplace_back(v.x, v.y, v.z);
  for (const Triangle& t : triangles_) corners.emplace_back(t[0], t[1], t[2]);
  auto& model = tree_->model;
  if (model.beginModel(static_cast<int>(corners.size()), static_cast<int>(points.size())) != fcl::BVH_OK ||
      model.addSubModel(points, corners) != fcl::BVH_OK || model.endModel() != fcl::BVH_OK)
    throw MeshError("FCL could not build the tree of " + std::to_string(corners.size()) + " triangles");
}

Mesh::~Mesh() = default;

void Mesh::find(const Vec3& point, double reach, std::vector<std::uint32_t>& triangles) const {
  const auto& model = tree_->model;
  const std::size_t found_before = triangles.size();
  const fcl::Vector3d p(point.x, point.y, point.z);

  // The larger child waits and the smaller one is next: its size halves every time, so at most 31 wait.
  int waiting[32] = {0};
  int count = 1;
  while (count > 0) {
    const auto* node = &model.getBV(waiting[--count]);
    for (;;) {
      const fcl::Vector3d beyond = (node->bv.min_ - p).cwiseMax(p - node->bv.max_).cwiseMax(0.0);
      if (!(beyond.squaredNorm() <= reach * reach)) break;
      if (node->isLeaf()) {
        const std::uint32_t t = node->primitiveId();
        if (nearest_on_triangle(point, triangles_[t], vertices_, face_normals_[t]).distance <= reach) triangles.push_back(t);
        break;
      }
      int smaller = node->leftChild(), larger = node->rightChild();
      if (model.getBV(smaller).num_primitives > model.getBV(larger).num_primitives) std::swap(smaller, larger);
      waiting[count++] = larger;
      node = &model.getBV(smaller);
    }
  }
  std::sort(triangles.begin() + found_before, triangles.end());
}

}  // namespace skred
