#include "kernels/body_forces.h"
#include <algorithm>

namespace skred {

std::vector<BodyLoad> body_loads(std::span<const Index> particle, std::span<const Index> geometry, std::span<const double> overlap,
                                 std::span<const Vec3> normal, std::span<const Vec3> force, std::span<const Vec3> rolling_torque,
                                 std::span<const Index> id, std::span<const Vec3> position, std::span<const double> radius,
                                 std::span<const Index> body_of_geometry, std::span<const Pose> pose) {
  struct Entry { Index id, contact; };
  std::vector<Entry> touching;
  for (Index c = 0; c < particle.size(); ++c)
    if (touches(overlap[c], force[c])) touching.push_back({id[particle[c]], c});
  std::sort(touching.begin(), touching.end(),               // rows of one particle already stand by geometry and slot
            [](const Entry& a, const Entry& b) { return a.id != b.id ? a.id < b.id : a.contact < b.contact; });

  std::vector<BodyLoad> loads(pose.size());
  for (const auto [_, c] : touching) {
    const Index p = particle[c], b = body_of_geometry[geometry[c]];
    const Vec3 point = position[p] - (radius[p] - 0.5 * overlap[c]) * normal[c];
    loads[b].force -= force[c];
    loads[b].torque -= cross(point - pose[b].position, force[c]);
    if (!rolling_torque.empty()) loads[b].torque -= rolling_torque[c];
  }
  return loads;
}

void add_rigid_loads(std::vector<BodyLoad>& loads, std::span<const Index> geometry_a, std::span<const Index> geometry_b,
                     std::span<const Vec3> point, std::span<const Vec3> force, std::span<const Index> body_of_geometry,
                     std::span<const Pose> pose) {
  for (std::size_t c = 0; c < point.size(); ++c) {
    const Index a = body_of_geometry[geometry_a[c]], b = body_of_geometry[geometry_b[c]];
    loads[a].force += force[c];
    loads[a].torque += cross(point[c] - pose[a].position, force[c]);
    loads[b].force -= force[c];
    loads[b].torque -= cross(point[c] - pose[b].position, force[c]);
  }
}

}  // namespace skred
