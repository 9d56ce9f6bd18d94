// engine/pack.h - several numbers side by side in one vector register, and the way between them and rows of a column.
//
// Arithmetic, roots and masks are std::experimental::simd's; this file adds what it lacks: reading and writing the rows of a
// column of Vec3 (x y z x y z ...) as one pack for each of x, y, z. A Lanes<R> names the rows that one batch works on: as
// many as R is wide, fewer at the end of a range, where the last is repeated for reading and left out when writing.
#pragma once
#include <cmath>
#include <cstddef>
#include <cstring>
#include <experimental/simd>
#include "engine/vec3.h"

namespace skred {

namespace stdx = std::experimental;

template <class R> inline constexpr int lanes = stdx::is_simd_v<R> ? int(sizeof(R) / sizeof(double)) : 1;

// A vector register as the compiler sees it, for shuffles.
template <int width> struct Register;
template <> struct Register<2> { typedef double type __attribute__((vector_size(16))); };
template <> struct Register<4> { typedef double type __attribute__((vector_size(32))); };
template <> struct Register<8> { typedef double type __attribute__((vector_size(64))); };

// The rows [first, first + count) of a table, or any rows listed in an array.
template <class R> struct Lanes {
  static constexpr int width = lanes<R>;
  std::size_t row[width];
  int count;

  static Lanes range(std::size_t first, std::size_t last) {
    Lanes l;
    l.count = last - first < std::size_t(width) ? int(last - first) : width;
    for (int k = 0; k < width; ++k) l.row[k] = first + std::size_t(k < l.count ? k : l.count - 1);
    return l;
  }
  template <class Index> static Lanes at(const Index* rows, const Lanes& of) {
    Lanes l;
    l.count = of.count;
    for (int k = 0; k < width; ++k) l.row[k] = rows[of.row[k]];
    return l;
  }
};

// Numbers of these rows, by `value(row)`.
template <class R, class Value> R gather(const Lanes<R>& at, const Value& value) {
  if constexpr (lanes<R> == 1) return value(at.row[0]);
  else return R([&](auto k) { return value(at.row[k]); });
}
template <class R> R load(const double* column, const Lanes<R>& at) {
  return gather<R>(at, [&](std::size_t row) { return column[row]; });
}

// Vectors of these rows.
template <class R> Vec3T<R> load(const Vec3* column, const Lanes<R>& at) {
  if constexpr (lanes<R> == 1) {
    return column[at.row[0]];
  } else {
    using Two = Register<2>::type;
    const auto two = [&](int k, int from) {                  // (x, y) or (y, z) of one row
      Two v;
      std::memcpy(&v, reinterpret_cast<const double*>(column + at.row[k]) + from, sizeof v);
      return v;
    };
    if constexpr (lanes<R> == 2) {
      const Two a = two(0, 0), b = two(1, 0), c = two(0, 1), d = two(1, 1);
      return {R(__builtin_shufflevector(a, b, 0, 2)), R(__builtin_shufflevector(a, b, 1, 3)), R(__builtin_shufflevector(c, d, 1, 3))};
    } else if constexpr (lanes<R> == 4) {
      const auto four = [&](int k, int from) { return __builtin_shufflevector(two(k, from), two(k + 2, from), 0, 1, 2, 3); };
      const auto a = four(0, 0), b = four(1, 0), c = four(0, 1), d = four(1, 1);
      return {R(__builtin_shufflevector(a, b, 0, 4, 2, 6)), R(__builtin_shufflevector(a, b, 1, 5, 3, 7)),
              R(__builtin_shufflevector(c, d, 1, 5, 3, 7))};
    } else {
      const auto four = [&](int k, int from) { return __builtin_shufflevector(two(k, from), two(k + 2, from), 0, 1, 2, 3); };
      const auto eight = [&](int k, int from) { return __builtin_shufflevector(four(k, from), four(k + 4, from), 0, 1, 2, 3, 4, 5, 6, 7); };
      const auto a = eight(0, 0), b = eight(1, 0), c = eight(0, 1), d = eight(1, 1);
      return {R(__builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14)), R(__builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15)),
              R(__builtin_shufflevector(c, d, 1, 9, 3, 11, 5, 13, 7, 15))};
    }
  }
}

// Writes vectors to the rows from `at.row[0]` on, which must follow each other.
template <class R> void store(const Vec3T<R>& v, Vec3* column, const Lanes<R>& at) {
  if constexpr (lanes<R> == 1) {
    column[at.row[0]] = v;
  } else {
    using All = typename Register<lanes<R>>::type;
    double* out = reinterpret_cast<double*>(column + at.row[0]);
    const All x = static_cast<All>(v.x), y = static_cast<All>(v.y), z = static_cast<All>(v.z);
    const auto put = [&](double* to, const All& part) { std::memcpy(to, &part, sizeof part); };
    if (at.count == lanes<R>) {
      if constexpr (lanes<R> == 2) {
        put(out, __builtin_shufflevector(x, y, 0, 2));
        put(out + 2, __builtin_shufflevector(z, x, 0, 3));
        put(out + 4, __builtin_shufflevector(y, z, 1, 3));
      } else if constexpr (lanes<R> == 4) {
        const All xy = __builtin_shufflevector(x, y, 0, 4, 1, 5), zx = __builtin_shufflevector(z, x, 0, 5, 2, 7), yz = __builtin_shufflevector(y, z, 2, 6, 3, 7);
        put(out, __builtin_shufflevector(xy, zx, 0, 1, 4, 5));
        put(out + 4, __builtin_shufflevector(__builtin_shufflevector(y, z, 1, 5, 1, 5), __builtin_shufflevector(x, y, 2, 6, 2, 6), 0, 1, 4, 5));
        put(out + 8, __builtin_shufflevector(zx, yz, 2, 3, 6, 7));
      } else {
        put(out, __builtin_shufflevector(__builtin_shufflevector(x, y, 0, 8, 0, 1, 9, 1, 2, 10), z, 0, 1, 8, 3, 4, 9, 6, 7));
        put(out + 8, __builtin_shufflevector(__builtin_shufflevector(y, z, 10, 3, 3, 11, 4, 4, 12, 5), x, 0, 11, 2, 3, 12, 5, 6, 13));
        put(out + 16, __builtin_shufflevector(__builtin_shufflevector(z, x, 5, 5, 14, 6, 6, 15, 7, 7), y, 13, 1, 2, 14, 4, 5, 15, 7));
      }
    } else {
      for (int k = 0; k < at.count; ++k) out[3 * k] = x[k], out[3 * k + 1] = y[k], out[3 * k + 2] = z[k];
    }
  }
}
template <class R> void store(const R& v, double* column, const Lanes<R>& at) {
  if constexpr (lanes<R> == 1) column[at.row[0]] = v;
  else
    for (int k = 0; k < at.count; ++k) column[at.row[0] + k] = v[k];
}

}  // namespace skred
