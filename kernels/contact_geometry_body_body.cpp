#include "kernels/contact_geometry_body_body.h"
#include <algorithm>
#include <utility>

namespace skred {

namespace {

// The rows of the last step that belong to a pair of geometries: both tables are sorted by pair.
std::pair<Index, Index> rows_of(const RigidContacts& old, Index a, Index b) {
  const auto before = [&](Index row) { return std::pair{old.geometry_a.data[row], old.geometry_b.data[row]} < std::pair{a, b}; };
  Index low = 0, high = static_cast<Index>(old.rows());
  while (low < high) {
    const Index middle = (low + high) / 2;
    before(middle) ? low = middle + 1 : high = middle;
  }
  Index last = low;
  while (last < old.rows() && old.geometry_a.data[last] == a && old.geometry_b.data[last] == b) ++last;
  return {low, last};
}

// The nearest touching point of the last step, as either body sees it: one of them may slide along the other. Two points that
// part from one both continue it: springs are displacements, and the bodies' is theirs.
Index continued(const RigidContacts& old, std::pair<Index, Index> rows, const Vec3& normal, const Vec3& anchor_a, const Vec3& anchor_b) {
  constexpr double least_cosine = 0.5;
  Index best = no_index;
  double least = std::numeric_limits<double>::infinity();
  for (Index r = rows.first; r < rows.second; ++r) {
    if (!(old.overlap.data[r] > 0) || dot(old.normal.data[r], normal) < least_cosine) continue;
    const double distance = std::min(norm(old.anchor_a.data[r] - anchor_a), norm(old.anchor_b.data[r] - anchor_b));
    if (distance < least) least = distance, best = r;
  }
  return best;
}

}  // namespace

void ContactGeometryBodyBody::operator()(Parallel parallel, Read<&RigidPairs::a> a, Read<&RigidPairs::b> b, Read<&Geometries::body> body,
                                         Read<&Geometries::local> local, Read<&Bodies::pose> pose, Resize<RigidContacts> contacts) const {
  constexpr std::size_t chunk = 16;
  struct Found { Index pair; Touch touch; };
  std::vector<std::vector<Found>> found((a.size() + chunk - 1) / chunk);
  parallel.chunks(a.size(), chunk, [&](std::size_t k, std::size_t begin, std::size_t end) {
    std::vector<Touch> touches;
    for (std::size_t p = begin; p < end; ++p) {
      touches.clear();
      touch((*solids)[a[p]], pose[body[a[p]]] * local[a[p]], (*solids)[b[p]], pose[body[b[p]]] * local[b[p]], margin, touches);
      for (const Touch& t : touches) found[k].push_back({static_cast<Index>(p), t});
    }
  });

  RigidContacts& now = *contacts.table;
  const RigidContacts old = std::exchange(now, {});
  for (const auto& of_chunk : found)
    for (const auto& [p, t] : of_chunk) {
      const Index g = a[p], h = b[p];
      const std::size_t row = now.rows();
      const bool first = row == 0 || now.geometry_a.data.back() != g || now.geometry_b.data.back() != h;
      now.slot.data.push_back(first ? 0 : now.slot.data.back() + 1);
      now.geometry_a.data.push_back(g);
      now.geometry_b.data.push_back(h);
      now.point.data.push_back(t.point);
      now.normal.data.push_back(t.normal);
      now.overlap.data.push_back(t.overlap);
      now.radius_eff.data.push_back(t.weight * t.weight * radius_eff((*solids)[g], (*solids)[h]));   // stiffness ~ its root
      now.anchor_a.data.push_back(to_local(pose[body[g]], t.point));
      now.anchor_b.data.push_back(to_local(pose[body[h]], t.point));
      const Index from = continued(old, rows_of(old, g, h), t.normal, now.anchor_a.data.back(), now.anchor_b.data.back());
      now.previous.data.push_back(from);
      if (springs) now.spring.data.push_back(from == no_index ? Vec3{} : old.spring.data[from]);
      if (memory) now.memory.data.push_back(from == no_index ? ContactMemory{} : old.memory.data[from]);
    }
  now.force.data.resize(now.rows());
}

}  // namespace skred
