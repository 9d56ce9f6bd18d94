#include "kernels/contact_solve.h"
#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include "kernels/contact_blocks.h"

namespace skred {

namespace {

struct Outcome {
  int sweeps = 0;
  double residual = 0;           // change of the last sweep, of all impulses; not finite where something is no number
  double left = 1;               // part that the sweeps leave of an error that falls as slowly as at the last of them
  bool unsolved = false;         // stopped above a tolerance
};

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

double power(double x, int n) {
  double out = 1;
  for (; n > 0 && out > 0; --n) out *= x;
  return out;
}

double residual_of(const SweepChange& all) { return all.change == 0 ? 0 : all.change / all.total; }

// Whether the last sweep, whose changes are `ratio` of those of the sweep before, may be the last. Changes that go on to fall like that
// add up to ratio / (1 - ratio) times the last one.
bool is_enough(const SweepOptions& o, double residual, double ratio) {
  return residual <= o.tolerance && (residual * ratio <= o.error_tolerance * (1 - ratio) || is_rounding(residual, ratio));
}

Outcome solve(const Parallel& parallel, const SweepOptions& o, const System& of) {
  const auto& [first_of_colour, groups, bodies, change, hubs, inertia] = of;
  constexpr int between_tests = 4;
  Outcome out;
  double before = 0, ratio = 1;                              // [N s] change of the sweep before a test, and that of the test to it
  while (out.sweeps < o.most) {
    ++out.sweeps;
    const auto is_tested = [&](int n) { return n == o.most || (o.tolerance > 0 && n % between_tests == 0); };
    const bool tested = is_tested(out.sweeps), measured = tested || is_tested(out.sweeps + 1);
    const SweepGroups sweep = measured ? o.measured_sweep : o.sweep;
    by_colour(parallel, first_of_colour, out.sweeps, [&](std::size_t b) { sweep_block(sweep, o, of, b); });
    SweepChange of_hubs;
    sweep_hubs(hubs, bodies, inertia, o.kind, o.separation_speed, of_hubs);
    if (!measured) continue;
    const SweepChange all = sum(change, of_hubs);
    if (!tested) {
      before = all.change;
      continue;
    }
    out.residual = residual_of(all);
    ratio = before > 0 ? std::min(1.0, all.change / before) : 1;
    out.unsolved = o.tolerance > 0 && !is_enough(o, out.residual, ratio);
    if (!std::isfinite(out.residual) || (o.tolerance > 0 && !out.unsolved)) break;
  }
  out.left = power(ratio, out.sweeps);
  return out;
}

// The same, but a block is visited only when it has an impact, or when it or a neighbour has just changed by more than its share of what
// the tolerance allows: few impacts need not wake everyone.
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
    const auto pressed = std::count_if(change.begin(), change.end(), [](const SweepChange& c) { return c.total > 0; });
    enough = pressed > 0 ? o.tolerance * all.total / double(pressed) : 0;
    out.residual = residual_of(all);
    if (!std::isfinite(out.residual)) break;
    if (std::any_of(awake.begin(), awake.end(), [](const auto& a) { return a.load(std::memory_order_relaxed) != 0; })) continue;
    if (out.residual <= o.tolerance) break;                  // else some fell asleep when all impulses were larger
    for (std::size_t b = 0; b < awake.size(); ++b) awake[b].store(change[b].change > enough, std::memory_order_relaxed);
  }
  out.unsolved = o.tolerance > 0 && !(out.residual <= o.tolerance);
  return out;
}

}  // namespace

void ImpactSolve::operator()(Parallel parallel, Read<&ContactBlocks::first_of_colour> first_of_colour,
    Read<&ContactBlocks::impacts> impacts_of_block, Read<&ContactBlocks::neighbours> neighbours, Update<&ContactBlocks::groups> groups,
    Update<&ContactBlocks::sources> sources, Update<&ContactBlocks::change> change, Update<&HubContacts::contact> hubs,
    Read<&SolverBodies::inverse_inertia> inertia, Update<&SolverBodies::state> bodies, Write<&Solver::impacts> impacts,
    Write<&Solver::impact_sweeps> sweeps_done, Write<&Solver::impact_residual> residual, Update<&Solver::impacts_unsolved> unsolved) const {
  impacts[0] = std::accumulate(impacts_of_block.begin(), impacts_of_block.end(), std::int64_t{0}) +
               std::count_if(hubs.begin(), hubs.end(), [](const HubContact& c) { return c.impact; });
  const Outcome done = impacts[0] > 0 ? solve_near(impacts_of_block, neighbours, parallel, sweeps, {first_of_colour, groups, bodies, change, hubs, inertia})
                                      : Outcome{};
  sweeps_done[0] = done.sweeps;
  residual[0] = done.residual;
  unsolved[0] += done.unsolved;
  if (impacts[0] == 0) return;
  for (HubContact& c : hubs) {
    c.impact_impulse = c.normal_impulse * c.normal + c.friction_impulse;
    c.normal_impulse = 0;
    c.friction_impulse = c.rolling_impulse = {};
  }
  parallel(groups.size(), blocks_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      for (std::size_t k = 0; k < groups[b].size(); ++k) {
        ContactGroup& g = groups[b][k];
        for (std::size_t l = 0; l < std::size_t(g.count); ++l)
          sources[b][k].impact_impulse[l] = g.normal_impulse[l] * at(g.normal, l) + at(g.friction_impulse, l);
        g.normal_impulse = {};
        g.friction_impulse = g.rolling_impulse = {};
      }
  });
}

void ContactSolve::operator()(Parallel parallel, Read<&ContactBlocks::first_of_colour> first_of_colour,
    Read<&ContactBlocks::contacts> contacts_of_block, Update<&ContactBlocks::groups> groups, Update<&ContactBlocks::change> change,
    Update<&HubContacts::contact> hubs, Read<&SolverBodies::inverse_inertia> inertia, Update<&SolverBodies::state> bodies,
    Write<&Solver::contacts> contacts, Write<&Solver::sweeps> sweeps_done, Write<&Solver::residual> residual,
    Write<&Solver::error_left> error_left, Update<&Solver::unsolved> unsolved) const {
  const Outcome done = solve(parallel, sweeps, {first_of_colour, groups, bodies, change, hubs, inertia});
  contacts[0] = std::accumulate(contacts_of_block.begin(), contacts_of_block.end(), std::int64_t(hubs.size()));
  sweeps_done[0] = done.sweeps;
  residual[0] = done.residual;
  error_left[0] = done.left;
  unsolved[0] += done.unsolved;
}

}  // namespace skred
