// A case and its verdicts, on a sphere in free fall.
#include "scenes/check/run_case.h"
#include <gmock/gmock.h>
#include "scenes/check/report.h"
#include "tests/scenes/scene_text.h"

namespace skred {
namespace {

const std::string fall =
    "parameters: {v0: 1, dense: 2500}\n"
    "end_time: 0.1 s\n"
    "time_step: \"= 2^-13\"\n"
    "materials: [{name: glass, density: \"= dense\", youngs_modulus: 1 MPa}]\n"
    "particles: [{list: [{radius: 1 cm, position: [0, 0, 0], velocity: [0, 0, \"= v0\"]}]}]\n";

CaseResult result_of(const std::string& check, const std::string& more = "") {
  const SceneFolder folder;
  return run_case(read_case(folder.write("fall.yaml", "check:\n  title: fall\n  group: contact\n  source: Galilei\n" + check + more + fall)));
}

TEST(RunCase, EveryMethodAndRowIsJudged) {
  const CaseResult r = result_of("  vary: {v0: [1, 2, 3]}\n"
                                 "  expect:\n"
                                 "    - {what: speed, value: \"vz(0)\", expected: \"v0 - 9.81 * t\", tolerance: 1e-9 %}\n"
                                 "    - {what: speed, value: \"vz(0)\", at_most: 1.5, method: sdem}\n");
  ASSERT_EQ(r.runs.size(), 6u);
  ASSERT_EQ(r.verdicts.size(), 9u);
  EXPECT_FALSE(r.passed());
  std::size_t failed = 0;
  for (const Verdict& v : r.verdicts) failed += !v.passed();
  EXPECT_EQ(failed, 1u);                              // v0 = 3 is above 1.5 at the end
  const auto groups = grouped(r);
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_EQ(groups.back().worst.label, "v0 = 3");
  EXPECT_EQ(groups.back().failed, 1u);
}

TEST(RunCase, WhatIsTrackedAndWorkedOut) {
  const CaseResult r = result_of("  methods: [sdem]\n"
                                 "  track_interval: 1 ms\n"
                                 "  track: {z: \"z(0)\", energy: \"kinetic_energy + potential_energy\"}\n"
                                 "  values: {top: 'greatest(\"z\")', twice: \"2 * top\"}\n"
                                 "  expect:\n"
                                 "    - {what: height, value: \"twice\", expected: \"v0^2 / 9.81\", tolerance: 0.1 %}\n"
                                 "    - {what: energy, value: 'swing(\"energy\", 0, 0.1)', at_most: 1e-12}\n");
  EXPECT_TRUE(r.passed());
  EXPECT_EQ(r.runs[0].series.at("z").value.size(), 104u);   // 819 steps: the start, every eighth, the end
}

TEST(RunCase, SeedsRunsMethodsAndThreads) {
  const CaseResult r = result_of("  seeds: 3\n"
                                 "  threads: [1, 2]\n"
                                 "  vary: {v0: [1, 2]}\n"
                                 "  values: {v: \"vz(0)\"}\n"
                                 "  expect:\n"
                                 "    - {what: mean, value: \"vz(0)\", expected: \"v0 - 9.81 * t\", tolerance: 1e-9, of: seeds}\n"
                                 "    - {what: line, value: 'slope(\"v against v0\")', expected: 1, tolerance: 1e-9, of: runs}\n"
                                 "    - {what: same, value: 'ndem(\"v\")', expected: 'sdem(\"v\")', tolerance: 1e-9, of: methods}\n");
  EXPECT_EQ(r.runs.size(), 2u * 2 * 3 * 2);
  EXPECT_TRUE(r.passed());
  std::size_t bits = 0;
  for (const Verdict& v : r.verdicts) bits += v.what == "same bits at 1, 2 threads [1]";
  EXPECT_EQ(bits, 2u);                                // of each method
  EXPECT_EQ(r.verdicts.size(), 4u + 2 + 2 + 2);        // methods are compared by their means over the seeds
}

// `skred run` with the seed of a label is that run.
TEST(RunCase, LabelsNameTheSeed) {
  const std::string check = "  seeds: 2\n  methods: [sdem]\n  expect: [{what: speed, value: \"vz(0)\", expected: 0, tolerance: 2}]\n";
  EXPECT_EQ(result_of(check).runs[0].label, "seed 1");           // the default of a scene
  const CaseResult r = result_of("  vary: {v0: [1]}\n" + check, "seed: 40\n");
  EXPECT_EQ(r.runs[0].label, "v0 = 1, seed 40");
  EXPECT_EQ(r.runs[1].label, "v0 = 1, seed 41");
  EXPECT_EQ(r.runs[1].seed, 41u);
}

// What `skred validate` refuses, `skred check` does not run.
TEST(RunCase, AnOverlapAtTheStartIsRefused) {
  const std::string check = "check: {title: f, group: contact, source: s, expect: [{what: x, value: 1, expected: 1}]}\n";
  const std::string pair = "end_time: 1 ms\ngravity: [0, 0, 0]\nmaterials: [{name: glass, density: 2500, youngs_modulus: 1 MPa}]\n"
                           "particles: [{list: [{radius: 0.01, position: [0, 0, 0]}, {radius: 0.01, position: [0.01, 0, 0]}]}]\n";
  const SceneFolder folder;
  const CaseResult refused = run_case(read_case(folder.write("pair.yaml", check + pair)));
  ASSERT_EQ(refused.verdicts.size(), 2u);
  EXPECT_THAT(refused.verdicts[0].failure, testing::HasSubstr("overlap at the start"));
  EXPECT_EQ(refused.verdicts[0].method, "sdem");
  EXPECT_TRUE(refused.verdicts[1].passed());          // nonsmooth DEM pushes them apart
  EXPECT_TRUE(run_case(read_case(folder.write("pair.yaml", check + "start: {overlap_limit: 1}\n" + pair))).passed());
}

TEST(RunCase, AnIntervalOfConfidenceMustLieWithinTheTolerance) {
  Verdict v{{0, 10.4, 10, 1, '='}, "", "", "", "", 0.5, 10};
  EXPECT_TRUE(v.passed());
  v.confidence = 0.7;
  EXPECT_FALSE(v.passed());
  v = {{0, 10.4, 10, 0, '<'}, "", "", "", "", 0, 1};
  EXPECT_FALSE(v.passed());
  v.reading.relation = '>';
  EXPECT_TRUE(v.passed());
}

TEST(RunCase, RunsThatFailAndFormulasWithoutMeaningFailTheCase) {
  const CaseResult refused = result_of("  methods: [sdem]\n  vary: {dense: [1e-9]}\n"
                                       "  expect: [{what: speed, value: \"vz(0)\", expected: 0, tolerance: 100}]\n");
  ASSERT_EQ(refused.verdicts.size(), 1u);
  EXPECT_THAT(refused.verdicts[0].failure, testing::HasSubstr("time_step"));
  const CaseResult unknown = result_of("  methods: [sdem]\n  expect: [{what: speed, value: \"vzz\", expected: 0}]\n");
  EXPECT_FALSE(unknown.passed());
  EXPECT_THAT(unknown.verdicts.at(0).failure, testing::HasSubstr("unknown name 'vzz'"));
  const CaseResult never = result_of("  methods: [sdem]\n  expect: [{what: speed, value: \"vz(0)\", expected: 0, when: \"v0 > 9\"}]\n");
  EXPECT_FALSE(never.passed());
}

TEST(RunCase, TheSectionIsChecked) {
  const auto errors = [](const std::string& check) { return errors_of("check:\n  title: fall\n  group: contact\n  source: Galilei\n" + check + fall); };
  EXPECT_THAT(errors("  expect: [{what: speed, value: \"1\"}]\n"), testing::HasSubstr("give one of expected, at_most and at_least"));
  EXPECT_THAT(errors("  vary: {a: [1, 2], b: [1]}\n  expect: [{what: x, value: 1, expected: 1}]\n"), testing::HasSubstr("1 values, but 'a' has 2"));
  EXPECT_THAT(errors("  expect: [{what: x, value: 1, expected: 1, of: run_s}]\n"), testing::HasSubstr("did you mean"));
  const SceneFolder folder;
  EXPECT_THROW(read_case(folder.write("plain.yaml", fall)), SceneError);
}

// In a direction that is not periodic a particle may be anywhere, also where another direction is periodic.
TEST(RunCase, NegativePositionsBesideAPeriodicDirection) {
  const std::string text = "check: {title: f, group: contact, source: s, expect: [{what: x, value: \"x(0) - 2 * y(0)\", expected: \"-0.3 - 2 * 0.2\", tolerance: 1e-12}]}\n"
                           "end_time: 1 ms\nperiodic: {y: [0, 1]}\ngravity: [0, 0, 0]\n"
                           "materials: [{name: glass, density: 2500, youngs_modulus: 1 MPa}]\n"
                           "particles: [{list: [{radius: 0.01, position: [-0.3, 1.2, 0]}, {radius: 0.01, position: [0.4, 0.5, -7]}]}]\n";
  const SceneFolder folder;
  EXPECT_TRUE(run_case(read_case(folder.write("box.yaml", text))).passed());
}

TEST(RunCase, AStoppedCaseHasNoVerdict) {
  const SceneFolder folder;
  const CheckCase c = read_case(folder.write("fall.yaml", "check: {title: f, group: contact, source: s, expect: [{what: x, value: 1, expected: 1}]}\n" + fall));
  EXPECT_TRUE(run_case(c, [] { return true; }).verdicts.empty());
}

}  // namespace
}  // namespace skred
