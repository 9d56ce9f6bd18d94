// engine/vec3.h - small vectors and rotations.
//
// Templates on the number type so that a contact law reads the same for one contact (double) and for a pack of
// contacts (a SIMD type with the same operators).
#pragma once
#include <cmath>
#include <type_traits>

namespace skred {

// The branch-free choice that laws use instead of `if`: of numbers, and lane by lane of packs.
constexpr double select(bool condition, double yes, double no) { return condition ? yes : no; }
template <class Mask, class Pack> requires(!std::is_same_v<Mask, bool>)
[[gnu::always_inline]] inline Pack select(const Mask& condition, const Pack& yes, const Pack& no) {
  Pack r = no;
  where(condition, r) = yes;                                 // std::experimental::where
  return r;
}

constexpr bool none_of(bool condition) { return !condition; }   // of packs: std::experimental::none_of, all_of
constexpr bool all_of(bool condition) { return condition; }

template <class R> struct Vec3T {
  R x{}, y{}, z{};

  constexpr Vec3T& operator+=(const Vec3T& b) { x += b.x; y += b.y; z += b.z; return *this; }
  constexpr Vec3T& operator-=(const Vec3T& b) { x -= b.x; y -= b.y; z -= b.z; return *this; }
  constexpr Vec3T& operator*=(R s) { x *= s; y *= s; z *= s; return *this; }
  friend constexpr bool operator==(const Vec3T&, const Vec3T&) = default;
};

template <class R> constexpr Vec3T<R> operator+(Vec3T<R> a, const Vec3T<R>& b) { return a += b; }
template <class R> constexpr Vec3T<R> operator-(Vec3T<R> a, const Vec3T<R>& b) { return a -= b; }
template <class R> constexpr Vec3T<R> operator-(const Vec3T<R>& a) { return {-a.x, -a.y, -a.z}; }
template <class R> constexpr Vec3T<R> operator*(R s, Vec3T<R> a) { return a *= s; }
template <class R> constexpr Vec3T<R> operator*(Vec3T<R> a, R s) { return a *= s; }
template <class R> constexpr R dot(const Vec3T<R>& a, const Vec3T<R>& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class R> constexpr Vec3T<R> cross(const Vec3T<R>& a, const Vec3T<R>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class R> constexpr Vec3T<R> select(const auto& condition, const Vec3T<R>& yes, const Vec3T<R>& no) {
  return {select(condition, yes.x, no.x), select(condition, yes.y, no.y), select(condition, yes.z, no.z)};
}
template <class R> R norm(const Vec3T<R>& a) { using std::sqrt; return sqrt(dot(a, a)); }

using Vec3 = Vec3T<double>;

inline Vec3 normalized(const Vec3& a) { return (1.0 / norm(a)) * a; }
inline bool is_finite(const Vec3& a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

// Unit quaternion: the rotation from a body's frame to the world.
struct Quaternion {
  double w = 1, x = 0, y = 0, z = 0;
  friend constexpr bool operator==(const Quaternion&, const Quaternion&) = default;
};

constexpr Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
constexpr Quaternion conjugate(const Quaternion& q) { return {q.w, -q.x, -q.y, -q.z}; }
inline Quaternion normalized(const Quaternion& q) {
  const double s = 1.0 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {s * q.w, s * q.x, s * q.y, s * q.z};
}
constexpr Vec3 rotate(const Quaternion& q, const Vec3& v) {
  const Vec3 u{q.x, q.y, q.z};
  const Vec3 t = 2.0 * cross(u, v);
  return v + q.w * t + cross(u, t);
}
constexpr Vec3 rotate_back(const Quaternion& q, const Vec3& v) { return rotate(conjugate(q), v); }

// The rotation by the angle |phi| [rad] about the axis phi / |phi|.
inline Quaternion rotation_by(const Vec3& phi) {
  const double angle = norm(phi);
  if (angle == 0) return {};
  const Vec3 v = (std::sin(0.5 * angle) / angle) * phi;
  return {std::cos(0.5 * angle), v.x, v.y, v.z};
}

// Position and orientation of a frame in its parent frame.
struct Pose {
  Vec3 position;           // [m]
  Quaternion orientation;
  friend constexpr bool operator==(const Pose&, const Pose&) = default;
};
constexpr Vec3 to_world(const Pose& p, const Vec3& local) { return p.position + rotate(p.orientation, local); }
constexpr Vec3 to_local(const Pose& p, const Vec3& world) { return rotate_back(p.orientation, world - p.position); }
constexpr Pose operator*(const Pose& parent, const Pose& child) {
  return {to_world(parent, child.position), parent.orientation * child.orientation};
}

}  // namespace skred
