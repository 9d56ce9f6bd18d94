// engine/geometry/shape.cpp - nearest places, bounds and names of the shapes of rigid bodies.
#include "engine/geometry/shape.h"
#include <algorithm>
#include <array>
#include <limits>
#include "engine/geometry/mesh.h"

namespace skred {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

template <class... F> struct Overloaded : F... { using F::operator()...; };
template <class... F> Overloaded(F...) -> Overloaded<F...>;

// Nearest place of a rectangle, or of a box: `beyond` is how far the point lies beyond the faces, axis by axis (negative
// inside), `side` the unit direction of the face it is measured from. Outside the distance is that to the face, edge or
// corner; inside, that to the nearest face.
template <std::size_t axes> Nearest nearest_of_block(const std::array<double, axes>& beyond, const std::array<Vec3, axes>& side) {
  std::size_t face = 0, outside = 0;                         // of how many faces the point is on the outer side
  for (std::size_t k = 0; k < axes; ++k) {
    if (beyond[k] > beyond[face]) face = k;
    outside += beyond[k] > 0;
  }
  if (outside < 2) return {beyond[face], side[face], 0};
  Vec3 out{};
  for (std::size_t k = 0; k < axes; ++k) out += std::max(beyond[k], 0.0) * side[k];
  const double distance = norm(out);
  return {distance, (1.0 / distance) * out, 0};
}

Vec3 along(const Vec3& axis, double coordinate) { return coordinate < 0 ? -axis : axis; }

// Direction from the axis z to the point.
Vec3 radial(const Vec3& point, double distance_from_axis) {
  return distance_from_axis > 0 ? Vec3{point.x / distance_from_axis, point.y / distance_from_axis, 0} : Vec3{1, 0, 0};
}

Bounds symmetric(const Vec3& half) { return {-half, half}; }

}  // namespace

Nearest nearest(const PlaneShape&, const Vec3& point) { return {point.z, {0, 0, 1}, 0}; }

Nearest nearest(const SphereShape& sphere, const Vec3& point) {
  const double d = norm(point);
  return {d - sphere.radius, d > 0 ? (1.0 / d) * point : Vec3{0, 0, 1}, 1.0 / sphere.radius};
}

Nearest nearest(const BoxShape& box, const Vec3& point) {
  const Vec3& h = box.half_size;
  return nearest_of_block<3>({std::abs(point.x) - h.x, std::abs(point.y) - h.y, std::abs(point.z) - h.z},
                             {along({1, 0, 0}, point.x), along({0, 1, 0}, point.y), along({0, 0, 1}, point.z)});
}

Nearest nearest(const CylinderShape& cylinder, const Vec3& point) {
  const double rho = std::sqrt(point.x * point.x + point.y * point.y);
  return nearest_of_block<2>({rho - cylinder.radius, std::abs(point.z) - 0.5 * cylinder.length},
                             {radial(point, rho), along({0, 0, 1}, point.z)});
}

Nearest nearest(const HollowCylinderShape& cylinder, const Vec3& point) {
  const double rho = std::sqrt(point.x * point.x + point.y * point.y);
  const Vec3 outwards = radial(point, rho);
  // Of the two walls the nearer one counts: the inner one for particles in the cylinder.
  const double beyond_inner = cylinder.radius - rho, beyond_outer = rho - (cylinder.radius + cylinder.thickness);
  const bool inner = beyond_inner > beyond_outer;
  return nearest_of_block<2>({inner ? beyond_inner : beyond_outer, std::abs(point.z) - 0.5 * cylinder.length},
                             {inner ? -outwards : outwards, along({0, 0, 1}, point.z)});
}

Bounds bounds(const Shape& shape) {
  return std::visit(
      Overloaded{[](const PlaneShape&) { return symmetric({infinity, infinity, infinity}); },
                 [](const SphereShape& s) { return symmetric({s.radius, s.radius, s.radius}); },
                 [](const BoxShape& s) { return symmetric(s.half_size); },
                 [](const CylinderShape& s) { return symmetric({s.radius, s.radius, 0.5 * s.length}); },
                 [](const HollowCylinderShape& s) {
                   return symmetric({s.radius + s.thickness, s.radius + s.thickness, 0.5 * s.length});
                 },
                 [](const MeshShape& s) { return s.mesh->bounds(); }},
      shape);
}

double outer_radius(const Shape& shape) {
  return std::visit(Overloaded{[](const PlaneShape&) { return infinity; },
                               [](const SphereShape& s) { return s.radius; },
                               [](const BoxShape& s) { return norm(s.half_size); },
                               [](const CylinderShape& s) { return std::hypot(s.radius, 0.5 * s.length); },
                               [](const HollowCylinderShape& s) { return std::hypot(s.radius + s.thickness, 0.5 * s.length); },
                               [](const MeshShape& s) { return s.mesh->outer_radius(); }},
                    shape);
}

const char* shape_name(const Shape& shape) {
  return std::visit(Overloaded{[](const PlaneShape&) { return "plane"; },
                               [](const SphereShape&) { return "sphere"; },
                               [](const BoxShape&) { return "box"; },
                               [](const CylinderShape&) { return "cylinder"; },
                               [](const HollowCylinderShape&) { return "hollow_cylinder"; },
                               [](const MeshShape&) { return "mesh"; }},
                    shape);
}

}  // namespace skred
