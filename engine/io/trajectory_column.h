// engine/io/trajectory_column.h - a column of reals in a trajectory, in the precision that the run asked for.
#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <vector>
#include "engine/io/hdf5.h"
#include "engine/vec3.h"

namespace skred {

// The group in which frame k's views are: "/frames/000012/".
inline std::string frame_group(std::size_t k) {
  const std::string digits = std::to_string(k);
  return "/frames/" + std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits + "/";
}

inline Hdf5Number real_type(bool single_precision) { return single_precision ? Hdf5Number::real32 : Hdf5Number::real64; }

// Rows per chunk: whole frames where they are small, parts of at most 4 MiB where they are large.
inline std::size_t chunk_rows(std::size_t rows_per_frame, std::size_t row_bytes) {
  constexpr std::size_t least = 4096, most = 4 << 20;
  const std::size_t frame_bytes = std::max<std::size_t>(1, rows_per_frame * row_bytes);
  if (frame_bytes > most) return (rows_per_frame - 1) / ((frame_bytes + most - 1) / most) + 1;
  return std::max<std::size_t>(1, rows_per_frame) * std::max<std::size_t>(1, least / frame_bytes);
}

// Appends vectors or plain numbers, converted to float if the dataset is made of them.
class RealColumn {
 public:
  RealColumn() = default;
  RealColumn(Hdf5File& file, const std::string& name, const std::string& unit, std::size_t columns, std::size_t rows_per_frame,
             bool single_precision)
      : single_(single_precision) {
    const auto type = real_type(single_);
    Hdf5Layout layout{.chunk_rows = chunk_rows(rows_per_frame, columns * size_of(type)), .unit = unit};
    if (columns > 1) layout.inner = {columns};
    data_ = file.dataset(name, type, layout);
  }
  template <class V> void append(std::span<const V> values) {
    if (single_) write<float>(values);
    else write<double>(values);
  }
  template <class V> void append(const std::vector<V>& values) { append(std::span<const V>(values)); }
  const Hdf5Dataset& dataset() const { return data_; }

 private:
  template <class R, class V> void write(std::span<const V> values) {
    std::vector<R> flat;
    if constexpr (std::is_same_v<V, double>) {
      flat.assign(values.begin(), values.end());
    } else if constexpr (std::is_same_v<V, Vec3>) {
      flat.resize(3 * values.size());
      for (std::size_t k = 0; k < values.size(); ++k) {
        flat[3 * k] = R(values[k].x);
        flat[3 * k + 1] = R(values[k].y);
        flat[3 * k + 2] = R(values[k].z);
      }
    } else {
      static_assert(std::is_same_v<V, Quaternion>);
      flat.reserve(4 * values.size());
      for (const Quaternion& q : values) flat.insert(flat.end(), {R(q.w), R(q.x), R(q.y), R(q.z)});
    }
    data_.append(flat);
  }
  Hdf5Dataset data_;
  bool single_ = false;
};

}  // namespace skred
