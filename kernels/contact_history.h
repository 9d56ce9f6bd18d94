// kernels/contact_history.h - the columns of a contact that only some laws have.
#pragma once
#include "engine/access.h"

namespace skred {

// Entry c of a column, or `none` where the effect is out and there is no column.
template <class V> V& entry(Nothing, std::size_t, V& none) { return none; }
template <auto F> value_t<F>& entry(Update<F>& column, std::size_t c, value_t<F>&) { return column[c]; }

// Zeroes entry c of the columns that exist: a contact that does not touch has no force, and forgets.
inline void clear(std::size_t, Nothing) {}
template <class C> void clear(std::size_t c, C& column) { column[c] = {}; }
template <class... Columns> void clear_all(std::size_t c, Columns&... columns) { (clear(c, columns), ...); }

}  // namespace skred
