// profiling/bench/limits.h - what the machine can do at best: memory traffic and arithmetic, measured in a fraction of a second.
#pragma once

namespace skred {

struct Limits {
  double bandwidth = 0;      // [byte/s] triad a = b + s c, 24 bytes an element as STREAM counts them (McCalpin 1995)
  double flops = 0;          // [1/s] additions and multiplications, in the widest vectors of up to 256 bits
  double roots = 0;          // [1/s] divisions and square roots, half of each, in the same vectors
};

// `working_set` [byte]: of the triad's arrays together. What fits into the caches runs at their bandwidth, as a small scene does.
Limits measure_limits(int threads, double working_set);

}  // namespace skred
