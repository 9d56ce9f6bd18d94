// kernels/contact_sweep_loop.h - one sweep of projected Gauss-Seidel: every row in turn is solved exactly for its own impulse, and
// the velocities follow at once [Jean 1999; Jourdan, Alart, Jean 1998; row by row exact for spheres].
#pragma once
#include "engine/pack_quads.h"
#include "kernels/contact_fetch.h"
#include "kernels/contact_law.h"
#include "kernels/contact_sweep.h"

namespace skred {

template <class R> R lanes_at(const ContactGroup::Lanes& x, int k) {
  if constexpr (lanes<R> == 1) return x[std::size_t(k)];
  else return R(&x[std::size_t(k)], stdx::vector_aligned);
}
template <class R> Vec3T<R> lanes_at(const ContactGroup::Vectors& v, int k) {
  return {lanes_at<R>(v.x, k), lanes_at<R>(v.y, k), lanes_at<R>(v.z, k)};
}
template <class R> void put_lanes(const R& v, ContactGroup::Lanes& x, int k) {
  if constexpr (lanes<R> == 1) x[std::size_t(k)] = v;
  else v.copy_to(&x[std::size_t(k)], stdx::vector_aligned);
}
template <class R> void put_lanes(const Vec3T<R>& v, ContactGroup::Vectors& x, int k) {
  put_lanes(v.x, x.x, k), put_lanes(v.y, x.y, k), put_lanes(v.z, x.z, k);
}

// Sums in an order that does not depend on the number of lanes: lane by lane of the group.
struct LaneSums {
  ContactGroup::Lanes change{}, total{};
};

template <class R, SweepKind kind> [[gnu::always_inline]] inline void sweep_lanes(ContactGroup& g, int k, SolverBody* bodies, R separation_speed, LaneSums& sums) {
  using std::abs;
  using V = Vec3T<R>;
  const auto angular_a = [&](int l) { return &bodies[g.a[std::size_t(k + l)]].angular; };
  const auto angular_b = [&](int l) { return &bodies[g.b[std::size_t(k + l)]].angular; };
  const auto linear_a = [&](int l) { return &bodies[g.a[std::size_t(k + l)]].linear; };
  const auto linear_b = [&](int l) { return &bodies[g.b[std::size_t(k + l)]].linear; };
  constexpr bool rotates = kind.friction || kind.rolling;

  QuadT<R> va = load_quads<R>(linear_a), vb = load_quads<R>(linear_b), wa, wb;
  if constexpr (rotates) wa = load_quads<R>(angular_a), wb = load_quads<R>(angular_b);
  const V n = lanes_at<R>(g.normal, k);

  // normal: p <- max(0, p + (b - u_n - S p) / (w_n + S)); what is not a number stays none, and is seen in the change
  const V dv = va.v - vb.v;
  const R u_n = dot(dv, n), p_before = lanes_at<R>(g.normal_impulse, k);
  R p_n;
  if constexpr (kind.impact) {
    const R bias = lanes_at<R>(g.bias, k), give = select(bias > R(0), R(0), give_of(lanes_at<R>(g.compliance, k) * lanes_at<R>(g.normal_step, k)));
    p_n = p_before + (bias - u_n) * ((R(1) - give) * lanes_at<R>(g.free_step, k)) - give * p_before;
  } else p_n = p_before + (lanes_at<R>(g.bias, k) - u_n - lanes_at<R>(g.compliance, k) * p_before) * lanes_at<R>(g.normal_step, k);
  if constexpr (kind.limited) {                              // no more than leaves the contact at that speed
    const R most = p_before + (separation_speed - u_n) * lanes_at<R>(g.free_step, k);
    p_n = select(p_n > most, most, p_n);
  }
  p_n = select(p_n < R(0), R(0), p_n);
  put_lanes(p_n, g.normal_impulse, k);
  V impulse = (p_n - p_before) * n;
  R change = abs(p_n - p_before);

  if constexpr (kind.friction) {                             // p_t <- [p_t - u_t / w_t] on the disc of radius mu p_n
    const R arm_a = lanes_at<R>(g.arm_a, k), arm_b = lanes_at<R>(g.arm_b, k);
    const V u_t = dv - u_n * n - cross(arm_a * wa.v + arm_b * wb.v, n);
    const V before = lanes_at<R>(g.friction_impulse, k);
    V p_t = before - lanes_at<R>(g.tangential_step, k) * u_t;
    p_t *= reduction(p_t, lanes_at<R>(g.friction, k) * p_n);
    put_lanes(p_t, g.friction_impulse, k);
    const V d = p_t - before, couple = cross(n, d);
    if constexpr (kind.measured) change = change + norm(d);
    impulse += d;
    wa.v -= (wa.s * arm_a) * couple;
    wb.v -= (wb.s * arm_b) * couple;
  }
  va.v += va.s * impulse;
  vb.v -= vb.s * impulse;
  if constexpr (kind.rolling) {                              // the same for the relative spin across the normal
    const V before = lanes_at<R>(g.rolling_impulse, k);
    V l = before - lanes_at<R>(g.rolling_step, k) * in_tangent_plane(wa.v - wb.v, n);
    l *= reduction(l, lanes_at<R>(g.rolling_arm, k) * p_n);
    put_lanes(l, g.rolling_impulse, k);
    const V d = l - before;
    wa.v += wa.s * d;
    wb.v -= wb.s * d;
  }

  store_quads<R>(va, linear_a);
  store_quads<R>(vb, linear_b);
  if constexpr (rotates) {
    store_quads<R>(wa, angular_a);
    store_quads<R>(wb, angular_b);
  }
  if constexpr (kind.measured) {
    put_lanes(lanes_at<R>(sums.change, k) + change, sums.change, k);
    put_lanes(lanes_at<R>(sums.total, k) + p_n, sums.total, k);
  }
}

template <class R, SweepKind kind>
[[gnu::flatten]] void sweep_groups(std::span<ContactGroup> groups, std::span<const ContactGroup> next, SolverBody* bodies, double separation_speed,
                                   SweepChange& out) {
  const auto ahead = [&](std::size_t k) -> const ContactGroup* {
    return k < groups.size() ? &groups[k] : k - groups.size() < next.size() ? &next[k - groups.size()] : nullptr;
  };
  alignas(64) LaneSums sums;
  for (std::size_t k = 0; k < groups.size(); ++k) {
    if (const ContactGroup* g = ahead(k + 3)) fetch(*g);
    if (const ContactGroup* g = ahead(k + 2)) fetch_bodies(*g, bodies);
    for (int l = 0; l < groups[k].count; l += lanes<R>) sweep_lanes<R, kind>(groups[k], l, bodies, R(separation_speed), sums);
  }
  out = {};
  if constexpr (kind.measured)
    for (std::size_t l = 0; l < ContactGroup::size; ++l) out.change += sums.change[l], out.total += sums.total[l];
}

template <SweepKind kind> template <VectorPath path>
void ContactSweep<kind>::run(std::span<ContactGroup> groups, std::span<const ContactGroup> next, SolverBody* bodies, double separation_speed, SweepChange& out) {
  sweep_groups<NumberOf<path>, kind>(groups, next, bodies, separation_speed, out);
}

}  // namespace skred
