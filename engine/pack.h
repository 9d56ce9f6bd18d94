// engine/pack.h - several numbers side by side in one vector register, and the way between them and rows of a column.
//
// Arithmetic, roots and masks are std::experimental::simd's.
#pragma once
#include <cstddef>
#include <experimental/simd>
#if defined(__AVX__)
#include <immintrin.h>
#endif
#include "engine/vec3.h"
#include "engine/vector_path.h"

namespace skred {

namespace stdx = std::experimental;

// The number type of a path, in a translation unit that is compiled for it.
template <VectorPath path> using NumberOf = std::conditional_t<path == VectorPath::scalar, double, stdx::native_simd<double>>;

template <class R> inline constexpr int lanes = stdx::is_simd_v<R> ? int(sizeof(R) / sizeof(double)) : 1;

// One bit a lane, the first the lowest.
inline unsigned bits(bool mask) { return mask; }
template <class Abi> unsigned bits(const stdx::simd_mask<double, Abi>& mask) {
#if defined(__AVX__) && !defined(__AVX512F__)
  if constexpr (stdx::simd_mask<double, Abi>::size() == 4) {
    stdx::simd<double, Abi> sign(0);
    where(mask, sign) = -1;
    return unsigned(_mm256_movemask_pd(static_cast<__m256d>(sign)));
  }
#endif
  unsigned out = 0;
  for (std::size_t k = 0; k < mask.size(); ++k) out |= unsigned(mask[k]) << k;
  return out;
}

// Any rows of a table, one per lane; the first `count` count.
template <class R> struct AnyRows {
  std::size_t row[lanes<R>];
  int count;
  std::size_t operator[](int k) const { return row[k]; }
};

// Rows that follow each other: as many as R is wide ...
template <class R> struct FullRange {
  static constexpr int count = lanes<R>;
  std::size_t first;
  std::size_t operator[](int k) const { return first + std::size_t(k); }
};

// ... or fewer at the end of a range: the last is repeated for reading, and left out when writing.
template <class R> struct PartOfRange {
  std::size_t first;
  int count;
  PartOfRange(std::size_t first_row, std::size_t last)
      : first(first_row), count(last - first_row < std::size_t(lanes<R>) ? int(last - first_row) : lanes<R>) {}
  std::size_t operator[](int k) const { return first + std::size_t(k < count ? k : count - 1); }
};

// The rows that a column of indices names there.
template <class R, class Rows> AnyRows<R> rows_named(const auto* column, const Rows& at) {
  AnyRows<R> out;
  out.count = at.count;
  for (int k = 0; k < lanes<R>; ++k) out.row[k] = column[at[k]];
  return out;
}

// Numbers by `value(lane)`; of these rows, by `value(row)`.
template <class R, class Value> R by_lane(const Value& value) {
  if constexpr (lanes<R> == 1) return value(0);
  else return R([&](auto k) { return value(int(k)); });
}
template <class R, class Rows, class Value> R gather(const Rows& at, const Value& value) {
  return by_lane<R>([&](int k) { return value(at[k]); });
}
template <class R, class Rows> R load(const double* column, const Rows& at) {
  if constexpr (lanes<R> > 1 && std::is_same_v<Rows, FullRange<R>>) return R(column + at[0], stdx::element_aligned);
  else return gather<R>(at, [&](std::size_t row) { return column[row]; });
}

template <class R, class Rows> void store(const R& v, double* column, const Rows& at) {
  if constexpr (lanes<R> == 1) column[at[0]] = v;
  else if constexpr (std::is_same_v<Rows, FullRange<R>>) v.copy_to(column + at[0], stdx::element_aligned);
  else
    for (int k = 0; k < at.count; ++k) column[at[k]] = v[k];
}

}  // namespace skred
