#include "profiling/bench/results.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <unistd.h>
#include "profiling/bench/bench_scenes.h"
#include "profiling/bench/report.h"
#include "profiling/bench/roofline.h"
#include "profiling/bench/spawn.h"
#include "profiling/bench/spread.h"
#include "profiling/bench/state_file.h"
#include "scenes/errors.h"
#include "scenes/thread_option.h"
#include "scenes/vector_option.h"

using namespace skred;

namespace {

Window window(int threads, double seconds, bool frame = false) {
  Window w{.threads = threads, .execution = "graph", .frame = frame, .steps = 100, .searches = 5, .listings = 20, .seconds = seconds};
  w.pairs = 1900, w.wall_contacts = 100, w.candidates = 3000, w.wall_candidates = 200;
  w.kernels = {{"integrate", 0.1 * seconds, 0.1 * seconds * threads}, {"broadphase", 0.3 * seconds, 0.3 * seconds}};
  return w;
}

// 1000 particles; the machine slows down from window to window, and two threads are always 1.6 times as fast as one.
SceneResult drifting() {
  SceneResult r{.name = "x", .threads = {1, 2}, .executions = {"graph"}};
  r.processes = {{.threads = 1, .particles = 1000}, {.threads = 2, .particles = 1000}};
  for (const double slow : {1.0, 1.5, 3.0}) {
    r.windows.push_back(window(1, 1.6 * slow));
    r.windows.push_back(window(2, slow));
  }
  return r;
}

double nearest_pair(const std::vector<Vec3>& x) {
  double least = 1e9;
  for (std::size_t a = 0; a < x.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) least = std::min(least, norm(x[a] - x[b]));
  return least;
}

}  // namespace

TEST(Spread, MedianOfOddAndEvenCounts) {
  EXPECT_EQ(spread_of({}).median, 0);
  const Spread odd = spread_of({3, 1, 2}), even = spread_of({4, 1, 2, 10});
  EXPECT_EQ(odd.median, 2);
  EXPECT_EQ(even.median, 3);
  EXPECT_EQ(even.least, 1);
  EXPECT_EQ(even.most, 10);
}

TEST(BenchSummary, RatesAndUnits) {
  const Summary s = summarize(drifting(), 2, "graph");
  EXPECT_EQ(s.windows, 3u);
  EXPECT_DOUBLE_EQ(s.rate.median, 100 * 1000 / 1.5);                  // particle-steps per second
  EXPECT_DOUBLE_EQ(s.rate.most, 100 * 1000 / 1.0);
  EXPECT_DOUBLE_EQ(s.step_seconds.median, 1.5 / 100);
  EXPECT_DOUBLE_EQ(s.contact_nanoseconds.median, 1.5e9 / 100 / 2000);  // pairs and walls
  EXPECT_DOUBLE_EQ(coordination(s, 1000), 3.8);                       // pairs count for both, walls do not count
  EXPECT_EQ(s.searches, 15);
  EXPECT_EQ(s.listings, 60);
  ASSERT_EQ(s.kernels.size(), 2u);
  EXPECT_NEAR(s.kernels[0].total, 0.1 * (1 + 1.5 + 3) / 300, 1e-15);  // of a step
  EXPECT_NEAR(s.kernels[0].busy, 2 * s.kernels[0].total, 1e-15);
}

TEST(BenchSummary, EfficiencyComesFromWindowsSideBySide) {
  const SceneResult r = drifting();
  EXPECT_FALSE(summarize(r, 1, "graph").efficiency);
  const Spread e = *summarize(r, 2, "graph").efficiency;
  EXPECT_NEAR(e.least, 0.8, 1e-12);          // the drift of the machine is not in it
  EXPECT_NEAR(e.most, 0.8, 1e-12);
}

TEST(BenchSummary, NothingTimedIsNoDivisionByZero) {
  const Summary s = summarize({.threads = {1}, .executions = {"graph"}}, 1, "graph");
  EXPECT_EQ(s.rate.median, 0);
  EXPECT_EQ(coordination(s, 0), 0);
}

TEST(BenchSummary, AFrameCostsWhatItsWindowTakesLonger) {
  SceneResult r{.name = "x", .threads = {1}, .executions = {"graph"}};
  r.processes = {{.threads = 1, .particles = 1000}};
  for (const double slow : {1.0, 2.0, 1.0}) {
    r.windows.push_back(window(1, slow));
    r.windows.push_back(window(1, slow + 0.05, true));
  }
  const auto costs = frame_costs(r);
  ASSERT_EQ(costs.size(), 1u);
  EXPECT_NEAR(costs[0].seconds.median, 0.05, 1e-12);
  EXPECT_NEAR(costs[0].share_of_1000_steps, 0.05 / (1000 * 0.01), 1e-12);
  EXPECT_EQ(summarize(r, 1, "graph").windows, 3u);
}

TEST(BenchSummary, AStateThatDependsOnTheThreadsIsAFailure) {
  SceneResult r = drifting();
  r.processes[0].hash = r.processes[1].hash = "0123456789abcdef";
  EXPECT_NO_THROW(check_agreement(r, &Process::hash, 100));
  r.processes[1].hash = "0123456789abcdee";
  EXPECT_THROW(check_agreement(r, &Process::hash, 100), NumericalFailure);
}

TEST(BenchSolver, SweepsOverTheTimeOfTheSweepsAlone) {
  SceneResult r{.name = "x", .threads = {1, 2}, .executions = {"graph"}};
  r.processes = {{.threads = 1, .nonsmooth = true, .time_step = 1e-3, .particles = 1000}, {.threads = 2, .nonsmooth = true, .time_step = 1e-3, .particles = 1000}};
  for (const double slow : {1.0, 1.5, 3.0})
    for (const bool cold : {false, true})
      for (const int threads : {1, 2}) {
        Window w = window(threads, threads == 1 ? 1.6 * slow : slow);
        w.cold = cold;
        w.kernels = {{"broadphase", 0.1 * w.seconds, 0}, {"constraint_setup", 0.2 * w.seconds, 0}, {"contact_start", 0.1 * w.seconds, 0},
                     {"impact_solve", 0.05 * w.seconds, 0}, {"contact_solve", 0.5 * w.seconds, 0}, {"integrate", 0.05 * w.seconds, 0}};
        w.solver = {.sweeps = cold ? 4000 : 1000, .impact_sweeps = 50, .unsolved = 1, .contact_sweeps = cold ? 8e6 : 2e6, .residual = 1e-3 / slow};
        r.windows.push_back(w);
      }
  const SolverSummary warm = summarize_solver(r, 2, false), cold = summarize_solver(r, 2, true);
  EXPECT_DOUBLE_EQ(warm.rate.median, 2e6 / (0.5 * 1.5));
  EXPECT_NEAR(warm.efficiency->least, 0.8, 1e-12);
  EXPECT_FALSE(summarize_solver(r, 1, false).efficiency);
  EXPECT_DOUBLE_EQ(warm.seconds_per_second.median, 1.5 / (100 * 1e-3));
  EXPECT_DOUBLE_EQ(warm.contacts, 2000);
  EXPECT_DOUBLE_EQ(warm.sweeps, 10);                         // of a step
  EXPECT_DOUBLE_EQ(cold.sweeps, 40);
  EXPECT_DOUBLE_EQ(warm.impact_sweeps, 0.5);
  EXPECT_EQ(warm.residual, 1e-3);
  EXPECT_EQ(warm.unsolved, 3);
  EXPECT_EQ(warm.steps, 300);
  EXPECT_NEAR(warm.detection, 0.1, 1e-12);
  EXPECT_NEAR(warm.setup, 0.3, 1e-12);
  EXPECT_NEAR(warm.impact, 0.05, 1e-12);
  EXPECT_NEAR(warm.solve, 0.5, 1e-12);
  EXPECT_NEAR(warm.rest, 0.05, 1e-12);
  EXPECT_EQ(summarize(r, 2, "graph").windows, 3u) << "rates are of the warm start";
  const std::string text = text_of(r, false);
  for (std::size_t at = 0, end; (end = text.find('\n', at)) != std::string::npos; at = end + 1)
    EXPECT_LE(end - at, 114u) << text.substr(at, end - at);
  EXPECT_NE(text.find("nonsmooth DEM"), std::string::npos);
}

TEST(BenchReport, RowsHaveTheColumnsOfTheHead) {
  const std::string csv = csv_of({}, {drifting()});
  const auto commas = [&](std::size_t from, std::size_t to) {
    return std::count(csv.begin() + std::ptrdiff_t(from), csv.begin() + std::ptrdiff_t(to), ',');
  };
  const std::size_t first = csv.find('\n'), second = csv.find('\n', first + 1);
  EXPECT_EQ(commas(0, first), commas(first, second));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
}

TEST(BenchReport, TextFitsTheTerminal) {
  const std::string text = text_of(drifting(), true) + text_of(drifting(), false);
  for (std::size_t at = 0, end; (end = text.find('\n', at)) != std::string::npos; at = end + 1)
    EXPECT_LE(end - at, 114u) << text.substr(at, end - at);
  EXPECT_NE(text.find("3.80 contacts a particle (1.90 of 3.00 listed pairs)"), std::string::npos) << text;
  EXPECT_NE(text.find("a search every 20.0 steps, a listing every 5.00 steps"), std::string::npos) << text;
}

TEST(Roofline, ASmallerWorkingSetHasTheBandwidthOfItsCache) {
  const Limits l{{{1e6, 100e9}, {4e6, 50e9}, {16e6, 10e9}}, 1e9, 1e8};
  EXPECT_EQ(l.bandwidth_for(1), 100e9);
  EXPECT_EQ(l.bandwidth_for(5e6), 50e9);
  EXPECT_EQ(l.bandwidth_for(1e9), 10e9);
}

TEST(Roofline, ListingKernelsCostAsOftenAsTheyRun) {
  const Limits l{{{1e5, 1e9}}, 1e9, 1e9};
  SceneResult r = drifting();
  Summary s = summarize(r, 1, "graph");
  s.kernels = {{"contact_hashing", 1e-3, 1e-3}, {"somebody_elses_kernel", 1, 1}};
  const Roofline f = roofline(s, 1000, l);
  ASSERT_EQ(f.kernels.size(), 1u) << "what is not counted is left out";
  s.listings *= 5;                                           // every step
  EXPECT_NEAR(roofline(s, 1000, l).kernels[0].bytes, 5 * f.kernels[0].bytes, 1e-6);
}

TEST(BenchStart, LayersDoNotOverlapAndStayInside) {
  const double radius = 0.01;
  const auto column = spawn_column(900, 0.1, radius);
  ASSERT_EQ(column.size(), 900u);
  EXPECT_GE(nearest_pair(column), 2 * radius);
  for (const Vec3& x : column) EXPECT_LT(std::hypot(x.x, x.y), 0.1 - radius);
  const auto bed = spawn_bed(6, 5, 4, radius);
  ASSERT_EQ(bed.size(), 120u);
  EXPECT_GE(nearest_pair(bed), 2 * radius);
  const double x = 6 * spawn_spacing(radius), y = 5 * spawn_spacing(radius);
  for (const Vec3& at : bed) EXPECT_TRUE(at.x >= 0 && at.x < x && at.y >= 0 && at.y < y && at.z >= radius);
  const auto two = tiled(bed, x, y, 3, 2);
  ASSERT_EQ(two.size(), 720u);
  EXPECT_GE(nearest_pair(two), 2 * radius) << "what is periodic fits to itself";
}

TEST(BenchStates, ReadBackAsWritten) {
  const auto path = std::filesystem::temp_directory_path() / ("skred-state-" + std::to_string(getpid()) + ".h5");
  State s{.scene = "bed-1k", .steps = 6000, .time_step = 5e-5};
  s.position = {{1, 2, 3}, {0.1, 0.2, 0.3}};
  s.velocity = {{4, 5, 6}, {}};
  s.angular_velocity = {{}, {7, 8, 9}};
  s.radius = {0.5, 0.25};
  write_state(path, s);
  const State back = read_state(path);
  EXPECT_TRUE(back.position == s.position && back.velocity == s.velocity && back.angular_velocity == s.angular_velocity);
  EXPECT_EQ(back.radius, s.radius);
  EXPECT_EQ(back.steps, 6000);
  EXPECT_EQ(back.scene, "bed-1k");
  std::filesystem::remove(path);
}

TEST(BenchScenes, EachOneReads) {
  for (const BenchScene& s : bench_scenes()) {
    const auto tile = s.tile.empty() ? s : *find_bench_scene(s.tile);
    EXPECT_TRUE(tile.settling_steps > 0) << s.name;
    // No state is at hand; this file exists.
    const Scene scene = read_bench_scene(s, SKRED_SOURCE_DIR "/README.md", s.settling);
    EXPECT_EQ(scene.name, s.name);
    EXPECT_EQ(scene.time_step, 5e-5);
  }
}

TEST(ThreadList, AscendingAndOnce) {
  EXPECT_EQ(parse_thread_list("4,1,2,1"), (std::vector<int>{1, 2, 4}));
  for (const char* bad : {"", "1,", "0", "1;2", "two", "1025", "1,-1"}) EXPECT_THROW(parse_thread_list(bad), UsageError) << bad;
}

TEST(VectorOption, WhatThisMachineHas) {
  EXPECT_EQ(parse_vector("auto"), best_vector_path());
  EXPECT_EQ(parse_vector("scalar"), VectorPath::scalar);
  const std::vector older{VectorPath::scalar, VectorPath::sse2};
  EXPECT_EQ(parse_vector("auto", older), VectorPath::sse2);
  const auto message = [&](const char* text) -> std::string {
    try {
      parse_vector(text, older);
      return "";
    } catch (const UsageError& e) {
      return e.what();
    }
  };
  EXPECT_EQ(message("avx2"), "--vector: the processor has no 'avx2'; this machine has auto, scalar, sse2");
  EXPECT_EQ(message("neon"), "--vector: 'neon' is not allowed; this machine has auto, scalar, sse2");
  EXPECT_NE(message(""), "");
}
