#include "kernels/contact_solve.h"
#include <algorithm>
#include <atomic>
#include <numeric>
#include "kernels/contact_blocks.h"

namespace skred {

namespace {

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

// One sweep of a block.
void sweep_block(SweepGroups sweep, const SweepOptions& o, const System& of, std::size_t b) {
  const auto next = b + 1 < of.groups.size() ? std::span<const ContactGroup>(of.groups[b + 1]) : std::span<const ContactGroup>{};
  sweep(of.groups[b], next, of.bodies.data(), o.separation_speed, of.change[b]);
}

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
    by_colour(parallel, first_of_colour, out.sweeps, [&](std::size_t b) { sweep_block(sweep, o, of, b); });
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
    by_colour(parallel, first_of_colour, out.sweeps, [&](std::size_t b) {
      if (!awake[b].exchange(0, std::memory_order_relaxed)) return;
      sweep_block(o.measured_sweep, o, of, b);
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

void ContactSolve::operator()(Parallel parallel, Read<&ContactBlocks::first_of_colour> first_of_colour, Read<&ContactBlocks::contacts> contacts_of_block,
                              Update<&ContactBlocks::groups> groups, Update<&ContactBlocks::change> change, Update<&HubContacts::contact> hubs,
                              Read<&SolverBodies::inverse_inertia> inertia, Update<&SolverBodies::state> bodies, Write<&Solver::contacts> contacts,
                              Write<&Solver::sweeps> sweeps_done, Write<&Solver::residual> residual, Update<&Solver::unsolved> unsolved) const {
  const Outcome done = solve(parallel, sweeps, {first_of_colour, groups, bodies, change, hubs, inertia});
  contacts[0] = std::accumulate(contacts_of_block.begin(), contacts_of_block.end(), std::int64_t(hubs.size()));
  sweeps_done[0] = done.sweeps;
  residual[0] = done.residual;
  unsolved[0] += done.residual > sweeps.tolerance && sweeps.tolerance > 0;
}

}  // namespace skred
