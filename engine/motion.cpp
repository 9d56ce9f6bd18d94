#include "engine/motion.h"
#include <algorithm>

namespace skred {

BodyState prescribed_state(const Pose& at_start, std::span<const MotionPiece> pieces, double time) {
  BodyState s{at_start, {}, {}};
  for (const MotionPiece& m : pieces) {
    const double elapsed = std::clamp(time, m.start, m.end) - m.start;
    const bool active = time >= m.start && time < m.end;
    if (m.angular_velocity != Vec3{}) {
      const Quaternion turn = rotation_by(elapsed * m.angular_velocity);
      s.pose.position = m.point + rotate(turn, s.pose.position - m.point);
      s.pose.orientation = normalized(turn * s.pose.orientation);
      s.velocity = rotate(turn, s.velocity);
      s.angular_velocity = rotate(turn, s.angular_velocity);
      if (active) {
        s.velocity += cross(m.angular_velocity, s.pose.position - m.point);
        s.angular_velocity += m.angular_velocity;
      }
    }
    s.pose.position += elapsed * m.velocity;
    if (active) s.velocity += m.velocity;
  }
  return s;
}

}  // namespace skred
