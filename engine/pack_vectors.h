// engine/pack_vectors.h - rows of a column of vectors (x y z x y z ...) as one pack for each of x, y, z, and back.
#pragma once
#include <cstring>
#include "engine/pack_flat.h"

namespace skred {

// Vectors of these rows: x, y, z of each. Reads one number beyond each, for which a Buffer keeps room.
template <class R, class V, class Rows> requires requires(V v) { v.x; }
Vec3T<R> load(const V* column, const Rows& at) {
  if constexpr (lanes<R> == 1) {
    const V& v = column[at[0]];
    return {v.x, v.y, v.z};
  } else if constexpr (std::is_same_v<V, Vec3> && std::is_same_v<Rows, FullRange<R>>) {
    return by_component(load_flat<R>(column, at[0]));
  } else if constexpr (lanes<R> == 2) {
    const V &a = column[at[0]], &b = column[at[1]];
    return {R(Two{a.x, b.x}), R(Two{a.y, b.y}), R(Two{a.z, b.z})};
  } else {
#if defined(__AVX__)
    const auto four = [&](int k) { return _mm256_loadu_pd(&column[at[k]].x); };
    if constexpr (lanes<R> == 4) {
      const Four a = four(0), b = four(1), c = four(2), d = four(3);
      const Four ab = __builtin_shufflevector(a, b, 0, 4, 2, 6), cd = __builtin_shufflevector(c, d, 0, 4, 2, 6);   // x x z z
      const Four yab = __builtin_shufflevector(a, b, 1, 5, 3, 7), ycd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
      return {R(__builtin_shufflevector(ab, cd, 0, 1, 4, 5)), R(__builtin_shufflevector(yab, ycd, 0, 1, 4, 5)),
              R(__builtin_shufflevector(ab, cd, 2, 3, 6, 7))};
    }
#if defined(__AVX512F__)
    if constexpr (lanes<R> == 8) {
      const auto eight = [&](int k, int l) -> Eight { return _mm512_insertf64x4(_mm512_castpd256_pd512(four(k)), four(l), 1); };
      const Eight a = eight(0, 2), b = eight(1, 3), c = eight(4, 6), d = eight(5, 7);
      const Eight ab = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14), cd = __builtin_shufflevector(c, d, 0, 8, 2, 10, 4, 12, 6, 14);
      const Eight yab = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15), ycd = __builtin_shufflevector(c, d, 1, 9, 3, 11, 5, 13, 7, 15);
      return {R(__builtin_shufflevector(ab, cd, 0, 1, 4, 5, 8, 9, 12, 13)), R(__builtin_shufflevector(yab, ycd, 0, 1, 4, 5, 8, 9, 12, 13)),
              R(__builtin_shufflevector(ab, cd, 2, 3, 6, 7, 10, 11, 14, 15))};
    }
#endif
#endif
  }
}

// Writes vectors to rows that follow each other.
template <class R, class Rows> void store(const Vec3T<R>& v, Vec3* column, const Rows& at) {
  if constexpr (lanes<R> == 1) {
    column[at[0]] = v;
  } else {
    if (at.count < lanes<R>) {
      for (int k = 0; k < at.count; ++k) column[at[k]] = {v.x[k], v.y[k], v.z[k]};
      return;
    }
    double* out = reinterpret_cast<double*>(column + at[0]);
    const auto put = [&](auto part) { std::memcpy(out, &part, sizeof part), out += lanes<R>; };
    if constexpr (lanes<R> == 2) {
      const Two x(v.x), y(v.y), z(v.z);
      put(__builtin_shufflevector(x, y, 0, 2));
      put(__builtin_shufflevector(z, x, 0, 3));
      put(__builtin_shufflevector(y, z, 1, 3));
    } else if constexpr (lanes<R> == 4) {
      const Four x(v.x), y(v.y), z(v.z);
      const Four xy = __builtin_shufflevector(x, y, 0, 4, 2, 6), yz = __builtin_shufflevector(y, z, 1, 5, 3, 7), zx = __builtin_shufflevector(z, x, 0, 5, 2, 7);
      put(__builtin_shufflevector(xy, zx, 0, 1, 4, 5));      // x0 y0 z0 x1
      put(__builtin_shufflevector(yz, xy, 0, 1, 6, 7));      // y1 z1 x2 y2
      put(__builtin_shufflevector(zx, yz, 2, 3, 6, 7));      // z2 x3 y3 z3
    } else {
      const Eight x(v.x), y(v.y), z(v.z);
      put(__builtin_shufflevector(__builtin_shufflevector(x, y, 0, 8, 0, 1, 9, 1, 2, 10), z, 0, 1, 8, 3, 4, 9, 6, 7));
      put(__builtin_shufflevector(__builtin_shufflevector(y, z, 10, 3, 3, 11, 4, 4, 12, 5), x, 0, 11, 2, 3, 12, 5, 6, 13));
      put(__builtin_shufflevector(__builtin_shufflevector(z, x, 5, 5, 14, 6, 6, 15, 7, 7), y, 13, 1, 2, 14, 4, 5, 15, 7));
    }
  }
}

}  // namespace skred
