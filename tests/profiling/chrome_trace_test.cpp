// tests/profiling/chrome_trace_test.cpp
#include "profiling/chrome_trace.h"
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include "engine/io/temporary_folder.h"
#include "tests/profiling/fake_run.h"

using namespace skred;
using nlohmann::json;
using testing::HasSubstr;

namespace {

const TraceInfo info{.scene = "drum", .method = "sdem", .software = "skred 0.1.0", .processor = "a \"quoted\" \\ one",
                     .other = {{"particles", "95052"}}};

json trace_of(const Timeline& t, const TraceInfo& about = info) {
  std::ostringstream os;
  write_chrome_trace(os, t, about);
  return json::parse(os.str());
}

// Nanoseconds from the microseconds of the file.
std::int64_t ns(const json& us) { return std::llround(1000 * us.get<double>()); }

}  // namespace

TEST(ChromeTrace, SpansAreCompleteSortedAndNested) {
  Timeline t(3);
  test::FakeRun run(t, test::drum_kernels());
  t.trace(1, 4);
  for (int step = 0; step < 5; ++step) run.step(step, 0.1);
  const json trace = trace_of(t);

  std::map<int, std::vector<json>> rows;
  int metadata = 0;
  for (const json& e : trace.at("traceEvents")) {
    EXPECT_EQ(e.at("pid"), 1);
    if (e.at("ph") == "M") ++metadata;
    if (e.at("ph") == "X") rows[e.at("tid")].push_back(e);
  }
  EXPECT_EQ(metadata, 1 + 2 * 5);                             // process, 3 threads, writer, steps
  ASSERT_EQ(rows.size(), 4u);                                 // 3 threads and the steps; the writer did nothing

  std::size_t chunks = 0, calls = 0;
  for (const auto& [tid, events] : rows) {
    std::vector<std::int64_t> open;
    std::int64_t last = 0;
    for (const json& e : events) {
      const std::int64_t begin = ns(e.at("ts")), end = begin + ns(e.at("dur"));
      EXPECT_GE(begin, last);
      last = begin;
      while (!open.empty() && open.back() <= begin) open.pop_back();
      if (!open.empty()) {
        EXPECT_LE(end, open.back()) << e;
      }
      open.push_back(end);
      if (tid == 4) continue;
      EXPECT_GE(e.at("args").at("rows"), 1);
      EXPECT_TRUE(e.contains("cname"));
      (e.at("cat") == "call" ? calls : chunks) += 1;
      if (e.at("cat") == "chunk" && tid == 0) {
        EXPECT_EQ(open.size(), 2u) << "a chunk of the main thread lies in its call: " << e;
      }
    }
  }
  std::size_t expected = 0;
  for (const auto& k : test::drum_kernels()) expected += static_cast<std::size_t>(k.chunks);
  EXPECT_EQ(chunks, 3 * expected);
  EXPECT_EQ(calls, 3 * test::drum_kernels().size());

  ASSERT_EQ(rows[4].size(), 3u);
  EXPECT_EQ(rows[4][0].at("name"), "step 1");
  EXPECT_EQ(ns(rows[4][0].at("ts")), 0);
  for (const json& e : rows[0]) {
    const json& step = rows[4].at(e.at("args").at("step").get<std::size_t>() - 1);
    EXPECT_GE(ns(e.at("ts")), ns(step.at("ts")));
    EXPECT_LE(ns(e.at("ts")) + ns(e.at("dur")), ns(step.at("ts")) + ns(step.at("dur")));
  }
}

TEST(ChromeTrace, SpansThatStickOutAreClipped) {
  Timeline t(1);
  const KernelId k = t.kernel("k");
  t.trace(0, 1);
  t.begin_step(0);
  const Ticks at = Timeline::now();
  t.chunk(0, k, at + 500000, at + 1500000, 1);                // its call ends earlier
  t.call(0, k, at, at + 1000000, 1);
  t.end_step();
  std::int64_t call_end = 0, chunk_end = 0;
  const json trace = trace_of(t);
  for (const json& e : trace.at("traceEvents")) {
    if (e.value("cat", "") == "call") call_end = ns(e.at("ts")) + ns(e.at("dur"));
    if (e.value("cat", "") == "chunk") chunk_end = ns(e.at("ts")) + ns(e.at("dur"));
  }
  EXPECT_GT(call_end, 0);
  EXPECT_EQ(chunk_end, call_end);
}

TEST(ChromeTrace, NamesCountersAndDescription) {
  Timeline t(2);
  const KernelId k = t.kernel("odd \"name\" \\ \n");
  t.trace(7, 8);
  t.begin_step(7);
  const Ticks at = Timeline::now();
  t.chunk(2, k, at, Timeline::now(), 5);
  t.counter("kinetic energy [J]", 1.25e-7);
  t.counter("nothing", std::numeric_limits<double>::quiet_NaN());
  t.end_step();
  const json trace = trace_of(t);
  std::map<int, std::string> names;
  std::map<int, int> order;
  int counters = 0, spans = 0;
  for (const json& e : trace.at("traceEvents")) {
    if (e.at("name") == "thread_name") names[e.at("tid")] = e.at("args").at("name");
    if (e.at("name") == "thread_sort_index") order[e.at("tid")] = e.at("args").at("sort_index");
    if (e.at("name") == "process_name") {
      EXPECT_EQ(e.at("args").at("name"), "drum sdem, 2 threads");
    }
    if (e.at("ph") == "C") {
      ++counters;
      EXPECT_EQ(e.at("name"), "kinetic energy [J]");
      EXPECT_EQ(e.at("args").at("value"), 1.25e-7);
    }
    if (e.value("cat", "") == "chunk") {
      ++spans;
      EXPECT_EQ(e.at("name"), "odd \"name\" \\ \n");
      EXPECT_EQ(e.at("tid"), 2);
    }
  }
  EXPECT_EQ(counters, 1);
  EXPECT_EQ(spans, 1);
  EXPECT_EQ(names, (std::map<int, std::string>{{0, "thread 0 (main)"}, {1, "thread 1"}, {2, "writer"}, {3, "steps"}}));
  EXPECT_EQ(order, (std::map<int, int>{{3, 0}, {0, 1}, {1, 2}, {2, 3}}));
  EXPECT_EQ(trace.at("displayTimeUnit"), "ns");
  EXPECT_EQ(trace.at("otherData").at("particles"), "95052");
  EXPECT_EQ(trace.at("otherData").at("processor"), info.processor);
  EXPECT_EQ(trace_of(t, {.title = "mine"}).at("traceEvents").at(0).at("args").at("name"), "mine");
}

TEST(ChromeTrace, NothingTracedIsStillAFile) {
  EXPECT_NO_THROW(trace_of(Timeline(1)));
}

TEST(ChromeTrace, FilesAndTheirErrors) {
  Timeline t(1);
  const TemporaryFolder folder;
  write_chrome_trace(folder / "trace.json", t, info);
  std::ifstream file(folder / "trace.json");
  EXPECT_TRUE(json::parse(file).contains("traceEvents"));
  try {
    write_chrome_trace("/no/such/folder/trace.json", t, info);
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), HasSubstr("/no/such/folder/trace.json"));
    EXPECT_THAT(e.what(), HasSubstr("No such file"));
  }
  if (std::filesystem::exists("/dev/full")) {
    try {
      write_chrome_trace("/dev/full", t, info);
      FAIL();
    } catch (const std::runtime_error& e) {
      EXPECT_THAT(e.what(), HasSubstr("No space left"));
    }
  }
}
