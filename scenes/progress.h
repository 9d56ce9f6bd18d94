// scenes/progress.h - how far a run is: one line that a terminal rewrites, a log line now and then elsewhere.
#pragma once
#include <chrono>
#include <functional>
#include <string>

namespace skred {

class Progress {
 public:
  struct Now { double time, kinetic_energy, max_overlap_ratio; std::size_t contacts; std::int64_t steps; };

  // `end_time` [s] > 0. `log` takes the lines where there is no terminal.
  Progress(double end_time, std::size_t particles, bool quiet, std::function<void(const std::string&)> log);

  bool due() const;                    // a line is worth making now
  void show(const Now&);
  void finish();                       // leaves the terminal's line

 private:
  using Clock = std::chrono::steady_clock;
  double end_time_;
  std::size_t particles_;
  bool quiet_, terminal_;
  std::function<void(const std::string&)> log_;
  Clock::time_point last_;
  double last_time_ = 0, cost_ = 0;    // [s wall per s simulated], smoothed: contacts come and go
  std::int64_t last_steps_ = 0;
};

std::string duration_text(double seconds);   // "42 s", "3 min 12 s", "2 h 05 min"

}  // namespace skred
