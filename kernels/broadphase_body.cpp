#include "kernels/broadphase_body.h"
#include <algorithm>
#include <numeric>
#include <utility>
#include "engine/geometry/mesh.h"

namespace skred {

namespace {

struct Place { Index particle, geometry, slot, first_triangle, triangle_count; };
struct Found { std::vector<Place> places; std::vector<Index> triangles; };

const Mesh* mesh_of(const Shape& s) {
  const auto* m = std::get_if<MeshShape>(&s);
  return m ? m->mesh.get() : nullptr;
}

// Whether a ball reaches the shape.
bool reaches(const Shape& shape, const Vec3& centre, double radius) {
  return std::visit([&](const auto& s) {
    if constexpr (std::is_same_v<std::decay_t<decltype(s)>, MeshShape>) {
      const Bounds& b = s.mesh->bounds();
      const Vec3 d{std::max({b.min.x - centre.x, 0.0, centre.x - b.max.x}), std::max({b.min.y - centre.y, 0.0, centre.y - b.max.y}),
                   std::max({b.min.z - centre.z, 0.0, centre.z - b.max.z})};
      if (dot(d, d) > radius * radius) return false;
      std::vector<std::uint32_t> hit;
      s.mesh->find(centre, radius, hit);
      return !hit.empty();
    } else {
      return nearest(s, centre).distance < radius;
    }
  }, shape);
}

}  // namespace

void BroadphaseBody::operator()(Parallel parallel, Read<&Search::due> due, Read<&Particles::position> position,
                                Read<&Particles::radius> radius, Read<&Particles::search_margin> margin, Read<&Geometries::body> body,
                                Read<&Geometries::shape> shape, Read<&Geometries::local> local, Read<&Bodies::pose> pose, Update<&Bodies::searched> searched,
                                Resize<BodyContacts> contacts, Resize<PreviousBodyContacts> previous,
                                Resize<BodyIncidence> incidence, Resize<Triangles> triangles) const {
  if (!due[0]) return;
  const std::size_t n = position.size();
  for (std::size_t b = 0; b < pose.size(); ++b) searched[b] = pose[b];
  std::vector<Pose> world(shape.size());
  for (std::size_t g = 0; g < shape.size(); ++g) world[g] = pose[body[g]] * local[g];

  // Of the geometries `from`, those within reach of a ball around the particles [begin, end).
  const auto reached = [&](const std::vector<Index>& from, std::size_t begin, std::size_t end) {
    Vec3 low = position[begin], high = low;
    double largest = 0;
    for (std::size_t p = begin; p < end; ++p) {
      const Vec3 x = position[p];
      low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
      high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
      largest = std::max(largest, radius[p] + margin[p]);
    }
    const Vec3 centre = 0.5 * (low + high);
    const double ball = 0.5 * norm(high - low) + largest + wall_margin;
    std::vector<Index> near;
    for (const Index g : from)
      if (reaches(shape[g], to_local(world[g], centre), ball)) near.push_back(g);
    return near;
  };
  std::vector<Index> all(shape.size());
  std::iota(all.begin(), all.end(), Index{0});

  constexpr std::size_t chunk = 256, group = 16;
  std::vector<Found> found((n + chunk - 1) / chunk);
  std::vector<Index> count(n);
  parallel.chunks(n, chunk, [&](std::size_t k, std::size_t begin, std::size_t end) {
    const std::vector<Index> near = reached(all, begin, end);
    std::vector<Index> nearer;
    Found& f = found[k];
    for (std::size_t p = begin; p < end; ++p) {
      const std::size_t before = f.places.size();
      if ((p - begin) % group == 0) nearer = reached(near, p, std::min(p + group, end));
      for (const Index g : nearer) {
        const Vec3 x = to_local(world[g], position[p]);
        if (const Mesh* mesh = mesh_of(shape[g])) {
          const auto first = static_cast<Index>(f.triangles.size());
          mesh->find(x, radius[p] + margin[p] + wall_margin, f.triangles);
          const auto listed = static_cast<Index>(f.triangles.size()) - first;
          for (Index s = 0; listed > 0 && s < max_mesh_contacts; ++s)
            f.places.push_back({static_cast<Index>(p), g, s, first, listed});
        } else if (reaches(shape[g], x, radius[p] + margin[p] + wall_margin)) {
          f.places.push_back({static_cast<Index>(p), g, 0, 0, 0});
        }
      }
      count[p] = static_cast<Index>(f.places.size() - before);
    }
  });

  std::swap(previous->first.data, incidence->first.data);
  std::swap(previous->geometry.data, contacts->geometry.data);
  std::swap(previous->overlap.data, contacts->overlap.data);
  std::swap(previous->normal.data, contacts->normal.data);
  std::swap(previous->spring.data, contacts->spring.data);
  std::swap(previous->rolling.data, contacts->rolling.data);
  std::swap(previous->memory.data, contacts->memory.data);

  std::vector<std::size_t> place_offset{0}, triangle_offset{0};
  for (const Found& f : found) {
    place_offset.push_back(place_offset.back() + f.places.size());
    triangle_offset.push_back(triangle_offset.back() + f.triangles.size());
  }
  const std::size_t total = place_offset.back();
  BodyContacts& c = *contacts.table;
  for (auto* column : {&c.particle, &c.geometry, &c.slot, &c.first_triangle, &c.triangle_count}) resize_for_overwrite(column->data, total);
  c.overlap.data.assign(total, 0.0);
  c.normal.data.assign(total, Vec3{});
  c.curvature.data.assign(total, 0.0);
  resize_for_overwrite(c.force.data, total);
  resize_for_overwrite(c.torque.data, columns.torque ? total : 0);
  resize_for_overwrite(c.rolling_torque.data, columns.rolling_torque ? total : 0);
  resize_for_overwrite(c.spring.data, columns.spring ? total : 0);
  resize_for_overwrite(c.rolling.data, columns.rolling ? total : 0);
  resize_for_overwrite(c.memory.data, columns.memory ? total : 0);
  resize_for_overwrite(triangles->triangle.data, triangle_offset.back());
  parallel(found.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      std::copy(found[k].triangles.begin(), found[k].triangles.end(), triangles->triangle.data.begin() + triangle_offset[k]);
      std::size_t r = place_offset[k];
      for (const Place& p : found[k].places) {
        c.particle.data[r] = p.particle;
        c.geometry.data[r] = p.geometry;
        c.slot.data[r] = p.slot;
        c.first_triangle.data[r] = static_cast<Index>(triangle_offset[k]) + p.first_triangle;
        c.triangle_count.data[r] = p.triangle_count;
        ++r;
      }
    }
  });
  resize_for_overwrite(incidence->first.data, n + 1);
  incidence->first.data[0] = 0;
  for (std::size_t p = 0; p < n; ++p) incidence->first.data[p + 1] = incidence->first.data[p] + count[p];
}

namespace {

constexpr double seen_late = 0.02;                           // of a radius

// Gives the places where a sphere touches a mesh to its slots: each, the deepest first, to the free slot whose last normal is
// nearest to its own, else to the first slot that was not in use (or, where all were, to one whose place has just ended).
void assign_slots(const MeshContacts& touched, const Pose& pose, double* overlap, Vec3* normal) {
  constexpr double least_cosine = 0.5;
  std::array<double, max_mesh_contacts> old_overlap;
  std::array<Vec3, max_mesh_contacts> old_normal;
  std::array<bool, max_mesh_contacts> taken{};
  for (std::size_t s = 0; s < max_mesh_contacts; ++s) {
    old_overlap[s] = overlap[s];
    old_normal[s] = normal[s];
    overlap[s] = 0;
    normal[s] = {};
  }
  std::array<std::size_t, max_mesh_contacts> slot;
  slot.fill(max_mesh_contacts);
  std::array<Vec3, max_mesh_contacts> n;
  for (std::size_t k = 0; k < touched.count; ++k) {
    n[k] = rotate(pose.orientation, touched.at[k].normal);
    double best = least_cosine;
    for (std::size_t s = 0; s < max_mesh_contacts; ++s) {
      if (taken[s] || !(old_overlap[s] > 0)) continue;
      const double cosine = dot(old_normal[s], n[k]);
      if (cosine > best) best = cosine, slot[k] = s;
    }
    if (slot[k] < max_mesh_contacts) taken[slot[k]] = true;
  }
  for (std::size_t k = 0; k < touched.count; ++k) {
    for (const bool reuse : {false, true})                   // a new place should find no history in its slot
      for (std::size_t s = 0; s < max_mesh_contacts && slot[k] == max_mesh_contacts; ++s)
        if (!taken[s] && (reuse || !(old_overlap[s] > 0))) slot[k] = s;
    taken[slot[k]] = true;
    overlap[slot[k]] = touched.at[k].overlap;
    normal[slot[k]] = n[k];
  }
}

}  // namespace

template <bool ahead>
void ContactGeometryBody<ahead>::operator()(Parallel parallel, Read<&BodyContacts::particle> particle,
    Read<&BodyContacts::geometry> geometry, Read<&BodyContacts::slot> slot, Read<&BodyContacts::first_triangle> first_triangle,
    Read<&BodyContacts::triangle_count> triangle_count, Read<&Triangles::triangle> triangle, Read<&Particles::position> position,
    If<ahead, Read<&Particles::velocity>> velocity, Read<&Particles::radius> radius, Read<&Geometries::body> body,
    Read<&Geometries::shape> shape, Read<&Geometries::local> local, Read<&Bodies::pose> pose,
    If<ahead, Read<&Bodies::velocity>> body_velocity, If<ahead, Read<&Bodies::angular_velocity>> body_spin,
    Update<&BodyContacts::overlap> overlap, Update<&BodyContacts::normal> normal, Update<&BodyContacts::curvature> curvature) const {
  std::vector<Pose> world(shape.size());
  for (std::size_t g = 0; g < shape.size(); ++g) world[g] = pose[body[g]] * local[g];
  parallel(geometry.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const Index later = particle[std::min(c + 8, end - 1)];   // as in kernels/force_calculation_particle_body.h
      __builtin_prefetch(&position[later]), __builtin_prefetch(&radius[later]);
      if (slot[c] != 0) continue;                            // a mesh: its first slot does it for all
      const Index g = geometry[c], p = particle[c];
      const Vec3 x = to_local(world[g], position[p]);
      if (const Mesh* mesh = mesh_of(shape[g])) {
        const auto near = triangle.subspan(first_triangle[c], triangle_count[c]);
        double reach = 0;
        if constexpr (ahead) {
          const Index b = body[g];
          const Vec3 v = velocity[p] - body_velocity[b] - cross(body_spin[b], position[p] - pose[b].position);
          reach = time_step * norm(v) + fall;
          if (reach <= seen_late * radius[p]) reach = 0;     // it is soon enough to see the wall when it is touched
        }
        MeshContacts touched = mesh->touch(x, radius[p] + reach, near);
        for (std::size_t k = 0; k < touched.count; ++k) touched.at[k].overlap -= reach;
        assign_slots(touched, world[g], &overlap[c], &normal[c]);
        continue;
      }
      std::visit([&](const auto& s) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(s)>, MeshShape>) {
          const Nearest at = nearest(s, x);
          overlap[c] = radius[p] - at.distance;
          normal[c] = rotate(world[g].orientation, at.normal);
          curvature[c] = at.curvature;
        }
      }, shape[g]);
    }
  });
}

template struct ContactGeometryBody<false>;
template struct ContactGeometryBody<true>;

}  // namespace skred
