// tests/scenes/read_scene_test.cpp - what a good scene means, and what is said about bad ones.
#include "scenes/read_scene.h"
#include <fstream>
#include <iterator>
#include <numbers>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include "engine/random.h"
#include "tests/scenes/scene_text.h"

using namespace skred;
using testing::HasSubstr;

TEST(ReadScene, FillsTheStructs) {
  const Scene s = parse_scene(R"(
name: test-1
method: ndem
end_time: 2 s
time_step: 50 us
gravity: [0, -1 g_n, 0]
effects: all
contact: {rolling: none}
periodic: {x: [-1 cm, 1 cm]}
bounds: {min: [-1, -1, -1], max: [1, 1, 1], action: report}
materials:
  - {name: a, density: 2 g/cm^3, youngs_modulus: 1 MPa, poissons_ratio: 0.3, restitution: 0.5, friction: 0.4,
     rolling_friction: 0.1}
  - {name: b, density: 1, youngs_modulus: 1}
pairs:
  - {between: [a, b], friction: 0.7}
particles:
  - lattice: {material: a, radius: {min: 1 mm, max: 2 mm}, min: [0, 0, 0], max: [1, 1, 1], spacing: 0.25, cylinder: {radius: 0.5}}
bodies:
  - name: ball
    motion: dynamic
    position: [0, 0, 2]
    mass: 3 kg
    velocity: [0, 0, -1]
    geometries: [{material: b, sphere: {radius: 10 cm}}]
  - name: wall
    geometries:
      - {material: b, plane: {normal: [0, 0, -2], point: [0, 0, 5]}}
      - {material: b, box: {size: [2, 4, 6]}, orientation: {axis: [0, 0, 3], angle: 90 deg}}
      - {material: b, hollow_cylinder: {radius: 2, length: 1}}
start: {relax: true}
limits: {overlap: 50 %}
search: {skin: 1 mm, reorder_every: 0}
output: {frame_interval: 0.1, contacts: true, orientation: true, precision: double}
)", "folder/s.yaml");
  EXPECT_EQ(s.name, "test-1");
  EXPECT_EQ(s.method, Method::ndem);
  EXPECT_EQ(s.time_step, 50e-6);
  EXPECT_EQ(s.gravity, (Vec3{0, -9.80665, 0}));
  EXPECT_TRUE(s.all_effects);
  EXPECT_EQ(s.contact.rolling, RollingLaw::none);
  EXPECT_EQ(s.contact.normal, NormalLaw::hertz);
  EXPECT_TRUE(s.periodic[0].on && !s.periodic[1].on);
  EXPECT_EQ(s.periodic[0].max, 0.01);
  EXPECT_EQ(s.bounds->max.z, 1);
  EXPECT_EQ(s.out_of_bounds, OutOfBounds::report);
  EXPECT_EQ(s.materials[0].bulk.density, 2000);
  EXPECT_EQ(s.materials[1].bulk.poissons_ratio, 0.25);
  EXPECT_EQ(s.pairs[0].friction, 0.7);
  EXPECT_FALSE(s.pairs[0].restitution);
  const auto& fill = std::get<LatticeFill>(s.particles[0]);
  EXPECT_EQ(fill.radius.max, 2e-3);
  EXPECT_EQ(fill.cylinder->radius, 0.5);
  EXPECT_EQ(s.bodies[0].motion, BodyMotion::dynamic);
  EXPECT_EQ(s.bodies[0].mass, 3);
  const auto& wall = s.bodies[1].geometries;
  EXPECT_NEAR(norm(rotate(wall[0].local.orientation, {0, 0, 1}) - Vec3{0, 0, -1}), 0, 1e-15);
  EXPECT_EQ(wall[0].local.position, (Vec3{0, 0, 5}));
  EXPECT_EQ(std::get<BoxShape>(wall[1].shape).half_size, (Vec3{1, 2, 3}));
  EXPECT_NEAR(norm(rotate(wall[1].local.orientation, {1, 0, 0}) - Vec3{0, 1, 0}), 0, 1e-15);
  EXPECT_EQ(std::get<HollowCylinderShape>(wall[2].shape).thickness, 0.15);
  EXPECT_TRUE(s.start.relax);
  EXPECT_EQ(s.limits.overlap, 0.5);
  EXPECT_EQ(s.search.skin, 1e-3);
  EXPECT_EQ(s.search.reorder_every, 0);
  EXPECT_FALSE(s.output.single_precision);
}

TEST(ReadScene, NamesASceneByItsFileAndReadsJson) {
  EXPECT_EQ(parse_scene(head + one_particle, "a/my scene.v2.yaml").name, "my-scene.v2");
  const Scene s = parse_scene(R"({"end_time": 1, "materials": [{"name": "m", "density": 1, "youngs_modulus": 1e5}],
                                 "particles": [{"list": [{"radius": 0.5, "position": [1, 2, 3]}]}]})", "s.json");
  EXPECT_EQ(std::get<ParticleList>(s.particles[0]).particles[0].position, (Vec3{1, 2, 3}));
}

TEST(ReadScene, ARingIsCopiesAtEqualAngles) {
  const Scene s = parse_scene(head + one_particle +
                              "bodies: [{name: w, geometries: [{sphere: {radius: 1}, position: [3, 0, 1], "
                              "ring: {count: 4, axis: [0, 0, 2], point: [1, 0, 0]}}]}]\n", "s.yaml");
  const auto& g = s.bodies[0].geometries;
  ASSERT_EQ(g.size(), 4u);
  EXPECT_EQ(g[0].local.position, (Vec3{3, 0, 1}));
  EXPECT_NEAR(norm(g[1].local.position - Vec3{1, 2, 1}), 0, 1e-15);
  EXPECT_NEAR(norm(g[3].local.position - Vec3{1, -2, 1}), 0, 1e-15);
  EXPECT_NEAR(norm(rotate(g[1].local.orientation, {1, 0, 0}) - Vec3{0, 1, 0}), 0, 1e-15);
}

TEST(ReadScene, IfKeepsItems) {
  const std::string text = "parameters: {wall: {value: boxes, choices: [boxes, mesh, none]}, a: 2}\n" + head + one_particle +
                           "bodies:\n  - if: {wall: [boxes, mesh], a: 2}\n    name: w\n    geometries: [{plane: {}}]\n";
  const auto bodies = [&](const char* wall, const char* a) {
    return parse_scene(text, "s.yaml", {.overrides = {{"wall", wall}, {"a", a}}}).bodies.size();
  };
  EXPECT_EQ(bodies("boxes", "2"), 1u);
  EXPECT_EQ(bodies("mesh", "2"), 1u);
  EXPECT_EQ(bodies("none", "2"), 0u);
  EXPECT_EQ(bodies("mesh", "3"), 0u);
  EXPECT_EQ(errors_of("parameters: {wall: {value: boxes, choices: [boxes, mesh]}}\n" + head +
                      "particles: [{if: {wal: boxes}, list: []}, {if: {wall: boxs}, list: []}]\n"),
            "s.yaml:5:19: error: particles: if: unknown parameter 'wal'; did you mean 'wall'?\n"
            "  particles: [{if: {wal: boxes}, list: []}, {if: {wall: boxs}, list: []}]\n"
            "                    ^\n"
            "s.yaml:5:38: error: list: empty; at least one particle is needed\n"
            "  particles: [{if: {wal: boxes}, list: []}, {if: {wall: boxs}, list: []}]\n"
            "                                       ^\n"
            "s.yaml:5:55: error: particles: if: boxs is not a choice of wall; did you mean 'boxes'?\n"
            "  particles: [{if: {wal: boxes}, list: []}, {if: {wall: boxs}, list: []}]\n"
            "                                                        ^");
}

TEST(BadScene, UnknownKeyNamesTheNearest) {
  EXPECT_EQ(errors_of(head + one_particle + "gravty: [0, 0, 0]\n"),
            "s.yaml:5:1: error: unknown key 'gravty'; did you mean 'gravity'?\n  gravty: [0, 0, 0]\n  ^");
  EXPECT_THAT(errors_of(head + one_particle + "zzz: 1\n"), HasSubstr("unknown key 'zzz'; known: name, description, method"));
}

TEST(BadScene, WrongUnit) {
  EXPECT_EQ(errors_of(head + "particles: [{list: [{radius: 5 kg, position: [0, 0, 0]}]}]\n"),
            "s.yaml:4:30: error: radius: '5 kg' is a mass [kg]; expected a length [m]\n"
            "  particles: [{list: [{radius: 5 kg, position: [0, 0, 0]}]}]\n"
            "                               ^");
  EXPECT_THAT(errors_of(head + one_particle + "gravity: [0, 0, -1 g]\n"), HasSubstr("(g is the gram; standard gravity is g_n)"));
  EXPECT_THAT(errors_of(head + one_particle + "time_step: 5 mm\n"), HasSubstr("'5 mm' is a length [m]; expected a time [s]"));
  EXPECT_THAT(errors_of(head + one_particle + "time_step: 5 fs\n"), HasSubstr("unknown unit 'fs'"));
}

TEST(BadScene, OutOfRange) {
  const auto lattice_with = [](const std::string& line) {
    return errors_of(lattice("      radius: 0.01\n      min: [0, 0, 0]\n      max: [1, 1, 1]\n      spacing: 0.1\n" + line));
  };
  EXPECT_EQ(lattice_with(""), "");
  EXPECT_THAT(lattice_with("      jitter: 0.6\n"),
              HasSubstr("s.yaml:10:15: error: jitter: 0.6 is out of range: must be 0 .. 0.5"));
  EXPECT_THAT(errors_of(head + "particles: [{list: [{radius: -1 mm, position: [0, 0, 0]}]}]\n"),
              HasSubstr("radius: -1 mm is out of range: must be > 0 m"));
  EXPECT_THAT(errors_of("parameters: {a: -2}\n" + head + "particles: [{list: [{radius: \"= a / 4\", position: [0, 0, 0]}]}]\n"),
              HasSubstr("radius: '= a / 4' = -0.5 is out of range: must be > 0 m"));
  const auto material = [](const std::string& key) {
    return errors_of("end_time: 1\nmaterials: [{name: m, density: 1, youngs_modulus: 1, " + key + "}]\n" + one_particle);
  };
  EXPECT_EQ(material("poissons_ratio: 0.5"), "");
  EXPECT_THAT(material("poissons_ratio: -1"), HasSubstr("must be > -1 and <= 0.5"));
  EXPECT_THAT(material("restitution: 1.01"), HasSubstr("must be 0 .. 1"));
  EXPECT_THAT(material("friction: -0.1"), HasSubstr("must be >= 0"));
  EXPECT_THAT(material("friction: .nan"), HasSubstr("'.nan' is not a number"));
  EXPECT_THAT(material("friction: .inf"), HasSubstr("'.inf' is not a number"));
}

TEST(BadScene, WrongType) {
  EXPECT_THAT(errors_of(head + one_particle + "gravity: 9.81\n"),
              HasSubstr("gravity: expected three numbers [x, y, z], got '9.81'"));
  EXPECT_THAT(errors_of(head + one_particle + "gravity: [0, 1]\n"), HasSubstr("got a list of 2"));
  EXPECT_THAT(errors_of(head + one_particle + "bodies: {}\n"), HasSubstr("bodies: expected a list, got a mapping"));
  EXPECT_THAT(errors_of(head + one_particle + "output: 3\n"), HasSubstr("output: expected a mapping, got '3'"));
  EXPECT_THAT(errors_of(head + one_particle + "output: {contacts: yes}\n"),
              HasSubstr("contacts: expected true or false, got 'yes'"));
  EXPECT_THAT(errors_of(head + one_particle + "seed: 1.5\n"), HasSubstr("seed: 1.5 is not an integer"));
  EXPECT_THAT(errors_of(head + one_particle + "seed: 18446744073709551616\n"),
              HasSubstr("too large: must be <= 18446744073709551615"));
  EXPECT_THAT(errors_of(head + one_particle + "time_step:\n"), HasSubstr("time_step: expected a number in s, or auto, got nothing"));
  EXPECT_THAT(errors_of(head + one_particle + "contact: {normal: hooke}\n"), HasSubstr("'hooke' is not one of hertz, linear, kuwabara_kono, walton_braun, none"));
  EXPECT_THAT(errors_of(head + one_particle + "name: a/b\n"), HasSubstr("'a/b' is not a name"));
  EXPECT_THAT(errors_of("[1, 2]"), HasSubstr("a scene is a mapping of keys, not a list"));
}

TEST(ReadScene, StepOfNonsmoothDem) {
  const std::string text = head + one_particle + "method: ndem\ntime_step: 0.1\n";
  const auto step = [&](const std::string& line, const ReadOptions& o = {}) { return parse_scene(text + line, "s.yaml", o).solver_time_step; };
  for (const char* same : {"", "solver: {iterations: 3}\n", "solver: {time_step: same}\n"}) EXPECT_FALSE(step(same).has_value()) << same;
  for (const auto& automatic : {step("solver: {time_step: auto}\n"), step("", {.overrides = {{"solver.time_step", "auto"}}})}) {
    ASSERT_TRUE(automatic.has_value());
    EXPECT_FALSE(automatic->has_value());
  }
  EXPECT_EQ(step("solver: {time_step: 2 ms}\n"), std::optional(2e-3));
  EXPECT_FALSE(step("solver: {time_step: 2}\n", {.time_step = "1 ms"}).has_value());    // --time-step goes before it
  const auto error = [&](const std::string& value) { return errors_of(text + "solver: {time_step: " + value + "}\n"); };
  EXPECT_THAT(error("soon"), HasSubstr("s.yaml:7:21: error: time_step: 'soon' is not a number; expected a number in s such as 0.5, \"0.5 s\" or "
                                       "\"= 2 * a\", or auto, or same\n"));
  EXPECT_THAT(error("-1 ms"), HasSubstr("time_step: -1 ms is out of range: must be > 0 s, or auto, or same"));
  EXPECT_THAT(error("[1]"), HasSubstr("time_step: expected a number in s, or auto, or same, got a list"));
  EXPECT_THAT(error("2"), HasSubstr("s.yaml:7:21: error: solver.time_step: 2 s is longer than end_time, 1 s"));
  EXPECT_THAT(errors_of(text + "bounds: {min: [0, 0, 0], max: [soon, 0, 0]}\n"), testing::Not(HasSubstr("or none")));   // not that of a corner
}

TEST(BadScene, Empty) {
  EXPECT_EQ(errors_of(""), "s.yaml:1:1: error: the scene is empty");
  EXPECT_THAT(errors_of(head), HasSubstr("missing key 'particles'"));
  EXPECT_THAT(errors_of(head + "particles: []\n"), HasSubstr("particles: empty; at least one source of particles is needed"));
  EXPECT_THAT(errors_of(head + "particles: [{}]\n"), HasSubstr("needs one of the keys lattice, list, file"));
  EXPECT_THAT(errors_of(lattice("      {radius: 1, min: [0, 0, 0], max: [5, 5, 1], spacing: 1}\n")),
              HasSubstr("no sphere of radius 1 m fits between 0 and 1 m along z"));
  EXPECT_THAT(errors_of(lattice("      {radius: 1 nm, min: [0, 0, 0], max: [5, 5, 1], spacing: 10 nm}\n")),
              HasSubstr("at most 4294967294 particles"));
}

TEST(BadScene, MissingFiles) {
  try {
    read_scene("no/such.yaml");
    FAIL();
  } catch (const SceneError& e) {
    EXPECT_STREQ(e.what(), "no/such.yaml: error: cannot read the scene: No such file or directory");
  }
  EXPECT_THROW(read_scene("/"), SceneError);
  EXPECT_THAT(errors_of(head + "particles: [{file: {path: no.csv}}]\n", {}, "/scenes/s.yaml"),
              HasSubstr("/scenes/s.yaml:4:27: error: path: there is no file '/scenes/no.csv'"));
}

TEST(BadScene, Meshes) {
  const SceneFolder folder;
  folder.write("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n");
  folder.write("empty.obj", "# nothing\n");
  folder.write("good.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto error = [&](const std::string& mesh) {
    return errors_of(head + one_particle + "bodies: [{name: w, geometries: [{mesh: " + mesh + "}]}]\n", {},
                     (folder.path / "s.yaml").string());
  };
  EXPECT_EQ(error("{file: good.obj, scale: 2}"), "");
  EXPECT_THAT(error("{file: bad.obj}"), HasSubstr("s.yaml:5:47: error: mesh: "));
  EXPECT_THAT(error("{file: bad.obj}"), HasSubstr("degenerate"));
  EXPECT_THAT(error("{file: empty.obj}"), HasSubstr("s.yaml:5:47: error: mesh: "));
  EXPECT_THAT(error("{file: none.obj}"), HasSubstr("there is no file"));
  EXPECT_THAT(error("{file: good.obj, scale: 0}"), HasSubstr("scale: 0 is out of range: must be > 0"));
}

TEST(BadScene, Bodies) {
  const auto error = [](const std::string& body) {
    return errors_of(head + one_particle + "bodies: [{name: w, " + body + "}]\n");
  };
  EXPECT_THAT(error("geometries: []"), HasSubstr("geometries: empty; at least one geometry is needed"));
  EXPECT_THAT(error("geometries: [{plane: {}, box: {size: [1, 1, 1]}}]"), HasSubstr("'plane' and 'box' are alternatives"));
  EXPECT_THAT(error("geometries: [{plan: {}}]"), HasSubstr("unknown key 'plan'; did you mean 'plane'?"));
  EXPECT_THAT(error("geometries: [{plane: {normal: [0, 0, 0]}}]"), HasSubstr("normal: a direction must not be zero"));
  EXPECT_THAT(error("geometries: [{material: pelet, plane: {}}]"),
              HasSubstr("there is no material 'pelet'; did you mean 'pellet'?"));
  EXPECT_THAT(error("geometries: [{plane: {}}], orientation: [1, 1, 0, 0]"), HasSubstr("a quaternion must have length 1"));
  EXPECT_THAT(error("geometries: [{plane: {}}], mass: 1"), HasSubstr("key 'mass' applies only where motion is dynamic"));
  EXPECT_THAT(error("geometries: [{plane: {}}], motion: kinematic"), HasSubstr("missing key 'pieces'"));
  EXPECT_THAT(error("geometries: [{plane: {}}], motion: kinematic, pieces: [{start: 2, end: 1}]"),
              HasSubstr("start 2 s must be before end 1 s"));
  EXPECT_THAT(error("geometries: [{plane: {}}], motion: kinematic, pieces: [{axis: [0, 0, 0]}]"), HasSubstr("must not be zero"));
  EXPECT_THAT(error("geometries: [{plane: {}}], motion: kinematic, pieces: [{frequency: -1 Hz}]"), HasSubstr("frequency: -1 Hz is out of range: must be 0 .. 1.0e+06 Hz"));
  EXPECT_THAT(error("geometries: [{plane: {}}], motion: kinematic, pieces: [{start: -1e308}]"), HasSubstr("start: -1e308 is out of range"));
  EXPECT_THAT(error("geometries: [{plane: {}}], motion: kinematic, pieces: [{phase: 90 deg}]"),
              HasSubstr("key 'phase' applies only where frequency is not 0"));
  EXPECT_THAT(error("geometries: [{sphere: {radius: 1}}], motion: dynamic"),
              HasSubstr("missing key 'mass' (number in kg, > 0)"));
  EXPECT_EQ(error("geometries: [{sphere: {radius: 1}}], motion: dynamic, mass: 1"), "");
  EXPECT_THAT(error("geometries: [{plane: {}}], motion: dynamic, mass: 1, inertia: [1, 1, 1]"), HasSubstr("cannot have a plane"));
  EXPECT_THAT(error("geometries: [{sphere: {radius: 1}}, {sphere: {radius: 2}}], motion: dynamic, mass: 1"),
              HasSubstr("missing key 'inertia'"));
  EXPECT_THAT(error("geometries: [{sphere: {radius: 1}}], motion: dynamic, mass: 1, inertia: [1, 1, 3]"),
              HasSubstr("no body has"));
  EXPECT_THAT(errors_of(head + one_particle +
                        "bodies: [{name: w, geometries: [{plane: {}}]}, {name: w, geometries: [{plane: {}}]}]\n"),
              HasSubstr("two bodies are called 'w'"));
}

TEST(BadScene, Parameters) {
  EXPECT_EQ(errors_of("parameters:\n  b: \"= 2 * c\"\n  c: 1\n" + head + one_particle),
            "s.yaml:2:13: error: b: unknown name 'c' in the expression\n    b: \"= 2 * c\"\n              ^");
  EXPECT_THAT(errors_of("parameters: {a: {value: 3, choices: [1, 2]}}\n" + head + one_particle),
              HasSubstr("a: 3 is not one of 1, 2"));
  EXPECT_THAT(errors_of("parameters: {sin: 3}\n" + head + one_particle), HasSubstr("sin: a parameter's name is"));
  EXPECT_THAT(errors_of("parameters: {seed: 3}\n" + head + one_particle), HasSubstr("seed: a key of the scene has this name"));
  EXPECT_THAT(errors_of("parameters: {a: {vale: 3}}\n" + head + one_particle),
              HasSubstr("unknown key 'vale'; did you mean 'value'?"));
  // A bad parameter is one error, however often it is used.
  EXPECT_EQ(errors_of("parameters: {a: 3 zz}\n" + head + one_particle +
                      "time_step: = a\nexpected_speed: = 2 * a\n").find("error:", 30),
            std::string::npos);
}

TEST(BadScene, AllErrorsAtOnceInTheOrderOfTheFile) {
  const std::string text = errors_of(
      "end_time: -1\n"
      "materials:\n"
      "  - {name: pellet, density: 0, youngs_modulus: 6 m}\n"
      "  - {name: pellet, density: 1, youngs_modulus: 1}\n"
      "  - {density: 1, youngs_modulus: 1}\n"
      "particles: [{list: [{material: peltet, radius: 1, position: [0, 0]}]}]\n"
      "outputs: {}\n");
  std::vector<int> lines;
  for (std::size_t at = text.find("s.yaml:"); at != std::string::npos; at = text.find("s.yaml:", at + 1))
    lines.push_back(std::stoi(text.substr(at + 7)));
  EXPECT_EQ(lines, (std::vector<int>{1, 3, 3, 4, 5, 6, 6, 7}));
}

TEST(BadScene, TwentyErrorsAreShown) {
  std::string text = head + one_particle;
  for (int k = 0; k < 25; ++k) text += "zz" + std::to_string(k) + ": 1\n";
  try {
    parse_scene(text, "s.yaml");
    FAIL();
  } catch (const SceneError& e) {
    EXPECT_EQ(e.diagnostics().size(), 20u);
    EXPECT_THAT(e.what(), HasSubstr("... and 5 more errors"));
  }
}

// Whatever is done to a scene file, it is read or refused; nothing else escapes.
TEST(BadScene, DamagedFilesAreRefused) {
  const std::string path = std::string(SKRED_SOURCE_DIR) + "/scenes/drum.yaml";
  std::ifstream in(path);
  const std::string whole((std::istreambuf_iterator<char>(in)), {});
  ASSERT_GT(whole.size(), 1000u);
  const std::string junk = ":-[]{}&*#!|>'\"%@`=,?\n\t 0.9e(\\\xc3\x01";
  int refused = 0;
  for (std::uint64_t k = 0; k < 400; ++k) {
    std::string text = whole;
    if (k % 4 == 0) text.resize(std::size_t(uniform(1, 0, k, 0) * double(whole.size())));
    else for (std::uint64_t c = 0; c < k % 4; ++c)
      text[std::size_t(uniform(1, 1, k, c) * double(text.size()))] = junk[std::size_t(uniform(1, 2, k, c) * double(junk.size()))];
    refused += !errors_of(text, {.overrides = {{"wall", "cylinder"}}}, path).empty();
  }
  EXPECT_GT(refused, 100);
}

TEST(BadScene, SyntaxAndDuplicates) {
  EXPECT_THAT(errors_of(head + one_particle + "gravity: [0, 0\n"), HasSubstr("error: YAML syntax: "));
  EXPECT_THAT(errors_of(head + one_particle + "end_time: 2\n"),
              HasSubstr("s.yaml:5:1: error: key 'end_time' is given twice, first in line 1"));
}
