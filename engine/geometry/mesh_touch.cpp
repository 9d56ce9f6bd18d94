// engine/geometry/mesh_touch.cpp - where a sphere touches a mesh.
//
// A place counts if the distance from the centre to the mesh as a whole is least there, not only to one triangle: an edge or
// vertex is dropped if a triangle that it belongs to has a nearer place, and of equal ones the first stays. Places of nearly the
// same normal are then joined.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory_resource>
#include <vector>
#include "engine/geometry/mesh.h"
#include "engine/geometry/nearest_on_triangle.h"

namespace skred {

namespace {

struct Place : TrianglePlace {
  std::uint32_t triangle;
};

using Places = std::pmr::vector<Place>;

bool has(const Triangle& triangle, std::uint32_t vertex) {
  return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

// Whether the feature of the triangle `owner` also belongs to `triangle`.
bool has(const Triangle& triangle, const Triangle& owner, Feature feature) {
  if (feature == Feature::face) return false;
  const auto k = static_cast<std::size_t>(feature);
  return k < 3 ? has(triangle, owner[k]) : has(triangle, owner[k - 3]) && has(triangle, owner[(k - 2) % 3]);
}

// Keeps the places that no triangle of a nearer one contains, in the order of distance.
void drop_shadowed(Places& places, std::span<const Triangle> triangles) {
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.triangle < b.triangle;
  });
  Places kept(places.get_allocator());
  kept.reserve(places.size());
  for (auto p = places.begin(); p != places.end(); ++p) {
    const Triangle& owner = triangles[p->triangle];
    // Its neighbours are most likely to be just before it.
    const bool shadowed = std::any_of(std::make_reverse_iterator(p), places.rend(), [&](const Place& nearer) {
      return has(triangles[nearer.triangle], owner, p->feature);
    });
    if (!shadowed) kept.push_back(*p);
  }
  places.swap(kept);
}

// Height of the nearest point of `place` above the tangent plane of the mesh at `other` [m]. It falls to 0 where a place
// slides into the realm of a deeper one, be it down a concave bend or across a seam of triangles that share no vertices.
double height(const Place& place, const Place& other) {
  return other.distance - place.distance * dot(place.normal, other.normal);
}

// What a place weighs beside a deeper one of the same group: 1 when equally deep, 0 where it ends.
double share(const Place& place, const Place& deeper) {
  const double from_above = height(deeper, place);
  return from_above > 0 ? std::clamp(height(place, deeper) / from_above, 0.0, 1.0) : 1.0;
}

// Joins places, deepest first, into groups about the deepest of each. The overlap is that of the deepest: more places do not
// make a sphere sink deeper. The normal is the mean, weighed by overlap and by `share`: a place joins and leaves with weight 0.
MeshContacts join(const Places& places, double radius) {
  static const double merge_cosine = std::cos(merge_angle);
  constexpr double hidden_height = 1e-3;   // of the radius: seams of files with rounded coordinates

  MeshContacts contacts{};
  std::array<const Place*, max_mesh_contacts> deepest{};
  std::pmr::vector<std::size_t> group(places.size(), max_mesh_contacts, places.get_allocator());
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Place& p = places[k];
    const double overlap = radius - p.distance;
    std::size_t g = 0;
    bool joins = false, hidden = false;
    for (; g < contacts.count && !joins && !hidden; ++g) {
      joins = dot(p.normal, deepest[g]->normal) > merge_cosine;
      hidden = height(p, *deepest[g]) <= hidden_height * radius;
    }
    if (joins) {
      group[k] = --g;
      double weight = overlap;
      for (std::size_t j = 0; j < k; ++j)
        if (group[j] == g) weight = std::min(weight, overlap * share(p, places[j]));
      contacts.at[g].normal += weight * p.normal;
    } else if (!hidden && g < max_mesh_contacts) {
      group[k] = g;
      deepest[g] = &p;
      contacts.at[contacts.count++] = {overlap, overlap * p.normal};
    }
  }
  for (std::size_t g = 0; g < contacts.count; ++g) contacts.at[g].normal = normalized(contacts.at[g].normal);
  return contacts;
}

}  // namespace

MeshContacts Mesh::touch(const Vec3& centre, double radius, std::span<const std::uint32_t> triangles) const {
  std::array<std::byte, 8192> room;        // enough for most spheres, so that no memory is asked for
  std::pmr::monotonic_buffer_resource memory(room.data(), room.size());
  Places places(&memory);
  for (const std::uint32_t t : triangles) {
    const TrianglePlace p = nearest_on_triangle(centre, triangles_[t], vertices_, face_normals_[t]);
    if (!(p.distance < radius)) continue;
    if (places.empty()) places.reserve(std::min<std::size_t>(triangles.size(), 64));
    places.push_back({p, t});
  }
  if (places.size() > 1) drop_shadowed(places, triangles_);
  return join(places, radius);
}

}  // namespace skred
