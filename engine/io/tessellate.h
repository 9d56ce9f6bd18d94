// engine/io/tessellate.h - the surface of a shape as triangles, for pictures.
#pragma once
#include <vector>
#include "engine/geometry/mesh.h"
#include "engine/geometry/shape.h"

namespace skred {

// Corners are counter-clockwise seen from where particles may be.
struct Surface {
  std::vector<Vec3> vertices;            // [m]
  std::vector<Triangle> triangles;
};

// The part of a plane that is drawn: a square about (x, y) in the plane's frame.
struct PlanePatch { double x = 0, y = 0, half_size = 0.5; };   // [m]

// In the shape's frame. Vertices lie on the true surface; round shapes have 96 corners around.
Surface tessellate(const Shape& shape, const PlanePatch& patch = {});

// Adds `part`, moved by `pose`.
void append(Surface& whole, const Surface& part, const Pose& pose);

}  // namespace skred
