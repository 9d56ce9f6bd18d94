#include "engine/geometry/patch.h"
#include <algorithm>
#include <numbers>

namespace skred {

// What lies inside the plane through `point` whose normal points out.
std::vector<Vec3> clipped(const std::vector<Vec3>& polygon, const Vec3& point, const Vec3& outwards) {
  std::vector<Vec3> out;
  const std::size_t n = polygon.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3 &a = polygon[k], &b = polygon[(k + 1) % n];
    const double da = dot(a - point, outwards), db = dot(b - point, outwards);
    if (da <= 0) out.push_back(a);
    const bool way_back = n == 2 && k == 1;                  // a segment is left once
    if (((da < 0 && db > 0) || (da > 0 && db < 0)) && !way_back) out.push_back(a + (da / (da - db)) * (b - a));
  }
  return out;
}

void rest_on(const Reference& face, std::vector<Vec3> polygon, double margin, std::vector<Touch>& out) {
  for (std::size_t k = 0; k < face.corners.size(); ++k) {
    const Vec3 &a = face.corners[k], &b = face.corners[(k + 1) % face.corners.size()];
    polygon = clipped(polygon, a, cross(b - a, face.normal));
  }
  const std::size_t n = polygon.size();
  if (n == 0) return;
  std::vector<double> side(n);                               // from a corner to the next, as seen along the normal
  double around = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3 step = polygon[(k + 1) % n] - polygon[k];
    around += side[k] = norm(step - dot(step, face.normal) * face.normal);
  }
  std::vector<Touch> points;
  for (std::size_t k = 0; k < n; ++k) {
    const double overlap = -dot(polygon[k] - face.point, face.normal);
    const double share = around > 0 ? (side[k] + side[(k + n - 1) % n]) / (2 * around) : 1.0 / double(n);
    if (overlap > -margin) points.push_back({polygon[k] + (0.5 * overlap) * face.normal, face.normal, overlap, std::min(1.0, 4 * share)});
  }
  while (points.size() > max_touches)                        // the least goes, at a cost in stiffness that is small
    points.erase(std::min_element(points.begin(), points.end(), [](const Touch& a, const Touch& b) { return a.weight < b.weight; }));
  for (const Touch& t : points)
    if (t.weight > 1e-9) out.push_back(t);                   // corners that coincide: one has it all
}

bool point_beats_face(double point_separation, const Vec3& point_normal, double face_separation, const Vec3& face_normal) {
  constexpr double clearly_less = 0.05, cosine = 0.99;       // 8 degrees
  return point_separation > face_separation + clearly_less * std::abs(face_separation) && std::abs(dot(point_normal, face_normal)) < cosine;
}

Roll::Roll(const Pose& pose, double r, double length)
    : centre(pose.position), axis(rotate(pose.orientation, {0, 0, 1})), across(rotate(pose.orientation, {1, 0, 0})),
      radius(r), half_length(0.5 * length) {}

namespace {

Vec3 around(const Roll& c, const Vec3& direction) { return direction - dot(direction, c.axis) * c.axis; }
Vec3 end_of(const Roll& c, const Vec3& direction) {
  return c.centre + (dot(direction, c.axis) < 0 ? -c.half_length : c.half_length) * c.axis;
}

// The direction of the rim's farthest point. A cylinder that stands has none: then a direction of the body's, so that the points
// it stands on stay where they are. The two blend at a tilt of 1e-5.
Vec3 farthest_across(const Roll& c, const Vec3& direction) {
  const Vec3 tilt = around(c, direction) + 1e-5 * c.across;
  return norm(tilt) > 0 ? normalized(tilt) : c.across;
}

}  // namespace

Vec3 Roll::support(const Vec3& direction) const {
  const Vec3 out = around(*this, direction);
  const double length = norm(out);
  constexpr double least = 1e-9;                             // less is rounding, and points anywhere
  return length > least * norm(direction) ? end_of(*this, direction) + (radius / length) * out : end_of(*this, direction);
}

std::vector<Vec3> Roll::end_towards(const Vec3& direction) const {
  const Vec3 end = end_of(*this, direction), u = radius * farthest_across(*this, direction), v = cross(axis, u);
  return {end + u, end + v, end - u, end - v};
}

std::vector<Vec3> Roll::rim_towards(const Vec3& direction) const {
  constexpr int corners = 16;
  const Vec3 end = end_of(*this, direction), along = dot(direction, axis) < 0 ? -axis : axis, u = radius * across, v = cross(along, u);
  std::vector<Vec3> out;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners;
    out.push_back(end + std::cos(angle) * u + std::sin(angle) * v);
  }
  return out;
}

std::vector<Vec3> Roll::face_towards(const Vec3& direction) const {
  if (std::abs(dot(direction, axis)) > std::sqrt(0.5)) return end_towards(direction);
  const Vec3 line = centre + radius * farthest_across(*this, direction);
  return {line + half_length * axis, line - half_length * axis};
}

double Roll::distance(const Vec3& point) const {
  const double z = std::abs(dot(point - centre, axis)) - half_length, rho = norm(around(*this, point - centre)) - radius;
  return z > 0 && rho > 0 ? std::sqrt(z * z + rho * rho) : std::max(z, rho);
}

Vec3 Roll::normal_at(const Vec3& point) const {
  const Vec3 x = point - centre, out = around(*this, x);
  const double along = dot(x, axis), length = norm(out), z = std::abs(along) - half_length, rho = length - radius;
  const Vec3 up = along < 0 ? -axis : axis, outwards = length > 0 ? (1 / length) * out : across;
  if (z > 0 && rho > 0) return normalized(z * up + rho * outwards);
  return z > rho ? up : outwards;
}

}  // namespace skred
