// engine/geometry/polyhedron.h - convex polyhedra: boxes, and the convex hulls of meshes.
#pragma once
#include <cstdint>
#include <span>
#include <vector>
#include "engine/vec3.h"

namespace skred {

struct Polyhedron {
  struct Face { Vec3 normal; std::vector<std::uint32_t> corners; };       // unit, outwards; counter-clockwise seen from outside
  struct Edge { std::uint32_t from, to, face, other_face; };

  std::vector<Vec3> vertices;                                             // [m] only corners: no vertex lies inside a face or an edge
  std::vector<Face> faces;
  std::vector<Edge> edges;
  Vec3 inside;                                                            // [m] a point inside

  double volume() const;                                                  // [m^3]
  const Face& face_towards(const Vec3& direction) const;                  // whose normal is nearest to the direction
  Vec3 support(const Vec3& direction) const;                              // the farthest vertex in the direction
  std::vector<Vec3> corners_of(const Face&) const;
  Polyhedron placed(const Pose&) const;                                   // in the frame that the pose is given in
};

Polyhedron box_polyhedron(const Vec3& half_size);

// The convex hull; triangles in a plane become one face. Without faces if the points lie in a plane.
Polyhedron convex_hull(std::span<const Vec3> points);

}  // namespace skred
