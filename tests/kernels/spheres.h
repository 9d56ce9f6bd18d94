// tests/kernels/spheres.h - spheres at random, and kernels called on their world by hand.
#pragma once
#include <algorithm>
#include <random>
#include <set>
#include "engine/access.h"
#include "engine/periodic.h"

namespace skred {

// Calls a kernel as the runtime does, on this thread.
template <class Kernel, class T, class... W>
void call(const Kernel& kernel, World& w, const Rows<T>& rows, void (Kernel::*)(W...) const) {
  kernel(make(w, rows, Parallel{}, Word<W>{})...);
}
template <class Kernel> void call(const Kernel& kernel, World& w) { call(kernel, w, Rows<Particles>{0, std::get<Particles>(w).rows()}, &Kernel::operator()); }

// In a cube, with radii of 0.3 .. 0.7 m and margins of up to 0.1 m. Rows are not ids.
inline World random_spheres(int n, double edge, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0, 1);
  World w;
  Particles& p = std::get<Particles>(w);
  for (Index k = 0; k < Index(n); ++k) {
    p.id.data.push_back(k);
    p.position.data.push_back({edge * u(random), edge * u(random), edge * u(random)});
    p.radius.data.push_back(0.3 + 0.4 * u(random));
    p.search_margin.data.push_back(0.1 * u(random));
    p.list_margin.data.push_back(u(random) * p.search_margin.data.back());
  }
  std::shuffle(p.id.data.begin(), p.id.data.end(), random);
  p.velocity.data.resize(p.rows());
  p.previous_row.data.resize(p.rows());
  p.searched.data = p.listed.data = p.position.data;
  return w;
}

// What the cells of a grid must measure for them [m].
inline constexpr double least_cell = 2 * (0.7 + 0.1);

using Pairs = std::set<std::pair<Index, Index>>;             // of ids, the lower first

// All pairs that are nearer than their radii and these margins.
template <class Space> Pairs by_brute_force(const World& w, const Space& space, Column<double> Particles::* margin) {
  const Particles& p = std::get<Particles>(w);
  const auto reach = [&](Index a) { return p.radius.data[a] + (p.*margin).data[a]; };
  Pairs out;
  for (Index a = 0; a < p.rows(); ++a)
    for (Index b = 0; b < p.rows(); ++b) {
      const double near = reach(a) + reach(b);
      const Vec3 d = space.shortest(p.position.data[a] - p.position.data[b]);
      if (p.id.data[a] < p.id.data[b] && dot(d, d) < near * near) out.insert({p.id.data[a], p.id.data[b]});
    }
  return out;
}

}  // namespace skred
