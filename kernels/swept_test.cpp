#include "kernels/swept_test.h"
#include <algorithm>
#include "engine/geometry/mesh.h"
#include "engine/periodic.h"

namespace skred {

namespace {

// Nearest place of a shape; of a mesh, among the triangles. Infinitely far where there are none.
Nearest nearest_of(const Shape& shape, const Vec3& x, std::span<const Index> triangles) {
  return std::visit([&](const auto& s) -> Nearest {
    if constexpr (std::is_same_v<std::decay_t<decltype(s)>, MeshShape>) {
      const double far = 2 * (norm(x) + s.mesh->outer_radius());
      const MeshContacts at = s.mesh->touch(x, far, triangles);
      return at.count > 0 ? Nearest{far - at.at[0].overlap, at.at[0].normal, 0} : Nearest{far, {0, 0, 1}, 0};
    } else {
      return nearest(s, x);
    }
  }, shape);
}

// How much of the path from x along d is free, 0 .. 1, and the normal of what ends it.
struct Free { double part = 1; Vec3 normal; };

Free free_path(const Shape& shape, const Vec3& x, const Vec3& d, double radius, std::span<const Index> triangles) {
  constexpr int most_steps = 100;
  const double length = norm(d), first = nearest_of(shape, x, triangles).distance;
  const double least = 0.5 * std::min(radius, first);        // of the centre from the wall
  if (first <= 0 || length == 0) return {};                  // inside already: its rows push it out
  double gone = 0;
  for (int k = 0; k < most_steps; ++k) {
    const Nearest at = nearest_of(shape, x + (gone / length) * d, triangles);
    const double room = at.distance - least;
    if (room < 1e-3 * radius) return {gone / length, at.normal};
    gone += room;
    if (gone >= length) return {};
  }
  return {gone / length, nearest_of(shape, x + (gone / length) * d, triangles).normal};
}

}  // namespace

template <class Space>
void SweptTest<Space>::operator()(Parallel parallel, Read<&Particles::position> position, Read<&Particles::radius> radius,
    Read<&Particles::searched> searched, Read<&Particles::search_margin> search_margin, Update<&Particles::velocity> velocity, Read<&BodyIncidence::first> first, Read<&BodyContacts::geometry> geometry,
    Read<&BodyContacts::slot> slot, Read<&BodyContacts::first_triangle> first_triangle, Read<&BodyContacts::triangle_count> triangle_count,
    Read<&Triangles::triangle> triangle, Read<&Geometries::body> body, Read<&Geometries::shape> shape, Read<&Geometries::local> local,
    Read<&Bodies::pose> pose, Read<&Bodies::velocity> body_velocity, Read<&Bodies::angular_velocity> body_spin) const {
  constexpr double far = 0.4;                                // of a radius: less cannot take the centre through a wall
  constexpr int most_walls = 8;                              // met one after the other
  parallel(position.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const Vec3 x = position[p];
      // Walls within a radius of the margin are listed: a centre that stays half a radius short of that meets no other.
      const double known = search_margin[p] + 0.5 * radius[p] - norm(space.shortest(x - searched[p]));
      if (const double way = time_step * norm(velocity[p]); way > known) velocity[p] *= std::max(0.0, known) / way;
      for (int met = 0; met <= most_walls; ++met) {
        bool stopped = false;
        for (Index c = first[p]; c < first[p + 1]; ++c) {
          if (slot[c] != 0) continue;                        // a mesh once
          const Index g = geometry[c], b = body[g];
          const Vec3 wall = body_velocity[b] + cross(body_spin[b], x - pose[b].position), v = velocity[p] - wall;
          if (!(time_step * norm(v) > far * radius[p])) continue;
          const Pose world = pose[b] * local[g];
          const Free way = free_path(shape[g], to_local(world, x), time_step * rotate_back(world.orientation, v), radius[p],
                                     triangle.subspan(first_triangle[c], triangle_count[c]));
          if (way.part >= 1) continue;
          stopped = true;
          const Vec3 n = rotate(world.orientation, way.normal);
          const double approach = dot(v, n);
          if (met == most_walls || !(approach < 0)) velocity[p] = wall + way.part * v;   // cornered
          else velocity[p] -= (1 - way.part) * approach * n;
        }
        if (!stopped) break;
      }
    }
  });
}

template struct SweptTest<OpenSpace>;
template struct SweptTest<PeriodicSpace>;

}  // namespace skred
