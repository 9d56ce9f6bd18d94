// Every effect and every pair of effects left out equals the full step with their parameters at zero, bit for bit; and what is only
// watched - orientations, the energy ledger - leaves no trace.
#include <gtest/gtest.h>
#include "tests/physics/stir.h"

namespace skred::lab {
namespace {

enum Effect { friction, rolling, restitution, several_radii, orientation, energy_ledger, effects };
constexpr const char* names[] = {"Friction", "Rolling", "Restitution", "SeveralRadii", "Orientation", "EnergyLedger"};

Lab stirred(Method method, const std::array<bool, effects>& in) {
  const double unused = method == Method::ndem ? 0 : 1;      // the restitution that needs no impact stage, or no damping
  Lab l(in[restitution] ? 0.4 : unused, in[friction] ? 0.5 : 0, in[rolling] ? 0.2 : 0);
  l.model.method = method;
  if (method == Method::ndem) l.model.time_step = 5e-4;
  l.model.gravity = {0, 0, -9.81};
  l.model.orientation = in[orientation];
  l.model.energy = in[energy_ledger];
  add_stir(l, in[several_radii]);
  return l;
}

struct Case { Method method; Effect one, other; };
class EffectsLeftOut : public ::testing::TestWithParam<Case> {};

TEST_P(EffectsLeftOut, EqualTheirParametersAtZero) {
  const auto [method, one, other] = GetParam();
  std::array<bool, effects> in;
  in.fill(true);
  in[one] = in[other] = false;
  const Lab lean = stirred(method, in);
  Lab full = lean;
  full.model.all_effects = full.model.orientation = full.model.energy = true;
  const auto a = lean.build(1), b = full.build(2);
  const auto step_of = [](const Simulation& s) {
    const Effects& e = s.effects();
    return std::array{e.friction, e.rolling, e.damping || e.impacts, !e.alike, e.orientation, e.energy};
  };
  EXPECT_TRUE(step_of(*b)[one] && step_of(*b)[other]);
  for (const Effect e : {one, other})                        // nonsmooth DEM always looks radii up
    EXPECT_EQ(step_of(*a)[e], method == Method::ndem && e == several_radii) << names[e];
  a->start();
  b->start();
  std::size_t touched = 0;
  for (int k = 0; k < 240; ++k) {
    a->step();
    b->step();
    if (k % 40 == 0) touched += measure(*a).contacts + measure(*a).body_contacts;
  }
  EXPECT_GT(touched, 30u);
  for (const auto column : {&Particles::position, &Particles::velocity, &Particles::angular_velocity, &Particles::force})
    EXPECT_EQ(by_id(*a, column), by_id(*b, column));
  EXPECT_EQ(std::get<Bodies>(a->world()).pose.data, std::get<Bodies>(b->world()).pose.data);
}

std::vector<Case> cases() {
  std::vector<Case> out;
  for (const Method method : {Method::sdem, Method::ndem})
    for (int a = 0; a < effects; ++a)
      for (int b = a; b < effects; ++b)
        if (method == Method::sdem || a != several_radii || b != several_radii) out.push_back({method, Effect(a), Effect(b)});
  return out;
}

INSTANTIATE_TEST_SUITE_P(Pairs, EffectsLeftOut, ::testing::ValuesIn(cases()), [](const auto& of) {
  const Case& c = of.param;
  return std::string(c.method == Method::sdem ? "Smooth" : "Nonsmooth") + names[c.one] + (c.one == c.other ? "" : names[c.other]);
});

}  // namespace
}  // namespace skred::lab
