// Same scene, any thread count, any order of the kernels, any skin, any vector instructions: the same bits. (Smooth DEM adds forces in the
// order of the rows, so that when these are sorted does matter.) And an effect that is
// left out equals the full step with its parameter at zero.
#include <gtest/gtest.h>
#include <algorithm>
#include "tests/physics/lab.h"

namespace skred::lab {
namespace {

// A cloud falling into a turning drum of several kinds of geometry, on a ball that may move: every kernel has work.
Lab stirred(double friction = 0.91, double rolling = 0.3211, double e = 0.18) {
  Lab l(e, friction, rolling);
  l.model.gravity = {0, 0, -9.81};
  add_cloud(l, 6, 2.1 * pellet_radius, 11, 1.0);
  const double size = 16 * pellet_radius;
  const Index drum = l.body(HollowCylinderShape{0.5 * size, size, 0.02}, {}, Motion::kinematic);
  l.geometry(drum, CylinderShape{0.55 * size, 0.01}, {{0, 0, -0.5 * size - 0.005}, {}});
  const auto mesh = std::make_shared<Mesh>(
      std::vector<Vec3>{{-0.2, -0.2, -0.03}, {0.2, -0.2, -0.03}, {0.2, 0.2, -0.035}, {-0.2, 0.2, -0.03}},
      std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
  l.body(MeshShape{mesh});
  l.model.pieces = {{MotionPiece{0, 1, {0, 0, 0}, {0, 0, 8}, {}}}, {}};
  const double ball = 2 * pellet_radius, mass = 5 * sphere_mass(pellet_radius), inertia = 0.4 * mass * ball * ball;
  l.body(SphereShape{ball}, {{0.01, 0, 7 * pellet_radius}, {}}, Motion::dynamic, mass, {inertia, inertia, inertia});
  return l;
}

Lab nonsmooth(Lab l) {
  l.model.method = Method::ndem;
  l.model.time_step = 5e-4;
  return l;
}

std::uint64_t hash_after(const Lab& l, int steps, int threads, Execution how) {
  const auto simulation = l.build(threads);
  Simulation& s = *simulation;
  s.start();
  for (int k = 0; k < steps; ++k) s.step(how);
  return s.state_hash();
}

// A random order of the kernels that respects the edges.
std::vector<std::size_t> shuffled_order(const Task& task, std::mt19937& random) {
  std::vector<std::size_t> waiting(task.size()), order, ready;
  for (const auto& e : task.edges()) ++waiting[e.to];
  for (std::size_t k = 0; k < task.size(); ++k)
    if (waiting[k] == 0) ready.push_back(k);
  while (!ready.empty()) {
    std::swap(ready[random() % ready.size()], ready.back());
    const std::size_t next = ready.back();
    ready.pop_back();
    order.push_back(next);
    for (const auto& e : task.edges())
      if (e.from == next && --waiting[e.to] == 0) ready.push_back(e.to);
  }
  return order;
}

void expect_the_same_in_any_order(const Lab& l, int steps) {
  const std::uint64_t reference = hash_after(l, steps, 1, Execution::serial);
  for (const int threads : {1, 2, 4}) {
    EXPECT_EQ(hash_after(l, steps, threads, Execution::graph), reference) << threads;
    EXPECT_EQ(hash_after(l, steps, threads, Execution::list), reference) << threads;
  }
  std::mt19937 random(7);
  for (int trial = 0; trial < 2; ++trial) {
    const auto simulation = l.build(2);
    Simulation& s = *simulation;
    s.start();
    for (int k = 0; k < steps; ++k) s.step_in_order(shuffled_order(s.task(), random));
    EXPECT_EQ(s.state_hash(), reference);
  }
}

TEST(Determinism, SerialListGraphAndShuffledOrder) { expect_the_same_in_any_order(stirred(), 1000); }
TEST(Determinism, SerialListGraphAndShuffledOrderNonsmooth) { expect_the_same_in_any_order(nonsmooth(stirred()), 300); }

Lab periodic_cloud() {
  Lab l(0.3, 0.5, 0.1);
  add_cloud(l, 6, 2.05 * pellet_radius, 4, 0.8);
  const double edge = 13 * pellet_radius;
  l.model.periodic = PeriodicSpace{{-edge / 2, -edge / 2, -edge / 2}, {edge, edge, edge}};
  return l;
}

// The same with laws chosen at run time; together they have every part and every kind of history.
Lab stirred_under(const ContactModel& contact, double friction = 0.5, double rolling = 0.2, double e = 0.4) {
  Lab l = stirred(friction, rolling, e);
  l.model.contact = contact;
  PairCoefficients& p = l.model.pairs.values[0];
  p.normal_stiffness = 3000, p.damping_time = 1e-4;
  p.tangential_damping = friction, p.rolling_viscosity = rolling, p.rolling_damping = p.rolling_damping_at_limit = 0.3;
  return l;
}
const ContactModel some_laws[] = {
    {NormalLaw::walton_braun, TangentialLaw::walton_braun, RollingLaw::spring},
    {NormalLaw::linear, TangentialLaw::haff_werner, RollingLaw::viscous},
    {NormalLaw::kuwabara_kono, TangentialLaw::spring, RollingLaw::constant_torque},
    {NormalLaw::walton_braun, TangentialLaw::coulomb, RollingLaw::none},
    {NormalLaw::hertz, TangentialLaw::viscous, RollingLaw::spring},
};
std::string name_of(const ContactModel& c) { return std::string(word_of(c.normal)) + " " + word_of(c.tangential) + " " + word_of(c.rolling); }

class ChosenLaws : public ::testing::TestWithParam<ContactModel> {};

TEST_P(ChosenLaws, SerialListGraphAndShuffledOrder) { expect_the_same_in_any_order(stirred_under(GetParam()), 150); }

// What the others compare is not empty.
TEST_P(ChosenLaws, HaveTouchingContactsAndTheirHistory) {
  const auto s = stirred_under(GetParam()).build();
  s->start();
  for (int k = 0; k < 150; ++k) s->step(Execution::serial);
  const Contacts& c = std::get<Contacts>(s->world());
  const auto count = [](const auto& column, const auto& nothing) {
    return std::count_if(column.begin(), column.end(), [&](const auto& x) { return !(x == nothing); });
  };
  EXPECT_TRUE(s->effects().chosen);
  EXPECT_GT(count(c.force.data, Vec3{}), 20);
  EXPECT_EQ(s->effects().memory, !c.memory.data.empty());
  if (s->effects().memory) { EXPECT_GT(count(c.memory.data, ContactMemory{}), 20); }
}

TEST_P(ChosenLaws, AnySkinAndVectorPath) {
  Lab l = stirred_under(GetParam());
  const std::uint64_t reference = hash_after(l, 300, 2, Execution::graph);
  for (const double skin : {0.02, 1.5}) {
    l.model.skin = skin * pellet_radius;
    l.model.vector_path = skin < 1 ? VectorPath::scalar : best_vector_path();
    EXPECT_EQ(hash_after(l, 300, 2, Execution::graph), reference) << skin;
  }
}

INSTANTIATE_TEST_SUITE_P(Determinism, ChosenLaws, ::testing::ValuesIn(some_laws), [](const auto& law) {
  std::string name = name_of(law.param);
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

TEST(Determinism, VectorPathsGiveTheSameBits) {
  for (Lab l : {stirred(), periodic_cloud()}) {
    l.model.vector_path = VectorPath::scalar;
    const std::uint64_t reference = hash_after(l, 600, 1, Execution::serial);
    for (const VectorPath path : vector_paths()) {
      l.model.vector_path = path;
      EXPECT_EQ(hash_after(l, 600, 2, Execution::graph), reference) << name_of(path) << (l.model.periodic ? ", periodic" : "");
    }
  }
}

// Large enough for several blocks of sums, which the rows are sorted into anew every 100 steps.
Lab crowd() {
  Lab l(0.18, 0.91, 0.3211);
  l.model.gravity = {0, 0, -9.81};
  add_cloud(l, 11, 1.8 * pellet_radius, 13, 0.6);
  l.body(PlaneShape{}, {{0, 0, -13 * pellet_radius}, {}});
  l.model.reorder_every = 100;
  return l;
}

TEST(Determinism, SumsAcrossBlocks) {
  Lab l = crowd();
  const auto simulation = l.build(2);
  simulation->start();
  for (int k = 0; k < 250; ++k) simulation->step();
  EXPECT_GT(std::get<Halo>(simulation->world()).rows(), 200u);
  EXPECT_GT(measure(*simulation).contacts, 300u);
  const std::uint64_t reference = simulation->state_hash();
  for (const int threads : {1, 2, 4}) EXPECT_EQ(hash_after(l, 250, threads, Execution::list), reference) << threads;
  EXPECT_EQ(hash_after(l, 250, 1, Execution::serial), reference);
  for (const double skin : {0.02, 1.5}) {
    l.model.skin = skin * pellet_radius;
    for (const VectorPath path : vector_paths()) {
      l.model.vector_path = path;
      EXPECT_EQ(hash_after(l, 250, 2, Execution::graph), reference) << skin << " " << name_of(path);
    }
  }
}

// Of steps whose states nobody looks at, the next begins while the particles of one are still in a cache.
TEST(Determinism, StepsThatNobodyLooksAt) {
  Lab walls = crowd();
  walls.body(HollowCylinderShape{0.1, 0.2, 0.02}, {}, Motion::kinematic);
  walls.model.pieces = {{}, {MotionPiece{0, 1, {0, 0, 0}, {0, 0, 8}, {}}}};
  Lab watched = periodic_cloud();
  watched.model.orientation = true;
  for (Lab l : {walls, watched, stirred_under({NormalLaw::linear, TangentialLaw::haff_werner, RollingLaw::viscous}), stirred()}) {
    const std::uint64_t reference = hash_after(l, 250, 1, Execution::serial);
    for (const int threads : {1, 2, 3})
      for (const Execution how : {Execution::graph, Execution::list, Execution::serial}) {
        const auto simulation = l.build(threads);
        Simulation& s = *simulation;
        s.start();
        for (int k = 1; k <= 250; ++k) s.step(how, k % 40 == 0 || k == 250 ? Look::now : Look::later);
        EXPECT_EQ(s.state_hash(), reference) << threads << " " << int(how);
        const Timeline::Totals totals = s.timeline().totals();
        for (const Timeline::Line& line : totals.lines) EXPECT_EQ(line.count, 250u) << line.name;
      }
  }
}

// A step in trouble has not begun the next: who looks then sees it as it ended.
TEST(Determinism, TroubleIsSeenAsItIs) {
  Lab l = crowd();
  l.sphere({0, 0, 0.5}, {0, 0, 0.9 * 0.5 * pellet_radius / l.model.time_step});
  l.model.gravity = {0, 0, 2000};                            // soon it is too fast
  const auto ended = [&](Look look) {
    const auto simulation = l.build(2);
    simulation->start();
    const Search& s = std::get<Search>(simulation->world());
    while (s.trouble.data[0] == Trouble::none && simulation->steps_done() < 200) simulation->step(Execution::graph, look);
    EXPECT_EQ(s.trouble.data[0], Trouble::too_fast);
    EXPECT_GT(simulation->steps_done(), 3);
    return std::tuple{simulation->steps_done(), s.culprit.data[0], simulation->state_hash()};
  };
  EXPECT_EQ(ended(Look::later), ended(Look::now));
}

TEST(Determinism, SkinAndCellsLeaveNoTrace) {
  Lab l = stirred();
  const std::uint64_t reference = hash_after(l, 600, 2, Execution::graph);
  for (const double skin : {0.02, 0.1, 1.5}) {
    l.model.skin = skin * pellet_radius;
    l.model.cell = skin > 1 ? 0 : 7.3 * pellet_radius;
    EXPECT_EQ(hash_after(l, 600, 2, Execution::graph), reference) << skin;
  }
}

TEST(Determinism, PeriodicBoxToo) {
  Lab l = periodic_cloud();
  const std::uint64_t reference = hash_after(l, 600, 1, Execution::serial);
  l.model.skin = 0.7 * pellet_radius;
  EXPECT_EQ(hash_after(l, 600, 2, Execution::graph), reference);
}

void expect_same_trajectory(const Lab& a, const Lab& b, int steps) {
  const auto one = a.build(2), other = b.build(2);
  Simulation &s = *one, &t = *other;
  s.start();
  t.start();
  const auto step_of = [](const Simulation& x) {
    const Effects& e = x.effects();
    return std::array{e.friction, e.rolling, e.damping, e.impacts, e.rotation, e.alike};
  };
  EXPECT_NE(step_of(s), step_of(t)) << "both steps are the same: nothing is tested";
  for (int k = 0; k < steps; ++k) {
    s.step();
    t.step();
  }
  EXPECT_EQ(by_id(s, &Particles::position), by_id(t, &Particles::position));
  EXPECT_EQ(by_id(s, &Particles::velocity), by_id(t, &Particles::velocity));
  EXPECT_EQ(by_id(s, &Particles::angular_velocity), by_id(t, &Particles::angular_velocity));
  EXPECT_EQ(by_id(s, &Particles::force), by_id(t, &Particles::force));
  EXPECT_EQ(std::get<Bodies>(s.world()).pose.data, std::get<Bodies>(t.world()).pose.data);
}

struct Parameters { double friction, rolling, e; };
class EffectLeftOut : public ::testing::TestWithParam<Parameters> {};

void expect_left_out_equals_zero(const Lab& lean, int steps) {
  Lab full = lean;
  full.model.all_effects = true;
  expect_same_trajectory(lean, full, steps);
}

TEST_P(EffectLeftOut, EqualsItsParameterAtZero) {
  const auto [friction, rolling, e] = GetParam();
  expect_left_out_equals_zero(stirred(friction, rolling, e), 600);
}

INSTANTIATE_TEST_SUITE_P(Effects, EffectLeftOut,
                         ::testing::Values(Parameters{0, 0, 0.18}, Parameters{0.5, 0, 0.18}, Parameters{0, 0.3, 0.18},
                                           Parameters{0.5, 0.3, 1}, Parameters{0, 0, 1}));

class EffectLeftOutNonsmooth : public ::testing::TestWithParam<Parameters> {};

TEST_P(EffectLeftOutNonsmooth, EqualsItsParameterAtZero) {
  const auto [friction, rolling, e] = GetParam();
  expect_left_out_equals_zero(nonsmooth(stirred(friction, rolling, e)), 300);
}

INSTANTIATE_TEST_SUITE_P(Effects, EffectLeftOutNonsmooth,
                         ::testing::Values(Parameters{0, 0, 0.18}, Parameters{0.5, 0, 0.18}, Parameters{0, 0.3, 0.18},
                                           Parameters{0.5, 0.3, 0}, Parameters{0, 0, 0}));

TEST(Effects, PartOfAChosenLawLeftOutEqualsItsParameterAtZero) {
  for (const ContactModel& c : some_laws)
    for (const auto& [friction, rolling] : {std::pair{0.0, 0.2}, {0.5, 0.0}, {0.0, 0.0}}) {
      SCOPED_TRACE(name_of(c));
      Lab lean = stirred_under(c, friction, rolling), full = lean;
      for (Lab* l : {&lean, &full}) l->model.pairs.values[0].rolling_damping_at_limit = 0;
      full.model.all_effects = true;
      if (c.rolling == RollingLaw::none && friction > 0) continue;   // nothing to leave out
      expect_same_trajectory(lean, full, 150);
      if (friction == 0 && rolling == 0) {                     // `none` in the scene is the same again
        Lab none = lean;
        none.model.contact.tangential = TangentialLaw::none;
        none.model.contact.rolling = RollingLaw::none;
        expect_same_trajectory(none, full, 150);
      }
    }
}

// Which laws a scene has decides what its step has.
TEST(Effects, ChosenLawsBringTheirHistoryOnly) {
  const auto kernels = [](const ContactModel& c) {
    const auto s = stirred_under(c).build();
    std::string all;
    for (std::size_t k = 0; k < s->task().size(); ++k) all += std::string(" ") + s->task().name(k);
    return all;
  };
  const auto effects = [](const ContactModel& c) { return stirred_under(c).build()->effects(); };
  for (const ContactModel& c : {ContactModel{NormalLaw::linear, TangentialLaw::coulomb, RollingLaw::viscous},
                                ContactModel{NormalLaw::kuwabara_kono, TangentialLaw::haff_werner, RollingLaw::constant_torque}}) {
    EXPECT_EQ(kernels(c).find("contact_hashing "), std::string::npos) << name_of(c);
    EXPECT_FALSE(effects(c).history);
    EXPECT_TRUE(effects(c).rotation);
  }
  const ContactModel smooth{NormalLaw::linear, TangentialLaw::none, RollingLaw::none};
  EXPECT_FALSE(effects(smooth).rotation);
  EXPECT_FALSE(effects(smooth).history);
  const ContactModel remembering{NormalLaw::walton_braun, TangentialLaw::none, RollingLaw::none};
  EXPECT_NE(kernels(remembering).find("contact_hashing "), std::string::npos);
  EXPECT_FALSE(effects(remembering).rotation);
  EXPECT_TRUE(effects({}).chosen);                           // the rolling spring's dashpot is not of the packed laws
  EXPECT_FALSE(stirred().build()->effects().chosen);
}

TEST(Effects, AlikeParticlesEqualLookedUpOnes) {
  Lab l(0.18, 0.5, 0.1);
  l.model.gravity = {0, 0, -9.81};
  add_cloud(l, 5, 2.1 * pellet_radius, 2, 1.0, false);
  l.body(PlaneShape{}, {{0, 0, -0.1}, {}});
  Lab full = l;
  full.model.all_effects = true;
  expect_same_trajectory(l, full, 600);
}

// Watching orientations must not change the motion.
TEST(Effects, OrientationOnlyWatches) {
  const Lab plain = stirred();
  Lab watched = plain;
  watched.model.orientation = true;
  const auto one = plain.build(2), other = watched.build(2);
  Simulation &s = *one, &t = *other;
  s.start();
  t.start();
  for (int k = 0; k < 300; ++k) s.step(), t.step();
  EXPECT_EQ(by_id(s, &Particles::position), by_id(t, &Particles::position));
  EXPECT_EQ(by_id(s, &Particles::angular_velocity), by_id(t, &Particles::angular_velocity));
  EXPECT_NE(by_id(t, &Particles::orientation)[0], Quaternion{});
}

}  // namespace
}  // namespace skred::lab
