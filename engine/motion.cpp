#include "engine/motion.h"
#include <algorithm>
#include <cmath>
#include <numbers>

namespace skred {
namespace {

// How far a piece has gone, of its velocity [s], and how fast it goes now, of its velocity [1].
struct Course { double way, rate; };

Course course_of(const MotionPiece& m, double elapsed) {
  if (m.frequency == 0) return {elapsed, 1};
  const double w = 2 * std::numbers::pi * m.frequency;
  return {(std::sin(w * elapsed + m.phase) - std::sin(m.phase)) / w, std::cos(w * elapsed + m.phase)};
}

}  // namespace

BodyState prescribed_state(const Pose& at_start, std::span<const MotionPiece> pieces, double time) {
  BodyState s{at_start, {}, {}};
  for (const MotionPiece& m : pieces) {
    const auto [way, rate] = course_of(m, std::clamp(time, m.start, m.end) - m.start);
    const bool active = time >= m.start && time < m.end;
    if (m.angular_velocity != Vec3{}) {
      const Quaternion turn = rotation_by(way * m.angular_velocity);
      s.pose.position = m.point + rotate(turn, s.pose.position - m.point);
      s.pose.orientation = normalized(turn * s.pose.orientation);
      s.velocity = rotate(turn, s.velocity);
      s.angular_velocity = rotate(turn, s.angular_velocity);
      if (active) {
        s.velocity += cross(rate * m.angular_velocity, s.pose.position - m.point);
        s.angular_velocity += rate * m.angular_velocity;
      }
    }
    s.pose.position += way * m.velocity;
    if (active) s.velocity += rate * m.velocity;
  }
  return s;
}

}  // namespace skred
