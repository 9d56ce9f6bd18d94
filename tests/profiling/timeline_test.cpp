// tests/profiling/timeline_test.cpp
#include "profiling/timeline.h"
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <thread>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace skred;
using testing::ElementsAre;

namespace {

std::vector<std::int64_t> numbers(const std::vector<Timeline::StepSpan>& steps) {
  std::vector<std::int64_t> out;
  for (const auto& s : steps) out.push_back(s.step);
  return out;
}

// A step whose only kernel does `chunks` chunks on lane 0.
void small_step(Timeline& t, std::int64_t step, KernelId k, int chunks = 1) {
  t.begin_step(step);
  const Ticks begin = Timeline::now();
  for (int i = 0; i < chunks; ++i) {
    const Ticks start = Timeline::now();
    t.chunk(0, k, start, Timeline::now(), 10);
  }
  t.call(0, k, begin, Timeline::now(), 10u * static_cast<unsigned>(chunks));
  t.counter("contacts", double(step));
  t.end_step();
}

const Timeline::Line& line(const Timeline::Totals& totals, const std::string& name) {
  for (const auto& l : totals.lines)
    if (l.name == name) return l;
  throw std::out_of_range(name);
}

}  // namespace

TEST(Timeline, SecondsAgreeWithSteadyClock) {
  const auto before = std::chrono::steady_clock::now();
  const Ticks begin = Timeline::now();
  std::this_thread::sleep_for(std::chrono::milliseconds(40));
  const Ticks end = Timeline::now();
  const double expected = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  EXPECT_GE(Timeline::seconds(end - begin), 0.0399);
  EXPECT_LE(Timeline::seconds(end - begin), expected * 1.0005);
}

TEST(Timeline, ChainedCallsShareTheirTime) {
  Timeline t(1);
  const KernelId a = t.kernel("a"), b = t.kernel("b");
  t.trace(1, 2);
  t.begin_step(1);
  const Ticks begin = Timeline::now(), end = begin + 1000;
  t.chunk(0, a, begin, begin + 600, 7);
  t.chunk(0, b, begin + 600, begin + 800, 7);
  t.chained_calls(0, a, b, begin, end, 7, 0.75);
  t.end_step();
  const Timeline::Totals totals = t.totals();
  EXPECT_EQ(line(totals, "a").count, 1u);
  EXPECT_EQ(line(totals, "b").count, 1u);
  EXPECT_EQ(line(totals, "b").rows, 7u);
  EXPECT_NEAR(line(totals, "a").total / line(totals, "b").total, 3, 1e-9);
  EXPECT_NEAR(line(totals, "a").busy / line(totals, "b").busy, 3, 1e-9);
  const auto events = t.events()[0];
  ASSERT_EQ(events.size(), 3u);                              // one call around both chunks
  EXPECT_TRUE(events[0].whole_call && events[0].kernel == a && events[0].end == end);
  EXPECT_EQ(events[2].kernel, b);
}

TEST(Timeline, KernelIdsAreByNameAndLimited) {
  Timeline t(1);
  const KernelId a = t.kernel("a"), b = t.kernel("b");
  EXPECT_NE(a, b);
  EXPECT_EQ(t.kernel("a"), a);
  for (std::size_t i = 2; i < Timeline::max_kernels; ++i) t.kernel(std::to_string(i));
  EXPECT_THROW(t.kernel("one too many"), std::length_error);
  EXPECT_EQ(t.kernel("b"), b);
}

TEST(Timeline, RejectsBadArguments) {
  EXPECT_THROW(Timeline(0), std::invalid_argument);
  Timeline t(1);
  EXPECT_THROW(t.trace(5, 5), std::invalid_argument);
  EXPECT_THROW(t.trace(0, 5, -1), std::invalid_argument);
}

TEST(Timeline, TotalsAreTheSumsOfTheSpans) {
  Timeline t(2);
  const double tick = Timeline::seconds_per_tick();
  const auto ticks = [&](double s) { return static_cast<Ticks>(s / tick); };
  const KernelId a = t.kernel("a"), b = t.kernel("b"), unused = t.kernel("unused"), frame = t.kernel("write_frame");
  (void)unused;
  for (int step = 0; step < 10; ++step) {
    t.begin_step(step);
    const Ticks o = 1000;
    t.chunk(0, a, o, o + ticks(3e-3), 60);                    // a: 4 ms of 2 x 3 ms
    t.chunk(1, a, o, o + ticks(1e-3), 40);
    t.call(0, a, o, o + ticks(3e-3), 100);
    t.chunk(1, b, o, o + ticks(4e-3), 7);                     // b: 4 ms of 2 x 4 ms
    t.call(1, b, o, o + ticks(4e-3), 7);
    t.chunk(2, frame, o, o + ticks(50e-3), 1);                // the writer's
    t.call(2, frame, o, o + ticks(50e-3), 1);
    t.end_step();
  }
  const auto totals = t.totals();
  ASSERT_EQ(totals.lines.size(), 3u) << "a kernel that never ran has no line";
  const auto& la = line(totals, "a");
  EXPECT_EQ(la.count, 10u);
  EXPECT_EQ(la.rows, 1000u);
  EXPECT_NEAR(la.total, 0.030, 3e-5);
  EXPECT_NEAR(la.busy, 0.040, 4e-5);
  EXPECT_NEAR(la.mean, 3e-3, 3e-6);
  EXPECT_NEAR(la.median, 3e-3, 0.02 * 3e-3);
  EXPECT_NEAR(la.max, 3e-3, 3e-6);
  EXPECT_NEAR(la.share, 0.5, 1e-3);
  EXPECT_NEAR(la.efficiency, 4.0 / 6, 1e-3);
  EXPECT_NEAR(la.idle, 0.020, 2e-5);
  EXPECT_NEAR(line(totals, "b").efficiency, 0.5, 1e-3);
  const auto& lw = line(totals, "write_frame");
  EXPECT_TRUE(lw.writer);
  EXPECT_EQ(lw.share, 0);
  EXPECT_EQ(lw.idle, 0);
  EXPECT_NEAR(lw.efficiency, 1, 1e-9);
  EXPECT_NEAR(totals.busy, 0.080, 8e-5) << "the writer's time is not the steps'";
  EXPECT_EQ(totals.steps, 10u);
  EXPECT_EQ(totals.spans, 70u);
  EXPECT_EQ(totals.dropped, 0u);
  EXPECT_GT(totals.wall, 0);
  EXPECT_GT(totals.span_cost, 1e-9);
  EXPECT_LT(totals.span_cost, 5e-6);
  EXPECT_NEAR(totals.cost, 70 * totals.span_cost / totals.wall, 1e-12);
}

TEST(Timeline, MedianAndP95WithinTwoPercentOverManyDecades) {
  const double tick = Timeline::seconds_per_tick();
  for (double scale : {200e-9, 3e-6, 0.7e-3, 0.11, 40.0}) {
    Timeline t(1);
    const KernelId k = t.kernel("k");
    // Durations from scale to 5 * scale, evenly, out of order.
    for (int i = 0; i < 1001; ++i)
      t.call(0, k, 5, 5 + static_cast<Ticks>(std::llround(scale * (1 + 4 * ((i * 370) % 1001) / 1000.0) / tick)), 1);
    const auto l = t.totals().lines.at(0);
    EXPECT_NEAR(l.median / (3 * scale), 1, 0.02) << scale;
    EXPECT_NEAR(l.p95 / (4.8 * scale), 1, 0.02) << scale;
    EXPECT_NEAR(l.max / (5 * scale), 1, 0.006) << scale;
    EXPECT_NEAR(l.mean / (3 * scale), 1, 0.006) << scale;
  }
}

TEST(Timeline, AbsurdSpansDoNoHarm) {
  Timeline t(1);
  const KernelId k = t.kernel("k");
  t.call(0, k, 100, 50, 1);                                   // clocks of two processors that differ
  t.call(0, k, 0, Ticks{1} << 60, 1);
  t.chunk(-2, k, 0, 1, 1);                                    // a thread that is in no arena
  t.chunk(2, k, 0, 1, 1);
  t.call(99, k, 0, 1, 1);
  const auto totals = t.totals();
  EXPECT_EQ(totals.lines.at(0).count, 2u);
  EXPECT_EQ(totals.dropped, 3u);
}

TEST(Timeline, KeepsOnlyTheTracedWindow) {
  Timeline t(1);
  const KernelId k = t.kernel("k");
  t.trace(3, 6);
  for (int step = 0; step < 10; ++step) {
    small_step(t, step, k, 2);
    EXPECT_EQ(t.tracing(), step >= 3 && step < 6);
  }
  EXPECT_THAT(numbers(t.steps()), ElementsAre(3, 4, 5));
  const auto events = t.events();
  ASSERT_EQ(events.size(), 2u);
  ASSERT_EQ(events[0].size(), 9u);
  EXPECT_EQ(events[0].front().step, 3);
  EXPECT_TRUE(events[0].front().whole_call) << "a call comes before its chunks";
  EXPECT_EQ(events[0].back().step, 5);
  EXPECT_EQ(t.counters().size(), 3u);
  EXPECT_EQ(t.totals().lines.at(0).count, 10u) << "sums are of all steps";
}

TEST(Timeline, RingKeepsTheLastStepsInBoundedRoom) {
  Timeline t(1);
  const KernelId k = t.kernel("k");
  t.trace(0, 1000000, 3);
  for (int step = 0; step < 2000; ++step) {
    small_step(t, step, k, 20);                               // 42 000 spans, many times the room of three steps
    const auto steps = t.steps();
    ASSERT_EQ(steps.size(), static_cast<std::size_t>(std::min(step + 1, 3)));
    ASSERT_EQ(steps.back().step, step);
  }
  EXPECT_THAT(numbers(t.steps()), ElementsAre(1997, 1998, 1999));
  EXPECT_EQ(t.events()[0].size(), 3u * 21u);
  EXPECT_EQ(t.counters().size(), 3u);
  EXPECT_EQ(t.totals().dropped, 0u);
}

TEST(Timeline, RoomGrowsBetweenStepsAndLossIsCounted) {
  Timeline t(1);
  const KernelId k = t.kernel("k");
  t.trace(1, 4);
  small_step(t, 0, k, 3000);                                  // untraced, but it tells how much a step needs
  small_step(t, 1, k, 5000);
  small_step(t, 2, k, 5000);
  EXPECT_EQ(t.totals().dropped, 0u);
  EXPECT_EQ(t.events()[0].size(), 2u * 5001u);
  small_step(t, 3, k, 30000);                                 // far more than any step before
  const auto kept = t.events()[0].size() - 2u * 5001u;
  EXPECT_GT(kept, 5000u);
  EXPECT_EQ(t.totals().dropped, 30001u - kept);
}

TEST(Timeline, AFrameThatOverlapsTheWindowIsKept) {
  Timeline t(1);
  const KernelId k = t.kernel("k"), frame = t.kernel("write_frame");
  t.trace(2, 4);
  Ticks begin[7];
  for (int step = 0; step < 6; ++step) {
    begin[step] = Timeline::now();
    small_step(t, step, k);
    const Ticks at = begin[step];
    if (step == 0) t.chunk(1, frame, at, Timeline::now(), 1);              // before the window
    if (step == 2) t.chunk(1, frame, begin[1], Timeline::now(), 1);        // into it
    if (step == 5) t.chunk(1, frame, begin[3], Timeline::now(), 1);        // out of it
    if (step == 5) t.chunk(1, frame, begin[5], Timeline::now(), 1);        // after it
  }
  const auto writer = t.events().at(1);
  ASSERT_EQ(writer.size(), 2u);
  EXPECT_EQ(writer[0].begin, begin[1]);
  EXPECT_EQ(writer[1].begin, begin[3]);
}

TEST(Timeline, ThreadsRecordAtOnce) {
  constexpr int threads = 4, steps = 30, chunks = 400;
  Timeline t(threads);
  const KernelId k = t.kernel("k"), frame = t.kernel("write_frame");
  t.trace(0, steps);
  std::atomic<bool> done{false};
  std::thread writer([&] {                                    // works while steps begin and end
    do {
      const Ticks begin = Timeline::now();
      t.chunk(threads, frame, begin, Timeline::now(), 1);
      t.call(threads, frame, begin, Timeline::now(), 1);
      std::this_thread::yield();
    } while (!done);
  });
  for (int step = 0; step < steps; ++step) {
    t.begin_step(step);
    const Ticks begin = Timeline::now();
    std::vector<std::thread> team;
    for (int lane = 0; lane < threads; ++lane)
      team.emplace_back([&, lane] {
        for (int i = 0; i < chunks; ++i) {
          const Ticks start = Timeline::now();
          t.chunk(lane, k, start, Timeline::now(), 2);
        }
      });
    for (auto& thread : team) thread.join();
    t.call(step % threads, k, begin, Timeline::now(), 2 * chunks * threads);
    t.end_step();
  }
  done = true;
  writer.join();
  const auto totals = t.totals();
  EXPECT_EQ(line(totals, "k").count, static_cast<std::uint64_t>(steps));
  EXPECT_EQ(line(totals, "k").rows, std::uint64_t{2} * chunks * threads * steps);
  EXPECT_EQ(totals.spans, std::uint64_t{chunks} * threads * steps + steps + 2 * line(totals, "write_frame").count);
  EXPECT_EQ(totals.dropped, 0u);
  const auto events = t.events();
  std::size_t in_steps = 0;
  for (int lane = 0; lane < threads; ++lane) {
    in_steps += events[lane].size();
    EXPECT_TRUE(std::is_sorted(events[lane].begin(), events[lane].end(), [](auto& a, auto& b) { return a.begin < b.begin; }));
  }
  EXPECT_EQ(in_steps, std::size_t{chunks} * threads * steps + steps);
  EXPECT_GT(events[threads].size(), 0u);
}
