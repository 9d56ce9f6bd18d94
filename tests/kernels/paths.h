// tests/kernels/paths.h - a loop over rows, run by every set of vector instructions over ranges of every length and remainder.
#pragma once
#include <gtest/gtest.h>
#include "engine/vector_path.h"

namespace skred {

inline constexpr std::size_t guard_rows = 20, longest_range = 41, rows_of_paths = guard_rows + longest_range + guard_rows;

// `after(path, first, last)` is what the loop over these of rows_of_paths rows leaves of `start`: the same bits on every path, and nothing
// outside. Calls also(got, want, path) for every path and of_scalar(want, first, last) for every range.
template <class Results, class After, class Also, class OfScalar>
void compare_paths(const Results& start, const After& after, const Also& also, const OfScalar& of_scalar) {
  for (const std::size_t first : {0, 3, 8, 13, 20})
    for (std::size_t count = 0; count < longest_range; ++count) {
      const std::size_t last = first + count;
      SCOPED_TRACE(testing::Message() << "[" << first << ", " << last << ")");
      const Results want = after(VectorPath::scalar, first, last);
      for (const VectorPath path : vector_paths()) {
        const Results got = after(path, first, last);
        ASSERT_TRUE(same_bits(got, want, first, last)) << name_of(path);
        ASSERT_TRUE(same_bits(got, start, 0, first)) << name_of(path) << " wrote in front of " << first;
        ASSERT_TRUE(same_bits(got, start, last, rows_of_paths)) << name_of(path) << " wrote behind " << last;
        ASSERT_NO_FATAL_FAILURE(also(got, want, path));
      }
      ASSERT_NO_FATAL_FAILURE(of_scalar(want, first, last));
    }
}

}  // namespace skred
