// kernels/contact_fetch.h - asks the memory for groups and bodies before they are needed: a sweep reads more than the caches beside
// a core hold, and where bodies lie no processor can guess.
#pragma once
#include "engine/contact_rows.h"

namespace skred {

template <class T> [[gnu::always_inline]] inline void fetch(const T& x) {
  for (std::size_t line = 0; line < sizeof x; line += 64) __builtin_prefetch(reinterpret_cast<const char*>(&x) + line, 1);
}
[[gnu::always_inline]] inline void fetch_bodies(const ContactGroup& g, const SolverBody* bodies) {
  for (std::size_t l = 0; l < ContactGroup::size; ++l) fetch(bodies[g.a[l]]), fetch(bodies[g.b[l]]);
}

}  // namespace skred
