// tests/scenes/fill_test.cpp - lattices of particles.
#include "scenes/fill.h"
#include <gtest/gtest.h>
#include "engine/random.h"
#include "tests/scenes/scene_text.h"

using namespace skred;

namespace {

constexpr double R = 0.00636665;

Scene scene_with(LatticeFill f, std::uint64_t seed = 1) {
  Scene s;
  s.seed = seed;
  s.materials = {{"other", {}}, {"pellet", {}}};
  f.material = "pellet";
  s.particles = {f};
  return s;
}

LatticeFill thesis_fill(double a) {
  const double side = std::sqrt(2.0) * a / 10, width = std::min(0.027 * a, 0.2);
  return {"", {R, R}, {-side / 2, -width / 2, -side / 2}, {side / 2, width / 2, side / 2}, 2.5 * R, 0.1, {}, {}, {}};
}

}  // namespace

// Pettersson 2015: figure 3.1 simulates 95 052 particles at a = 10.
TEST(Fill, CountsOfTheThesisDrum) {
  EXPECT_EQ(lattice_sites(thesis_fill(10)), (std::array<std::size_t, 3>{89, 12, 89}));
  const std::pair<double, std::size_t> counts[] = {{2, 867}, {4, 7350}, {6, 28090}, {8, 60492}, {10, 95052}};
  for (const auto& [a, count] : counts) EXPECT_EQ(make_particles(scene_with(thesis_fill(a))).size(), count) << a;
}

TEST(Fill, ABoxMadeToMeasureIsFilled) {
  const LatticeFill f{"", {0.05, 0.05}, {0, 0, 0}, {1, 0.3, 0.1}, 0.1, 0, {}, {}, {}};
  EXPECT_EQ(lattice_sites(f), (std::array<std::size_t, 3>{10, 3, 1}));
  const ParticleSet set = make_particles(scene_with(f));
  EXPECT_NEAR(norm(set.position[0] - Vec3{0.05, 0.05, 0.05}), 0, 1e-15);
  EXPECT_NEAR(norm(set.position[1] - set.position[0] - Vec3{0.1, 0, 0}), 0, 1e-15);     // x runs fastest
  EXPECT_NEAR(norm(set.position[29] - Vec3{0.95, 0.25, 0.05}), 0, 1e-15);
  EXPECT_EQ(set.material[0], 1u);
}

TEST(Fill, JitterStaysInTheBoxAndLeavesGaps) {
  LatticeFill f = thesis_fill(2);
  const ParticleSet set = make_particles(scene_with(f));
  f.jitter = 0;
  const ParticleSet still = make_particles(scene_with(f));
  double furthest = 0;
  for (std::size_t k = 0; k < set.size(); ++k) {
    const Vec3 p = set.position[k], moved = p - still.position[k];
    for (const double m : {moved.x, moved.y, moved.z}) {
      EXPECT_LE(std::abs(m), 0.1 * f.spacing * (1 + 1e-12));
      furthest = std::max(furthest, std::abs(m));
    }
    for (const auto& [x, low, high] : {std::tuple{p.x, f.min.x, f.max.x}, {p.y, f.min.y, f.max.y}, {p.z, f.min.z, f.max.z}}) {
      EXPECT_GE(x, low + R);
      EXPECT_LE(x, high - R);
    }
    if (k > 0) { EXPECT_GT(norm(p - set.position[k - 1]), 2 * R); }
  }
  EXPECT_GT(furthest, 0.099 * f.spacing);
}

TEST(Fill, JitterIsClampedToATightBox) {
  const LatticeFill f{"", {0.05, 0.05}, {0, 0, 0}, {0.1, 0.1, 0.1}, 0.1, 0.5, {}, {}, {}};
  EXPECT_NEAR(norm(make_particles(scene_with(f)).position[0] - Vec3{0.05, 0.05, 0.05}), 0, 1e-16);
}

TEST(Fill, SeedDecidesAndACutMovesNobody) {
  LatticeFill f = thesis_fill(2);
  const auto positions = [&](std::uint64_t seed) { return make_particles(scene_with(f, seed)).position; };
  const auto whole = positions(1);
  EXPECT_EQ(positions(1), whole);
  EXPECT_NE(positions(2), whole);
  f.cylinder = CylinderCut{{0, 0, 0}, {0, 1, 0}, 0.1};
  const auto cut = positions(1);
  EXPECT_LT(cut.size(), whole.size());
  std::size_t found = 0;
  for (const Vec3& p : whole) {
    const bool inside = std::hypot(p.x, p.z) + R <= 0.1;
    if (inside) { ASSERT_LT(found, cut.size()); EXPECT_EQ(cut[found++], p); }
  }
  EXPECT_EQ(found, cut.size());
}

TEST(Fill, RadiiFillTheirRange) {
  LatticeFill f = thesis_fill(4);
  f.radius = {0.5 * R, R};
  const ParticleSet set = make_particles(scene_with(f));
  double sum = 0;
  for (const double r : set.radius) {
    EXPECT_GE(r, 0.5 * R);
    EXPECT_LE(r, R);
    sum += r;
  }
  // The mean of n uniform numbers strays by width / sqrt(12 n); four times that.
  EXPECT_NEAR(sum / double(set.size()), 0.75 * R, 4 * 0.5 * R / std::sqrt(12.0 * double(set.size())));
}

TEST(Fill, UniformNumbersAreTheSameEverywhere) {
  EXPECT_EQ(mix64(0), 0xe220a8397b1dcdafu);        // the first output of SplitMix64 from state 0 (Vigna's reference code)
  EXPECT_EQ(uniform(1, 0, 0, 1), uniform(1, 0, 0, 1));
  EXPECT_NE(uniform(1, 0, 0, 1), uniform(1, 0, 1, 0));
  for (std::uint64_t k = 0; k < 1000; ++k) {
    const double u = uniform(7, 0, k, 0);
    EXPECT_GE(u, 0);
    EXPECT_LT(u, 1);
  }
}

TEST(Fill, NoParticleIsAnError) {
  LatticeFill f = thesis_fill(2);
  f.cylinder = CylinderCut{{9, 9, 9}, {0, 1, 0}, 0.1};
  EXPECT_THROW(make_particles(scene_with(f)), SceneError);
}
