// engine/access.h - what a kernel may say in its parameter list. It is handed these and nothing else, so its parameter
// types are the complete declaration of what it reads and writes; the runtime (tasks/task.h) derives the graph from them.
//
//   Rows<T>            the rows [first, last) of table T that this call owns; the runtime calls the kernel once per chunk.
//                      Must come first. A kernel without it is called once.
//   Read<&T::column>   any row, unchanged
//   Write<&T::column>  own rows, all overwritten (a debug build fills them with NaN first)
//   Update<&T::column> own rows, read and changed
//   Raise<&T::column>  a flag that any call may raise, of a table of one row: which comes first makes no difference
//   Resize<T>          may add, drop or reorder rows of T
//   If<condition, W>   the word W where an effect is in, nothing where it is out
//   Parallel           a parallel loop, for kernels without Rows
#pragma once
#include <atomic>
#include <cstddef>
#include <span>
#include <type_traits>
#include "engine/parallel.h"
#include "engine/world.h"

namespace skred {

template <class> struct column_of;
template <class T, class V> struct column_of<Column<V> T::*> { using table = T; using value = V; };
template <auto F> using table_t = typename column_of<decltype(F)>::table;
template <auto F> using value_t = typename column_of<decltype(F)>::value;

template <auto F> struct Read   : std::span<const value_t<F>> {};
template <auto F> struct Write  : std::span<value_t<F>> {};
template <auto F> struct Update : std::span<value_t<F>> {};
template <auto F> struct Raise  : std::span<value_t<F>> {
  void operator()(bool raised) const { if (raised) std::atomic_ref((*this)[0]).store(1, std::memory_order_relaxed); }
};
template <class T> struct Resize { T* table; T* operator->() const { return table; } };
template <class T> struct Rows { std::size_t first = 0, last = 0; };
struct Nothing {};
template <bool condition, class W> using If = std::conditional_t<condition, W, Nothing>;

// The plain array behind a word; null where the effect is out.
template <class V> V* pointer(std::span<V> column) { return column.data(); }
inline std::nullptr_t pointer(Nothing) { return nullptr; }

// One use of one resource: a column, or the row count of a table (a table and its first column share an address).
struct Access {
  const void* address;
  bool row_count;
  bool writes;
  const char* name;
  friend bool conflicts(const Access& a, const Access& b) {
    return a.address == b.address && a.row_count == b.row_count && (a.writes || b.writes);
  }
};

template <class W> using Word = std::type_identity<W>;
template <auto F> auto& column(World& w) { return std::get<table_t<F>>(w).*F; }

// touch() says what a word uses; make() produces the argument. Every use of a column also reads its table's row count.
using Uses = std::vector<Access>;
inline void touch(World&, Uses&, Word<Nothing>) {}
inline void touch(World&, Uses&, Word<Parallel>) {}
template <class T> void touch(World& w, Uses& u, Word<Rows<T>>) { u.push_back({&std::get<T>(w), true, false, "rows"}); }
template <class T> void touch(World& w, Uses& u, Word<Resize<T>>) {
  T& table = std::get<T>(w);
  u.push_back({&table, true, true, "rows"});
  std::apply([&](auto... c) { (u.push_back({&(table.*c), false, true, (table.*c).name}), ...); }, T::columns());
}
template <template <auto> class W, auto F> void touch(World& w, Uses& u, Word<W<F>>) {
  touch(w, u, Word<Rows<table_t<F>>>{});
  u.push_back({&column<F>(w), false, !std::is_same_v<W<F>, Read<F>>, column<F>(w).name});
}

template <class R> Nothing make(World&, const R&, const Parallel&, Word<Nothing>) { return {}; }
template <class R> Parallel make(World&, const R&, const Parallel& p, Word<Parallel>) { return p; }
template <class T> Rows<T> make(World&, const Rows<T>& r, const Parallel&, Word<Rows<T>>) { return r; }
template <class T, class R> Resize<T> make(World& w, const R&, const Parallel&, Word<Resize<T>>) { return {&std::get<T>(w)}; }
template <template <auto> class W, auto F, class R> W<F> make(World& w, const R&, const Parallel&, Word<W<F>>) {
  return {{column<F>(w).data}};
}

// A kernel over rows of T may write only columns of T: no two chunks can collide.
template <class T, class W> struct writes_own_rows : std::true_type {};
template <class T, auto F> struct writes_own_rows<T, Write<F>>  : std::is_same<T, table_t<F>> {};
template <class T, auto F> struct writes_own_rows<T, Update<F>> : std::is_same<T, table_t<F>> {};
template <class T, class U> struct writes_own_rows<T, Resize<U>> : std::false_type {};

}  // namespace skred
