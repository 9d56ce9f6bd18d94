// tests/scenes/pairs_test.cpp - coefficients of pairs of materials.
#include "scenes/pairs.h"
#include <cmath>
#include <gtest/gtest.h>
#include "tests/scenes/scene_text.h"

using namespace skred;

TEST(Pairs, GeometricMeanUnlessGiven) {
  const Scene s = parse_scene(R"(
end_time: 1
materials:
  - {name: a, density: 1, youngs_modulus: 1 MPa, restitution: 0.18, friction: 0.9, rolling_friction: 0.3}
  - {name: b, density: 1, youngs_modulus: 2 MPa, restitution: 0.5, friction: 0}
  - {name: c, density: 1, youngs_modulus: 3 MPa, restitution: 0.18, friction: 0.4, rolling_friction: 0.3}
pairs:
  - {between: [c, b], friction: 0.7}
  - {between: [b, b], restitution: 0.25}
particles: [{list: [{material: a, radius: 1, position: [0, 0, 0]}]}]
)", "s.yaml");
  const PairTable t = resolve_pairs(s);
  ASSERT_EQ(t.count, 3u);
  EXPECT_EQ(t(0, 0).friction, 0.9);                      // equal values stay, to the bit
  EXPECT_EQ(t(0, 2).restitution, 0.18);
  EXPECT_EQ(t(0, 1).friction, 0);                        // zero stays zero
  EXPECT_EQ(t(0, 2).friction, std::sqrt(0.9 * 0.4));
  EXPECT_EQ(t(0, 1).restitution, std::sqrt(0.18 * 0.5));
  EXPECT_EQ(t(1, 2).friction, 0.7);
  EXPECT_EQ(t(1, 2).restitution, std::sqrt(0.5 * 0.18));
  EXPECT_EQ(t(1, 1).restitution, 0.25);
  EXPECT_EQ(t(1, 1).friction, 0);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) EXPECT_EQ(t(i, j), t(j, i));
  EXPECT_NEAR(t(0, 0).young_eff, 1e6 / (2 * (1 - 0.0625)), 1e-9 * 1e6);
}

// Coefficients that only some laws need: of the pair, else the mean of both materials', else none.
TEST(Pairs, CoefficientsOfSomeLaws) {
  const std::string scene = R"(
end_time: 1
materials:
  - {name: a, density: 1, youngs_modulus: 1 MPa, normal_stiffness: 4 kN/m, rolling_damping: 0.4}
  - {name: b, density: 1, youngs_modulus: 1 MPa, normal_stiffness: 1 kN/m, rolling_damping: 0.1}
  - {name: c, density: 1, youngs_modulus: 1 MPa}
particles: [{list: [{material: a, radius: 1, position: [0, 0, 0]}]}]
)";
  const std::string pairs = "pairs: [{between: [c, c], normal_stiffness: 5}, {between: [a, c], normal_stiffness: 6}";
  const PairTable t = resolve_pairs(parse_scene(scene + pairs + ", {between: [c, b], normal_stiffness: 7, rolling_damping: 0.3}]", "s.yaml",
                                                {.overrides = {{"contact.normal", "linear"}}}));
  EXPECT_EQ(t(0, 1).normal_stiffness, 2000);
  EXPECT_EQ(t(0, 2).normal_stiffness, 6);
  EXPECT_EQ(t(1, 2).normal_stiffness, 7);
  EXPECT_EQ(t(2, 2).normal_stiffness, 5);
  EXPECT_EQ(t(0, 1).rolling_damping, 0.2);
  EXPECT_EQ(t(1, 2).rolling_damping, 0.3);
  EXPECT_EQ(t(0, 0).damping_time, 0);
  EXPECT_EQ(errors_of(scene + pairs + "]\ncontact: {normal: linear}\n"),
            "s.yaml:9:19: error: contact.normal: linear needs normal_stiffness, and the pair b, c has none: give it to both materials, or to the pair\n"
            "  contact: {normal: linear}\n                    ^");
  EXPECT_EQ(errors_of(scene + pairs + "]\n"), "");              // Hertz does not need it
  for (const auto& [laws, name] : {std::pair{"normal: walton_braun", "normal_stiffness"}, {"normal: kuwabara_kono", "damping_time"},
                                   {"tangential: viscous", "tangential_damping"}, {"tangential: haff_werner", "tangential_damping"},
                                   {"rolling: viscous", "rolling_viscosity"}}) {
    const std::string with = head + one_particle + "contact: {" + laws + "}\n";
    EXPECT_NE(errors_of(with).find(std::string(" needs ") + name + ", and material 'pellet' has none"), std::string::npos) << errors_of(with);
    EXPECT_EQ(errors_of(with + "method: ndem\n"), "") << laws;   // which has rows of its own
  }
}

TEST(Pairs, BadPairs) {
  const auto error = [](const std::string& pairs) { return errors_of(head + one_particle + "pairs: " + pairs + "\n"); };
  EXPECT_NE(error("[{between: [pellet, steel]}]").find("there is no material 'steel'"), std::string::npos);
  EXPECT_NE(error("[{between: [pellet]}]").find("the names of two materials"), std::string::npos);
  EXPECT_NE(error("[{between: [pellet, pellet]}, {between: [pellet, pellet]}]").find("is given twice"), std::string::npos);
  EXPECT_NE(error("[{friction: 1}]").find("missing key 'between'"), std::string::npos);
}
