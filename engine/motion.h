// engine/motion.h - prescribed motion of a kinematic body: pose and velocity as a function of time alone, so that a restart
// at any time gives the same bits as a run that never stopped.
#pragma once
#include <span>
#include "engine/vec3.h"

namespace skred {

// Active for start <= t < end [s]. With a frequency f the piece swings: both velocities are the greatest, and go with
// cos(2 pi f (t - start) + phase).
struct MotionPiece {
  double start = 0, end = 0;
  Vec3 velocity;               // [m/s]
  Vec3 angular_velocity;       // [rad/s] about the axis through `point`
  Vec3 point;                  // [m]
  double frequency = 0;        // [Hz] >= 0; 0: steady
  double phase = 0;            // [rad]
};

struct BodyState {
  Pose pose;
  Vec3 velocity;               // of the origin of the body's frame [m/s]
  Vec3 angular_velocity;       // [rad/s]
};

// Applies the pieces one after the other to the pose at t = 0: each turns the body about its axis, then shifts it.
BodyState prescribed_state(const Pose& at_start, std::span<const MotionPiece> pieces, double time);

}  // namespace skred
