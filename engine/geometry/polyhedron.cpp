#include "engine/geometry/polyhedron.h"
#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace skred {

namespace {

using Corners = std::array<std::uint32_t, 3>;

struct Facet { Corners corners; Vec3 normal; };

Facet facet(std::span<const Vec3> x, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  return {{a, b, c}, normalized(cross(x[b] - x[a], x[c] - x[a]))};
}

// Four points that span a body, the widest first; fewer if the points lie in a plane.
std::vector<std::uint32_t> first_simplex(std::span<const Vec3> x, double least) {
  const auto farthest = [&](auto distance) {
    std::uint32_t best = 0;
    for (std::uint32_t k = 1; k < x.size(); ++k)
      if (distance(x[k]) > distance(x[best])) best = k;
    return best;
  };
  const std::uint32_t a = farthest([&](const Vec3& p) { return p.x; });
  const std::uint32_t b = farthest([&](const Vec3& p) { return norm(p - x[a]); });
  if (norm(x[b] - x[a]) <= least) return {};
  const Vec3 along = normalized(x[b] - x[a]);
  const std::uint32_t c = farthest([&](const Vec3& p) { return norm(cross(p - x[a], along)); });
  if (norm(cross(x[c] - x[a], along)) <= least) return {};
  const Vec3 up = normalized(cross(x[b] - x[a], x[c] - x[a]));
  const std::uint32_t d = farthest([&](const Vec3& p) { return std::abs(dot(p - x[a], up)); });
  if (std::abs(dot(x[d] - x[a], up)) <= least) return {};
  if (dot(x[d] - x[a], up) > 0) return {a, c, b, d};          // seen from d the first three turn clockwise
  return {a, b, c, d};
}

// Triangles of the hull: every point that sees some of them replaces these by a cone over their rim.
std::vector<Facet> hull_facets(std::span<const Vec3> x, double least) {
  const std::vector<std::uint32_t> s = first_simplex(x, least);
  if (s.empty()) return {};
  std::vector<Facet> facets{facet(x, s[0], s[1], s[2]), facet(x, s[0], s[3], s[1]), facet(x, s[1], s[3], s[2]), facet(x, s[2], s[3], s[0])};
  for (std::uint32_t p = 0; p < x.size(); ++p) {
    const auto sees = [&](const Facet& f) { return dot(x[p] - x[f.corners[0]], f.normal) > least; };
    std::map<std::pair<std::uint32_t, std::uint32_t>, bool> rim;
    for (const Facet& f : facets)
      if (sees(f))
        for (int k = 0; k < 3; ++k) rim[{f.corners[k], f.corners[(k + 1) % 3]}] = true;
    if (rim.empty()) continue;
    std::erase_if(facets, sees);
    for (const auto& [edge, _] : rim)
      if (!rim.contains({edge.second, edge.first})) facets.push_back(facet(x, edge.first, edge.second, p));
  }
  return facets;
}

// The polygon around facets of one plane: their directed edges that no other of them has in reverse, without corners on a line.
std::vector<std::uint32_t> outline(std::span<const Vec3> x, const std::vector<Facet>& group) {
  std::map<std::uint32_t, std::uint32_t> next;
  for (const Facet& f : group)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = f.corners[k], b = f.corners[(k + 1) % 3];
      const bool inner = std::any_of(group.begin(), group.end(), [&](const Facet& g) {
        return std::any_of(g.corners.begin(), g.corners.end(), [&](const std::uint32_t& c) {
          return c == b && g.corners[(&c - g.corners.data() + 1) % 3] == a;
        });
      });
      if (!inner) next[a] = b;
    }
  std::vector<std::uint32_t> loop;
  for (std::uint32_t v = next.begin()->first; loop.size() < next.size(); v = next.at(v)) loop.push_back(v);
  std::vector<std::uint32_t> corners;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec3 before = x[loop[k]] - x[loop[(k + loop.size() - 1) % loop.size()]], after = x[loop[(k + 1) % loop.size()]] - x[loop[k]];
    if (norm(cross(before, after)) > 1e-7 * norm(before) * norm(after)) corners.push_back(loop[k]);
  }
  return corners;
}

// Keeps the vertices that are corners of faces, and derives edges and a point inside.
Polyhedron finished(std::span<const Vec3> x, std::vector<Polyhedron::Face> faces) {
  Polyhedron p;
  std::map<std::uint32_t, std::uint32_t> index;
  for (auto& f : faces)
    for (std::uint32_t& c : f.corners) {
      const auto [at, fresh] = index.try_emplace(c, std::uint32_t(p.vertices.size()));
      if (fresh) p.vertices.push_back(x[c]);
      c = at->second;
    }
  p.faces = std::move(faces);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> face_of;
  for (std::uint32_t f = 0; f < p.faces.size(); ++f) {
    const auto& c = p.faces[f].corners;
    for (std::size_t k = 0; k < c.size(); ++k) face_of[{c[k], c[(k + 1) % c.size()]}] = f;
  }
  for (const auto& [edge, f] : face_of)
    if (edge.first < edge.second)
      if (const auto other = face_of.find({edge.second, edge.first}); other != face_of.end())
        p.edges.push_back({edge.first, edge.second, f, other->second});
  for (const Vec3& v : p.vertices) p.inside += (1.0 / double(p.vertices.size())) * v;
  return p;
}

}  // namespace

double Polyhedron::volume() const {
  double six = 0;
  for (const Face& f : faces)
    for (std::size_t k = 2; k < f.corners.size(); ++k)
      six += dot(vertices[f.corners[0]] - inside, cross(vertices[f.corners[k - 1]] - inside, vertices[f.corners[k]] - inside));
  return six / 6;
}

const Polyhedron::Face& Polyhedron::face_towards(const Vec3& direction) const {
  return *std::max_element(faces.begin(), faces.end(),
                           [&](const Face& a, const Face& b) { return dot(a.normal, direction) < dot(b.normal, direction); });
}

Vec3 Polyhedron::support(const Vec3& direction) const {
  return *std::max_element(vertices.begin(), vertices.end(),
                           [&](const Vec3& a, const Vec3& b) { return dot(a, direction) < dot(b, direction); });
}

std::vector<Vec3> Polyhedron::corners_of(const Face& f) const {
  std::vector<Vec3> out;
  for (const std::uint32_t c : f.corners) out.push_back(vertices[c]);
  return out;
}

Polyhedron Polyhedron::placed(const Pose& pose) const {
  Polyhedron p = *this;
  for (Vec3& v : p.vertices) v = to_world(pose, v);
  for (Face& f : p.faces) f.normal = rotate(pose.orientation, f.normal);
  p.inside = to_world(pose, inside);
  return p;
}

Polyhedron box_polyhedron(const Vec3& h) {
  std::vector<Vec3> x;
  for (int k = 0; k < 8; ++k) x.push_back({k & 1 ? h.x : -h.x, k & 2 ? h.y : -h.y, k & 4 ? h.z : -h.z});
  return finished(x, {{{-1, 0, 0}, {0, 4, 6, 2}}, {{1, 0, 0}, {1, 3, 7, 5}}, {{0, -1, 0}, {0, 1, 5, 4}},
                      {{0, 1, 0}, {2, 6, 7, 3}}, {{0, 0, -1}, {0, 2, 3, 1}}, {{0, 0, 1}, {4, 5, 7, 6}}});
}

Polyhedron convex_hull(std::span<const Vec3> points) {
  if (points.empty()) return {};
  Vec3 low = points[0], high = low;
  for (const Vec3& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  std::vector<Facet> rest = hull_facets(points, 1e-9 * norm(high - low));
  constexpr double same_plane = 1 - 1e-10;                   // cosine: 1.4e-5 rad
  std::vector<Polyhedron::Face> faces;
  while (!rest.empty()) {
    const Vec3 normal = rest.front().normal;                 // a convex body has one face of a normal
    const auto split = std::stable_partition(rest.begin(), rest.end(), [&](const Facet& f) { return dot(f.normal, normal) < same_plane; });
    faces.push_back({normal, outline(points, {split, rest.end()})});
    rest.erase(split, rest.end());
  }
  return faces.empty() ? Polyhedron{} : finished(points, std::move(faces));
}

}  // namespace skred
