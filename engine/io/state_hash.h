// engine/io/state_hash.h - one number for a whole state: two runs that differ in a single bit have different hashes.
//
// 64-bit FNV-1a (Fowler, Noll, Vo) over the bytes in memory, so -0 and 0 differ, and big-endian machines get other values.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace skred {

class StateHash {
 public:
  void add(std::span<const std::byte> bytes) {
    for (const std::byte b : bytes) value_ = (value_ ^ std::uint64_t(b)) * 0x100000001b3ull;
  }
  // A value whose bytes are all data: a number, Vec3, Quaternion, Pose. Structs with padding have no defined hash.
  template <class T> requires std::is_trivially_copyable_v<T> && (!std::is_pointer_v<T>) && (!requires(T t) { t.size(); })
  void add(const T& value) { add(std::as_bytes(std::span<const T, 1>(&value, 1))); }
  // A column, with its length: where one column ends and the next begins matters.
  template <class T> requires std::is_trivially_copyable_v<T>
  void add(const std::vector<T>& column) {
    add(std::uint64_t(column.size()));
    add(std::as_bytes(std::span<const T>(column)));
  }
  std::uint64_t value() const { return value_; }
  std::string hex() const {              // 16 digits
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value_));
    return text;
  }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ull;
};

}  // namespace skred
