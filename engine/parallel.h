// engine/parallel.h - the parallel loop that kernels use. Chunks are fixed ranges of rows: no result depends on who runs them.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>
#include "engine/loop_label.h"

namespace skred {

// Told of every chunk when it is done, and of the serial stretches between parallel loops; the runtime's way to time kernels.
struct ChunkObserver {
  virtual std::uint64_t now() const = 0;
  virtual void chunk(int lane, std::uint64_t begin, std::size_t rows, LoopLabel label) = 0;
  virtual void end_serial() = 0;                         // a parallel loop begins ...
  virtual void begin_serial() = 0;                       // ... and has ended: both on the kernel's thread
 protected:
  ~ChunkObserver() = default;
};

// Handed to a kernel that names it in its parameter list.
class Parallel {
 public:
  Parallel() = default;                                  // serial
  Parallel(bool threaded, ChunkObserver* observer) : threaded_(threaded), observer_(observer) {}

  Parallel labelled(LoopLabel label) const {
    Parallel p = *this;
    p.label_ = label;
    return p;
  }

  // Calls body(first, last) for ranges of `grain` rows, the last one shorter, that cover [0, count). A loop of one range runs
  // inline. Ranges begin at multiples of the grain: at the beginning of a cache line, in columns.
  template <class Body> void operator()(std::size_t count, std::size_t grain, const Body& body) const {
    const bool alone = count <= grain;
    if (!threaded_ || (alone && label_.sweep == 0)) return body(std::size_t{0}, count);
    if (observer_) observer_->end_serial();
    if (alone) run(0, count, body);
    else
      // Isolated: a thread that waits here must not start another kernel inside this one (its spans would nest).
      tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, (count + grain - 1) / grain),
                          [&](const auto& r) { run(r.begin() * grain, std::min(r.end() * grain, count), body); },
                          tbb::simple_partitioner{});
      });
    if (observer_) observer_->begin_serial();
  }

  // Calls body(chunk, first, last) for the fixed chunks [k * size, (k+1) * size): for results gathered per chunk.
  template <class Body> void chunks(std::size_t count, std::size_t size, const Body& body) const {
    const std::size_t n = (count + size - 1) / size;
    (*this)(n, 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t k = first; k < last; ++k) body(k, k * size, std::min(count, (k + 1) * size));
    });
  }

 private:
  template <class Body> void run(std::size_t first, std::size_t last, const Body& body) const {
    if (!observer_) return body(first, last);
    const auto begin = observer_->now();
    body(first, last);
    observer_->chunk(tbb::this_task_arena::current_thread_index(), begin, last - first, label_);
  }
  bool threaded_ = false;
  ChunkObserver* observer_ = nullptr;
  LoopLabel label_;
};

}  // namespace skred
