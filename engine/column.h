// engine/column.h - a column of a table, and the number of a row.
#pragma once
#include <cstdint>
#include <limits>
#include "engine/buffer.h"

namespace skred {

template <class V> struct Column {
  const char* name;             // shown in the graph, the timeline and the output files
  const char* unit;             // SI; "1" if dimensionless
  Buffer<V> data = {};
};

using Index = std::uint32_t;    // a row of a table
inline constexpr Index no_index = std::numeric_limits<Index>::max();

}  // namespace skred
