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

struct Leaving { Index id, row, remover; };

}  // namespace

void RemoveParticles::operator()(Parallel parallel, Read<&Clock::step> step, Update<&Search::rows_changed> changed,
                                 Update<&Removed::count> count, Update<&Removed::mass> mass, Resize<Particles> particles) const {
  std::vector<Index> looking;
  for (Index r = 0; r < removers.size(); ++r)
    if (looks(removers[r], step[0] - steps_behind, time_step)) looking.push_back(r);
  const auto& position = particles->position.data;
  const std::size_t n = particles->rows();
  if (looking.empty() || n == 0) return;

  constexpr std::size_t chunk = 4096;
  std::vector<std::vector<Leaving>> found((n + chunk - 1) / chunk);
  parallel.chunks(n, chunk, [&](std::size_t k, std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      for (const Index r : looking)
        if (contains(removers[r].region, position[p])) {
          found[k].push_back({particles->id.data[p], static_cast<Index>(p), r});
          break;
        }
  });
  std::vector<Leaving> leaving;
  for (const auto& f : found) leaving.insert(leaving.end(), f.begin(), f.end());
  if (leaving.empty()) return;
  // Where something is not a number the run ends in this step, and the lists stay as they are (check_motion).
  for (std::size_t p = 0; p < n; ++p)
    if (!is_finite(position[p]) || !is_finite(particles->velocity.data[p])) return;

  std::vector<char> leaves(n, 0);
  for (const Leaving& l : leaving) leaves[l.row] = 1;
  std::sort(leaving.begin(), leaving.end(), [](const Leaving& a, const Leaving& b) { return a.id < b.id; });   // the order of the sums
  for (const Leaving& l : leaving) {
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
