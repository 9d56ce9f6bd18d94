#include "kernels/contact_solve.h"
#include <algorithm>
#include <atomic>
#include <numeric>
#include "kernels/contact_law.h"

namespace skred {

namespace {

constexpr std::size_t blocks_at_a_time = 8;                  // of a thread

// Calls visit(block) for all blocks, colour by colour.
template <class Visit> void by_colour(const Parallel& parallel, std::span<const Index> first_of_colour, const Visit& visit) {
  for (std::size_t c = 0; c < block_colours; ++c) {
    const Index first = first_of_colour[c];
    parallel(first_of_colour[c + 1] - first, blocks_at_a_time, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) visit(first + k);
    });
  }
}

struct Outcome { int sweeps = 0; double residual = 0; };

// What the sweeps of a step work on.
struct System {
  std::span<const Index> first_of_colour;
  std::span<Buffer<ContactGroup>> groups;
  std::span<SolverBody> bodies;
  std::span<SweepChange> change;
  std::span<HubContact> hubs;
  std::span<const InverseInertia> inertia;
};

SweepChange sum(std::span<const SweepChange> change, SweepChange all) {
  for (const SweepChange& c : change) all.change += c.change, all.total += c.total;
  return all;
}

double residual_of(const SweepChange& all) { return all.change > 0 ? all.change / all.total : 0; }

Outcome solve(const Parallel& parallel, const SweepOptions& o, const System& of) {
  const auto& [first_of_colour, groups, bodies, change, hubs, inertia] = of;
  constexpr int between_measures = 4;
  Outcome out;
  while (out.sweeps < o.most) {
    ++out.sweeps;
    const bool last = out.sweeps == o.most, measured = last || (o.tolerance > 0 && out.sweeps % between_measures == 0);
    const SweepGroups sweep = measured ? o.measured_sweep : o.sweep;
    by_colour(parallel, first_of_colour, [&](std::size_t b) { sweep(groups[b].data(), groups[b].size(), bodies.data(), o.separation_speed, change[b]); });
    SweepChange of_hubs;
    sweep_hubs(hubs, bodies, inertia, o.kind, o.separation_speed, of_hubs);
    if (!measured) continue;
    out.residual = residual_of(sum(change, of_hubs));
    if (out.residual <= o.tolerance) break;
  }
  return out;
}

// The same, but a block is visited only when it has an impact, or when it or a neighbour has just changed by more than the tolerance
// allows: few impacts need not wake everyone.
// A dynamic body may reach anywhere: with one, everyone is awake.
Outcome solve_near(std::span<const Index> impacts, std::span<const BlockNeighbours> neighbours, const Parallel& parallel, const SweepOptions& o, const System& of) {
  if (!of.hubs.empty()) return solve(parallel, o, of);
  const auto& [first_of_colour, groups, bodies, change, hubs, inertia] = of;
  std::vector<std::atomic<char>> awake(groups.size());       // of blocks of one colour only others are neighbours: no order in which
  for (std::size_t b = 0; b < awake.size(); ++b) awake[b].store(impacts[b] > 0, std::memory_order_relaxed);   // a colour is run can matter
  Outcome out;
  double enough = 0;                                         // [N s]
  while (out.sweeps < o.most) {
    ++out.sweeps;
    by_colour(parallel, first_of_colour, [&](std::size_t b) {
      if (!awake[b].exchange(0, std::memory_order_relaxed)) return;
      o.measured_sweep(groups[b].data(), groups[b].size(), bodies.data(), o.separation_speed, change[b]);
      if (change[b].change <= enough) return;
      awake[b].store(1, std::memory_order_relaxed);
      for (const Index n : neighbours[b])
        if (n != no_index) awake[n].store(1, std::memory_order_relaxed);
    });
    const SweepChange all = sum(change, {});
    enough = o.tolerance * all.total;
    out.residual = residual_of(all);
    if (std::none_of(awake.begin(), awake.end(), [](const auto& a) { return a.load(std::memory_order_relaxed) != 0; })) break;
  }
  return out;
}

Vec3 at(const ContactGroup::Vectors& v, std::size_t lane) { return {v.x[lane], v.y[lane], v.z[lane]}; }
void put(const Vec3& v, ContactGroup::Vectors& to, std::size_t lane) { to.x[lane] = v.x, to.y[lane] = v.y, to.z[lane] = v.z; }

}  // namespace

void ImpactSolve::operator()(Parallel parallel, Read<&ContactBlocks::first_of_colour> first_of_colour, Read<&ContactBlocks::impacts> impacts_of_block,
                             Read<&ContactBlocks::neighbours> neighbours, Update<&ContactBlocks::groups> groups, Update<&ContactBlocks::sources> sources, Update<&ContactBlocks::change> change,
                             Update<&HubContacts::contact> hubs, Read<&SolverBodies::inverse_inertia> inertia, Update<&SolverBodies::state> bodies, Write<&Solver::impacts> impacts, Write<&Solver::impact_sweeps> sweeps_done,
                             Write<&Solver::impact_residual> residual) const {
  impacts[0] = std::accumulate(impacts_of_block.begin(), impacts_of_block.end(), std::int64_t{0}) +
               std::count_if(hubs.begin(), hubs.end(), [](const HubContact& c) { return c.impact; });
  const Outcome done = impacts[0] > 0 ? solve_near(impacts_of_block, neighbours, parallel, sweeps, {first_of_colour, groups, bodies, change, hubs, inertia})
                                      : Outcome{};
  sweeps_done[0] = done.sweeps;
  residual[0] = done.residual;
  if (impacts[0] == 0) return;
  for (HubContact& c : hubs) {
    c.impact_impulse = c.normal_impulse * c.normal + c.friction_impulse;
    c.normal_impulse = 0;
    c.friction_impulse = {};
  }
  parallel(groups.size(), blocks_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      for (std::size_t k = 0; k < groups[b].size(); ++k) {
        ContactGroup& g = groups[b][k];
        for (std::size_t l = 0; l < std::size_t(g.count); ++l)
          sources[b][k].impact_impulse[l] = g.normal_impulse[l] * at(g.normal, l) + at(g.friction_impulse, l);
        g.normal_impulse = {};
        g.friction_impulse = {};
      }
  });
}

template <bool rolling>
void ContactSolve<rolling>::operator()(Parallel parallel, Read<&Particles::id> id, Read<&ContactBlocks::first_of_colour> first_of_colour,
                                       Read<&ContactBlocks::contacts> contacts_of_block, Update<&ContactBlocks::groups> groups,
                                       Read<&ContactBlocks::sources> sources, Update<&ContactBlocks::change> change,
                                       Read<&Contacts::spring> impulse, Read<&BodyContacts::spring> body_impulse,
                                       If<rolling, Read<&Contacts::rolling>> rolling_impulse, If<rolling, Read<&BodyContacts::rolling>> body_rolling_impulse,
                                       Read<&RigidContacts::spring> rigid_impulse, Update<&HubContacts::contact> hubs, Read<&SolverBodies::inverse_inertia> inertia,
                                       Update<&SolverBodies::state> bodies, Write<&Solver::contacts> contacts, Write<&Solver::sweeps> sweeps_done,
                                       Update<&Solver::residual> residual, Update<&Solver::unsolved> unsolved) const {
  const double h = time_step;
  const auto for_each_contact = [&](std::size_t b, const auto& visit) {
    for (std::size_t k = 0; k < groups[b].size(); ++k)
      for (std::size_t l = 0; l < std::size_t(groups[b][k].count); ++l) visit(groups[b][k], sources[b][k], l);
  };

  // The right-hand sides, from the velocities before gravity.
  parallel(groups.size(), blocks_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      for_each_contact(b, [&](ContactGroup& g, const GroupSource& s, std::size_t l) {
        const double u_n = dot(bodies[g.a[l]].linear.v - bodies[g.b[l]].linear.v, at(g.normal, l)), factor = s.velocity_factor[l];
        g.bias[l] = s.overlap[l] > 0 ? 16.0 / 5.0 * (factor / h) * s.overlap[l] + factor * u_n : (s.overlap[l] - s.allowance[l]) / h;
      });
  });
  set_hub_biases(hubs, bodies, h);
  const auto fall = [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      if (bodies[p].linear.s > 0) bodies[p].linear.v += h * gravity;
  };
  parallel(id.size(), 4096, fall);
  fall(bodies.size() - inertia.size(), bodies.size());

  constexpr double trusted = 0.05;                           // residual of the last step up to which its impulses are taken whole
  const double share = residual[0] <= trusted ? 1 : 0.5;
  if (warm_start)
    by_colour(parallel, first_of_colour, [&](std::size_t b) {
      for_each_contact(b, [&](ContactGroup& g, const GroupSource& s, std::size_t l) {
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

  if (warm_start) {
    if constexpr (rolling) warm_start_hubs(hubs, bodies, inertia, share, body_impulse, body_rolling_impulse, rigid_impulse);
    else warm_start_hubs(hubs, bodies, inertia, share, body_impulse, {}, rigid_impulse);
  }

  const Outcome done = solve(parallel, sweeps, {first_of_colour, groups, bodies, change, hubs, inertia});
  contacts[0] = std::accumulate(contacts_of_block.begin(), contacts_of_block.end(), std::int64_t(hubs.size()));
  sweeps_done[0] = done.sweeps;
  residual[0] = done.residual;
  unsolved[0] += done.residual > sweeps.tolerance && sweeps.tolerance > 0;
}

template struct ContactSolve<true>;
template struct ContactSolve<false>;

}  // namespace skred
