// tests/scenes/overrides_test.cpp - --set and the other options that change a scene.
#include <gtest/gtest.h>
#include "scenes/scene.h"
#include "tests/scenes/scene_text.h"

using namespace skred;

namespace {

const std::string scene =
    "parameters:\n"
    "  a: {value: 2, choices: [2, 4]}\n"
    "  r: \"= a / 100\"\n" +
    head +
    "particles: [{list: [{radius: \"= r\", position: [0, 0, 0]}]}]\n"
    "bodies:\n"
    "  - name: drum\n"
    "    motion: kinematic\n"
    "    geometries: [{plane: {}}]\n"
    "    pieces: [{angular_velocity: 1}]\n";

Scene with(const std::string& path, const std::string& value) {
  return parse_scene(scene, "s.yaml", {.overrides = {{path, value}}});
}
std::string error(const std::string& path, const std::string& value) { return errors_of(scene, {.overrides = {{path, value}}});
}

}  // namespace

TEST(Overrides, AParameterByItsNameAlone) {
  EXPECT_EQ(std::get<ParticleList>(with("a", "4").particles[0]).particles[0].radius, 0.04);
  EXPECT_EQ(std::get<ParticleList>(with("parameters.r", "5 mm").particles[0]).particles[0].radius, 0.005);
}

TEST(Overrides, KeysByPath) {
  EXPECT_EQ(with("bodies.drum.pieces.0.angular_velocity", "\"30 deg/s\"").bodies[0].pieces[0].angular_velocity,
            with("bodies.0.pieces.0.angular_velocity", "30 deg/s").bodies[0].pieces[0].angular_velocity);
  EXPECT_EQ(with("materials.pellet.friction", "0.5").materials[0].friction, 0.5);      // a key that is not in the file
  EXPECT_EQ(with("gravity", "[0, 0, -1]").gravity, (Vec3{0, 0, -1}));
  EXPECT_EQ(with("output.frame_interval", "1 ms").output.frame_interval, 1e-3);        // nor is its mapping
  EXPECT_EQ(with("particles.0.list.0.position.2", "1 cm").particles.size(), 1u);
  EXPECT_EQ(std::get<ParticleList>(with("particles.0.list.0.position.2", "1 cm").particles[0]).particles[0].position.z, 0.01);
}

TEST(Overrides, OtherOptionsWin) {
  const Scene s = parse_scene(scene, "s.yaml", {.overrides = {{"time_step", "1 ms"}, {"seed", "3"}},
                                                .method = "ndem", .time_step = "2 ms", .end_time = "0.5",
                                                .seed = "18446744073709551615"});
  EXPECT_EQ(s.method, Method::ndem);
  EXPECT_EQ(s.time_step, 2e-3);
  EXPECT_EQ(s.end_time, 0.5);
  EXPECT_EQ(s.seed, 18446744073709551615u);
}

TEST(Overrides, ErrorsNameTheOption) {
  EXPECT_EQ(error("a", "7"), "--set a=7: error: a: 7 is not one of 2, 4");
  EXPECT_EQ(error("b", "7"), "--set b=7: error: there is no key or parameter 'b'; did you mean 'a'?");
  EXPECT_EQ(error("gravitie", "7"), "--set gravitie=7: error: there is no key or parameter 'gravitie'; did you mean 'gravity'?");
  EXPECT_EQ(error("parameters.q", "7"), "--set parameters.q=7: error: there is no parameter 'q'; did you mean 'a'?");
  EXPECT_EQ(error("materials.pelet.friction", "0"),
            "--set materials.pelet.friction=0: error: materials has no item 'pelet'; did you mean 'pellet'?");
  EXPECT_EQ(error("bodies.3.motion", "static"),
            "--set bodies.3.motion=static: error: bodies has 1 items, counted from 0; there is no 3");
  EXPECT_EQ(error("materials.pellet.fricton", "0"),
            "--set materials.pellet.fricton=0: error: materials: unknown key 'fricton'; did you mean 'friction'?");
  EXPECT_EQ(error("materials.pellet.friction", "-1"),
            "--set materials.pellet.friction=-1: error: friction: -1 is out of range: must be >= 0");
  EXPECT_EQ(error("end_time.x", "1"), "--set end_time.x=1: error: end_time is the value '1'; there is no 'x' in it");
  EXPECT_EQ(error("end_time", "[1").substr(0, 30), "--set end_time=[1: error: YAML");
  EXPECT_EQ(error("end_time", "").substr(0, 28), "--set end_time=: error: end_");
  EXPECT_EQ(error("a..b", "1"), "--set a..b=1: error: a path is keys joined by dots");
  EXPECT_EQ(errors_of(scene, {.method = "sdm"}),
            "--method sdm: error: method: 'sdm' is not one of sdem, ndem; did you mean 'sdem'?");
  EXPECT_EQ(errors_of(scene, {.time_step = "5 m"}),
            "--time-step 5 m: error: time_step: '5 m' is a length [m]; expected a time [s]");
  EXPECT_EQ(errors_of(scene, {.seed = "-1"}), "--seed -1: error: seed: -1 is out of range: must be >= 0");
}
