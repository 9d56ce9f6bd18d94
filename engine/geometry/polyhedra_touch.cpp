// engine/geometry/polyhedra_touch.cpp - two convex polyhedra: the axis along which they overlap least, and the patch there.
//
// Faces are tried as axes, and the pairs of edges that make a face of the Minkowski difference [Gregorius 2013, The separating
// axis test between convex polyhedra, GDC]. Two edges touch in a point; else the face that gave the axis carries the patch.
#include <algorithm>
#include <limits>
#include "engine/geometry/patch.h"

namespace skred {

namespace {

struct FaceAxis { double separation = -std::numeric_limits<double>::infinity(); const Polyhedron::Face* face = nullptr; };

FaceAxis best_face(const Polyhedron& a, const Polyhedron& b) {
  FaceAxis best;
  for (const Polyhedron::Face& f : a.faces) {
    const double s = dot(b.support(-f.normal) - a.vertices[f.corners[0]], f.normal);
    if (s > best.separation) best = {s, &f};
  }
  return best;
}

struct EdgeAxis {
  double separation = -std::numeric_limits<double>::infinity();
  Vec3 normal;                                               // unit, from a to b
  const Polyhedron::Edge *of_a = nullptr, *of_b = nullptr;
};

// Whether the arcs between the normals of the two edges' faces cross on the Gauss map of a - b.
bool cross_on_gauss_map(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 along_a = cross(b, a), along_b = cross(d, c);
  const double cba = dot(c, along_a), dba = dot(d, along_a), adc = dot(a, along_b), bdc = dot(b, along_b);
  return cba * dba < 0 && adc * bdc < 0 && cba * bdc > 0;
}

EdgeAxis best_edges(const Polyhedron& a, const Polyhedron& b) {
  constexpr double least_sine = 1e-4;                        // edges that are nearly parallel add nothing to the faces
  EdgeAxis best;
  for (const auto& e : a.edges) {
    const Vec3 from = a.vertices[e.from], along = a.vertices[e.to] - from;
    for (const auto& f : b.edges) {
      if (!cross_on_gauss_map(a.faces[e.face].normal, a.faces[e.other_face].normal, -b.faces[f.face].normal, -b.faces[f.other_face].normal))
        continue;
      const Vec3 other = b.vertices[f.to] - b.vertices[f.from], normal = cross(along, other);
      const double length = norm(normal);
      if (length <= least_sine * norm(along) * norm(other)) continue;
      const Vec3 n = (dot(normal, from - a.inside) < 0 ? -1 / length : 1 / length) * normal;
      const double s = dot(b.vertices[f.from] - from, n);
      if (s > best.separation) best = {s, n, &e, &f};
    }
  }
  return best;
}

// Halfway between the nearest points of two lines that are not parallel.
Vec3 between_lines(const Vec3& p, const Vec3& u, const Vec3& q, const Vec3& v) {
  const Vec3 n = cross(u, v), d = q - p;
  const double n2 = dot(n, n);
  return 0.5 * (p + (dot(cross(d, v), n) / n2) * u + q + (dot(cross(d, u), n) / n2) * v);
}

}  // namespace

void touch_polyhedra(const Polyhedron& a, const Polyhedron& b, double margin, std::vector<Touch>& out) {
  const FaceAxis of_a = best_face(a, b), of_b = best_face(b, a);
  if (std::max(of_a.separation, of_b.separation) >= margin) return;
  const EdgeAxis edges = best_edges(a, b);
  if (edges.separation >= margin) return;

  // Where they give nearly the same, faces of a are preferred to those of b: the choice shall not flicker.
  constexpr double clearly = 0.01;
  const bool on_b = of_b.separation > of_a.separation + clearly * std::abs(of_a.separation);
  const FaceAxis& flat = on_b ? of_b : of_a;
  const auto touch_at_edges = [&] {
    const auto &e = *edges.of_a, &f = *edges.of_b;
    const Vec3 point = between_lines(a.vertices[e.from], a.vertices[e.to] - a.vertices[e.from], b.vertices[f.from],
                                     b.vertices[f.to] - b.vertices[f.from]);
    out.push_back({point, -edges.normal, -edges.separation, 1});
  };
  if (edges.of_a && point_beats_face(edges.separation, edges.normal, flat.separation, flat.face->normal)) return touch_at_edges();
  const std::size_t before = out.size();
  const Polyhedron &below = on_b ? b : a, &above = on_b ? a : b;
  const Polyhedron::Face& face = *flat.face;
  rest_on({below.vertices[face.corners[0]], face.normal, below.corners_of(face)}, above.corners_of(above.face_towards(-face.normal)), margin, out);
  if (out.size() == before && edges.of_a) return touch_at_edges();
  if (out.size() == before && flat.separation < 0) {         // a corner beside the face: deep, or between two axes
    out.push_back({above.support(-face.normal) - (0.5 * flat.separation) * face.normal, face.normal, -flat.separation, 1});
  }
  for (std::size_t k = before; k < out.size() && !on_b; ++k) out[k].normal = -out[k].normal;   // from b to a
}

}  // namespace skred
