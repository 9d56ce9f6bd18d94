#include "kernels/move_bodies.h"
#include "kernels/body_forces.h"
#include "kernels/integrate.h"

namespace skred {

void MoveBodies::operator()(Read<&Clock::step> step, Read<&Bodies::motion> motion, Read<&Bodies::acceleration> acceleration,
                            Read<&Bodies::angular_acceleration> angular_acceleration,
                            Read<&Bodies::previous_acceleration> previous_acceleration,
                            Read<&Bodies::previous_angular_acceleration> previous_angular_acceleration, Update<&Bodies::pose> pose,
                            Update<&Bodies::velocity> velocity, Update<&Bodies::angular_velocity> spin) const {
  const double h = time_step;
  for (std::size_t b = 0; b < motion.size(); ++b) {
    if (motion[b] == Motion::kinematic) {
      const BodyState s = prescribed_state(at_start[b], pieces[b], double(step[0]) * step_length);
      pose[b] = s.pose;
      velocity[b] = s.velocity;
      spin[b] = s.angular_velocity;
    } else if (motion[b] == Motion::dynamic) {
      pose[b].position += h * velocity[b] + (0.5 * h * h) * acceleration[b];
      pose[b].orientation =
          normalized(rotation_by(h * spin[b] + (0.5 * h * h) * angular_acceleration[b]) * pose[b].orientation);
      velocity[b] += (0.5 * h) * (acceleration[b] + mean(acceleration[b], previous_acceleration[b]));
      spin[b] += (0.5 * h) * (angular_acceleration[b] + mean(angular_acceleration[b], previous_angular_acceleration[b]));
    }
  }
}

template <bool rigid_contacts>
void ForceApplicationBody<rigid_contacts>::operator()(
    Read<&BodyContacts::particle> particle, Read<&BodyContacts::geometry> geometry, Read<&BodyContacts::overlap> overlap,
    Read<&BodyContacts::normal> normal, Read<&BodyContacts::force> force, Read<&BodyContacts::rolling_torque> rolling_torque,
    Read<&Particles::id> id, Read<&Particles::position> position, Read<&Particles::radius> radius,
    If<rigid_contacts, Read<&RigidContacts::geometry_a>> geometry_a, If<rigid_contacts, Read<&RigidContacts::geometry_b>> geometry_b,
    If<rigid_contacts, Read<&RigidContacts::point>> point, If<rigid_contacts, Read<&RigidContacts::force>> rigid_force,
    Read<&Geometries::body> body, Read<&Bodies::motion> motion, Read<&Bodies::pose> pose, Read<&Bodies::mass> mass,
    Read<&Bodies::inertia> inertia, Write<&Bodies::force> body_force, Write<&Bodies::torque> body_torque,
    Update<&Bodies::acceleration> acceleration, Update<&Bodies::angular_acceleration> angular_acceleration,
    Update<&Bodies::previous_acceleration> previous_acceleration,
    Update<&Bodies::previous_angular_acceleration> previous_angular_acceleration, Update<&Bodies::velocity> velocity,
    Update<&Bodies::angular_velocity> spin) const {
  auto loads = body_loads(particle, geometry, overlap, normal, force, rolling_torque, id, position, radius, body, pose);
  if constexpr (rigid_contacts) add_rigid_loads(loads, geometry_a, geometry_b, point, rigid_force, body, pose);
  for (std::size_t b = 0; b < motion.size(); ++b) {
    body_force[b] = loads[b].force;
    body_torque[b] = loads[b].torque;
    if (motion[b] != Motion::dynamic) continue;
    const Vec3 a = (1 / mass[b]) * loads[b].force + gravity;
    // Euler's equations in the body's frame, I alpha = T - w x I w, Goldstein ch. 5
    const Vec3 t = rotate_back(pose[b].orientation, loads[b].torque), w = rotate_back(pose[b].orientation, spin[b]);
    const Vec3 angular_momentum{inertia[b].x * w.x, inertia[b].y * w.y, inertia[b].z * w.z};
    const Vec3 m = t - cross(w, angular_momentum);
    const Vec3 alpha = rotate(pose[b].orientation, {m.x / inertia[b].x, m.y / inertia[b].y, m.z / inertia[b].z});
    velocity[b] += (0.5 * time_step) * (a - mean(acceleration[b], previous_acceleration[b]));
    spin[b] += (0.5 * time_step) * (alpha - mean(angular_acceleration[b], previous_angular_acceleration[b]));
    previous_acceleration[b] = time_step > 0 ? acceleration[b] : a;
    previous_angular_acceleration[b] = time_step > 0 ? angular_acceleration[b] : alpha;
    acceleration[b] = a;
    angular_acceleration[b] = alpha;
  }
}

template struct ForceApplicationBody<false>;
template struct ForceApplicationBody<true>;

}  // namespace skred
