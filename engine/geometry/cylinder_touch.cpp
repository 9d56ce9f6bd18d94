// engine/geometry/cylinder_touch.cpp - a cylinder against convex polyhedra and cylinders: the axis of least overlap, and the patch.
//
// The axis is the best of those that faces, ends and sides offer, and of those at the place of every edge and rim that is deepest
// in the other cylinder. Each is judged by the true extents of both shapes along it, so shapes that are apart are found to be.
#include <algorithm>
#include <limits>
#include <numbers>
#include "engine/geometry/patch.h"

namespace skred {

namespace {

enum class Carrier { face_of_b, end_of_a, end_of_b, sides, point };

struct Axis {
  Vec3 normal;                   // unit, from b to a
  Carrier carrier = Carrier::point;
  Vec3 point;                    // Carrier::point: halfway between the surfaces
  const Polyhedron::Face* face = nullptr;
  double separation = -std::numeric_limits<double>::infinity();
};

// The best axes so far.
template <class A, class B> struct Best {
  const A& a;
  const B& b;
  Axis flat{}, point{}, any{};   // carried by a face, end or side; by a point; by whatever

  void offer(Axis axis) {
    axis.separation = dot(axis.normal, a.support(-axis.normal) - b.support(axis.normal));
    if (axis.separation > flat.separation) flat = axis;
    if (axis.separation > any.separation) any = axis;
  }
  // x on an edge or rim of b (or of a) inside the other, from which `out` points out of that other. It is the place of contact
  // only if nothing of its shape lies deeper along this axis.
  void offer_point(const Vec3& x, const Vec3& out, bool of_b) {
    if (!(norm(out) > 0)) return;
    constexpr double part_of_overlap = 0.1;
    const Vec3 m = normalized(out), n = of_b ? -m : m;
    const double s = dot(n, a.support(-n) - b.support(n)), deeper = of_b ? dot(n, b.support(n) - x) : dot(-n, a.support(-n) - x);
    const Axis axis{n, Carrier::point, x - (0.5 * s) * m, nullptr, s};   // halfway: out of the other by half the overlap
    if (s > any.separation) any = axis;
    if (s > point.separation && deeper <= part_of_overlap * std::abs(s)) point = axis;
  }
  const Axis& chosen() const { return point_beats_face(point.separation, point.normal, flat.separation, flat.normal) ? point : flat; }
};

// Where a function of [low, high] with one minimum is least, to 2e-7 of the range: depths at minima do not feel it.
template <class F> double least(double low, double high, F f) {
  constexpr double golden = 0.6180339887498949;
  double x = high - golden * (high - low), y = low + golden * (high - low), fx = f(x), fy = f(y);
  for (int k = 0; k < 32; ++k) {
    if (fx <= fy) { high = y; y = x; fy = fx; fx = f(x = high - golden * (high - low)); }
    else { low = x; x = y; fx = fy; fy = f(y = low + golden * (high - low)); }
  }
  return 0.5 * (low + high);
}

// Direction of the rim of a cylinder near a point.
Vec3 rim_direction(const Roll& c, const Vec3& x) { return cross(c.axis, x - c.centre); }

Vec3 away_from(const Vec3& centre, const Vec3& x, const Vec3& direction) { return dot(direction, x - centre) < 0 ? -direction : direction; }

template <class B> void rims_of(const Roll& a, const Roll& in, bool of_b, B& best) {
  constexpr int places = 32;
  for (const double end : {-1.0, 1.0}) {
    const Vec3 u = a.radius * a.across, v = cross(a.axis, u), middle = a.centre + (end * a.half_length) * a.axis;
    const auto at = [&](double angle) { return middle + std::cos(angle) * u + std::sin(angle) * v; };
    const auto depth = [&](double angle) { return in.distance(at(angle)); };
    constexpr double step = 2 * std::numbers::pi / places;
    for (int k = 0; k < places; ++k) {                       // from every local minimum of the places tried
      if (depth(k * step) > depth((k - 1) * step) || depth(k * step) > depth((k + 1) * step)) continue;
      const Vec3 x = at(least((k - 1) * step, (k + 1) * step, depth));
      best.offer_point(x, in.normal_at(x), of_b);
      best.offer_point(x, away_from(in.centre, x, cross(rim_direction(a, x), rim_direction(in, x))), of_b);
    }
  }
}

void flip(std::vector<Touch>& out, std::size_t from) {
  for (std::size_t k = from; k < out.size(); ++k) out[k].normal = -out[k].normal;
}

// The best point or, where that is clearly deeper than the axis of least overlap, what that axis says.
template <class B> void touch_at_point(const B& best, double facing, std::vector<Touch>& out) {
  constexpr double clearly = 1.2;
  const Axis& axis = -best.point.separation <= clearly * -best.any.separation ? best.point : best.any;
  const Vec3 place = axis.carrier == Carrier::point ? axis.point : best.a.support(-axis.normal) - (0.5 * axis.separation) * axis.normal;
  out.push_back({place, facing * axis.normal, -axis.separation, 1});
}

// Where the chosen axis is carried by a face: what the other shape rests on it with. If nothing of it lies inside the face's outline,
// or all too deep, a point stands for it.
template <class B> void rest(const B& best, const Reference& face, std::vector<Vec3> polygon, double margin, std::vector<Touch>& out) {
  constexpr double too_deep = 1.5;                           // times the least overlap that is known
  const std::size_t before = out.size();
  rest_on(face, std::move(polygon), margin, out);
  double deepest = -std::numeric_limits<double>::infinity();
  for (std::size_t k = before; k < out.size(); ++k) deepest = std::max(deepest, out[k].overlap);
  if (out.size() > before && (deepest <= 0 || deepest <= too_deep * -best.any.separation)) return;
  out.resize(before);
  if (best.any.separation >= 0) return;                      // beside the face, and near at most
  touch_at_point(best, dot(face.normal, best.flat.normal) < 0 ? -1 : 1, out);   // the face may be one of a: its normal points to b
}

Reference end_reference(const Roll& c, const Vec3& outwards) {
  std::vector<Vec3> rim = c.rim_towards(outwards);
  return {rim[0], outwards, std::move(rim)};
}

}  // namespace

void touch_roll_polyhedron(const Roll& a, const Polyhedron& b, double margin, std::vector<Touch>& out) {
  Best<Roll, Polyhedron> best{a, b};
  for (const auto& f : b.faces) best.offer({f.normal, Carrier::face_of_b, {}, &f});
  for (const Vec3& n : {a.axis, -a.axis}) best.offer({n, Carrier::end_of_a});
  if (best.any.separation >= margin) return;
  for (const auto& e : b.edges) {
    const Vec3 from = b.vertices[e.from], along = b.vertices[e.to] - from;
    const Vec3 x = from + least(0, 1, [&](double s) { return a.distance(from + s * along); }) * along;
    best.offer_point(x, a.normal_at(x), true);
    best.offer_point(x, away_from(a.centre, x, cross(along, rim_direction(a, x))), true);
  }
  if (best.any.separation >= margin) return;
  const Axis& axis = best.chosen();
  const std::size_t before = out.size();
  switch (axis.carrier) {
    case Carrier::face_of_b:
      rest(best, {b.vertices[axis.face->corners[0]], axis.normal, b.corners_of(*axis.face)}, a.face_towards(-axis.normal), margin, out);
      break;
    case Carrier::end_of_a:
      rest(best, end_reference(a, -axis.normal), b.corners_of(b.face_towards(axis.normal)), margin, out);
      flip(out, before);
      break;
    default: touch_at_point(best, 1, out);
  }
}

void touch_rolls(const Roll& a, const Roll& b, double margin, std::vector<Touch>& out) {
  constexpr double parallel = 0.01;                          // sine of the angle between axes whose sides touch in a line
  Best<Roll, Roll> best{a, b};
  for (const Vec3& n : {b.axis, -b.axis}) best.offer({n, Carrier::end_of_b});
  for (const Vec3& n : {a.axis, -a.axis}) best.offer({n, Carrier::end_of_a});
  const Vec3 apart = a.centre - b.centre, beside = apart - dot(apart, b.axis) * b.axis, across = cross(a.axis, b.axis);
  if (norm(across) <= parallel && norm(beside) > 1e-9 * a.radius) best.offer({normalized(beside), Carrier::sides});
  if (norm(across) > parallel) {
    const Vec3 n = normalized(dot(across, apart) < 0 ? -across : across);
    const Vec3 along = cross(n, a.axis);                     // the point of b's axis that is nearest to a's
    best.offer_point(b.centre + (dot(apart, along) / dot(b.axis, along)) * b.axis + b.radius * n, -n, true);
  }
  if (best.any.separation >= margin) return;
  rims_of(a, b, false, best);
  rims_of(b, a, true, best);
  if (best.any.separation >= margin) return;
  const Axis& axis = best.chosen();
  const std::size_t before = out.size();
  switch (axis.carrier) {
    case Carrier::end_of_b:
      rest(best, end_reference(b, axis.normal), a.face_towards(-axis.normal), margin, out);
      break;
    case Carrier::end_of_a:
      rest(best, end_reference(a, -axis.normal), b.face_towards(axis.normal), margin, out);
      flip(out, before);
      break;
    case Carrier::sides: {
      std::vector<Vec3> line = a.face_towards(-axis.normal);
      for (const double end : {-1.0, 1.0}) line = clipped(line, b.centre + (end * b.half_length) * b.axis, end * b.axis);
      rest(best, {b.support(axis.normal), axis.normal, {}}, std::move(line), margin, out);
      break;
    }
    default: touch_at_point(best, 1, out);
  }
}

}  // namespace skred
