// engine/pack_flat.h - vectors of several rows in the order in which they lie in memory: x y z x y z ...
//
// What treats x, y and z alike needs no other order, and so no shuffles on the way from memory and back.
#pragma once
#include "engine/pack.h"

namespace skred {

// As many rows as R is wide; of a plain number, one: x, y, z.
template <class R> struct Flat { R part[3]; };

template <class R> Flat<R> load_flat(const Vec3* column, std::size_t row) {
  const double* from = &column[row].x;
  if constexpr (lanes<R> == 1) return {from[0], from[1], from[2]};
  else return {R(from, stdx::element_aligned), R(from + lanes<R>, stdx::element_aligned), R(from + 2 * lanes<R>, stdx::element_aligned)};
}
template <class R> void store_flat(const Flat<R>& v, Vec3* column, std::size_t row) {
  if constexpr (lanes<R> == 1) column[row] = {v.part[0], v.part[1], v.part[2]};
  else
    for (int k = 0; k < 3; ++k) v.part[k].copy_to(&column[row].x + k * lanes<R>, stdx::element_aligned);
}

// The same vector for every row.
template <class R> Flat<R> repeated(const Vec3& v) {
  const double of[3] = {v.x, v.y, v.z};
  const auto part = [&](int k) { return by_lane<R>([&](int lane) { return of[(k * lanes<R> + lane) % 3]; }); };
  return {part(0), part(1), part(2)};
}

// A number of each row, for its x, y and z.
template <class R> Flat<R> spread(const R& of_row) {
  if constexpr (lanes<R> == 1) return {of_row, of_row, of_row};
  else if constexpr (lanes<R> == 2) {
    const Two r(of_row);
    return {R(__builtin_shufflevector(r, r, 0, 0)), of_row, R(__builtin_shufflevector(r, r, 1, 1))};
  } else if constexpr (lanes<R> == 4) {
    const Four r(of_row);
    return {R(__builtin_shufflevector(r, r, 0, 0, 0, 1)), R(__builtin_shufflevector(r, r, 1, 1, 2, 2)), R(__builtin_shufflevector(r, r, 2, 3, 3, 3))};
  } else {
    const Eight r(of_row);
    return {R(__builtin_shufflevector(r, r, 0, 0, 0, 1, 1, 1, 2, 2)), R(__builtin_shufflevector(r, r, 2, 3, 3, 3, 4, 4, 4, 5)),
            R(__builtin_shufflevector(r, r, 5, 5, 6, 6, 6, 7, 7, 7))};
  }
}

template <class R> Vec3T<R> by_component(const Flat<R>& v) {
  if constexpr (lanes<R> == 1) return {v.part[0], v.part[1], v.part[2]};
  else if constexpr (lanes<R> == 2) {
    const Two a(v.part[0]), b(v.part[1]), c(v.part[2]);
    return {R(__builtin_shufflevector(a, b, 0, 3)), R(__builtin_shufflevector(a, c, 1, 2)), R(__builtin_shufflevector(b, c, 0, 3))};
  } else if constexpr (lanes<R> == 4) {
    const Four a(v.part[0]), b(v.part[1]), c(v.part[2]);     // x y z x, y z x y, z x y z
    return {R(__builtin_shufflevector(__builtin_shufflevector(a, b, 0, 3, 6, 6), c, 0, 1, 2, 5)),
            R(__builtin_shufflevector(__builtin_shufflevector(a, b, 1, 4, 7, 7), c, 0, 1, 2, 6)),
            R(__builtin_shufflevector(__builtin_shufflevector(a, b, 2, 5, 5, 5), c, 0, 1, 4, 7))};
  } else {
    const Eight a(v.part[0]), b(v.part[1]), c(v.part[2]);    // x y z x y z x y, z x y z x y z x, y z x y z x y z
    return {R(__builtin_shufflevector(__builtin_shufflevector(a, b, 0, 3, 6, 9, 12, 15, 0, 0), c, 0, 1, 2, 3, 4, 5, 10, 13)),
            R(__builtin_shufflevector(__builtin_shufflevector(a, b, 1, 4, 7, 10, 13, 0, 0, 0), c, 0, 1, 2, 3, 4, 8, 11, 14)),
            R(__builtin_shufflevector(__builtin_shufflevector(a, b, 2, 5, 8, 11, 14, 0, 0, 0), c, 0, 1, 2, 3, 4, 9, 12, 15))};
  }
}

// Number by number.
template <class R> Flat<R> operator+(const Flat<R>& a, const Flat<R>& b) { return {a.part[0] + b.part[0], a.part[1] + b.part[1], a.part[2] + b.part[2]}; }
template <class R> Flat<R> operator-(const Flat<R>& a, const Flat<R>& b) { return {a.part[0] - b.part[0], a.part[1] - b.part[1], a.part[2] - b.part[2]}; }
template <class R> Flat<R> operator*(const Flat<R>& a, const Flat<R>& b) { return {a.part[0] * b.part[0], a.part[1] * b.part[1], a.part[2] * b.part[2]}; }
template <class R> Flat<R> operator*(double a, const Flat<R>& b) { return {R(a) * b.part[0], R(a) * b.part[1], R(a) * b.part[2]}; }

}  // namespace skred
