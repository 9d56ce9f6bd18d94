// engine/geometry/nearest_on_triangle.h - the place of a triangle that is nearest to a point, and on which feature it lies.
//
// Ericson, Real-Time Collision Detection (2005), section 5.1.5, has the regions. Here the sides of the edges are told with the
// unit normal of the face: the error stays small for triangles much smaller than their distance.
#pragma once
#include <cstdint>
#include <limits>
#include <span>
#include "engine/geometry/mesh.h"

namespace skred {

// Edge k goes from corner k to corner (k + 1) % 3.
enum class Feature : std::uint8_t { corner0, corner1, corner2, edge0, edge1, edge2, face };

struct TrianglePlace {
  double distance;     // [m] >= 0
  Vec3 normal;         // unit, from the triangle to the point; the face's where the point lies on the triangle
  Feature feature;
};

// `face_normal` is the triangle's: unit, right-handed about its corners.
inline TrianglePlace nearest_on_triangle(const Vec3& point, const Triangle& triangle, std::span<const Vec3> vertices,
                                         const Vec3& face_normal) {
  const Vec3 corner[] = {vertices[triangle[0]], vertices[triangle[1]], vertices[triangle[2]]};
  const Vec3 from[] = {point - corner[0], point - corner[1], point - corner[2]};

  // The nearest point of a triangle beside its prism lies on an edge that has the point on its outer side.
  double nearest = std::numeric_limits<double>::infinity();
  Vec3 offset{};
  Feature feature = Feature::face;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    if (dot(cross(corner[next] - corner[k], face_normal), from[k]) <= 0) continue;
    // From the lower vertex to the higher, so that triangles that share the edge find the same bits.
    const bool forward = triangle[k] < triangle[next];
    const int first = forward ? k : next, last = forward ? next : k;
    const Vec3 edge = corner[last] - corner[first];
    const double part = dot(from[first], edge) / dot(edge, edge);
    const bool at_first = part <= 0, at_last = part >= 1;
    const Vec3 o = at_first ? from[first] : at_last ? from[last] : from[first] - part * edge;
    if (const double d = dot(o, o); d < nearest) {
      nearest = d;
      offset = o;
      feature = static_cast<Feature>(at_first ? first : at_last ? last : 3 + k);
    }
  }

  if (feature == Feature::face) {
    // Measured along the normal, so that a flat mesh is a plane to round-off; either side is a wall.
    const double height = dot(face_normal, from[0]);
    return height < 0 ? TrianglePlace{-height, -face_normal, feature} : TrianglePlace{height, face_normal, feature};
  }
  const double distance = norm(offset);
  return {distance, distance > 0 ? (1.0 / distance) * offset : face_normal, feature};
}

}  // namespace skred
