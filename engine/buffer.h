// engine/buffer.h - the memory of a column: a vector whose first element lies on a cache line, so that packs of rows do not
// straddle two of them, and with room for one number behind its last element, which a pack may read.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <vector>

namespace skred {

template <class V> struct Aligned {
  using value_type = V;
  Aligned() = default;
  template <class U> Aligned(const Aligned<U>&) {}
  template <class U> friend bool operator==(const Aligned&, const Aligned<U>&) { return true; }

  static constexpr std::size_t line = 64;                    // [bytes]

  static constexpr std::size_t max_size() { return (PTRDIFF_MAX - 2 * line) / sizeof(V); }   // what allocate() adds fits too

  V* allocate(std::size_t n) {
    const std::size_t bytes = n * sizeof(V) + sizeof(double);
    void* p = std::aligned_alloc(line, (bytes + line - 1) / line * line);
    if (!p) throw std::bad_alloc();
    return static_cast<V*>(p);
  }
  void deallocate(V* p, std::size_t) { std::free(p); }
};

template <class V> using Buffer = std::vector<V, Aligned<V>>;

// Gives it n elements, whatever they are. Where it must grow, by a little more: a vector would double its memory.
template <class V> void resize_for_overwrite(Buffer<V>& b, std::size_t n) {
  if (n > b.capacity()) {
    b.clear();
    b.shrink_to_fit();
    b.reserve(n + n / 16);
  }
  b.resize(n);
}

}  // namespace skred
