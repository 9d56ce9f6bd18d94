// The loop of the integration: what it says it does, the same bits by every set of vector instructions, and the one particle that strays.
#include <gtest/gtest.h>
#include <cstring>
#include <limits>
#include <random>
#include "engine/buffer.h"
#include "engine/periodic.h"
#include "kernels/integrate.h"
#include "tests/kernels/paths.h"

namespace skred {
namespace {

constexpr double h = 0.01;                                           // [s]

struct Results { Buffer<Vec3> position, velocity, spin; };

struct Moving {
  Buffer<double> mass, radius, list_margin;
  Buffer<Vec3> force, previous_force, torque, previous_torque, listed;
  Results start;

  explicit Moving(std::size_t n, unsigned seed = 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(-1, 1);
    const auto any = [&](double scale) { return scale * Vec3{u(random), u(random), u(random)}; };
    for (std::size_t p = 0; p < n; ++p) {
      mass.push_back(2 + u(random)), radius.push_back(1.5 + u(random)), list_margin.push_back(1);
      for (auto* column : {&force, &previous_force, &torque, &previous_torque, &start.velocity, &start.spin}) column->push_back(any(3));
      start.position.push_back(Vec3{1, 1, 1} + any(1));
    }
    listed = start.position;
  }
  template <bool rotates, class Space, class Inertia> VerletStep<rotates, Space, Inertia> step(const Space& space, const Inertia& inertia, Results& r) const {
    return {space, h, inertia, no_bounds, mass.data(), radius.data(), list_margin.data(), force.data(), previous_force.data(),
            torque.data(), previous_torque.data(), listed.data(), r.position.data(), r.velocity.data(), r.spin.data()};
  }
};

bool same_bits(const Results& a, const Results& b, std::size_t first, std::size_t last) {
  const auto same = [&](const Buffer<Vec3>& x, const Buffer<Vec3>& y) {
    return std::memcmp(x.data() + first, y.data() + first, (last - first) * sizeof(Vec3)) == 0;
  };
  return same(a.position, b.position) && same(a.velocity, b.velocity) && same(a.spin, b.spin);
}

// x + h v + h^2/2 f/m, and v + h/2 (a + a~) with a~ the mean of the last two; the same of the spin by torque and moment of inertia.
template <bool rotates, class Space, class Inertia> void compare(const Space& space, const Inertia& inertia) {
  SCOPED_TRACE(testing::Message() << "rotates " << rotates << ", alike " << Inertia::alike);
  const Moving m(rows_of_paths);
  const auto after = [&](VectorPath path, std::size_t first, std::size_t last) {
    Results r = m.start;
    const auto step = m.step<rotates>(space, inertia, r);
    const AllOf all = verlet_loop<std::decay_t<decltype(step)>>(path)(step, first, last);
    EXPECT_TRUE(all.in_margin && all.well);
    return r;
  };
  const auto near = [](const Vec3& a, const Vec3& b) { return norm(a - b) <= 1e-14 * (1 + norm(b)); };
  compare_paths(m.start, after, [](const Results&, const Results&, VectorPath) {}, [&](const Results& got, std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) {
      const double mass = inertia.mass_of(m.mass, p), moment = inertia.moment_of(m.mass, m.radius, p);
      const Vec3 a = (1 / mass) * m.force[p], before = (1 / mass) * m.previous_force[p];
      ASSERT_TRUE(near(got.position[p], space.wrap(m.start.position[p] + h * m.start.velocity[p] + (0.5 * h * h) * a))) << p;
      ASSERT_TRUE(near(got.velocity[p], m.start.velocity[p] + (0.5 * h) * (a + 0.5 * (a + before)))) << p;
      const Vec3 alpha = (1 / moment) * m.torque[p], alpha_before = (1 / moment) * m.previous_torque[p];
      ASSERT_TRUE(near(got.spin[p], m.start.spin[p] + (rotates ? 0.5 * h : 0.0) * (alpha + 0.5 * (alpha + alpha_before)))) << p;
    }
  });
}

TEST(Integrate, EveryPathGivesTheBitsOfTheScalarOne) {
  const PeriodicSpace box{{0, 0, 0}, {2, std::numeric_limits<double>::infinity(), 2}};     // some come out, and in again
  compare<true>(OpenSpace{}, Inertia<false>{});
  compare<true>(OpenSpace{}, Inertia<true>{2, 0.5});
  compare<false>(OpenSpace{}, Inertia<false>{});
  compare<true>(box, Inertia<false>{});
  compare<true>(box, Inertia<true>{2, 0.5});
  compare<false>(box, Inertia<true>{2, 0.5});
}

// One particle of many is not where it should be, whichever it is: every set of vector instructions sees it, and sees nothing else.
TEST(Integrate, EveryPathSeesTheOneThatStrays) {
  constexpr double infinite = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  constexpr std::size_t n = 21;
  const PeriodicSpace space{{0, 0, -20}, {30, infinite, infinite}};
  struct Stray { Vec3 moved, velocity; bool in_margin, well; };
  const Stray strays[]{{{0, 0.5, 0}, {}, true, true},      // as far as it may
                       {{0, 0.51, 0}, {}, false, true},
                       {{30, 0, 0}, {}, true, true},       // its image is where it was listed
                       {{0, 0, -1.5}, {}, false, false},
                       {{0, 0, -0.5}, {0, 0, 50}, true, true},     // half a radius in a step
                       {{0, 0, -0.5}, {0, 0, 50.1}, true, false},
                       {{nan, 0, 0}, {}, false, false},
                       {{}, {0, nan, 0}, false, false}};
  for (const VectorPath path : vector_paths())
    for (const Stray& stray : strays)
      for (std::size_t which = 0; which < n; ++which) {
        Moving m(n);
        for (std::size_t p = 0; p < n; ++p) {
          m.listed[p] = m.start.position[p] = {1.0 + double(p), 2, 0};
          m.start.velocity[p] = m.force[p] = m.previous_force[p] = {};
          m.radius[p] = 1, m.list_margin[p] = 0.5;
        }
        m.start.position[which] += stray.moved, m.start.velocity[which] = stray.velocity;
        const auto look = [&](std::size_t first, std::size_t last) {
          Results r = m.start;
          auto step = m.step<false>(space, Inertia<false>{}, r);
          step.bounds = {{0, 0, -1}, {n + 1.0, 3, 1}};
          return verlet_loop<decltype(step)>(path)(step, first, last);
        };
        const AllOf with = look(0, n), before = look(0, which), behind = look(which + 1, n);
        EXPECT_EQ(with.in_margin, stray.in_margin) << name_of(path) << " " << &stray - strays << " " << which;
        EXPECT_EQ(with.well, stray.well) << name_of(path) << " " << &stray - strays << " " << which;
        EXPECT_TRUE(before.in_margin && before.well && behind.in_margin && behind.well) << name_of(path) << " " << which;
      }
}

}  // namespace
}  // namespace skred
