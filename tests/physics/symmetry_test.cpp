// What physics does not know: where the origin is and how fast it moves, left and right, which way is north, the names of the
// particles. Bit for bit where the arithmetic allows it, else to rounding: chaos makes it grow, so these runs are short.
#include <gtest/gtest.h>
#include <algorithm>
#include <functional>
#include <numeric>
#include "tests/physics/lab.h"

namespace skred::lab {
namespace {

Lab in_method(Lab l, Method method) {
  l.model.method = method;
  if (method == Method::sdem) return l;
  l.model.time_step = 2e-4;
  l.model.solver.tolerance = 1e-14;
  l.model.solver.impact_iterations = l.model.solver.iterations = 20000;
  return l;
}

// A cloud that collides above a floor.
Lab cloud(Method method) {
  Lab l(0.4, 0.5, 0.1);
  l.model.gravity = {0, 0, -9.81};
  add_cloud(l, 3, 2.02 * pellet_radius, 17, 0.8);
  l.body(PlaneShape{}, {{0, 0, -3.4 * pellet_radius}, {}});
  return in_method(l, method);
}

// `contacts`: sum over the steps, impacts of nonsmooth DEM included.
struct State { std::vector<Vec3> x, v, w; std::int64_t contacts; };

double short_time(const Lab& l) { return l.model.method == Method::sdem ? 0.02 : 0.05; }   // [s] each particle hits one or two others

State after(const Lab& l) {
  const auto s = l.build();
  s->start();
  std::int64_t contacts = 0;
  while (s->time() < short_time(l) - 1e-9) {
    s->step(Execution::list);
    const Measures m = measure(*s);
    contacts += std::int64_t(m.contacts + m.body_contacts) + std::get<Solver>(s->world()).impacts.data[0];
  }
  return {by_id(*s, &Particles::position), by_id(*s, &Particles::velocity), by_id(*s, &Particles::angular_velocity), contacts};
}

double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double most = 0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, norm(a[k] - b[k]));
  return most;
}

using Map = std::function<Vec3(const Vec3&)>;

// Maps vectors by `map` and axial vectors by `axial`, before the run and after it.
struct Twins { State mapped_before, mapped_after; };
Twins twins(const Lab& l, const Map& map, const Map& axial) {
  Lab other = l;
  Particles& p = other.particles();
  for (auto* c : {&p.position, &p.velocity}) std::transform(c->data.begin(), c->data.end(), c->data.begin(), map);
  std::transform(p.angular_velocity.data.begin(), p.angular_velocity.data.end(), p.angular_velocity.data.begin(), axial);
  State s = after(l);
  for (auto* c : {&s.x, &s.v}) std::transform(c->begin(), c->end(), c->begin(), map);
  std::transform(s.w.begin(), s.w.end(), s.w.begin(), axial);
  return {after(other), s};
}

Vec3 mirror(const Vec3& a) { return {-a.x, a.y, a.z}; }
Vec3 mirror_axial(const Vec3& a) { return {a.x, -a.y, -a.z}; }
Vec3 quarter_turn(const Vec3& a) { return {-a.y, a.x, a.z}; }

// Rounding to nearest knows no sign, and x^2 + y^2 = y^2 + x^2. Rows are left as they are: the curve along which they are sorted, and with
// it the order of sums, is not the mirrored one.
TEST(Symmetry, MirrorAndQuarterTurnGiveTheSameBits) {
  Lab l = cloud(Method::sdem);
  l.model.reorder_every = 0;
  for (const auto& [map, axial] : {std::pair<Map, Map>{mirror, mirror_axial}, {quarter_turn, quarter_turn}}) {
    const auto [before, after] = twins(l, map, axial);
    EXPECT_GT(before.contacts, 1000);
    EXPECT_EQ(before.x, after.x);
    EXPECT_EQ(before.v, after.v);
    EXPECT_EQ(before.w, after.w);
  }
}

// Nonsmooth DEM sweeps its contacts by blocks of space, in another order in the mirror: the same to the solver's tolerance.
TEST(Symmetry, MirrorAndQuarterTurnNonsmooth) {
  const Lab l = cloud(Method::ndem);
  for (const auto& [map, axial] : {std::pair<Map, Map>{mirror, mirror_axial}, {quarter_turn, quarter_turn}}) {
    const auto [before, after] = twins(l, map, axial);
    EXPECT_GT(before.contacts, 30);
    EXPECT_LT(farthest(before.x, after.x), 1e-9 * pellet_radius);
    EXPECT_LT(farthest(before.v, after.v), 1e-9);
  }
}

class BothMethods : public ::testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(Symmetry, BothMethods, ::testing::Values(Method::sdem, Method::ndem),
                         [](const auto& of) { return of.param == Method::sdem ? "Smooth" : "Nonsmooth"; });

// Seen from a train.
TEST_P(BothMethods, GalileanInvariance) {
  Lab rest(0.4, 0.5, 0.1);
  add_cloud(rest, 3, 2.02 * pellet_radius, 17, 0.8);
  rest = in_method(rest, GetParam());
  rest.model.solver.impact_speed = 0.01;
  const Vec3 train{3, -2, 1};                                // [m/s]
  Lab moving = rest;
  for (Vec3& v : moving.particles().velocity.data) v += train;
  const State a = after(rest);
  State b = after(moving);
  for (Vec3& x : b.x) x -= short_time(rest) * train;
  for (Vec3& v : b.v) v -= train;
  EXPECT_GT(a.contacts, 30);
  EXPECT_LT(farthest(a.x, b.x), 1e-9 * pellet_radius);
  EXPECT_LT(farthest(a.v, b.v), 1e-9);
  EXPECT_LT(farthest(a.w, b.w), 1e-9 / pellet_radius);
}

template <class V> void permute(Buffer<V>& column, const std::vector<Index>& from) {
  const Buffer<V> old = column;
  for (std::size_t k = 0; k < old.size(); ++k) column[k] = old[from[k]];
}
Lab permuted(Lab l, const std::vector<Index>& from) {
  Particles& p = l.particles();
  permute(p.position.data, from), permute(p.velocity.data, from), permute(p.angular_velocity.data, from);
  permute(p.radius.data, from), permute(p.mass.data, from), permute(p.material.data, from);
  return l;
}
std::vector<Index> shuffled(std::size_t n) {
  std::vector<Index> from(n);
  std::iota(from.begin(), from.end(), 0);
  std::shuffle(from.begin(), from.end(), std::mt19937(5));
  return from;
}

// Particles in other rows of the table, with their names: nothing changes, to the last bit.
TEST_P(BothMethods, RowsLeaveNoTrace) {
  const Lab l = cloud(GetParam());
  const std::vector<Index> from = shuffled(27);
  Lab other = permuted(l, from);
  other.particles().id.data.assign(from.begin(), from.end());
  const State a = after(l), b = after(other);
  EXPECT_GT(a.contacts, 30);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.v, b.v);
  EXPECT_EQ(a.w, b.w);
}

// Other names: sums in another order, and the same to rounding.
TEST_P(BothMethods, NamesAreOnlyNames) {
  const Lab l = cloud(GetParam());
  const std::vector<Index> from = shuffled(27);
  const State a = after(l), b = after(permuted(l, from));
  State named = a;
  for (std::size_t k = 0; k < from.size(); ++k) named.x[k] = a.x[from[k]], named.v[k] = a.v[from[k]];
  EXPECT_NE(named.x, a.x);
  EXPECT_LT(farthest(named.x, b.x), 1e-9 * pellet_radius);
  EXPECT_LT(farthest(named.v, b.v), 1e-9);
}

}  // namespace
}  // namespace skred::lab
