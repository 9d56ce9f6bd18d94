// kernels/broadphase_loop.h - which places of the grid are near a particle (kernels/broadphase.h).
#pragma once
#include <array>
#include <cstring>
#include "engine/pack_vectors.h"
#include "kernels/broadphase.h"

namespace skred {

using FourIndices [[gnu::vector_size(4 * sizeof(Index))]] = Index;

// Of four bits: which are set, from the lowest on.
struct SetBits { std::array<Index, 4> which; std::size_t count; };
constexpr auto set_bits = [] {
  std::array<SetBits, 16> out{};
  for (unsigned bits = 0; bits < 16; ++bits)
    for (Index k = 0; k < 4; ++k)
      if (bits >> k & 1) out[bits].which[out[bits].count++] = k;
  return out;
}();

template <class Space> template <VectorPath path> [[gnu::flatten]]
std::size_t Surroundings<Space>::near(const Surroundings& s, const Vec3& at, double mine, const Places* first, const Places* last, Index* out) {
  using R = NumberOf<path>;
  const Vec3T<R> x{R(at.x), R(at.y), R(at.z)};
  std::size_t count = 0;
  for (const Places* places = first; places < last; ++places)
    for (Index k = places->first; k < places->last; k += lanes<R>) {
      const FullRange<R> row{k};
      const Vec3T<R> d = s.space.shortest(load<R>(s.position, row) - x);
      const R touch = R(mine) + load<R>(s.reach, row);
      const Index left = places->last - k;
      unsigned near = bits(dot(d, d) < touch * touch) & (left < Index(lanes<R>) ? (1u << left) - 1 : ~0u);
      for (Index four = 0; four < Index(lanes<R>); four += 4, near >>= 4) {   // no branch on nearness: which of them are near is a matter of chance
        const SetBits& in = set_bits[near & 15];
        FourIndices places_near;
        std::memcpy(&places_near, in.which.data(), sizeof places_near);
        places_near += k + four;
        std::memcpy(out + count, &places_near, sizeof places_near);
        count += in.count;
      }
    }
  return count;
}

}  // namespace skred
