// tests/profiling/profile_table_test.cpp
#include "profiling/profile_table.h"
#include <sstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using namespace skred;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

namespace {

Timeline::Totals totals() {
  Timeline::Totals t;
  t.lines = {{.name = "integrate", .count = 1000, .rows = 95052000, .total = 0.5, .busy = 0.9, .mean = 0.5e-3, .median = 0.49e-3,
              .p95 = 0.6e-3, .max = 0.01, .share = 0.09, .efficiency = 0.9, .idle = 0.1},
             {.name = "write_frame", .writer = true, .count = 3, .rows = 3, .total = 0.3, .busy = 0.3, .mean = 0.1, .median = 0.1,
              .p95 = 0.1, .max = 0.1, .efficiency = 1},
             {.name = "force_calculation_particle_particle", .count = 1000, .rows = 1, .total = 5, .busy = 9.1, .mean = 5e-3,
              .median = 4.9e-3, .p95 = 6e-3, .max = 0.02, .share = 0.91, .efficiency = 0.91, .idle = 0.9}};
  t.steps = 1000;
  t.spans = 1234567;
  t.wall = 5.6;
  t.busy = 10.0;
  t.span_cost = 31.2e-9;
  t.cost = t.spans * t.span_cost / t.wall;
  return t;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

}  // namespace

TEST(ProfileTable, ColumnsAlignedCostliestFirstWriterLast) {
  const auto lines = lines_of(profile_table(totals(), 2));
  ASSERT_EQ(lines.size(), 7u);
  std::istringstream head(lines[0]);
  std::vector<std::string> words;
  for (std::string w; head >> w;) words.push_back(w);
  EXPECT_THAT(words, ElementsAre("kernel", "count", "total", "mean", "median", "share", "efficiency", "idle"));
  EXPECT_EQ(lines[1].find_first_not_of('-'), std::string::npos);
  EXPECT_THAT(lines[2], StartsWith("force_calculation_particle_particle"));
  EXPECT_THAT(lines[3], StartsWith("integrate"));
  EXPECT_THAT(lines[4], StartsWith("write_frame"));
  for (const char* cell : {" 1000 ", " 5.00 s ", " 5.00 ms", " 4.90 ms", " 91.0 %", " 900 ms"})
    EXPECT_THAT(lines[2], HasSubstr(cell));
  EXPECT_THAT(lines[3], HasSubstr(" 500 us"));
  EXPECT_THAT(lines[4], HasSubstr("beside"));
  // Right-aligned: the share column ends where its heading ends.
  const auto share_end = lines[0].find("share") + 5;
  EXPECT_EQ(lines[2].substr(share_end - 6, 6), "91.0 %");
  EXPECT_EQ(lines[3].substr(share_end - 6, 6), " 9.0 %");
}

TEST(ProfileTable, ClosesWithTheWholeAndItsOwnCost) {
  const std::string text = profile_table(totals(), 2);
  EXPECT_THAT(text, HasSubstr("total: 1000 steps in 5.60 s on 2 threads, 5.60 ms a step; busy 89.3 %, idle 10.7 %\n"));
  EXPECT_THAT(text, HasSubstr("profiling: 1.23 M spans, 31.2 ns each, 0.7 % of the wall time\n"));
  EXPECT_THAT(text, Not(HasSubstr("missing")));
  auto lossy = totals();
  lossy.dropped = 17;
  EXPECT_THAT(profile_table(lossy, 2), HasSubstr("17 spans found no room"));
}

TEST(ProfileTable, NothingRunIsNoDivisionByZero) {
  const std::string text = profile_table({}, 4);
  EXPECT_THAT(text, HasSubstr("total: 0 steps in 0 s on 4 threads"));
  EXPECT_THAT(text, Not(HasSubstr("nan")));
}

TEST(ProfileTable, JsonHasEveryFieldInOrderOfTheStep) {
  const auto json = profile_json(totals());
  ASSERT_EQ(json.size(), 3u);
  EXPECT_EQ(json[0].at("name"), "integrate");
  EXPECT_EQ(json[2].at("name"), "force_calculation_particle_particle");
  EXPECT_EQ(json[0].at("count"), 1000);
  EXPECT_EQ(json[0].at("rows"), 95052000);
  EXPECT_EQ(json[0].at("total"), 0.5);
  EXPECT_EQ(json[0].at("p95"), 0.6e-3);
  for (const char* key : {"name", "count", "total", "mean", "median", "p95", "max", "share", "efficiency", "idle", "rows"})
    EXPECT_TRUE(json[1].contains(key)) << key;
}
