// profiling/timeline.cpp - what happens between steps: clocks, room for events, sums.
#include "profiling/timeline.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <thread>
#if defined(__x86_64__)
#include <cpuid.h>
#endif

namespace skred {

namespace {

using std::chrono::steady_clock;

bool counter_is_invariant() {
#if defined(__x86_64__)
  // Leaf 0x80000007, EDX bit 8: ticks at a constant rate in all states of the processor (Intel SDM vol. 3B, "Invariant TSC").
  unsigned a = 0, b = 0, c = 0, d = 0;
  return __get_cpuid(0x80000007, &a, &b, &c, &d) != 0 && (d & (1u << 8)) != 0;
#else
  return false;
#endif
}

struct ClockPair { Ticks ticks; steady_clock::time_point time; };

// Both clocks at one moment: of a few tries, the one least disturbed.
ClockPair read_clocks() {
  ClockPair best{};
  auto narrowest = steady_clock::duration::max();
  for (int i = 0; i < 5; ++i) {
    const auto before = steady_clock::now();
    const Ticks ticks = Timeline::now();
    const auto after = steady_clock::now();
    if (after - before >= narrowest) continue;
    narrowest = after - before;
    best = {ticks, before + narrowest / 2};
  }
  return best;
}

}  // namespace

const bool detail::invariant_time_stamp_counter = counter_is_invariant();

namespace {
const ClockPair program_start = read_clocks();       // after the line above: initialised in this order
}

double Timeline::seconds_per_tick() {
  if (!detail::invariant_time_stamp_counter) return double(steady_clock::period::num) / steady_clock::period::den;
  // 0.1 us between the two readings is then an error of 1e-5.
  std::this_thread::sleep_until(program_start.time + std::chrono::milliseconds(10));
  const ClockPair end = read_clocks();
  return std::chrono::duration<double>(end.time - program_start.time).count() / double(end.ticks - program_start.ticks);
}

double Timeline::seconds(Ticks ticks) { return double(ticks) * seconds_per_tick(); }

Timeline::Timeline(int threads)
    : threads_(threads > 0 ? threads : throw std::invalid_argument("timeline: threads is " + std::to_string(threads) +
                                                                   ", must be at least 1")),
      lanes_(static_cast<std::size_t>(threads) + 1),
      spans_before_(lanes_.size(), 0) {}

KernelId Timeline::kernel(const std::string& name) {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found != names_.end()) return static_cast<KernelId>(found - names_.begin());
  if (names_.size() == max_kernels)
    throw std::length_error("timeline: no room for kernel '" + name + "', at most " + std::to_string(max_kernels));
  names_.push_back(name);
  calls_.push_back(std::make_unique<Calls>());
  return static_cast<KernelId>(names_.size() - 1);
}

void Timeline::trace(std::int64_t first, std::int64_t last, std::int64_t ring) {
  if (last <= first || ring < 0)
    throw std::invalid_argument("timeline: cannot trace steps " + std::to_string(first) + ":" + std::to_string(last) +
                                ", ring " + std::to_string(ring) + "; the first must be less than the last, the ring 0 or more");
  first_ = first, last_ = last, ring_ = ring;
  most_spans_ = 0;
  for (std::size_t i = 0; i < lanes_.size(); ++i) spans_before_[i] = lanes_[i].spans.get();
  traced_.clear();
  counters_.clear();
  const std::lock_guard lock(writer_mutex_);
  window_begin_ = window_end_ = 0;
  for (Lane& l : lanes_) l.used = 0;
  tracing_.store(false, std::memory_order_relaxed);
  wanted_.store(true, std::memory_order_relaxed);
}

// The oldest step of the ring, when `finished` traced steps belong to it.
std::int64_t Timeline::first_kept_step(std::size_t finished) const {
  if (ring_ == 0 || traced_.size() <= finished) return first_;
  return finished == 0 ? traced_.back().step + 1 : traced_[traced_.size() - finished].step;
}

// Before a traced step: drops what fell out of the ring, then grows the lanes to twice what a step has needed so far.
void Timeline::make_room() {
  constexpr std::uint64_t least = 4096;
  const std::size_t need = std::max(least, 2 * most_spans_);
  const bool full = std::any_of(lanes_.begin(), lanes_.begin() + threads_,
                                [&](const Lane& l) { return l.used + need > l.events.size(); });
  if (!full) return;
  if (ring_ > 0 && traced_.size() >= static_cast<std::size_t>(ring_)) {
    const std::int64_t oldest = first_kept_step(static_cast<std::size_t>(ring_) - 1);
    const auto keep_from = std::find_if(traced_.begin(), traced_.end(), [&](const StepSpan& s) { return s.step >= oldest; });
    const Ticks from = keep_from == traced_.end() ? step_begin_ : keep_from->begin;
    traced_.erase(traced_.begin(), keep_from);
    std::erase_if(counters_, [&](const CounterEvent& c) { return c.at < from; });
    const std::lock_guard lock(writer_mutex_);
    window_begin_ = from;
    for (Lane& l : lanes_) {
      const bool writers = &l == &lanes_.back();
      const auto used = l.events.begin() + static_cast<std::ptrdiff_t>(l.used);
      const auto end = std::remove_if(l.events.begin(), used,
                                      [&](const Event& e) { return writers ? e.end < from : e.step < oldest; });
      l.used = static_cast<std::size_t>(end - l.events.begin());
    }
  }
  const std::size_t most = std::max<std::size_t>(max_events / static_cast<std::size_t>(threads_), 1);
  for (int i = 0; i < threads_; ++i) {
    Lane& l = lanes_[i];
    if (l.used + need <= l.events.size()) continue;
    // Filled, not just reserved: pages must not be touched for the first time while measuring.
    l.events.resize(std::max(l.events.size(), std::min(most, std::max(2 * l.events.size(), l.used + need))));
  }
}

void Timeline::begin_step(std::int64_t step) {
  step_.store(step, std::memory_order_relaxed);
  if (wanted_.load(std::memory_order_relaxed)) {
    // Spans of the writer's lane do not come from the step: they need no room here.
    for (int i = 0; i < threads_; ++i) {
      const std::uint64_t spans = lanes_[i].spans.get();
      most_spans_ = std::max(most_spans_, spans - spans_before_[i]);
      spans_before_[i] = spans;
    }
    const bool trace_this = step >= first_ && step < last_;
    step_begin_ = now();
    if (trace_this) make_room();
    tracing_.store(trace_this, std::memory_order_relaxed);
  }
  step_begin_ = now();
  if (tracing()) {
    const std::lock_guard lock(writer_mutex_);
    if (window_begin_ == 0) window_begin_ = step_begin_;
    window_end_ = ~Ticks{0};
  }
}

void Timeline::end_step() {
  const Ticks end = now();
  wall_ += elapsed(step_begin_, end);
  ++step_count_;
  if (!tracing()) return;
  traced_.push_back({step_.load(std::memory_order_relaxed), step_begin_, end});
  const std::lock_guard lock(writer_mutex_);
  window_end_ = end;
}

// A frame is written during several steps: kept if it overlaps the traced ones.
void Timeline::keep_writers(const Event& e) {
  const std::lock_guard lock(writer_mutex_);
  if (window_begin_ == 0 || e.end < window_begin_ || e.begin > window_end_) return;
  Lane& l = lanes_.back();
  if (l.used == l.events.size() && l.used < max_events) l.events.resize(std::max<std::size_t>(1024, 2 * l.used));
  keep(l, e);
}

void Timeline::counter(const std::string& name, double value) {
  if (tracing()) counters_.push_back({name, now(), value});
}

std::vector<Timeline::StepSpan> Timeline::steps() const {
  const std::int64_t oldest = first_kept_step(static_cast<std::size_t>(ring_));
  std::vector<StepSpan> out;
  std::copy_if(traced_.begin(), traced_.end(), std::back_inserter(out), [&](const StepSpan& s) { return s.step >= oldest; });
  return out;
}

std::vector<std::vector<Timeline::Event>> Timeline::events() const {
  const std::int64_t oldest = first_kept_step(static_cast<std::size_t>(ring_));
  const auto kept = steps();
  const std::lock_guard lock(writer_mutex_);
  std::vector<std::vector<Event>> out;
  for (const Lane& l : lanes_) {
    const bool writers = &l == &lanes_.back();
    auto& events = out.emplace_back();
    std::copy_if(l.events.begin(), l.events.begin() + static_cast<std::ptrdiff_t>(l.used), std::back_inserter(events),
                 [&](const Event& e) { return writers ? kept.empty() || e.end >= kept.front().begin : e.step >= oldest; });
    std::stable_sort(events.begin(), events.end(), [](const Event& a, const Event& b) {
      if (a.begin != b.begin) return a.begin < b.begin;
      return a.end != b.end ? a.end > b.end : a.whole_call && !b.whole_call;
    });
  }
  return out;
}

std::vector<Timeline::CounterEvent> Timeline::counters() const {
  const auto kept = steps();
  std::vector<CounterEvent> out;
  std::copy_if(counters_.begin(), counters_.end(), std::back_inserter(out),
               [&](const CounterEvent& c) { return kept.empty() || c.at >= kept.front().begin; });
  return out;
}

double Timeline::Histogram::quantile(double q) const {
  std::uint64_t all = 0;
  for (const auto& n : count) all += n.load(std::memory_order_relaxed);
  if (all == 0) return 0;
  const auto rank = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(q * double(all))));
  std::size_t b = 0;
  for (std::uint64_t below = 0; b < bins; ++b)
    if ((below += count[b].load(std::memory_order_relaxed)) >= rank) break;
  if (b < 128) return double(b);                     // exact
  const std::size_t shift = b / 64 - 1;
  return std::ldexp(64.5 + double(b % 64), static_cast<int>(shift));   // the middle of the bin
}

// The median of a few short loops: what a span costs in the run, not at best.
double Timeline::measure_span_cost() {
  constexpr int loops = 9, spans = 2000;
  Timeline scratch(1);
  const KernelId k = scratch.kernel("scratch");
  std::array<Ticks, loops> took{};
  for (Ticks& t : took) {
    const Ticks begin = now();
    for (int i = 0; i < spans; ++i) {
      const Ticks start = now();
      scratch.chunk(0, k, start, now(), 1);
    }
    t = elapsed(begin, now());
  }
  std::nth_element(took.begin(), took.begin() + loops / 2, took.end());
  return seconds(took[loops / 2]) / spans;
}

Timeline::Totals Timeline::totals() const {
  static const double span_cost = measure_span_cost();
  const double tick = seconds_per_tick();
  Totals t;
  t.steps = step_count_;
  t.wall = double(wall_) * tick;
  t.span_cost = span_cost;
  t.dropped = astray_.load(std::memory_order_relaxed);
  for (const Lane& l : lanes_) t.spans += l.spans.get(), t.dropped += l.dropped.get();
  for (std::size_t k = 0; k < names_.size(); ++k) {
    const Calls& c = *calls_[k];
    Ticks in_steps = 0;
    for (int i = 0; i < threads_; ++i) in_steps += lanes_[i].busy[k].get();
    const Ticks beside = lanes_.back().busy[k].get();
    Line line{.name = names_[k], .writer = beside > in_steps};
    line.count = c.count.load(std::memory_order_relaxed);
    if (line.count == 0 && in_steps + beside == 0) continue;
    const int threads = line.writer ? 1 : threads_;
    line.rows = c.rows.load(std::memory_order_relaxed);
    line.total = double(c.total.load(std::memory_order_relaxed)) * tick;
    line.busy = double(line.writer ? beside : in_steps) * tick;
    line.max = double(c.max.load(std::memory_order_relaxed)) * tick;
    line.mean = line.count > 0 ? line.total / double(line.count) : 0;
    line.median = std::min(line.max, c.durations.quantile(0.5) * tick);
    line.p95 = std::min(line.max, c.durations.quantile(0.95) * tick);
    line.efficiency = line.total > 0 ? std::min(1.0, line.busy / (threads * line.total)) : 0;
    line.idle = line.writer ? 0 : std::max(0.0, threads * line.total - line.busy);
    if (!line.writer) t.busy += line.busy;
    t.lines.push_back(std::move(line));
  }
  for (Line& line : t.lines)
    if (!line.writer && t.busy > 0) line.share = line.busy / t.busy;
  if (t.wall > 0) t.cost = double(t.spans) * span_cost / t.wall;
  return t;
}

}  // namespace skred
