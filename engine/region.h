// engine/region.h - parts of space in which particles are removed, created or measured. A particle is where its centre is.
#pragma once
#include <variant>
#include "engine/geometry/shape.h"
#include "engine/vec3.h"

namespace skred {

struct BoxRegion { Vec3 min, max; };                                               // [m] min <= x < max: boxes side by side share nothing
struct CylinderRegion { Vec3 point, axis{0, 0, 1}; double radius = 0, length = 0; };   // [m] from the point along the axis (unit)
struct HalfSpaceRegion { Vec3 point, normal{0, 0, 1}; };                           // the side that the normal (unit) points to

using Region = std::variant<BoxRegion, CylinderRegion, HalfSpaceRegion>;

bool contains(const Region&, const Vec3& x);
double volume(const Region&);                                                      // [m^3] infinite for a half-space

// Axis-aligned box around a region; infinite for a half-space.
Bounds bounds(const Region&);

// The box or cylinder less a rim of width `margin` [m] on all sides: where centres of whole spheres may be. Its volume is not positive
// where there is no such place. A half-space stays as it is.
Region shrunk(const Region&, double margin);

// The place of three uniform numbers in [0, 1) in a box or cylinder, which it fills evenly.
Vec3 place_in(const Region&, double u, double v, double w);

// A flat area that particles cross.
struct Disc { Vec3 point, normal{0, 0, 1}; double radius = 0; };                   // [m] > 0, infinite for a whole plane; normal of length 1
struct Rectangle { Vec3 point, normal{0, 0, 1}, along{1, 0, 0}; double length = 0, width = 0; };   // [m] > 0, centred; length lies along `along`, a unit vector across the normal

using Area = std::variant<Disc, Rectangle>;

// +1 if the way from a to b crosses the area along its normal, -1 against it, else 0. A point on the plane lies on the side of the normal.
int crossing(const Area&, const Vec3& a, const Vec3& b);

}  // namespace skred
