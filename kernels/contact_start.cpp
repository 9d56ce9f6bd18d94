#include "kernels/contact_start.h"
#include <algorithm>
#include "kernels/contact_blocks.h"
#include "kernels/contact_fetch.h"
#include "kernels/contact_law.h"

namespace skred {

template <bool rolling>
void ContactStart<rolling>::operator()(Parallel parallel, Read<&Particles::id> id, Read<&ContactBlocks::first_of_colour> first_of_colour,
    Update<&ContactBlocks::groups> groups, Read<&ContactBlocks::sources> sources, Read<&Contacts::spring> impulse,
    Read<&BodyContacts::spring> body_impulse, If<rolling, Read<&Contacts::rolling>> rolling_impulse,
    If<rolling, Read<&BodyContacts::rolling>> body_rolling_impulse, Read<&RigidContacts::spring> rigid_impulse,
    Update<&HubContacts::contact> hubs, Read<&SolverBodies::inverse_inertia> inertia, Update<&SolverBodies::state> bodies,
    Read<&Solver::residual> residual, Read<&Solver::error_left> error_left) const {
  const double h = time_step;
  const auto for_each_contact = [&](std::size_t b, const auto& fetch_last, const auto& visit) {
    const auto& of_block = groups[b];
    for (std::size_t k = 0; k < of_block.size(); ++k) {
      if (k + 3 < of_block.size()) fetch(of_block[k + 3]), fetch(sources[b][k + 3]);
      if (k + 2 < of_block.size()) {
        fetch_bodies(of_block[k + 2], bodies.data());
        for (const Index c : sources[b][k + 2].contact) fetch_last(c);
      }
      for (std::size_t l = 0; l < std::size_t(of_block[k].count); ++l) visit(groups[b][k], sources[b][k], l);
    }
  };

  // The right-hand sides, from the velocities before gravity.
  parallel(groups.size(), blocks_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      for_each_contact(b, [](Index) {}, [&](ContactGroup& g, const GroupSource& s, std::size_t l) {
        const double u_n = dot(bodies[g.a[l]].linear.v - bodies[g.b[l]].linear.v, at(g.normal, l));
        g.bias[l] = normal_bias(s.overlap[l], s.allowance[l], s.velocity_factor[l], u_n, h);
      });
  });
  set_hub_biases(hubs, bodies, h);
  const auto fall = [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      if (bodies[p].linear.s > 0) bodies[p].linear.v += h * gravity;
  };
  parallel(id.size(), 4096, fall);
  fall(bodies.size() - inertia.size(), bodies.size());

  // Impulses kept for many steps lag behind the motion and drive it: of an error, what sweeps and this leave of it is half at the most.
  const double share = residual[0] <= trusted_residual ? 1 : std::min(1.0, 0.5 / error_left[0]);
  const auto fetch_impulses = [&](Index c) {                 // of pairs; a few are at walls
    __builtin_prefetch(impulse.data() + c);
    if constexpr (rolling) __builtin_prefetch(rolling_impulse.data() + c);
  };
  if (!warm_start) return;
  by_colour(parallel, first_of_colour, 0, [&](std::size_t b) {
    for_each_contact(b, fetch_impulses, [&](ContactGroup& g, const GroupSource& s, std::size_t l) {
      if (s.impact[l]) return;
      const Index c = s.contact[l];
      const Vec3 n = at(g.normal, l), before = share * (s.of_body[l] ? body_impulse[c] : impulse[c]);
      const double p_n = std::max(0.0, dot(before, n)), p_before = dot(before, n);
      Vec3 p_t = before - p_before * n;
      p_t *= reduction(p_t, g.friction[l] * p_n);
      g.normal_impulse[l] = p_n;
      put(p_t, g.friction_impulse, l);
      SolverBody &a = bodies[g.a[l]], &other = bodies[g.b[l]];
      const Vec3 p = p_n * n + p_t, couple = cross(n, p_t);
      a.linear.v += a.linear.s * p;
      other.linear.v -= other.linear.s * p;
      a.angular.v -= (a.angular.s * g.arm_a[l]) * couple;
      other.angular.v -= (other.angular.s * g.arm_b[l]) * couple;
      if constexpr (rolling) {
        Vec3 moment = in_tangent_plane(share * (s.of_body[l] ? body_rolling_impulse[c] : rolling_impulse[c]), n);
        moment *= reduction(moment, g.rolling_arm[l] * p_n);
        put(moment, g.rolling_impulse, l);
        a.angular.v += a.angular.s * moment;
        other.angular.v -= other.angular.s * moment;
      }
    });
  });

  if constexpr (rolling) warm_start_hubs(hubs, bodies, inertia, share, body_impulse, body_rolling_impulse, rigid_impulse);
  else warm_start_hubs(hubs, bodies, inertia, share, body_impulse, {}, rigid_impulse);
}

template struct ContactStart<true>;
template struct ContactStart<false>;

}  // namespace skred
