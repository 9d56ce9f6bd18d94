// tasks/kernel_observer.h - tells the timeline of a kernel's calls: their chunks, and the serial stretches between parallel loops.
#pragma once
#include "engine/parallel.h"
#include "profiling/timeline.h"

namespace skred {

class KernelObserver final : public ChunkObserver {
 public:
  KernelObserver(Timeline& t, KernelId k) : timeline_(&t), id_(k) {}

  KernelId id() const { return id_; }

  // Calls `kernel(parallel)`, which returns the rows it ran over, on a thread of the arena.
  template <class Kernel> void call(bool threaded, const Kernel& kernel) {
    begin_serial();
    const Ticks begin = serial_since_;
    const std::size_t rows = kernel(Parallel(threaded, this));
    end_serial();
    timeline_->call(tbb::this_task_arena::current_thread_index(), id_, begin, Timeline::now(), rows);
  }

  std::uint64_t now() const override { return Timeline::now(); }
  void chunk(int lane, std::uint64_t begin, std::size_t rows, LoopLabel label) override {
    timeline_->chunk(lane, id_, begin, Timeline::now(), rows, label);
  }
  void begin_serial() override { serial_since_ = Timeline::now(); }
  void end_serial() override { chunk(tbb::this_task_arena::current_thread_index(), serial_since_, 0, {}); }

 private:
  Timeline* timeline_;
  KernelId id_;
  Ticks serial_since_ = 0;
};

}  // namespace skred
