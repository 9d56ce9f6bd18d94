// profiling/bench/roofline.h - how long a kernel would take if nothing but memory or nothing but arithmetic took time (Williams,
// Waterman, Patterson 2009), from counted bytes and operations.
#pragma once
#include "profiling/bench/results.h"

namespace skred {

// Of the kernel that moves most in a call [byte]: how far measure_limits() has to look.
double largest_working_set(const Summary&, std::size_t particles);

Roofline roofline(const Summary&, std::size_t particles, const Limits&);

}  // namespace skred
