// engine/geometry/patch.h - the points of contact of two faces, and how convex shapes find the direction in which they touch.
#pragma once
#include <span>
#include <vector>
#include "engine/geometry/solid.h"

namespace skred {

// The part of a polygon, or of a segment, behind the plane through `point` whose normal points out.
std::vector<Vec3> clipped(const std::vector<Vec3>& polygon, const Vec3& point, const Vec3& outwards);

// A face that others rest on: a polygon, counter-clockwise about the normal, or a whole plane where `corners` is empty.
struct Reference { Vec3 point, normal; std::vector<Vec3> corners; };

// Clips a polygon (or a segment: two corners) against the sides of the reference face [Sutherland & Hodgman 1974]. Each corner of
// what is left is a point of contact, its weight four times its share of the outline, at most one: four corners of a square
// have weight 1, and where two points part from one they share its weight, so that stiffness changes continuously.
// Normals point from the reference to the polygon.
void rest_on(const Reference&, std::vector<Vec3> polygon, double margin, std::vector<Touch>& out);

// Whether a point where two edges cross is the place of contact, and not the face whose axis is the best of all faces': its overlap
// is clearly less and its normal clearly another. Else the choice would flicker where faces are nearly parallel - and the patch
// has the crossing among its corners.
bool point_beats_face(double point_separation, const Vec3& point_normal, double face_separation, const Vec3& face_normal);

// A cylinder in the world.
struct Roll {
  Vec3 centre, axis, across;     // unit; `across` is a direction of the body that is perpendicular to the axis
  double radius, half_length;    // [m]
  Roll(const Pose&, double radius, double length);
  Vec3 support(const Vec3& direction) const;
  // Four points of the end towards `direction`, the farthest in the direction first.
  std::vector<Vec3> end_towards(const Vec3& direction) const;
  // Its outline, counter-clockwise seen from outside.
  std::vector<Vec3> rim_towards(const Vec3& direction) const;
  // That end by its four points, or the line of the side that is farthest in the direction.
  std::vector<Vec3> face_towards(const Vec3& direction) const;
  double distance(const Vec3& point) const;                  // [m] negative inside
  Vec3 normal_at(const Vec3& point) const;                   // unit, out of the nearest surface
};

void touch_polyhedra(const Polyhedron& a, const Polyhedron& b, double margin, std::vector<Touch>& out);
void touch_roll_polyhedron(const Roll& a, const Polyhedron& b, double margin, std::vector<Touch>& out);
void touch_rolls(const Roll& a, const Roll& b, double margin, std::vector<Touch>& out);

}  // namespace skred
