// tests/scenes/schema_test.cpp - what the table of keys gives: explanations, and resolved scenes that read back.
#include "scenes/schema.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include "scenes/fill.h"
#include "scenes/read_scene.h"
#include "tests/scenes/scene_text.h"

using namespace skred;
using testing::HasSubstr;

namespace {

const std::string scenes = std::string(SKRED_SOURCE_DIR) + "/scenes/";

// A resolved scene must read back, from any folder, as the same scene.
void expect_round_trip(const Scene& s) {
  const std::string text = resolved_yaml(s);
  const Scene t = parse_scene(text, "/elsewhere/scene.resolved.yaml");
  EXPECT_EQ(resolved_yaml(t), text);
  EXPECT_EQ(t.name, s.name);
  EXPECT_EQ(t.seed, s.seed);
  const ParticleSet a = make_particles(s), b = make_particles(t);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.angular_velocity, b.angular_velocity);
  EXPECT_EQ(a.radius, b.radius);
  EXPECT_EQ(a.material, b.material);
  ASSERT_EQ(s.bodies.size(), t.bodies.size());
  for (std::size_t k = 0; k < s.bodies.size(); ++k) {
    EXPECT_EQ(s.bodies[k].pose, t.bodies[k].pose);
    ASSERT_EQ(s.bodies[k].geometries.size(), t.bodies[k].geometries.size());
    for (std::size_t g = 0; g < s.bodies[k].geometries.size(); ++g) {
      EXPECT_EQ(s.bodies[k].geometries[g].local, t.bodies[k].geometries[g].local);
      EXPECT_EQ(s.bodies[k].geometries[g].shape.index(), t.bodies[k].geometries[g].shape.index());
    }
  }
}

}  // namespace

TEST(ResolvedScene, ShippedScenesReadBack) {
  expect_round_trip(read_scene(scenes + "hello.yaml"));
  for (const char* wall : {"boxes", "cylinder", "mesh"}) {
    const Scene s = read_scene(scenes + "drum.yaml", {.overrides = {{"wall", wall}, {"a", "4"}}, .seed = "12345678901234567890"});
    EXPECT_EQ(s.bodies[0].geometries.size(), std::string(wall) == "boxes" ? 202u : 3u);
    expect_round_trip(s);
  }
  for (const char* wall : {"mesh", "cylinder"})
    expect_round_trip(read_scene(scenes + "silo.yaml", {.overrides = {{"wall", wall}}}));
}

TEST(ResolvedScene, EveryKeyReadsBack) {
  const SceneFolder folder;
  folder.write("p.csv", "x,y,z\n1,2,3\n");
  folder.write("q.csv", "x,y,z,material\n1,2,9,b\n");
  expect_round_trip(parse_scene(R"(
name: all.keys-1
description: "a: \"b\", c"
method: ndem
parameters: {n: 7}
end_time: 0.1
expected_speed: 1/3 m/s
seed: "= n * 6"
gravity: ["= 1 / n", 0, -1]
effects: all
contact: {normal: none, tangential: none, rolling: none}
periodic: {y: ["= -1 / n", "= 1 / n"]}
bounds: {min: [-9, -9, -9], max: [9, 9, 9], action: report}
materials:
  - {name: a, density: 1, youngs_modulus: 1, poissons_ratio: -0.5, restitution: 0, friction: 1, rolling_friction: 1,
     rolling_damping: 0.3, rolling_damping_at_limit: 1, normal_stiffness: 3, tangential_damping: 0, rolling_viscosity: 2}
  - {name: b, density: 1, youngs_modulus: 1, damping_time: 2}
pairs: [{between: [b, a], restitution: 0.1, rolling_friction: 0, normal_stiffness: 1, damping_time: 0, rolling_damping: 0.1}]
particles:
  - lattice: {material: b, radius: {min: 0.01, max: 0.03}, min: [0, 0, 0], max: [1, 1, 1], spacing: 0.1, jitter: 0.01,
              cylinder: {point: [0.5, 0.5, 0], axis: [1, 1, 5], radius: 0.3}, velocity: [1, 2, 3], angular_velocity: [0, 1, 0]}
  - list: [{material: a, radius: 1, position: [3, 3, 3]}]
  - file: {path: p.csv, material: a, radius: 0.1}
  - file: {path: q.csv, radius: 0.1}
bodies:
  - name: d
    motion: dynamic
    position: [1, 2, 3]
    orientation: {axis: [1, 2, 3], angle: 1}
    mass: 2
    inertia: [1, 1, 1]
    velocity: [1, 0, 0]
    angular_velocity: [0, 0, 1 rpm]
    geometries: [{material: b, box: {size: [0.1, 0.2, 0.3]}, orientation: {axis: [3, 1, 1], angle: 2},
                  ring: {count: 7, axis: [1, 1, 1]}}]
  - name: k
    motion: kinematic
    pieces: [{start: -1, end: 0.3}, {start: 1, velocity: [1, 1, 1], angular_velocity: 3, axis: [1, 2, 2.5], point: [0, 0, 1], frequency: 3, phase: 90 deg}]
    geometries: [{material: a, plane: {normal: [1, 2, 3], point: [4, 5, 6]}}, {material: a, cylinder: {radius: 1, length: 2}}]
start: {overlap_limit: 0.5, relax: true}
limits: {overlap: 0.2}
search: {skin: 0.001, cell_size: 0.1, reorder_every: 5}
output: {frame_interval: 0.1, statistics_interval: 0.2, contacts: true, orientation: true, energy: true, precision: double}
)", (folder.path / "s.yaml").string(), {.overrides = {{"expected_speed", "0.3333"}}}));
}

TEST(Explain, AKey) {
  EXPECT_EQ(explain("materials.youngs_modulus"),
            "materials.youngs_modulus: number in Pa, > 0; required\n  Young's modulus Y.\n");
  EXPECT_THAT(explain("materials.poissons_ratio"), HasSubstr("number, > -1 and <= 0.5; default 0.25"));
  EXPECT_THAT(explain("gravity"), HasSubstr("[x, y, z] in m/s^2; default [0, 0, -9.81]"));
  EXPECT_THAT(explain("bodies.0.mass"), HasSubstr("only where motion is dynamic"));
  EXPECT_THAT(explain("bodies.geometries.box.size"), HasSubstr("Edge lengths"));
  EXPECT_THAT(explain("output"), HasSubstr("frame_interval"));
}

TEST(Explain, AllKeys) {
  const std::string all = explain();
  for (const char* key : {"name", "method", "parameters", "time_step", "materials", "particles", "bodies", "output"})
    EXPECT_THAT(all, HasSubstr(key));
}

TEST(Explain, AMissNamesTheNearest) {
  const auto error = [](const char* path) {
    try {
      return explain(path);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
  };
  EXPECT_EQ(error("materials.young_modulus"), "there is no key 'young_modulus' in materials; did you mean 'youngs_modulus'?");
  EXPECT_EQ(error("gravity.x"), "there is no key 'x' in gravity: it has no keys");
  EXPECT_THAT(error("matrials"), HasSubstr("did you mean 'materials'?"));
}

// Every key says what it is for, and what it is if it is not given.
TEST(Schema, EveryKeyIsExplained) {
  using Check = std::function<void(const std::vector<KeyDescription>&, const std::string&)>;
  const Check check = [&](const auto& keys, const std::string& where) {
    for (const KeyDescription& k : keys) {
      EXPECT_GT(k.explanation.size(), 5u) << where << k.name;
      EXPECT_FALSE(k.value.text.empty()) << where << k.name;
      const bool has_default = !k.default_text.empty() || !k.value.keys.empty() || k.name == "parameters";
      EXPECT_TRUE(k.required || k.alternative || has_default) << where << k.name;
      check(k.value.keys, where + k.name + ".");
    }
  };
  check(scene_keys().describe(), "");
}
