// The graphs of some scenes against the pictures kept here: a change of the graph shows as a difference to review.
// SKRED_WRITE_GOLDEN=1 in the environment writes them anew.
#include <gtest/gtest.h>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include "scenes/read_scene.h"
#include "scenes/show.h"

namespace skred {
namespace {

std::string golden(const std::string& name, const std::string& now) {
  const std::string path = SKRED_SOURCE_DIR "/tests/golden/" + name + ".dot";
  if (std::getenv("SKRED_WRITE_GOLDEN")) std::ofstream(path) << now;
  std::ifstream in(path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string frictionless() {
  ReadOptions o;
  o.overrides = {{"materials.pellet.friction", "0"}, {"materials.pellet.rolling_friction", "0"}};
  return graph_dot(read_scene(SKRED_SOURCE_DIR "/scenes/drum.yaml", o));
}

std::string without_bodies() {
  return graph_dot(parse_scene(R"(
end_time: 1 s
materials:
  - {name: grain, density: 2500, youngs_modulus: 1 MPa, restitution: 0.8, friction: 0.5}
particles:
  - lattice: {material: grain, radius: 5 mm, min: [0, 0, 0], max: [0.1, 0.1, 0.1], spacing: 12 mm}
)", "gas.yaml"));
}

std::string drum() { return graph_dot(read_scene(SKRED_SOURCE_DIR "/scenes/drum.yaml")); }

TEST(Graph, Drum) { EXPECT_EQ(drum(), golden("drum", drum())); }
TEST(Graph, FrictionlessDrum) { EXPECT_EQ(frictionless(), golden("drum_frictionless", frictionless())); }
TEST(Graph, NoBodies) { EXPECT_EQ(without_bodies(), golden("no_bodies", without_bodies())); }

TEST(Graph, Tower) {
  const std::string tower = graph_dot(read_scene(SKRED_SOURCE_DIR "/scenes/tower.yaml"));
  EXPECT_EQ(tower, golden("tower", tower));
  EXPECT_EQ(drum().find("body_body"), std::string::npos);
}

// Nonsmooth DEM: the drum with other coefficients of its two materials.
Scene nonsmooth_drum(std::vector<std::pair<std::string, std::string>> coefficients = {}) {
  ReadOptions o;
  o.method = "ndem";
  for (const auto& [key, value] : coefficients)
    for (const std::string material : {"pellet", "disc"}) o.overrides.push_back({"materials." + material + "." + key, value});
  return read_scene(SKRED_SOURCE_DIR "/scenes/drum.yaml", o);
}

TEST(Graph, NonsmoothDrum) {
  const std::string drum = graph_dot(nonsmooth_drum());
  EXPECT_EQ(drum, golden("drum_ndem", drum));
}

TEST(Graph, NonsmoothDrumWithoutFrictionRollingAndRestitution) {
  const Scene scene = nonsmooth_drum({{"friction", "0"}, {"rolling_friction", "0"}, {"restitution", "0"}});
  const std::string drum = graph_dot(scene);
  EXPECT_EQ(drum, golden("drum_ndem_lean", drum));
  EXPECT_EQ(drum.find("impact_solve"), std::string::npos);
  const auto out = [text = graph_text(scene)](const std::string& effect) {
    const std::size_t at = text.find("  " + effect + " ");
    return at != std::string::npos && text.substr(at, text.find('\n', at) - at).find(" out ") != std::string::npos;
  };
  for (const char* effect : {"friction", "rolling resistance", "rotation", "impact stage"}) EXPECT_TRUE(out(effect)) << effect;
  EXPECT_FALSE(out("contact history"));                        // the solver starts from it
}

TEST(Graph, TheThreeDiffer) {
  EXPECT_NE(drum(), frictionless());
  EXPECT_NE(drum(), without_bodies());
  EXPECT_NE(frictionless(), without_bodies());
  EXPECT_EQ(frictionless().find("contact_hashing\""), std::string::npos);
  EXPECT_EQ(without_bodies().find("body"), std::string::npos);
}

}  // namespace
}  // namespace skred
