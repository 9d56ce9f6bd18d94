// engine/geometry/mesh.h - a triangle mesh as a wall for spheres.
//
// FCL holds the triangles in a BVH of axis-aligned boxes; the traversal and the sphere-triangle distance are ours, since
// fcl::collide gives wrong depths for spheres that reach over an edge (FCL issue 503) and copies the model per query.
//
// A sphere touches *features* (faces, edges, vertices), not triangles: an edge or vertex of a triangle that has a nearer place
// adds nothing, a feature shared by several triangles counts once, and places whose normals differ by less than
// `merge_angle` act as one. So a flat mesh is a plane, and a faceted cylinder is a smooth wall. Both sides are walls.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>
#include "engine/geometry/shape.h"

namespace skred {

using Triangle = std::array<std::uint32_t, 3>;     // indices of vertices

// One place where a sphere touches a mesh.
struct MeshContact {
  double overlap;    // [m] > 0
  Vec3 normal;       // unit, from the mesh to the centre of the sphere
};

// Places whose normals differ from the deepest one's by less than this act as one [rad]: 25 degrees.
inline constexpr double merge_angle = 25 * std::numbers::pi / 180;

// At most this many places are kept, the deepest first.
inline constexpr std::size_t max_mesh_contacts = 4;
struct MeshContacts {
  std::size_t count = 0;
  std::array<MeshContact, max_mesh_contacts> at;
};

// A mesh that cannot be used. The message starts with the triangle or the vertex at fault, counted from 1.
struct MeshError : std::runtime_error {
  static constexpr std::size_t no_triangle = std::numeric_limits<std::size_t>::max();
  explicit MeshError(const std::string& what, std::size_t at = no_triangle) : std::runtime_error(what), triangle(at) {}
  std::size_t triangle;   // row of the triangles handed in, if one is at fault
};

class Mesh {
 public:
  // Vertices at exactly equal places are joined, vertices without a triangle are left out; triangles keep their order. Throws
  // MeshError on an empty mesh, an index out of range, a vertex that is not finite or a degenerate triangle (its corners lie
  // on a line: one height is less than 1e-10 of the longest edge).
  Mesh(std::vector<Vec3> vertices, std::vector<Triangle> triangles);
  ~Mesh();

  std::span<const Vec3> vertices() const { return vertices_; }
  std::span<const Triangle> triangles() const { return triangles_; }
  const Bounds& bounds() const { return bounds_; }
  double outer_radius() const { return outer_radius_; }

  // Appends the triangles within the distance `reach` of `point`, in ascending order; allocates only to grow `triangles`.
  void find(const Vec3& point, double reach, std::vector<std::uint32_t>& triangles) const;

  // Where a sphere touches the given triangles (ascending; triangles out of reach do not matter). The order of the places
  // depends on the mesh and the sphere only. The place of several that act as one has the deepest's overlap and a mean normal
  // (mesh_touch.cpp); both change continuously as places join and leave.
  MeshContacts touch(const Vec3& centre, double radius, std::span<const std::uint32_t> triangles) const;

 private:
  struct Tree;
  std::vector<Vec3> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<Vec3> face_normals_;
  Bounds bounds_;
  double outer_radius_ = 0;
  std::unique_ptr<Tree> tree_;
};

// Reads a mesh from a Wavefront OBJ file (name ends in .obj; v and f, polygons become fans of triangles, the rest is ignored)
// or an STL file (.stl; ASCII or binary, told apart by content). `scale` multiplies the coordinates axis by axis: finite, not 0.
// Throws std::runtime_error: "file:line: what is wrong", or "file: what is wrong" where there are no lines; a triangle of a
// binary STL file is named by its number.
std::shared_ptr<const Mesh> read_mesh(const std::string& path, const Vec3& scale = {1, 1, 1});

}  // namespace skred
