// tests/scenes/flow_keys_test.cpp - removal, inflow and probes in a scene file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include "scenes/schema.h"
#include "tests/scenes/scene_text.h"

using testing::HasSubstr;

namespace skred {
namespace {

const std::string inflow = "inflow: [{name: feed, box: {min: [0, 0, 0], max: [1, 1, 1]}, radius: 1 cm, rate: 100 Hz}]\n";

TEST(FlowKeys, AreReadInSiUnits) {
  const Scene s = parse_scene(head + one_particle + R"(
remove:
  - {name: bin, half_space: {point: [0, 0, -10 cm], normal: [0, 0, -2]}, interval: 5 ms}
  - {name: trap, box: {min: [0, 0, 0], max: [1, 1, 1]}, start: 1 s, end: 2 s}
inflow:
  - name: feed
    cylinder: {point: [0, 0, 1], radius: 20 cm, length: 50 cm}
    radius: {min: 4 mm, max: 6 mm}
    mass_rate: 1.8 t/h
    number: 1000
    velocity: [0, 0, -1]
    seed: 7
probes:
  - {name: outlet, disc: {normal: [0, 0, -1], radius: .inf}}
  - {name: slot, rectangle: {normal: [0, 0, 1], along: [1, 0, 1], length: 0.2, width: 0.1}}
  - {name: bed, cylinder: {radius: 1, length: 2}}
)", "s.yaml");
  ASSERT_EQ(s.remove.size(), 2u);
  const auto& half = std::get<HalfSpaceRegion>(s.remove[0].region);
  EXPECT_EQ(half.point, (Vec3{0, 0, -0.1}));
  EXPECT_EQ(half.normal, (Vec3{0, 0, -1}));
  EXPECT_EQ(s.remove[0].interval, 0.005);
  EXPECT_EQ(s.remove[0].end, std::numeric_limits<double>::infinity());
  EXPECT_EQ(s.remove[1].start, 1);
  EXPECT_EQ(s.remove[1].end, 2);
  ASSERT_EQ(s.inflow.size(), 1u);
  EXPECT_EQ(s.inflow[0].material, "pellet");
  EXPECT_DOUBLE_EQ(s.inflow[0].mass_rate.value(), 0.5);
  EXPECT_FALSE(s.inflow[0].rate.has_value());
  EXPECT_EQ(s.inflow[0].number, 1000);
  EXPECT_EQ(s.inflow[0].seed, 7u);
  ASSERT_EQ(s.probes.size(), 3u);
  EXPECT_TRUE(std::isinf(std::get<Disc>(s.probes[0].place).radius));
  EXPECT_EQ(std::get<Rectangle>(s.probes[1].place).along, (Vec3{1, 0, 0}));
  EXPECT_EQ(std::get<CylinderRegion>(s.probes[2].place).length, 2);

  const std::string resolved = resolved_yaml(s);
  EXPECT_EQ(resolved_yaml(parse_scene(resolved, "s.yaml")), resolved);
}

TEST(FlowKeys, AnInflowNeedsNoParticles) {
  const Scene s = parse_scene(head + inflow, "s.yaml");
  EXPECT_TRUE(s.particles.empty());
  const std::string resolved = resolved_yaml(s);
  EXPECT_EQ(resolved_yaml(parse_scene(resolved, "s.yaml")), resolved);
}

TEST(FlowKeys, Errors) {
  const auto with = [](const std::string& text) { return errors_of(head + one_particle + text); };
  EXPECT_EQ(with(inflow), "");
  EXPECT_THAT(with("remove: [{name: a}]\n"), HasSubstr("needs one of the keys box, cylinder, half_space"));
  EXPECT_THAT(with("remove: [{box: {min: [0, 0, 0], max: [1, 1, 1]}}]\n"), HasSubstr("missing key 'name'"));
  EXPECT_THAT(with("remove: [{name: a, box: {min: [0, 0, 0], max: [1, 0, 1]}}]\n"), HasSubstr("min must be less than max"));
  EXPECT_THAT(with("remove: [{name: a, half_space: {}, start: 2, end: 1}]\n"), HasSubstr("start 2 s must be before end 1 s"));
  EXPECT_THAT(with("remove: [{name: a, half_space: {}, interval: -1}]\n"), HasSubstr("interval: -1 is out of range: must be >= 0 s"));
  EXPECT_THAT(with("remove: [{name: a, half_space: {}}]\nprobes: [{name: a, half_space: {}}]\n"), HasSubstr("are called 'a'"));
  EXPECT_THAT(with("probes: [{name: a, disc: {radius: 0}}]\n"), HasSubstr("must be > 0 m"));
  EXPECT_THAT(with("probes: [{name: a, rectangle: {normal: [1, 0, 0], length: 1, width: 1}}]\n"), HasSubstr("must not be parallel"));
  const auto feed = [&](const std::string& keys) {
    return with("inflow: [{name: feed, box: {min: [0, 0, 0], max: [1, 1, 1]}, radius: 1 cm, " + keys + "}]\n");
  };
  EXPECT_THAT(feed("number: 3"), HasSubstr("give one of the keys rate, mass_rate"));
  EXPECT_THAT(feed("rate: 1, mass_rate: 1"), HasSubstr("give one of the keys rate, mass_rate"));
  EXPECT_THAT(feed("rate: 0"), HasSubstr("rate: 0 is out of range: must be > 0 1/s"));
  EXPECT_THAT(feed("rate: 1, number: 0"), HasSubstr("number"));
  EXPECT_THAT(feed("rate: 1, material: gold"), HasSubstr("there is no material 'gold'"));
  EXPECT_THAT(with("inflow: [{name: feed, half_space: {}, radius: 1, rate: 1}]\n"), HasSubstr("unknown key 'half_space'"));
  EXPECT_THAT(with("inflow: [{name: feed, box: {min: [0, 0, 0], max: [1, 1, 1]}, radius: 0.6, rate: 1}]\n"), HasSubstr("no sphere of radius 0.6 m"));
}

}  // namespace
}  // namespace skred
