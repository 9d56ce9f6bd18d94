// engine/io/tessellate.cpp - triangles of every shape.
#include "engine/io/tessellate.h"
#include <numbers>
#include <variant>

namespace skred {
namespace {

using Index = std::uint32_t;
constexpr Index around = 96, meridian = 48;    // corners of a circle, bands of a sphere from pole to pole

// A quadrilateral a, b, c, d, counter-clockwise from outside.
void quad(Surface& s, Index a, Index b, Index c, Index d) {
  s.triangles.push_back({a, b, c});
  s.triangles.push_back({a, c, d});
}

// Adds a circle about the z axis; returns its first vertex.
Index ring(Surface& s, double radius, double z) {
  const auto first = Index(s.vertices.size());
  for (Index k = 0; k < around; ++k) {
    const double angle = 2 * std::numbers::pi * k / around;
    s.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
  }
  return first;
}

// The band between two rings; its outside is on the right of the way from `from` to `to` in the half-plane (r, z).
void band(Surface& s, Index from, Index to) {
  for (Index k = 0; k < around; ++k) quad(s, from + k, from + (k + 1) % around, to + (k + 1) % around, to + k);
}

// The disc from a ring to a point on the axis, on the same side as band(ring, point).
void cap(Surface& s, Index from, const Vec3& centre) {
  const auto tip = Index(s.vertices.size());
  s.vertices.push_back(centre);
  for (Index k = 0; k < around; ++k) s.triangles.push_back({from + k, from + (k + 1) % around, tip});
}

// The disc from a point on the axis to a ring.
void cap(Surface& s, const Vec3& centre, Index to) {
  const auto tip = Index(s.vertices.size());
  s.vertices.push_back(centre);
  for (Index k = 0; k < around; ++k) s.triangles.push_back({tip, to + (k + 1) % around, to + k});
}

Surface surface(const PlaneShape&, const PlanePatch& p) {
  Surface s;
  for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
    s.vertices.push_back({p.x + x * p.half_size, p.y + y * p.half_size, 0});
  quad(s, 0, 1, 2, 3);
  return s;
}

Surface surface(const SphereShape& sphere, const PlanePatch&) {
  Surface s;
  const auto at = [&](Index k, bool z) {
    const double angle = std::numbers::pi * k / meridian;
    return sphere.radius * (z ? -std::cos(angle) : std::sin(angle));
  };
  Index below = ring(s, at(1, false), at(1, true));
  cap(s, {0, 0, -sphere.radius}, below);
  for (Index k = 2; k < meridian; ++k) {
    const Index above = ring(s, at(k, false), at(k, true));
    band(s, below, above);
    below = above;
  }
  cap(s, below, {0, 0, sphere.radius});
  return s;
}

Surface surface(const BoxShape& box, const PlanePatch&) {
  Surface s;
  for (Index k = 0; k < 8; ++k)                // bit 0: x, bit 1: y, bit 2: z
    s.vertices.push_back({k & 1 ? box.half_size.x : -box.half_size.x, k & 2 ? box.half_size.y : -box.half_size.y,
                          k & 4 ? box.half_size.z : -box.half_size.z});
  quad(s, 0, 2, 3, 1);
  quad(s, 4, 5, 7, 6);
  quad(s, 0, 1, 5, 4);
  quad(s, 2, 6, 7, 3);
  quad(s, 0, 4, 6, 2);
  quad(s, 1, 3, 7, 5);
  return s;
}

Surface surface(const CylinderShape& c, const PlanePatch&) {
  Surface s;
  const Index bottom = ring(s, c.radius, -0.5 * c.length), top = ring(s, c.radius, 0.5 * c.length);
  cap(s, {0, 0, -0.5 * c.length}, bottom);
  band(s, bottom, top);
  cap(s, top, {0, 0, 0.5 * c.length});
  return s;
}

Surface surface(const HollowCylinderShape& c, const PlanePatch&) {
  Surface s;
  const double outer = c.radius + c.thickness, end = 0.5 * c.length;
  const Index inner_bottom = ring(s, c.radius, -end), outer_bottom = ring(s, outer, -end);
  const Index outer_top = ring(s, outer, end), inner_top = ring(s, c.radius, end);
  band(s, inner_bottom, outer_bottom);
  band(s, outer_bottom, outer_top);
  band(s, outer_top, inner_top);
  band(s, inner_top, inner_bottom);
  return s;
}

Surface surface(const MeshShape& m, const PlanePatch&) {
  return {{m.mesh->vertices().begin(), m.mesh->vertices().end()}, {m.mesh->triangles().begin(), m.mesh->triangles().end()}};
}

}  // namespace

Surface tessellate(const Shape& shape, const PlanePatch& patch) {
  return std::visit([&](const auto& s) { return surface(s, patch); }, shape);
}

void append(Surface& whole, const Surface& part, const Pose& pose) {
  const auto first = Index(whole.vertices.size());
  for (const Vec3& v : part.vertices) whole.vertices.push_back(to_world(pose, v));
  for (const Triangle& t : part.triangles) whole.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

}  // namespace skred
