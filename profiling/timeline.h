// profiling/timeline.h - who ran what, when: one lane per thread, so that recording takes no lock.
//
// The always-on part adds the time of every chunk to a per-thread, per-kernel sum and the duration of every kernel call to
// a histogram. Events (one per chunk and per kernel call) are kept only while a window of steps is being traced.
// Nothing here knows of kernels or scenes; names are the ones given to `kernel()`.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

namespace skred {

using Ticks = std::uint64_t;
using KernelId = std::uint16_t;

class Timeline {
 public:
  // Lanes 0 .. threads-1 are the arena's slots; lane `threads` is the frame writer's.
  explicit Timeline(int threads);

  static Ticks now();                               // time stamp counter where it is invariant, else steady_clock
  static double seconds(Ticks ticks);               // calibrated once per process
  KernelId kernel(const std::string& name);         // same name, same id

  int threads() const { return threads_; }

  // Which steps [first, last) to keep events of; `ring` > 0 keeps the events of only the last `ring` steps of the window.
  void trace(std::int64_t first, std::int64_t last, std::int64_t ring = 0);

  // Called by the thread that runs the step loop.
  void begin_step(std::int64_t step);
  void end_step();

  // A part of a kernel's rows done by the calling thread on `lane`: busy time.
  void chunk(int lane, KernelId k, Ticks begin, Ticks end, std::size_t rows);
  // A whole call of a kernel, from its start to the end of its last chunk, waiting included.
  void call(int lane, KernelId k, Ticks begin, Ticks end, std::size_t rows);
  // A value at the present step for the trace's counter tracks ("contacts", "kinetic energy [J]").
  void counter(const std::string& name, double value);
  bool tracing() const { return tracing_; }

  struct Event { Ticks begin, end; std::uint32_t rows; KernelId kernel; bool whole_call; std::int64_t step; };
  struct StepSpan { std::int64_t step; Ticks begin, end; };
  struct CounterEvent { std::string name; Ticks at; double value; };

  // One line of the table at the end of a run. Times in seconds.
  struct Line {
    std::string name;
    std::uint64_t count = 0, rows = 0;              // calls, rows done
    double total = 0, busy = 0;                     // wall time of the calls; busy time of all threads in them
    double mean = 0, median = 0, p95 = 0, max = 0;  // of a call
    double share = 0;                               // busy time of this kernel / busy time of all kernels
    double efficiency = 0;                          // busy / (threads * total), at most 1
    double idle = 0;                                // threads * total - busy, at least 0
  };
  struct Totals {
    std::vector<Line> lines;                        // in order of first use
    std::uint64_t steps = 0, spans = 0, dropped = 0;
    double wall = 0, busy = 0;                      // of the steps; idle of a step = threads * wall - busy
    double cost = 0;                                // share of the wall time spent in measuring: spans * measured cost of one
    double span_cost = 0;                           // [s] measured
  };
  Totals totals() const;

  const std::vector<std::string>& names() const { return names_; }
  std::vector<StepSpan> steps() const;                              // traced
  std::vector<std::vector<Event>> events() const;                   // by lane, traced, in order of begin
  const std::vector<CounterEvent>& counters() const { return counters_; }

 private:
  // (private part: the implementer's; keep the hot calls inline below the class)
  int threads_;
  bool tracing_ = false;
  std::vector<std::string> names_;
  std::vector<CounterEvent> counters_;
};

}  // namespace skred
