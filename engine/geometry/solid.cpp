#include "engine/geometry/solid.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include "engine/geometry/mesh.h"
#include "engine/geometry/patch.h"

namespace skred {

namespace {

constexpr double pi = std::numbers::pi;

double enclosed_volume(const Mesh& mesh) {
  double six = 0;
  for (const Triangle& t : mesh.triangles()) six += dot(mesh.vertices()[t[0]], cross(mesh.vertices()[t[1]], mesh.vertices()[t[2]]));
  return std::abs(six) / 6;
}

// Every edge has two triangles.
bool is_closed(const Mesh& mesh) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Triangle& t : mesh.triangles())
    for (int k = 0; k < 3; ++k) edges.push_back(std::minmax(t[k], t[(k + 1) % 3]));
  std::sort(edges.begin(), edges.end());
  for (std::size_t k = 0; k < edges.size(); k += 2)
    if (k + 1 == edges.size() || edges[k] != edges[k + 1] || (k + 2 < edges.size() && edges[k + 2] == edges[k])) return false;
  return true;
}

double equivalent_radius(double volume) { return std::cbrt(3 * volume / (4 * pi)); }

double radius_of(const Shape& shape) {
  if (const auto* s = std::get_if<SphereShape>(&shape)) return s->radius;
  if (const auto* b = std::get_if<BoxShape>(&shape)) return equivalent_radius(8 * b->half_size.x * b->half_size.y * b->half_size.z);
  if (const auto* c = std::get_if<CylinderShape>(&shape)) return equivalent_radius(pi * c->radius * c->radius * c->length);
  if (const auto* h = std::get_if<HollowCylinderShape>(&shape))
    return equivalent_radius(pi * (h->radius + h->thickness) * (h->radius + h->thickness) * h->length);
  if (const auto* m = std::get_if<MeshShape>(&shape)) {
    const double solid = is_closed(*m->mesh) ? equivalent_radius(enclosed_volume(*m->mesh)) : 0;
    return solid > 1e-3 * m->mesh->outer_radius() ? solid : m->mesh->outer_radius();   // a sheet has no volume
  }
  return std::numeric_limits<double>::infinity();
}

template <class S> const S* as(const Solid& s) { return std::get_if<S>(&s.shape); }

// The outer side of a hollow cylinder is one of a cylinder.
std::optional<Roll> roll_of(const Solid& s, const Pose& pose) {
  if (const auto* c = as<CylinderShape>(s)) return Roll(pose, c->radius, c->length);
  if (const auto* h = as<HollowCylinderShape>(s)) return Roll(pose, h->radius + h->thickness, h->length);
  return {};
}

void keep_deepest(std::vector<Touch>& out, std::size_t from) {
  if (out.size() - from <= max_touches) return;
  std::stable_sort(out.begin() + std::ptrdiff_t(from), out.end(), [](const Touch& a, const Touch& b) { return a.overlap > b.overlap; });
  out.resize(from + max_touches);
}

// Below, the normals point from b to a, and `b` is the shape that the function is named after.

void touch_sphere(const Solid& a, const Pose& pose_a, const SphereShape& b, const Pose& pose_b, double margin, std::vector<Touch>& out) {
  const Vec3 x = to_local(pose_a, pose_b.position);
  const auto add = [&](double overlap, const Vec3& towards_sphere) {
    const Vec3 n = -rotate(pose_a.orientation, towards_sphere);
    out.push_back({pose_b.position + (b.radius - 0.5 * overlap) * n, n, overlap, 1});
  };
  std::visit([&](const auto& s) {
    if constexpr (std::is_same_v<std::decay_t<decltype(s)>, MeshShape>) {
      std::vector<std::uint32_t> near;
      s.mesh->find(x, b.radius + margin, near);              // near places: as if the sphere were larger by the margin
      const MeshContacts touched = s.mesh->touch(x, b.radius + margin, near);
      for (std::size_t k = 0; k < touched.count; ++k) add(touched.at[k].overlap - margin, touched.at[k].normal);
    } else {
      const Nearest at = nearest(s, x);
      if (b.radius - at.distance > -margin) add(b.radius - at.distance, at.normal);
    }
  }, a.shape);
}

void touch_plane(const Solid& a, const Pose& pose_a, const Pose& plane, double margin, std::vector<Touch>& out) {
  const Reference ground{plane.position, rotate(plane.orientation, {0, 0, 1}), {}};
  if (const auto roll = roll_of(a, pose_a)) return rest_on(ground, roll->face_towards(-ground.normal), margin, out);
  if (!a.hull.faces.empty()) {
    const Vec3 down = rotate_back(pose_a.orientation, -ground.normal);
    if (dot(to_world(pose_a, a.hull.support(down)) - ground.point, ground.normal) >= margin) return;
    std::vector<Vec3> face = a.hull.corners_of(a.hull.face_towards(down));
    for (Vec3& v : face) v = to_world(pose_a, v);
    return rest_on(ground, std::move(face), margin, out);
  }
  const std::size_t before = out.size();                     // a flat mesh has no hull
  for (const Vec3& v : as<MeshShape>(a)->mesh->vertices()) {
    const Vec3 x = to_world(pose_a, v);
    const double overlap = -dot(x - ground.point, ground.normal);
    if (overlap > -margin) out.push_back({x + (0.5 * overlap) * ground.normal, ground.normal, overlap, 1});
  }
  keep_deepest(out, before);
}

// The points of a's rim at one end that are farthest from the axis z of the frame: opposite each other or, where the axes are
// parallel, all alike. Maximises the distance by a fixed-point iteration that never lessens it, as it is convex.
std::vector<Vec3> far_points_of_rim(const Roll& a, double end, const Pose& frame) {
  const auto flat = [&](Vec3 v) { v = rotate_back(frame.orientation, v); v.z = 0; return rotate(frame.orientation, v); };
  const Vec3 middle = a.centre + (end * a.half_length) * a.axis, from_axis = flat(middle - frame.position);
  const Vec3 across = cross(a.axis, rotate(frame.orientation, {0, 0, 1}));
  std::vector<Vec3> starts{from_axis};
  if (norm(across) > 1e-9) starts = {from_axis + a.radius * normalized(across), from_axis - a.radius * normalized(across)};
  std::vector<Vec3> out;
  for (const Vec3& start : starts) {
    Vec3 r;
    for (int k = 0; k < 40; ++k) {
      const Vec3 g = k == 0 ? start : from_axis + flat(r), pull = g - dot(g, a.axis) * a.axis;
      r = a.radius * (norm(pull) > 1e-9 * a.radius ? normalized(pull) : a.across);
    }
    if (out.empty() || norm(out.back() - (middle + r)) > 1e-3 * a.radius) out.push_back(middle + r);
  }
  return out;
}

void touch_hollow(const Solid& a, const Pose& pose_a, const HollowCylinderShape& b, const Pose& pose_b, double margin, std::vector<Touch>& out) {
  const std::size_t before = out.size();
  std::vector<Vec3> points;
  if (const auto roll = roll_of(a, pose_a)) {
    for (const double end : {-1.0, 1.0})
      for (const Vec3& x : far_points_of_rim(*roll, end, pose_b)) points.push_back(x);
  } else {
    for (const Vec3& v : a.hull.vertices) points.push_back(to_world(pose_a, v));
  }
  for (const Vec3& x : points) {
    const Nearest at = nearest(b, to_local(pose_b, x));
    if (at.distance >= margin) continue;
    const Vec3 n = rotate(pose_b.orientation, at.normal);
    out.push_back({x - (0.5 * at.distance) * n, n, -at.distance, 1});
  }
  keep_deepest(out, before);
}

// Whether this order of the two is one of those written out above; the other order is the same with normals reversed.
bool in_order(const Solid& a, const Solid& b) {
  if (as<SphereShape>(b)) return true;
  if (as<SphereShape>(a)) return false;
  if (as<PlaneShape>(b)) return true;
  if (as<PlaneShape>(a)) return false;
  if (as<HollowCylinderShape>(b)) return true;
  if (as<HollowCylinderShape>(a)) return false;
  return as<CylinderShape>(a) || b.convex;
}

std::string name(const Solid& s) {
  if (!as<MeshShape>(s)) return shape_name(s.shape);
  return s.convex ? "mesh" : "mesh that is not convex and closed";
}

}  // namespace

Solid::Solid(Shape s) : shape(std::move(s)), radius(radius_of(shape)) {
  if (const auto* b = std::get_if<BoxShape>(&shape)) hull = box_polyhedron(b->half_size), convex = true;
  if (const auto* m = std::get_if<MeshShape>(&shape)) {
    hull = convex_hull(m->mesh->vertices());
    const double volume = hull.faces.empty() ? 0 : hull.volume();
    convex = volume > 0 && is_closed(*m->mesh) && std::abs(enclosed_volume(*m->mesh) - volume) < 1e-6 * volume;
  }
}

double radius_eff(const Solid& a, const Solid& b) {
  const bool sphere_a = as<SphereShape>(a), sphere_b = as<SphereShape>(b);
  const double curvature_a = sphere_b && !sphere_a ? 0 : 1 / a.radius, curvature_b = sphere_a && !sphere_b ? 0 : 1 / b.radius;
  return 1 / (curvature_a + curvature_b);
}

void touch(const Solid& a, const Pose& pose_a, const Solid& b, const Pose& pose_b, double margin, std::vector<Touch>& out) {
  const std::size_t before = out.size();
  if (!in_order(a, b)) {
    touch(b, pose_b, a, pose_a, margin, out);
    for (std::size_t k = before; k < out.size(); ++k) out[k].normal = -out[k].normal;
    return;
  }
  if (const auto* sphere = as<SphereShape>(b)) touch_sphere(a, pose_a, *sphere, pose_b, margin, out);
  else if (as<PlaneShape>(b)) touch_plane(a, pose_a, pose_b, margin, out);
  else if (const auto* hollow = as<HollowCylinderShape>(b)) touch_hollow(a, pose_a, *hollow, pose_b, margin, out);
  else if (!as<CylinderShape>(a)) touch_polyhedra(a.hull.placed(pose_a), b.hull.placed(pose_b), margin, out);
  else if (as<CylinderShape>(b)) touch_rolls(*roll_of(a, pose_a), *roll_of(b, pose_b), margin, out);
  else touch_roll_polyhedron(*roll_of(a, pose_a), b.hull.placed(pose_b), margin, out);
}

std::optional<std::string> why_not(const Solid& a, const Solid& b) {
  const auto names = [&] { return "a " + name(a) + " and a " + name(b); };
  if (as<HollowCylinderShape>(a) && as<HollowCylinderShape>(b)) return names() + ": contacts of two hollow cylinders are not computed";
  const auto any_mesh_will_do = [](const Solid& s) { return as<SphereShape>(s) || as<PlaneShape>(s); };
  for (const auto& [mesh, other] : {std::pair{&a, &b}, std::pair{&b, &a}})
    if (as<MeshShape>(*mesh) && !mesh->convex && !any_mesh_will_do(*other))
      return names() + ": against anything but a sphere or a plane a mesh must be convex and closed; make the body of several convex parts";
  return {};
}

}  // namespace skred
