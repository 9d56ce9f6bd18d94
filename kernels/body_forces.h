// kernels/body_forces.h - force and torque of all contacts on every rigid body, in an order that depends on nothing but ids.
#pragma once
#include <span>
#include <vector>
#include "engine/access.h"

namespace skred {

struct BodyLoad { Vec3 force, torque; };   // [N], [N m] about the origin of the body's frame

// What overlaps now, or has been pushed apart in this step: nonsmooth DEM turns impacts round before they overlap.
inline bool touches(double overlap, const Vec3& force) { return overlap > 0 || force != Vec3{}; }

// Of the particles. Contacts are taken by ascending (particle id, geometry, slot). `rolling_torque` may be empty.
std::vector<BodyLoad> body_loads(std::span<const Index> particle, std::span<const Index> geometry, std::span<const double> overlap,
                                 std::span<const Vec3> normal, std::span<const Vec3> force, std::span<const Vec3> rolling_torque,
                                 std::span<const Index> id, std::span<const Vec3> position, std::span<const double> radius,
                                 std::span<const Index> body_of_geometry, std::span<const Pose> pose);

// Adds the contacts between bodies, in the order of their table.
void add_rigid_loads(std::vector<BodyLoad>& loads, std::span<const Index> geometry_a, std::span<const Index> geometry_b,
                     std::span<const Vec3> point, std::span<const Vec3> force, std::span<const Index> body_of_geometry,
                     std::span<const Pose> pose);

}  // namespace skred
