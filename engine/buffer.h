// engine/buffer.h - the memory of a column: a vector whose first element lies on a cache line, so that packs of rows do not
// straddle two of them, and with room for one number behind its last element, which a pack may read; a long one lies on huge pages where the system has them, since kernels jump about in it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <vector>
#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace skred {

template <class V> struct Aligned {
  using value_type = V;
  Aligned() = default;
  template <class U> Aligned(const Aligned<U>&) {}
  template <class U> friend bool operator==(const Aligned&, const Aligned<U>&) { return true; }

  static constexpr std::size_t line = 64, huge = std::size_t{2} << 20;   // [bytes]

  static constexpr std::size_t max_size() { return (PTRDIFF_MAX - 2 * huge) / sizeof(V); }   // what allocate() adds fits too

  V* allocate(std::size_t n) {
    const std::size_t bytes = n * sizeof(V) + sizeof(double), alignment = bytes < 2 * huge ? line : huge;
    void* p = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
    if (!p) throw std::bad_alloc();
#if defined(__linux__)
    if (alignment == huge) madvise(p, bytes, MADV_HUGEPAGE);             // advice: nothing is lost if it is not taken
#endif
    return static_cast<V*>(p);
  }
  void deallocate(V* p, std::size_t) { std::free(p); }
};

template <class V> using Buffer = std::vector<V, Aligned<V>>;

}  // namespace skred
