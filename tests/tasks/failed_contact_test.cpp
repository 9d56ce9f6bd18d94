#include "tasks/failed_contact.h"
#include <gtest/gtest.h>
#include "tests/physics/lab.h"

namespace skred {
namespace {

using namespace lab;

constexpr double R = pellet_radius, nan = std::numeric_limits<double>::quiet_NaN();

// Three spheres in a row that press on each other, and the first on a wall.
Lab row(Method method, double friction) {
  Lab lab(0.5, friction, friction / 3);
  lab.model.method = method;
  if (method == Method::ndem) lab.model.time_step = 1e-3;
  for (int k = 0; k < 3; ++k) lab.sphere({0, 0, (0.999 + 1.998 * k) * R});
  lab.body(PlaneShape{});
  return lab;
}

bool solved(const Simulation& s) { return std::isfinite(std::get<Solver>(s.world()).residual.data[0]); }
Trouble trouble(const Simulation& s) { return std::get<Search>(s.world()).trouble.data[0]; }

TEST(FailedContact, IsNoneWhileAllIsWell) {
  for (const Method method : {Method::sdem, Method::ndem}) {
    auto s = row(method, 0.5).build();
    s->start();
    for (int k = 0; k < 5; ++k) s->step();
    EXPECT_TRUE(solved(*s));
    EXPECT_FALSE(failed_contact(s->world()));
  }
}

TEST(FailedContact, OfAVelocityThatIsNoNumberIsNamedInItsStep) {
  for (const double friction : {0.0, 0.5}) {
    auto s = row(Method::ndem, friction).build();
    s->start();
    s->step();
    std::get<Particles>(s->world()).velocity.data[2] = {0, 0, nan};
    s->step();
    EXPECT_FALSE(solved(*s)) << friction;
    const auto failed = failed_contact(s->world());
    ASSERT_TRUE(failed) << friction;
    EXPECT_NE(failed->particle, no_index);
    EXPECT_TRUE(failed->partner == failed->particle + 1 || failed->body == 0u);
  }
}

// Spheres so light that 1/m is infinite.
TEST(FailedContact, OfAMassWithoutAnInverseIsNamed) {
  for (const bool at_wall : {false, true}) {
    Lab lab(0.5, 0.5, 0.1);
    lab.model.method = Method::ndem;
    lab.model.time_step = 1e-3;
    lab.sphere({0, 0, 0.999 * R}, {}, {}, R, at_wall ? 1e-310 : 1);
    lab.sphere({4 * R, 0, R}, {}, {}, R, 1);
    lab.sphere({6 * R, 0, R}, {-1, 0, 0}, {}, R, at_wall ? 1 : 1e-310);
    lab.body(PlaneShape{}, {{0, 0, at_wall ? 0 : -R}, {}});
    auto s = lab.build();
    s->start();
    s->step();
    EXPECT_FALSE(solved(*s));
    const auto failed = failed_contact(s->world());
    ASSERT_TRUE(failed);
    EXPECT_EQ(failed->particle, at_wall ? 0u : 1u);
    EXPECT_EQ(failed->partner, at_wall ? no_index : 2u);
    EXPECT_EQ(failed->body, at_wall ? 0u : no_index);
    EXPECT_EQ(failed->others, 0u);
  }
}

// Smooth DEM divides by the mass before it looks for contacts: there is none to name, but the particle.
TEST(FailedContact, IsNoneWhereAStartIsNoNumber) {
  Lab lab(0.5, 0.5, 0.1);
  lab.sphere({0, 0, 0.999 * R}, {}, {}, R, 1e-310);
  lab.sphere({0, 0, 2.997 * R}, {}, {}, R, 1);
  lab.body(PlaneShape{});
  auto s = lab.build();
  s->start();
  EXPECT_EQ(trouble(*s), Trouble::not_finite);
  EXPECT_EQ(std::get<Search>(s->world()).culprit.data[0], 0u);
  EXPECT_FALSE(failed_contact(s->world()));
}

// Smooth DEM sees it in the step after, from where the particles went.
TEST(FailedContact, OfAForceThatOverflowsIsNamedInSmoothDem) {
  for (const bool at_wall : {false, true}) {
    Lab lab(0.5, 0.5, 0.1);
    lab.model.pairs = one_pair(0.5, 0.5, 0.1, {pellet_density, 1e307, 0.25});
    lab.sphere({0, 0, at_wall ? 0.6 * R : 9 * R}, {}, {}, R, 1e-20);
    lab.sphere({5 * R, 0, 9 * R}, {}, {}, R, 1e-20);
    lab.sphere({at_wall ? 7.1 * R : 6 * R, 0, 9 * R}, {}, {}, R, 1e-20);
    lab.body(PlaneShape{});
    auto s = lab.build();
    s->start();
    for (int k = 0; k < 5 && trouble(*s) == Trouble::none; ++k) s->step();
    EXPECT_EQ(trouble(*s), Trouble::not_finite);
    const auto failed = failed_contact(s->world());
    ASSERT_TRUE(failed);
    EXPECT_EQ(failed->particle, at_wall ? 0u : 1u);
    EXPECT_EQ(failed->partner, at_wall ? no_index : 2u);
    EXPECT_EQ(failed->body, at_wall ? 0u : no_index);
  }
}

}  // namespace
}  // namespace skred
