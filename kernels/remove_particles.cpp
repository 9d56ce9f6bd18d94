#include "kernels/remove_particles.h"
#include <algorithm>
#include <cmath>
#include <numeric>

namespace skred {

namespace {

// Is there a look at this step? Times are compared in whole steps: no sum of rounding errors decides.
bool looks(const Remover& r, std::int64_t step, double time_step) {
  const double first = std::max(0.0, std::ceil(r.start / time_step - 1e-6)), since = double(step) - first;
  if (since < 0 || double(step) * time_step >= r.end) return false;
  const double every = std::max(1.0, std::round(r.interval / time_step));
  return std::fmod(since, every) == 0;
}

}  // namespace

std::vector<Leaving> leaving(const Parallel& parallel, std::span<const Remover> removers, std::int64_t step, double time_step,
                             std::span<const Vec3> position, std::span<const Vec3> velocity) {
  std::vector<Index> looking;
  for (Index r = 0; r < removers.size(); ++r)
    if (looks(removers[r], step, time_step)) looking.push_back(r);
  const std::size_t n = position.size();
  if (looking.empty() || n == 0) return {};

  constexpr std::size_t chunk = 4096;
  std::vector<std::vector<Leaving>> found((n + chunk - 1) / chunk);
  parallel.chunks(n, chunk, [&](std::size_t k, std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      for (const Index r : looking)
        if (contains(removers[r].region, position[p])) {
          found[k].push_back({static_cast<Index>(p), r});
          break;
        }
  });
  std::vector<Leaving> all;
  for (const auto& f : found) all.insert(all.end(), f.begin(), f.end());
  for (std::size_t p = 0; p < n && !all.empty(); ++p)
    if (!is_finite(position[p]) || !is_finite(velocity[p])) return {};
  return all;
}

void RemoveParticles::operator()(Parallel parallel, Read<&Clock::step> step, Update<&Search::rows_changed> changed,
                                 Update<&Removed::count> count, Update<&Removed::mass> mass, Resize<Particles> particles) const {
  auto gone = leaving(parallel, removers, step[0] - steps_behind, time_step, particles->position.data, particles->velocity.data);
  if (gone.empty()) return;
  const std::size_t n = particles->rows();
  const auto& id = particles->id.data;
  std::vector<char> leaves(n, 0);
  for (const Leaving& l : gone) leaves[l.row] = 1;
  std::sort(gone.begin(), gone.end(), [&](const Leaving& a, const Leaving& b) { return id[a.row] < id[b.row]; });   // the order of the sums
  for (const Leaving& l : gone) {
    ++count[l.remover];
    mass[l.remover] += particles->mass.data[l.row];
  }
  auto& previous = particles->previous_row.data;
  if (!changed[0]) std::iota(previous.begin(), previous.end(), Index{0});
  const auto close_ranks = [&](auto& column) {
    if (column.data.size() != n) return;                     // an effect that is out leaves its columns empty
    std::size_t to = 0;
    for (std::size_t p = 0; p < n; ++p)
      if (!leaves[p]) column.data[to++] = column.data[p];
    column.data.resize(to);
  };
  std::apply([&](auto... c) { (close_ranks((*particles.table).*c), ...); }, Particles::columns());
  changed[0] = 1;
}

}  // namespace skred
