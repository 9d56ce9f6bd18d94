// profiling/bench/roofline.h - how long a kernel would take if nothing but memory or nothing but arithmetic took time (Williams,
// Waterman, Patterson 2009), from counted bytes and operations.
#pragma once
#include "profiling/bench/limits.h"
#include "profiling/bench/results.h"

namespace skred {

// Bytes that a step moves at least, of all kernels: the working set for measure_limits().
double bytes_of_step(const Summary&, std::size_t particles);

Roofline roofline(const Summary&, std::size_t particles, double working_set, const Limits&);

}  // namespace skred
