// kernels/move_bodies.h - poses and velocities of moving bodies at the next time.
//
// Kinematic bodies follow their prescribed motion, a function of time alone. Dynamic bodies are predicted like particles
// (kernels/integrate.h) and corrected by force_application_body.
#pragma once
#include <vector>
#include "engine/access.h"
#include "engine/motion.h"

namespace skred {

struct MoveBodies {
  static constexpr const char* name = "move_bodies";

  std::vector<std::vector<MotionPiece>> pieces;   // by body; empty unless kinematic
  Buffer<Pose> at_start;                          // by body
  double step_length;                             // [s] time = step * step_length
  double time_step;                               // h [s] of this step; 0 before the first

  void operator()(Read<&Clock::step> step, Read<&Bodies::motion> motion, Read<&Bodies::acceleration> acceleration,
                  Read<&Bodies::angular_acceleration> angular_acceleration,
                  Read<&Bodies::previous_acceleration> previous_acceleration,
                  Read<&Bodies::previous_angular_acceleration> previous_angular_acceleration, Update<&Bodies::pose> pose,
                  Update<&Bodies::velocity> velocity, Update<&Bodies::angular_velocity> spin) const;
};

// Total loads on all bodies, and the velocities of dynamic ones that follow.
template <bool rigid_contacts> struct ForceApplicationBody {
  static constexpr const char* name = "force_application_body";

  Vec3 gravity;       // [m/s^2]
  double time_step;   // h [s]

  void operator()(Read<&BodyContacts::particle> particle, Read<&BodyContacts::geometry> geometry,
                  Read<&BodyContacts::overlap> overlap, Read<&BodyContacts::normal> normal, Read<&BodyContacts::force> force,
                  Read<&BodyContacts::rolling_torque> rolling_torque, Read<&Particles::id> id, Read<&Particles::position> position,
                  Read<&Particles::radius> radius, If<rigid_contacts, Read<&RigidContacts::geometry_a>> geometry_a,
                  If<rigid_contacts, Read<&RigidContacts::geometry_b>> geometry_b, If<rigid_contacts, Read<&RigidContacts::point>> point,
                  If<rigid_contacts, Read<&RigidContacts::force>> rigid_force, Read<&Geometries::body> body,
                  Read<&Bodies::motion> motion, Read<&Bodies::pose> pose, Read<&Bodies::mass> mass, Read<&Bodies::inertia> inertia,
                  Write<&Bodies::force> body_force, Write<&Bodies::torque> body_torque, Update<&Bodies::acceleration> acceleration,
                  Update<&Bodies::angular_acceleration> angular_acceleration,
                  Update<&Bodies::previous_acceleration> previous_acceleration,
                  Update<&Bodies::previous_angular_acceleration> previous_angular_acceleration,
                  Update<&Bodies::velocity> velocity, Update<&Bodies::angular_velocity> spin) const;
};

extern template struct ForceApplicationBody<false>;
extern template struct ForceApplicationBody<true>;

}  // namespace skred
