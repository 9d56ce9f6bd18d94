#include "profiling/bench/roofline.h"
#include <algorithm>

namespace skred {

namespace {

// Per particle, candidate pair, touching pair, listed place at a wall, touching place at a wall.
struct Counts { double particle = 0, candidate = 0, touching = 0, wall = 0, wall_touching = 0; };
enum Often { every_step, every_listing, every_search };

struct KernelCost {
  const char* name;
  Often often;
  Counts bytes, flops, roots;
};

// Counted by hand in kernels/*.h for a scene with friction, rolling resistance and equal particles:
//   bytes   every column that the kernel's parameters name, once per row: read 1 x, written 1 x, updated 2 x its size (Vec3 24,
//           double 8, Index 4). Columns of particles that contacts gather count once per particle: neighbours share cache lines.
//   flops   additions, subtractions, multiplications, comparisons that select; roots: divisions and square roots.
// A pack of contacts takes the roots of sliding if one of its lanes slides: counted as in a flowing bed, always. Loops whose
// length depends on the packing: 85 particles in 27 cells, two neighbours for each listed pair (a candidate), one
// guest of a block for six candidates. The integration takes velocities and forces from the caches in which the application has left
// them (add_chain in tasks/task.h).
constexpr KernelCost costs[] = {
    // name, when, bytes, flops, roots
    {"integrate", every_step, {.particle = 80}, {.particle = 72}, {}},
    {"check_motion", every_listing, {.particle = 112}, {.particle = 20}, {.particle = 2}},
    {"reorder", every_search, {.particle = 130}, {.particle = 7}, {.particle = 1}},
    {"broadphase", every_search, {.particle = 120, .candidate = 16}, {.particle = 760}, {}},
    {"contact_listing", every_listing, {.particle = 48, .candidate = 32}, {.candidate = 22}, {}},
    {"contact_hashing", every_listing, {.particle = 12, .candidate = 104}, {}, {}},
    {"broadphase_body", every_search, {.particle = 44, .wall = 20}, {.particle = 10}, {}},
    {"contact_hashing_body", every_search, {.particle = 12, .wall = 168}, {}, {}},
    {"contact_geometry_body", every_step, {.wall = 92}, {.wall = 60}, {.wall = 2}},
    {"force_calculation_particle_particle", every_step, {.particle = 120, .candidate = 152}, {.candidate = 199}, {.candidate = 10}},
    {"force_calculation_particle_body", every_step, {.wall = 136, .wall_touching = 172}, {.wall_touching = 190}, {.wall_touching = 13}},
    {"force_application_particle", every_step, {.particle = 292, .candidate = 11, .wall = 48},
     {.particle = 39, .candidate = 1, .wall = 6}, {}},
};

double total(const Counts& c, const Summary& s, std::size_t particles) {
  return c.particle * double(particles) + c.candidate * s.candidates + c.touching * s.pairs + c.wall * s.wall_candidates +
         c.wall_touching * s.wall_contacts;
}

double per_step(const KernelCost& k, const Summary& s) {
  if (k.often == every_step) return 1;
  return s.steps ? double(k.often == every_search ? s.searches : s.listings) / double(s.steps) : 0;
}

const KernelCost* cost_of(const std::string& kernel) {
  const auto found = std::find_if(std::begin(costs), std::end(costs), [&](const KernelCost& k) { return kernel == k.name; });
  return found == std::end(costs) ? nullptr : found;
}

}  // namespace

double largest_working_set(const Summary& s, std::size_t particles) {
  double most = 0;
  for (const KernelTime& ran : s.kernels)
    if (const KernelCost* cost = cost_of(ran.name)) most = std::max(most, total(cost->bytes, s, particles));
  return most;
}

Roofline roofline(const Summary& s, std::size_t particles, const Limits& limits) {
  Roofline r{s.threads, limits, {}};
  for (const KernelTime& ran : s.kernels) {
    const KernelCost* cost = cost_of(ran.name);
    if (!cost) continue;                               // not counted: nothing to compare with
    const double often = per_step(*cost, s), bytes = total(cost->bytes, s, particles);
    KernelBound b{ran.name, often * bytes, often * total(cost->flops, s, particles), often * total(cost->roots, s, particles)};
    // As if the caches held nothing but this kernel's columns: a bound that no order of the kernels can beat.
    b.memory_seconds = b.bytes / limits.bandwidth_for(bytes);
    b.arithmetic_seconds = b.flops / limits.flops + b.roots / limits.roots;
    b.measured_seconds = ran.total;
    r.kernels.push_back(b);
  }
  return r;
}

}  // namespace skred
