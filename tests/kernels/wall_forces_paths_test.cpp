// The loop over contacts of particles with bodies: every set of vector instructions gives the bits of the scalar one, for every law, and
// writes no row but its own.
#include <gtest/gtest.h>
#include <cstring>
#include <random>
#include "engine/buffer.h"
#include "kernels/force_calculation_particle_body.h"
#include "kernels/laws.h"
#include "tests/kernels/paths.h"

namespace skred {
namespace {

constexpr double time_step = 5e-5;                                   // [s]
constexpr std::size_t particles = 200, contacts = rows_of_paths;

struct Results { Buffer<Vec3> force, torque, rolling_torque, spring, rolling; };

// Contacts of random particles with geometries of three bodies: one stands, one is moved, one moves. Neighbouring rows are alike now and
// then: that do not touch, stick, slide, fly off.
struct Walls {
  Buffer<Index> particle, geometry, material, body{0, 1, 1, 2, 0}, wall_material{0, 2, 1, 0, 1};
  Buffer<double> overlap, curvature, radius, mass, body_mass{0, 0, 0.02};
  Buffer<Vec3> normal, position, velocity, spin, body_velocity{{}, {0.1, 0, -0.2}, {0, 0.3, 0}}, body_spin{{}, {0, 1, 0}, {2, 0, 3}};
  Buffer<Motion> motion{Motion::fixed, Motion::kinematic, Motion::dynamic};
  Buffer<Pose> pose{{{}, {}}, {{0.1, 0.2, 0.3}, {}}, {{-0.1, 0, 0}, {}}};
  Results start;
  std::size_t touching = 0;

  explicit Walls(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(-1, 1);
    const auto any = [&](double scale) { return scale * Vec3{u(random), u(random), u(random)}; };
    for (std::size_t p = 0; p < particles; ++p) {
      radius.push_back(0.004 * (1.5 + u(random)));
      mass.push_back(4e-3 * (1.5 + u(random)));
      material.push_back(Index(random() % 3));
      position.push_back(any(0.2));
      velocity.push_back(any(p % 3 ? 1e-4 : 1));
      spin.push_back(any(p % 3 ? 1e-3 : 50));
    }
    bool apart = false;
    for (std::size_t c = 0, change = 0; c < contacts; ++c) {
      if (c == change) apart = random() % 3 == 0, change += 1 + random() % (random() % 3 ? 2 : 20);
      const auto p = Index(random() % particles);
      particle.push_back(p);
      geometry.push_back(Index(random() % body.size()));
      overlap.push_back(apart ? (random() % 4 ? -0.1 : 0.0) * radius[p] : 0.02 * radius[p] * std::abs(u(random)));
      touching += overlap.back() > 0;
      normal.push_back(normalized(any(1)));
      curvature.push_back(random() % 2 ? 0 : 20 * std::abs(u(random)));
      for (auto* column : {&start.force, &start.torque, &start.rolling_torque}) column->push_back(any(1));
      start.spring.push_back(any(p % 3 ? 1e-9 : 1e-3));
      start.rolling.push_back(any(p % 3 ? 1e-9 : 1e-2));
    }
  }

  template <class Law> Results after(const WallForces<Law>& forces, VectorPath path, std::size_t first, std::size_t last) const {
    Results r = start;
    wall_loop<Law>(path)(forces,
                         {particle.data(), geometry.data(), overlap.data(), normal.data(), curvature.data(), position.data(), velocity.data(), spin.data(),
                          radius.data(), mass.data(), material.data(), body.data(), wall_material.data(), motion.data(), pose.data(),
                          body_velocity.data(), body_spin.data(), body_mass.data(), r.force.data(), r.torque.data(), r.rolling_torque.data(),
                          r.spring.data(), r.rolling.data(), nullptr},
                         first, last);
    return r;
  }
};

bool same_bits(const Results& a, const Results& b, std::size_t first, std::size_t last) {
  const auto same = [&](const Buffer<Vec3>& x, const Buffer<Vec3>& y) {
    return std::memcmp(x.data() + first, y.data() + first, (last - first) * sizeof(Vec3)) == 0;
  };
  return same(a.force, b.force) && same(a.torque, b.torque) && same(a.rolling_torque, b.rolling_torque) && same(a.spring, b.spring) &&
         same(a.rolling, b.rolling);
}

std::vector<LawCoefficients> three_materials() {
  std::vector<LawCoefficients> out;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      out.push_back({6e6 * (1 + a + b), 2e7 * (1 + a * b), a + b == 3 ? 0 : 1.8e3, a + b == 3 ? 0 : 3.2e3, a == b ? 0 : 0.5, a == b ? 0 : 0.05});
  return out;
}

template <class Law> void compare() {
  const Walls walls(3);
  EXPECT_TRUE(walls.touching > contacts / 4 && walls.touching < contacts) << walls.touching;
  for (const double h : {time_step, 0.0}) {
    SCOPED_TRACE(h);
    const WallForces<Law> forces{{}, 3, three_materials(), h};
    compare_paths(
        walls.start, [&](VectorPath path, std::size_t first, std::size_t last) { return walls.after(forces, path, first, last); },
        [](const Results&, const Results&, VectorPath) {},
        [&](const Results& want, std::size_t first, std::size_t last) {
          for (std::size_t c = first; c < last; ++c) {
            ASSERT_TRUE(is_finite(want.force[c])) << c;
            ASSERT_TRUE(walls.overlap[c] > 0 || want.force[c] == Vec3{}) << c;
            ASSERT_TRUE(walls.overlap[c] > 0 || !Law::has_tangential || want.spring[c] == Vec3{}) << c;
          }
        });
  }
}

TEST(WallForces, EveryPathGivesTheBitsOfTheScalarOne) {
#define SKRED_COMPARE(LAW) { SCOPED_TRACE(#LAW); compare<LAW>(); }
  SKRED_FOR_EACH_LAW(SKRED_COMPARE)
}

}  // namespace
}  // namespace skred
