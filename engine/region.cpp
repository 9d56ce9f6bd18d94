#include "engine/region.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace skred {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

bool in(const BoxRegion& r, const Vec3& x) {
  return x.x >= r.min.x && x.x < r.max.x && x.y >= r.min.y && x.y < r.max.y && x.z >= r.min.z && x.z < r.max.z;
}
bool in(const CylinderRegion& r, const Vec3& x) {
  const Vec3 arm = x - r.point;
  const double height = dot(arm, r.axis);
  const Vec3 across = arm - height * r.axis;
  return height >= 0 && height < r.length && dot(across, across) <= r.radius * r.radius;
}
bool in(const HalfSpaceRegion& r, const Vec3& x) { return dot(x - r.point, r.normal) >= 0; }

double volume_of(const BoxRegion& r) {
  const Vec3 size = r.max - r.min;
  return size.x > 0 && size.y > 0 && size.z > 0 ? size.x * size.y * size.z : 0;
}
double volume_of(const CylinderRegion& r) { return r.radius > 0 && r.length > 0 ? std::numbers::pi * r.radius * r.radius * r.length : 0; }
double volume_of(const HalfSpaceRegion&) { return infinite; }

Bounds around(const BoxRegion& r) { return {r.min, r.max}; }
Bounds around(const CylinderRegion& r) {
  const auto rim = [&](double a) { return r.radius * std::sqrt(std::max(0.0, 1 - a * a)); };   // half the width of a disc across the axis
  const Vec3 half{rim(r.axis.x), rim(r.axis.y), rim(r.axis.z)}, other = r.point + r.length * r.axis;
  return {Vec3{std::min(r.point.x, other.x), std::min(r.point.y, other.y), std::min(r.point.z, other.z)} - half,
          Vec3{std::max(r.point.x, other.x), std::max(r.point.y, other.y), std::max(r.point.z, other.z)} + half};
}
Bounds around(const HalfSpaceRegion&) { return {{-infinite, -infinite, -infinite}, {infinite, infinite, infinite}}; }

Region within(const BoxRegion& r, double margin) {
  const Vec3 m{margin, margin, margin};
  return BoxRegion{r.min + m, r.max - m};
}
Region within(const CylinderRegion& r, double margin) {
  return CylinderRegion{r.point + margin * r.axis, r.axis, r.radius - margin, r.length - 2 * margin};
}
Region within(const HalfSpaceRegion& r, double) { return r; }

Vec3 place(const BoxRegion& r, double u, double v, double w) {
  const Vec3 size = r.max - r.min;
  return r.min + Vec3{u * size.x, v * size.y, w * size.z};
}
Vec3 place(const CylinderRegion& r, double u, double v, double w) {
  const Vec3 side = std::abs(r.axis.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0};
  const Vec3 e = normalized(cross(r.axis, side)), f = cross(r.axis, e);
  const double distance = r.radius * std::sqrt(u), angle = 2 * std::numbers::pi * v;
  return r.point + (w * r.length) * r.axis + (distance * std::cos(angle)) * e + (distance * std::sin(angle)) * f;
}
Vec3 place(const HalfSpaceRegion& r, double, double, double) { return r.point; }

bool on(const Disc& d, const Vec3& arm) { return dot(arm, arm) <= d.radius * d.radius; }
bool on(const Rectangle& r, const Vec3& arm) {
  return std::abs(dot(arm, r.along)) <= 0.5 * r.length && std::abs(dot(arm, cross(r.normal, r.along))) <= 0.5 * r.width;
}

}  // namespace

bool contains(const Region& region, const Vec3& x) {
  return std::visit([&](const auto& r) { return in(r, x); }, region);
}
double volume(const Region& region) {
  return std::visit([](const auto& r) { return volume_of(r); }, region);
}
Bounds bounds(const Region& region) {
  return std::visit([](const auto& r) { return around(r); }, region);
}
Region shrunk(const Region& region, double margin) {
  return std::visit([&](const auto& r) { return within(r, margin); }, region);
}
Vec3 place_in(const Region& region, double u, double v, double w) {
  return std::visit([&](const auto& r) { return place(r, u, v, w); }, region);
}

int crossing(const Area& area, const Vec3& a, const Vec3& b) {
  return std::visit([&](const auto& plane) {
    const double from = dot(a - plane.point, plane.normal), to = dot(b - plane.point, plane.normal);
    if ((from >= 0) == (to >= 0)) return 0;
    if (!on(plane, a + (from / (from - to)) * (b - a) - plane.point)) return 0;
    return to >= 0 ? 1 : -1;
  }, area);
}

}  // namespace skred
