// engine/geometry/solid.h - where two shapes of rigid bodies touch each other.
//
// Everything is our own: fcl::collide gives one point where a face rests on a face, and depths between meshes that mean nothing
// (FCL issues 491, 574), while a pile of blocks asks for patches of points that change continuously.
//   sphere          against every shape: its nearest place; a mesh may be touched in several (mesh.h)
//   plane           against the lowest face, side or rim of the convex hull; hulls of meshes need not fill them
//   box, mesh       against each other: separating axes (polyhedra_touch.cpp); meshes must be convex and closed
//   cylinder        against box, mesh, cylinder: axes that its faces, side and rims offer (cylinder_touch.cpp)
//   hollow cylinder against the corners of boxes and meshes, and the rims of cylinders
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include "engine/geometry/polyhedron.h"
#include "engine/geometry/shape.h"

namespace skred {

// A shape, and what contacts with other shapes need beside it.
struct Solid {
  explicit Solid(Shape);
  Shape shape;
  Polyhedron hull;      // of boxes and meshes; without faces for the rest, and for flat meshes
  bool convex = false;  // the shape is a box, or a mesh that fills its hull
  double radius;        // [m] of a sphere of equal volume; infinite for a plane
};

// R_eff of one point of contact [m]. Corners and faces have no radius of curvature; as LIGGGHTS does for superquadrics
// [Podlozhnyuk, Pirker & Kloss 2017], the radii of spheres of equal volume stand for them. Where a sphere touches something flat,
// its own radius counts, as for particles.
double radius_eff(const Solid& a, const Solid& b);

// One point of a patch of contact.
struct Touch {
  Vec3 point;           // [m] halfway between the two surfaces
  Vec3 normal;          // unit, from b to a
  double overlap;       // [m] > 0 where the shapes overlap
  double weight;        // [1] 0 .. 1: its stiffness, as part of that of a corner
};

inline constexpr std::size_t max_touches = 8;

// Appends the points where a and b overlap or are less than `margin` apart, at most max_touches, in an order that depends on the
// shapes and poses only. The poses are those of the shapes in the world.
void touch(const Solid& a, const Pose& pose_a, const Solid& b, const Pose& pose_b, double margin, std::vector<Touch>& out);

// Why touch() cannot handle such a pair: "a hollow_cylinder and a hollow_cylinder ...", or nothing.
std::optional<std::string> why_not(const Solid& a, const Solid& b);

}  // namespace skred
