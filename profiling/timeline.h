// profiling/timeline.h - who ran what, when: one lane per thread, so that recording takes no lock.
//
// The always-on part adds the time of every chunk to a per-thread, per-kernel sum and the duration of every kernel call to
// a histogram. Events (one per chunk and per kernel call) are kept only while a window of steps is being traced.
// Nothing here knows of kernels or scenes; names are the ones given to `kernel()`.
#pragma once
#include <array>
#include <atomic>
#include <bit>
#include <cassert>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>
#include "engine/loop_label.h"
#if defined(__x86_64__)
#include <x86intrin.h>
#endif

namespace skred {

using Ticks = std::uint64_t;
using KernelId = std::uint16_t;

class Timeline {
 public:
  static constexpr std::size_t max_kernels = 128;
  static constexpr std::size_t max_events = std::size_t{1} << 22;   // kept in all lanes together: 160 MiB, a trace of ~0.6 GB

  // Lanes 0 .. threads-1 are the arena's slots; lane `threads` is the frame writer's. Throws std::invalid_argument if
  // threads < 1.
  explicit Timeline(int threads);
  Timeline(const Timeline&) = delete;
  Timeline& operator=(const Timeline&) = delete;

  static Ticks now();                               // time stamp counter where it is invariant, else steady_clock
  static double seconds(Ticks ticks);               // ticks * seconds_per_tick()
  // Calibrated against steady_clock from the start of the program to this call, so it changes in its last digits: convert
  // times that are to be compared with one value. Waits if the program is younger than a few ms.
  static double seconds_per_tick();

  // Same name, same id. Call it before the first step; throws std::length_error beyond max_kernels.
  KernelId kernel(const std::string& name);

  int threads() const { return threads_; }

  // Which steps [first, last) to keep events of; `ring` > 0 keeps the events of only the last `ring` steps of the window.
  // Throws std::invalid_argument if last <= first or ring < 0. Forgets what was kept before.
  void trace(std::int64_t first, std::int64_t last, std::int64_t ring = 0);

  // Called by the thread that runs the step loop. Kernels run between the two, or their time is missing in `wall`.
  void begin_step(std::int64_t step);
  void end_step();

  // A part of a kernel's rows done by the calling thread on `lane`: busy time. Chunks of a lane do not overlap.
  void chunk(int lane, KernelId k, Ticks begin, Ticks end, std::size_t rows, LoopLabel label = {});
  // A whole call of a kernel, from its start to the end of its last chunk, waiting included. Its work is recorded as chunks, at
  // least one. A kernel is not called while it runs.
  void call(int lane, KernelId k, Ticks begin, Ticks end, std::size_t rows);
  // Of two different kernels that took turns in one loop. Each has its part of the time [0, 1]; the trace shows one call, of the first.
  void chained_calls(int lane, KernelId first, KernelId then, Ticks begin, Ticks end, std::size_t rows, double part_of_first);
  // A value at the present step for the trace's counter tracks ("contacts", "kinetic energy [J]").
  void counter(const std::string& name, double value);
  bool tracing() const { return tracing_.load(std::memory_order_relaxed); }

  struct Event { Ticks begin, end; std::uint32_t rows; KernelId kernel; bool whole_call; std::int64_t step; LoopLabel label = {}; };
  struct StepSpan { std::int64_t step; Ticks begin, end; };
  struct CounterEvent { std::string name; Ticks at; double value; };

  // One line of the table at the end of a run. Times in seconds.
  struct Line {
    std::string name;
    bool writer = false;                            // ran on the writer's lane, beside the steps: no share, no idle
    std::uint64_t count = 0, rows = 0;              // calls, rows done
    double total = 0, busy = 0;                     // wall time of the calls; busy time of all threads in them
    double mean = 0, median = 0, p95 = 0, max = 0;  // of a call; median and p95 to 1 %
    double share = 0;                               // busy time of this kernel / busy time of all kernels in the steps
    double efficiency = 0;                          // busy / (threads * total), at most 1; the writer's: busy / total
    double idle = 0;                                // threads * total - busy, at least 0
  };
  struct Totals {
    std::vector<Line> lines;                        // kernels that ran, in the order of kernel()
    std::uint64_t steps = 0, spans = 0;             // spans: chunks and calls recorded
    std::uint64_t dropped = 0;                      // events that found no room while tracing, and spans on a lane that is none
    double wall = 0, busy = 0;                      // of the steps; idle of a step = threads * wall - busy
    double cost = 0;                                // share of the wall time spent in measuring: spans * span_cost / wall, as if
                                                    // one thread had recorded them all, so an upper bound
    double span_cost = 0;                           // [s] of one span, its two clock readings included; measured once
  };
  Totals totals() const;

  const std::vector<std::string>& names() const { return names_; }
  std::vector<StepSpan> steps() const;                              // traced and finished
  std::vector<std::vector<Event>> events() const;                   // by lane, traced, in order of begin, calls first
  std::vector<CounterEvent> counters() const;                       // traced, in order of time

 private:
  // A sum with one writer: others may read it at any time, and adding costs no more than to a plain integer.
  struct Sum {
    std::atomic<std::uint64_t> value{0};
    void add(std::uint64_t x) { value.store(value.load(std::memory_order_relaxed) + x, std::memory_order_relaxed); }
    std::uint64_t get() const { return value.load(std::memory_order_relaxed); }
  };

  // Durations in bins of 1/64 of a power of two: at most 1.6 % wide. The last one takes all from 2^48 ticks (a day) on.
  struct Histogram {
    static constexpr std::size_t bins = 43 * 64;
    std::array<std::atomic<std::uint32_t>, bins> count{};
    static std::size_t bin(Ticks d);
    double quantile(double q) const;                // [ticks], q in 0 .. 1
  };

  // Calls of one kernel come from any thread: a few atomic additions per kernel and step.
  struct alignas(64) Calls {
    std::atomic<std::uint64_t> count{0}, total{0}, rows{0}, max{0};
    Histogram durations;
  };

  struct alignas(64) Lane {
    std::array<Sum, max_kernels> busy;              // [ticks]
    Sum spans, dropped;
    std::vector<Event> events;                      // room; the first `used` are events
    std::size_t used = 0;
  };

  static Ticks elapsed(Ticks begin, Ticks end) { return end > begin ? end - begin : 0; }
  static double measure_span_cost();
  bool is_lane(int lane);                           // else the span went astray
  void record(int lane, const Event& e);
  void count_call(KernelId k, Ticks duration, std::size_t rows);
  void keep(Lane& lane, const Event& e);
  void keep_writers(const Event& e);
  void make_room();
  std::int64_t first_kept_step(std::size_t finished) const;

  int threads_;
  std::vector<std::string> names_;
  std::vector<std::unique_ptr<Calls>> calls_;       // by kernel
  std::vector<Lane> lanes_;
  std::atomic<std::uint64_t> astray_{0};            // spans on a lane that is none

  std::uint64_t step_count_ = 0;
  Ticks step_begin_ = 0, wall_ = 0;

  std::int64_t first_ = 0, last_ = 0, ring_ = 0;    // the window asked for
  std::atomic<bool> wanted_{false}, tracing_{false};
  std::atomic<std::int64_t> step_{0};
  std::uint64_t most_spans_ = 0;                    // of a lane in a step, since the trace was asked for
  std::vector<std::uint64_t> spans_before_;         // by lane, at the start of the step
  std::vector<StepSpan> traced_;
  std::vector<CounterEvent> counters_;

  mutable std::mutex writer_mutex_;                 // the frame writer works while steps begin and end
  Ticks window_begin_ = 0, window_end_ = 0;         // of the traced steps; guarded by writer_mutex_, as is the writer's lane
};

namespace detail {
extern const bool invariant_time_stamp_counter;
}

inline Ticks Timeline::now() {
#if defined(__x86_64__)
  if (detail::invariant_time_stamp_counter) return __rdtsc();
#endif
  return static_cast<Ticks>(std::chrono::steady_clock::now().time_since_epoch().count());
}

inline std::size_t Timeline::Histogram::bin(Ticks d) {
  if (d < 64) return d;
  const int shift = static_cast<int>(std::bit_width(d)) - 7;        // d >> shift lies in [64, 128)
  const std::size_t b = std::size_t{64} * shift + (d >> shift);
  return b < bins ? b : bins - 1;
}

inline void Timeline::keep(Lane& lane, const Event& e) {
  if (lane.used < lane.events.size()) lane.events[lane.used++] = e;
  else lane.dropped.add(1);                         // never allocate while measuring; report the loss
}

inline bool Timeline::is_lane(int lane) {
  if (lane >= 0 && lane <= threads_) return true;
  astray_.fetch_add(1, std::memory_order_relaxed);  // of a thread outside the arena
  return false;
}

inline void Timeline::record(int lane, const Event& e) {
  lanes_[lane].spans.add(1);
  if (lane == threads_) {
    if (wanted_.load(std::memory_order_relaxed)) keep_writers(e);
  } else if (tracing()) {
    keep(lanes_[lane], e);
  }
}

inline void Timeline::chunk(int lane, KernelId k, Ticks begin, Ticks end, std::size_t rows, LoopLabel label) {
  assert(k < names_.size());
  if (!is_lane(lane)) return;
  lanes_[lane].busy[k].add(elapsed(begin, end));
  record(lane, {begin, end, static_cast<std::uint32_t>(rows), k, false, step_.load(std::memory_order_relaxed), label});
}

inline void Timeline::count_call(KernelId k, Ticks duration, std::size_t rows) {
  Calls& c = *calls_[k];
  c.count.fetch_add(1, std::memory_order_relaxed);
  c.total.fetch_add(duration, std::memory_order_relaxed);
  c.rows.fetch_add(rows, std::memory_order_relaxed);
  c.durations.count[Histogram::bin(duration)].fetch_add(1, std::memory_order_relaxed);
  for (Ticks most = c.max.load(std::memory_order_relaxed); duration > most;)
    if (c.max.compare_exchange_weak(most, duration, std::memory_order_relaxed)) break;
}

inline void Timeline::call(int lane, KernelId k, Ticks begin, Ticks end, std::size_t rows) {
  assert(k < names_.size());
  if (!is_lane(lane)) return;
  count_call(k, elapsed(begin, end), rows);
  record(lane, {begin, end, static_cast<std::uint32_t>(rows), k, true, step_.load(std::memory_order_relaxed)});
}

inline void Timeline::chained_calls(int lane, KernelId first, KernelId then, Ticks begin, Ticks end, std::size_t rows, double part_of_first) {
  assert(first < names_.size() && then < names_.size());
  if (!is_lane(lane)) return;
  const Ticks d = elapsed(begin, end), of_first = static_cast<Ticks>(part_of_first * double(d));
  count_call(first, of_first, rows);
  count_call(then, d - of_first, rows);
  record(lane, {begin, end, static_cast<std::uint32_t>(rows), first, true, step_.load(std::memory_order_relaxed)});
}

}  // namespace skred
