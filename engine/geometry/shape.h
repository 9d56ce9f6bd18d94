// engine/geometry/shape.h - the shapes of rigid bodies, in their own frame, and the point of each that is nearest to a
// particle.
//
// A shape knows nothing of its pose: callers bring the particle's centre into the shape's frame (engine/vec3.h).
// Analytic shapes have one nearest point; a mesh may touch a sphere in several places (engine/geometry/mesh.h).
#pragma once
#include <memory>
#include <variant>
#include "engine/vec3.h"

namespace skred {

class Mesh;

struct PlaneShape {};                                                   // the half-space z <= 0; particles live at z > 0
struct SphereShape { double radius; };                                  // [m] > 0
struct BoxShape { Vec3 half_size; };                                    // [m] each > 0
struct CylinderShape { double radius, length; };                        // [m] solid, axis z, centred
// [m] a wall from radius to radius + thickness, axis z, centred, open ends
struct HollowCylinderShape { double radius, length, thickness; };
struct MeshShape { std::shared_ptr<const Mesh> mesh; };

using Shape = std::variant<PlaneShape, SphereShape, BoxShape, CylinderShape, HollowCylinderShape, MeshShape>;

// The place on a shape's surface that is nearest to a point.
struct Nearest {
  double distance;    // [m] from the surface to the point; negative inside the shape
  Vec3 normal;        // unit, out of the shape, towards the point
  double curvature;   // [1/m] 1/radius of a sphere, 0 elsewhere: R_eff = 1 / (1/R + curvature)
};

// Nearest place of an analytic shape. A point exactly on an axis or a centre gets a fixed, arbitrary normal.
Nearest nearest(const PlaneShape&, const Vec3& point);
Nearest nearest(const SphereShape&, const Vec3& point);
Nearest nearest(const BoxShape&, const Vec3& point);
Nearest nearest(const CylinderShape&, const Vec3& point);
Nearest nearest(const HollowCylinderShape&, const Vec3& point);

// Axis-aligned box in the shape's frame; infinite for a plane.
struct Bounds { Vec3 min, max; };
Bounds bounds(const Shape&);

// Greatest distance of a point of the shape from the origin of its frame [m]; infinite for a plane.
double outer_radius(const Shape&);

const char* shape_name(const Shape&);   // "plane", "sphere", "box", "cylinder", "hollow_cylinder", "mesh"

}  // namespace skred
