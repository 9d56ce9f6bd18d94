// profiling/bench/limits.h - what the machine can do at best: memory traffic and arithmetic, measured in a few seconds.
#pragma once
#include <vector>

namespace skred {

// Of a triad a = b + s c on arrays of so many bytes together; 24 bytes an element, as STREAM counts them (McCalpin 1995).
struct Bandwidth { double bytes = 0, rate = 0; };          // [byte], [byte/s]

struct Limits {
  std::vector<Bandwidth> bandwidth;                        // ascending in bytes: what fits into a cache runs at its speed
  double flops = 0;          // [1/s] additions and multiplications, in the widest vectors of up to 256 bits
  double roots = 0;          // [1/s] divisions and square roots, half of each, in the same vectors

  // Of the largest arrays that are not larger than `bytes`: no loop over so many bytes is faster.
  double bandwidth_for(double bytes) const;
};

// Arrays of up to `largest` bytes, and of a quarter, a sixteenth, ... of that.
Limits measure_limits(int threads, double largest);

}  // namespace skred
