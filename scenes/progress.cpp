#include "scenes/progress.h"
#include <cmath>
#include <cstdio>
#include <unistd.h>
#include <fmt/format.h>

namespace skred {

std::string duration_text(double s) {
  if (s < 0.0995) return fmt::format("{:.0f} ms", s * 1e3);
  if (s < 9.95) return fmt::format("{:.1f} s", s);
  if (s < 119.5) return fmt::format("{:.0f} s", s);
  const long whole = std::lround(s);
  if (whole < 7200) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

Progress::Progress(double end_time, std::size_t particles, bool quiet, std::function<void(const std::string&)> log)
    : end_time_(end_time), particles_(particles), quiet_(quiet), terminal_(isatty(STDERR_FILENO)), log_(std::move(log)), last_(Clock::now()) {}

bool Progress::due() const {
  const double waited = std::chrono::duration<double>(Clock::now() - last_).count();
  return !quiet_ && waited > (terminal_ ? 0.25 : 10.0);
}

void Progress::show(const Now& n) {
  const auto at = Clock::now();
  const double wall = std::chrono::duration<double>(at - last_).count();
  const double advanced = n.time - last_time_;
  if (advanced > 0) cost_ = cost_ > 0 ? 0.7 * cost_ + 0.3 * wall / advanced : wall / advanced;
  const double rate = double(n.steps - last_steps_) / wall;
  last_ = at;
  last_time_ = n.time;
  last_steps_ = n.steps;
  const std::string text =
      fmt::format("t {:.3f}/{:g} s  {:.1f} %  {:.0f} steps/s  {:.2f} M particle-steps/s  {} left  contacts {}  Ek {:.3g} J  overlap max {:.2f} %",
                  n.time, end_time_, 100 * n.time / end_time_, rate, rate * double(particles_) * 1e-6,
                  duration_text(std::max(0.0, end_time_ - n.time) * cost_), n.contacts, n.kinetic_energy, 100 * n.max_overlap_ratio);
  if (terminal_) std::fprintf(stderr, "\r\x1b[2K%s", text.c_str());
  else log_(text);
}

void Progress::finish() {
  if (terminal_ && !quiet_) std::fprintf(stderr, "\r\x1b[2K");
}

}  // namespace skred
