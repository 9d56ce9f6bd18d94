#include "kernels/count_crossings.h"
#include <algorithm>

namespace skred {

namespace { struct Passage { Index id, area; int sign; double mass; }; }

template <class Space>
void CountCrossings<Space>::operator()(Parallel parallel, Read<&Particles::id> id, Read<&Particles::position> position,
                                       Read<&Particles::mass> mass, Update<&Particles::before> before, Update<&Crossed::count> count,
                                       Update<&Crossed::mass> crossed_mass) const {
  constexpr std::size_t chunk = 4096;
  const std::size_t n = position.size();
  std::vector<std::vector<Passage>> found((n + chunk - 1) / chunk);
  parallel.chunks(n, chunk, [&](std::size_t k, std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const Vec3 straight = position[p] - before[p], way = space.shortest(straight);
      for (Index a = 0; a < areas.size(); ++a) {
        int sign = 0;
        if (way == straight) sign = crossing(areas[a], before[p], position[p]);
        else sign = crossing(areas[a], before[p], before[p] + way) + crossing(areas[a], position[p] - way, position[p]);
        if (sign != 0) found[k].push_back({id[p], a, sign, mass[p]});
      }
      before[p] = position[p];
    }
  });
  std::vector<Passage> passages;
  for (const auto& f : found) passages.insert(passages.end(), f.begin(), f.end());
  std::sort(passages.begin(), passages.end(), [](const Passage& x, const Passage& y) { return x.id < y.id; });   // the order of the sums
  for (const Passage& p : passages) {
    count[p.area] += p.sign;
    crossed_mass[p.area] += p.sign * p.mass;
  }
}

template struct CountCrossings<OpenSpace>;
template struct CountCrossings<PeriodicSpace>;

}  // namespace skred
