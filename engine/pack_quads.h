// engine/pack_quads.h - quads read and written as packs, from any places in memory: a load and a store per lane, and shuffles.
#pragma once
#include "engine/pack.h"
#include "engine/quad.h"

namespace skred {

template <class R> struct QuadT {
  Vec3T<R> v;
  R s{};
};

// The rows at `where(k)`, one per lane.
template <class R, class Where> QuadT<R> load_quads(const Where& where) {
  if constexpr (lanes<R> == 1) {
    const Quad& q = *where(0);
    return {q.v, q.s};
  } else if constexpr (lanes<R> == 2) {
    const Quad &a = *where(0), &b = *where(1);
    return {{R(Two{a.v.x, b.v.x}), R(Two{a.v.y, b.v.y}), R(Two{a.v.z, b.v.z})}, R(Two{a.s, b.s})};
  } else {
#if defined(__AVX__)
    const auto four = [&](int k) -> Four { return _mm256_load_pd(&where(k)->v.x); };
    if constexpr (lanes<R> == 4) {
      const Four a = four(0), b = four(1), c = four(2), d = four(3);
      const Four xz = __builtin_shufflevector(a, b, 0, 4, 2, 6), xz2 = __builtin_shufflevector(c, d, 0, 4, 2, 6);
      const Four ys = __builtin_shufflevector(a, b, 1, 5, 3, 7), ys2 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
      return {{R(__builtin_shufflevector(xz, xz2, 0, 1, 4, 5)), R(__builtin_shufflevector(ys, ys2, 0, 1, 4, 5)),
               R(__builtin_shufflevector(xz, xz2, 2, 3, 6, 7))}, R(__builtin_shufflevector(ys, ys2, 2, 3, 6, 7))};
    }
#if defined(__AVX512F__)
    if constexpr (lanes<R> == 8) {
      const auto two = [&](int k, int l) -> Eight { return _mm512_insertf64x4(_mm512_castpd256_pd512(four(k)), four(l), 1); };
      const Eight a = two(0, 4), b = two(1, 5), c = two(2, 6), d = two(3, 7);          // each: row k, then row k + 4
      const Eight xz = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14), xz2 = __builtin_shufflevector(c, d, 0, 8, 2, 10, 4, 12, 6, 14);
      const Eight ys = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15), ys2 = __builtin_shufflevector(c, d, 1, 9, 3, 11, 5, 13, 7, 15);
      return {{R(__builtin_shufflevector(xz, xz2, 0, 1, 8, 9, 4, 5, 12, 13)), R(__builtin_shufflevector(ys, ys2, 0, 1, 8, 9, 4, 5, 12, 13)),
               R(__builtin_shufflevector(xz, xz2, 2, 3, 10, 11, 6, 7, 14, 15))}, R(__builtin_shufflevector(ys, ys2, 2, 3, 10, 11, 6, 7, 14, 15))};
    }
#endif
#endif
  }
}

// x y z s of each of four lanes.
[[gnu::always_inline]] inline void as_rows(const Four& x, const Four& y, const Four& z, const Four& s, Four* out) {
  const Four xy = __builtin_shufflevector(x, y, 0, 4, 2, 6), xy2 = __builtin_shufflevector(x, y, 1, 5, 3, 7);
  const Four zs = __builtin_shufflevector(z, s, 0, 4, 2, 6), zs2 = __builtin_shufflevector(z, s, 1, 5, 3, 7);
  out[0] = __builtin_shufflevector(xy, zs, 0, 1, 4, 5);
  out[1] = __builtin_shufflevector(xy2, zs2, 0, 1, 4, 5);
  out[2] = __builtin_shufflevector(xy, zs, 2, 3, 6, 7);
  out[3] = __builtin_shufflevector(xy2, zs2, 2, 3, 6, 7);
}
// x y z 0 of each lane.
template <class R> void as_rows(const Vec3T<R>& v, Four* out) {
  if constexpr (lanes<R> == 1) {
    *out = Four{v.x, v.y, v.z, 0};
  } else if constexpr (lanes<R> == 2) {
    for (int k = 0; k < 2; ++k) out[k] = Four{v.x[k], v.y[k], v.z[k], 0};
  } else if constexpr (lanes<R> == 4) {
    as_rows(Four(v.x), Four(v.y), Four(v.z), Four{}, out);
  } else {
    const Eight x(v.x), y(v.y), z(v.z);
    const auto low = [](const Eight& a) { return __builtin_shufflevector(a, a, 0, 1, 2, 3); };
    const auto high = [](const Eight& a) { return __builtin_shufflevector(a, a, 4, 5, 6, 7); };
    as_rows(low(x), low(y), low(z), Four{}, out);
    as_rows(high(x), high(y), high(z), Four{}, out + 4);
  }
}

// Writes them to `where(k)`, the last lane first: where two lanes name the same place, the first of them is kept.
template <class R, class Where> void store_quads(const QuadT<R>& q, const Where& where) {
  if constexpr (lanes<R> == 1) {
    *where(0) = {q.v, q.s};
  } else if constexpr (lanes<R> == 2) {
    for (int k = 1; k >= 0; --k) *where(k) = {{q.v.x[k], q.v.y[k], q.v.z[k]}, q.s[k]};
  } else {
#if defined(__AVX__)
    const auto put = [&](int k, Four row) { _mm256_store_pd(&where(k)->v.x, row); };
    if constexpr (lanes<R> == 4) {
      Four row[4];
      as_rows(Four(q.v.x), Four(q.v.y), Four(q.v.z), Four(q.s), row);
      for (int k = 3; k >= 0; --k) put(k, row[k]);
    }
#if defined(__AVX512F__)
    if constexpr (lanes<R> == 8) {
      const Eight x(q.v.x), y(q.v.y), z(q.v.z), s(q.s);
      const Eight xy = __builtin_shufflevector(x, y, 0, 8, 2, 10, 4, 12, 6, 14), xy2 = __builtin_shufflevector(x, y, 1, 9, 3, 11, 5, 13, 7, 15);
      const Eight zs = __builtin_shufflevector(z, s, 0, 8, 2, 10, 4, 12, 6, 14), zs2 = __builtin_shufflevector(z, s, 1, 9, 3, 11, 5, 13, 7, 15);
      const auto put_two = [&](int k, Eight rows) {          // row k + 4, then row k
        put(k + 4, _mm512_extractf64x4_pd(rows, 1));
        put(k, _mm512_castpd512_pd256(rows));
      };
      put_two(3, __builtin_shufflevector(xy2, zs2, 2, 3, 10, 11, 6, 7, 14, 15));
      put_two(2, __builtin_shufflevector(xy, zs, 2, 3, 10, 11, 6, 7, 14, 15));
      put_two(1, __builtin_shufflevector(xy2, zs2, 0, 1, 8, 9, 4, 5, 12, 13));
      put_two(0, __builtin_shufflevector(xy, zs, 0, 1, 8, 9, 4, 5, 12, 13));
    }
#endif
#endif
  }
}

}  // namespace skred
