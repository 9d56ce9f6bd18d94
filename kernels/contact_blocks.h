// kernels/contact_blocks.h - loops over the blocks of contacts that are the serial ones for any number of threads.
#pragma once
#include "engine/access.h"

namespace skred {

inline constexpr std::size_t blocks_at_a_time = 8;           // of a thread

// Calls visit(block) for all blocks, colour by colour. `sweep`, from 1 on, labels the loops in the timeline.
template <class Visit> void by_colour(const Parallel& parallel, std::span<const Index> first_of_colour, int sweep, const Visit& visit) {
  for (std::size_t c = 0; c < block_colours; ++c) {
    const Index first = first_of_colour[c];
    const LoopLabel label{static_cast<std::uint16_t>(sweep), static_cast<std::uint16_t>(c)};
    parallel.labelled(label)(first_of_colour[c + 1] - first, blocks_at_a_time, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) visit(first + k);
    });
  }
}

inline Vec3 at(const ContactGroup::Vectors& v, std::size_t lane) { return {v.x[lane], v.y[lane], v.z[lane]}; }
inline void put(const Vec3& v, ContactGroup::Vectors& to, std::size_t lane) { to.x[lane] = v.x, to.y[lane] = v.y, to.z[lane] = v.z; }

}  // namespace skred
