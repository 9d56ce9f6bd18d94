// Nonsmooth DEM against closed forms: single contacts, columns, impacts, and the rate of the solver.
#include "tests/physics/nonsmooth_lab.h"

namespace skred {
namespace {

using namespace lab;

TEST(Nonsmooth, ColumnRestsAtTheOverlapsOfHertz) {             // T2
  for (const double h : {1e-4, 1e-3, 4e-3}) {
    NonsmoothLab lab(0.18, 0.91, 0.3211, h);
    lab.under_gravity();
    lab.floor();
    constexpr int n = 10;
    for (int k = 0; k < n; ++k) lab.sphere({0, 0, (2 * k + 1) * R});
    auto s = lab.build();
    run(*s, 3);
    const std::vector<double> z = column_at_rest(lab, n), f = pair_forces(*s);
    for (Index k = 0; k < n; ++k) {
      EXPECT_NEAR(position(*s, k).z, z[k], 1e-6 * 1e-3) << h << " sphere " << k;
      if (k + 1 < n) {
        EXPECT_NEAR(f[k] / ((n - 1 - k) * m * g), 1, 1e-6) << h;
      }
    }
    EXPECT_NEAR(measure(*s).body_normal_force / (n * m * g), 1, 1e-6);
  }
}

TEST(Nonsmooth, ImpactsAreTurnedRoundWithTheRestitution) {
  for (const double e : {0.0, 0.18, 0.5, 1.0})
    for (const double v : {0.5, 3.0}) {
      NonsmoothLab lab(e, 0, 0);
      lab.sphere({0, 0, 0}, {v, 0, 0});
      lab.sphere({2.3 * R, 0, 0});
      lab.model.solver.impact_speed = 0.1;
      auto s = lab.build();
      run(*s, 0.05);
      EXPECT_NEAR(velocity(*s, 1).x - velocity(*s, 0).x, e * v, e > 0 ? 1e-9 * v : 0.02 * v) << e;   // e = 0: the little that the gap ends with
      EXPECT_NEAR(velocity(*s, 1).x + velocity(*s, 0).x, v, 1e-12);
      EXPECT_LT(measure(*s).max_overlap_ratio, 1e-9);          // it was seen to come
    }
}

TEST(Nonsmooth, CradleFollowsNewtonsLaw) {                     // T6
  NonsmoothLab lab(1, 0, 0);
  lab.sphere({0, 0, 0}, {1, 0, 0});
  lab.sphere({2 * R, 0, 0});
  lab.sphere({4 * R, 0, 0});
  lab.model.solver.impact_iterations = 10000;
  lab.model.solver.impact_speed = 0.1;
  auto s = lab.build();
  s->start();
  s->step();
  EXPECT_NEAR(velocity(*s, 0).x, -1.0 / 3, 1e-6);
  EXPECT_NEAR(velocity(*s, 1).x, 2.0 / 3, 1e-6);
  EXPECT_NEAR(velocity(*s, 2).x, 2.0 / 3, 1e-6);
}

double resting_height(const Lab& lab) { return R - std::pow(m * g / hertz(lab, R), 2.0 / 3.0); }

TEST(Nonsmooth, RollsDownAnInclineAgainstRollingResistance) {  // T7
  const double mu = 0.91, mu_r = 0.3211;
  for (const double degrees : {25.0, 17.0}) {
    const double theta = degrees * M_PI / 180;
    NonsmoothLab lab(0, mu, mu_r);
    lab.model.pairs = one_pair(0, mu, mu_r, {pellet_density, 1e10, 0.25});   // hard: the arm of friction is R
    lab.model.gravity = g * Vec3{std::sin(theta), 0, -std::cos(theta)};
    lab.floor();
    const double overlap = std::pow(m * g * std::cos(theta) / hertz(lab, R), 2.0 / 3.0);
    lab.sphere({0, 0, R - overlap});
    auto s = lab.build();
    s->start();
    const double time = degrees > 20 ? 1 : 10;
    while (s->time() < time - 1e-9) s->step();
    const double a = velocity(*s, 0).x / s->time();
    const double expected = degrees > 20 ? 5.0 / 7 * g * (std::sin(theta) - mu_r * std::cos(theta)) : 0;
    EXPECT_NEAR(a, expected, 0.001 * g * std::sin(theta) * (degrees > 20 ? 0.1 : 1e-6)) << degrees;
  }
}

TEST(Nonsmooth, RollingOnTheFlatStopsAndStaysStopped) {        // T8
  const double mu_r = 0.3211;
  NonsmoothLab lab(0, 0.91, mu_r, 1e-4);
  lab.under_gravity();
  lab.floor();
  const double z = resting_height(lab);
  const double arm = 0.5 * (R + z);
  lab.sphere({0, 0, z}, {0.5, 0, 0}, {0, 0.5 / arm, 0});
  auto s = lab.build();
  run(*s, 1);
  EXPECT_NEAR(position(*s, 0).x, 0.5 * 0.5 / (2 * 5.0 / 7 * g * mu_r), 0.005 * 0.0556);
  EXPECT_LT(norm(velocity(*s, 0)), 1e-6);
}

TEST(Nonsmooth, SlidingTurnsIntoRolling) {                     // T9
  for (const double mu_r : {0.0, 0.3211}) {
    NonsmoothLab lab(0, 0.91, mu_r, 1e-5);
    lab.under_gravity();
    lab.floor();
    const double z = resting_height(lab);
    lab.sphere({0, 0, z}, {0.5, 0, 0});
    auto s = lab.build();
    s->start();
    const auto slip = [&] { return velocity(*s, 0).x - spin(*s, 0).y * 0.5 * (R + z); };
    while (slip() > 1e-9 && s->time() < 0.1) s->step();
    const double expected = 0.5 / (g * (3.5 * 0.91 - 2.5 * mu_r));
    EXPECT_NEAR(s->time() / expected, 1, 0.005) << mu_r;
    EXPECT_NEAR(velocity(*s, 0).x, 0.5 - 0.91 * g * expected, 0.005 * 0.35) << mu_r;
  }
}

TEST(Nonsmooth, ObliqueImpactsSlideOrStick) {                  // T10
  const double mu = 0.3, e = 0.5;
  for (const double degrees : {10.0, 30.0, 45.0, 70.0, 80.0}) {
    const double t = std::tan(degrees * M_PI / 180), vn = 1, vt = t * vn;
    NonsmoothLab lab(e, mu, 0);
    lab.floor();
    lab.sphere({0, 0, R + 1e-9}, {vt, 0, -vn});
    lab.model.solver.impact_speed = 0.1;
    lab.model.solver.impact_iterations = 1000;
    auto s = lab.build();
    s->start();
    s->step();
    const bool slips = t > 3.5 * mu * (1 + e);
    const double arm = R;
    EXPECT_NEAR(velocity(*s, 0).z, e * vn, 1e-9);
    EXPECT_NEAR(velocity(*s, 0).x, slips ? vt - mu * (1 + e) * vn : 5.0 / 7 * vt, 1e-6) << degrees;
    EXPECT_NEAR(spin(*s, 0).y * arm, slips ? 2.5 * mu * (1 + e) * vn : 5.0 / 7 * vt, 1e-6) << degrees;
  }
}

TEST(Nonsmooth, OverlappingSpheresPartGently) {                // T12
  for (const bool limited : {false, true}) {
    NonsmoothLab lab(0.18, 0, 0);
    lab.sphere({0, 0, 0});
    lab.sphere({R, 0, 0});                                     // overlap R
    lab.model.pairs = one_pair(0.18, 0, 0, {pellet_density, 1e10, 0.25});
    if (limited) lab.model.solver.separation_speed = 0.2;
    auto s = lab.build();
    s->start();
    s->step();
    const double speed = velocity(*s, 1).x - velocity(*s, 0).x;
    const double spook = 3.2 * R / (1e-3 * 9);
    EXPECT_NEAR(speed, limited ? 0.2 : spook, 0.02 * spook);
    for (int k = 0; k < 200; ++k) {
      s->step();
      EXPECT_LE(velocity(*s, 1).x - velocity(*s, 0).x, (limited ? 0.2 : spook) * (1 + 1e-12));
    }
    EXPECT_EQ(measure(*s).contacts, 0u);
  }
}

TEST(Nonsmooth, MomentumIsKept) {                              // T22
  NonsmoothLab lab(0.5, 0.5, 0.1);
  add_cloud(lab, 6, 2.05 * R, 7, 1.0);
  std::unique_ptr<Simulation> s;
  const auto sums = [&] {
    Vec3 p, l;
    const Particles& q = std::get<Particles>(s->world());
    for (const Index r : rows_by_id(q)) {
      const double i = 0.4 * q.mass.data[r] * q.radius.data[r] * q.radius.data[r];
      p += q.mass.data[r] * q.velocity.data[r];
      l += cross(q.position.data[r], q.mass.data[r] * q.velocity.data[r]) + i * q.angular_velocity.data[r];
    }
    return std::pair(p, l);
  };
  lab.model.solver.tolerance = 1e-6;
  s = lab.build();
  s->start();
  const auto [p0, l0] = sums();
  double scale = 0, turn = 0;
  const Particles& q = std::get<Particles>(s->world());
  for (std::size_t k = 0; k < q.rows(); ++k) scale += q.mass.data[k] * norm(q.velocity.data[k]), turn += q.mass.data[k] * norm(q.velocity.data[k]) * norm(q.position.data[k]);
  for (int k = 0; k < 50; ++k) s->step();
  const auto [p1, l1] = sums();
  EXPECT_GT(std::get<Solver>(s->world()).sweeps.data[0], 2);
  EXPECT_LT(norm(p1 - p0), 1e-12 * scale);
  EXPECT_LT(norm(l1 - l0), 1e-11 * turn);
}

// What leaves the particles must arrive at the walls, impacts too, although these are turned round before anything overlaps.
TEST(Nonsmooth, WallsTakeTheMomentumThatParticlesLose) {
  NonsmoothLab l(0.8, 0.3, 0.1);
  l.under_gravity();
  l.body(PlaneShape{});
  l.body(BoxShape{{0.5, 0.5, 0.1}}, {{4 * R + 0.5, 0, 0}, {}});
  for (int k = 0; k < 27; ++k) l.sphere(2.5 * R * Vec3{k % 3 - 1.0, k / 3 % 3 - 1.0, 1.0 + k / 9}, {1.0 + 0.1 * k, 0, -0.2 * (k % 5)});
  auto s = l.build();
  s->start();
  const auto momentum = [&] {
    Vec3 sum;
    const Particles& p = std::get<Particles>(s->world());
    for (std::size_t r = 0; r < p.rows(); ++r) sum += p.mass.data[r] * p.velocity.data[r];
    return sum;
  };
  const Vec3 weight = 27 * m * l.model.gravity;
  std::size_t impacts = 0;
  for (int k = 0; k < 300; ++k) {
    const Vec3 before = momentum();
    s->step();
    const Measures now = measure(*s);
    impacts += std::size_t(std::get<Solver>(s->world()).impacts.data[0]);
    const Vec3 walls = now.loads[0].force + now.loads[1].force, missing = momentum() - before - l.model.time_step * (weight - walls);
    ASSERT_LT(norm(missing), 1e-12 * (norm(before) + norm(weight))) << k;
  }
  EXPECT_GT(impacts, 100u);
}

TEST(Nonsmooth, SameBitsForAnyThreadsOrdersAndVectors) {
  const auto hash = [](int threads, VectorPath path, Execution how, int reorder, double skin) {
    NonsmoothLab lab(0.3, 0.6, 0.2);
    lab.under_gravity();
    lab.floor();
    add_cloud(lab, 9, 2.02 * R, 3, 1.0);
    for (Vec3& x : lab.particles().position.data) x.z += 12 * R;
    lab.model.solver.tolerance = 1e-3;
    lab.model.vector_path = path;
    lab.model.reorder_every = reorder;
    lab.model.skin = skin;
    auto s = lab.build(threads);
    s->start();
    for (int k = 0; k < 60; ++k) s->step(how);
    EXPECT_GT(std::get<Solver>(s->world()).contacts.data[0], 300);
    return s->state_hash();
  };
  const auto expected = hash(1, VectorPath::scalar, Execution::serial, 0, 0);
  for (const VectorPath path : vector_paths()) EXPECT_EQ(hash(1, path, Execution::serial, 0, 0), expected) << name_of(path);
  for (const int threads : {1, 2, 4}) EXPECT_EQ(hash(threads, best_vector_path(), Execution::graph, 1, 0.5 * R), expected) << threads;
}

// Sweeps until the floor's force of a rigid column at rest under gravity, started cold, is right to 1e-3.   T3
TEST(Nonsmooth, SweepsOfARigidColumnGrowWithTheSquareOfItsHeight) {
  for (const auto& [n, expected] : {std::pair{5, 68}, {10, 271}, {20, 1086}, {40, 4343}}) {
    NonsmoothLab lab(0, 0, 0);
    lab.model.pairs = one_pair(0, 0, 0, {pellet_density, 1e18, 0.25});
    lab.under_gravity();
    lab.floor();
    for (int k = 0; k < n; ++k) lab.sphere({0, 0, R - 1e-12 + k * (2 * R - 1e-12)});
    lab.model.solver.warm_start = false;
    lab.model.solver.tolerance = 0;
    EXPECT_NEAR(sweeps_needed(lab, 3 * expected, n * m * g), expected, std::max(1.0, 0.02 * expected)) << n;
  }
}

// A box without thickness, of 12 triangles, about the origin.
Shape closed_box(double half) {
  std::vector<Vec3> v;
  for (int k = 0; k < 8; ++k) v.push_back({k & 1 ? half : -half, k & 2 ? half : -half, k & 4 ? half : -half});
  return MeshShape{std::make_shared<Mesh>(v, std::vector<Triangle>{{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                                                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}})};
}

TEST(Nonsmooth, NoneOfTenThousandShotsEscapes) {               // T13
  std::mt19937_64 random(17);
  const auto u = [&] { return 2.0 * double(random() >> 11) * 0x1p-53 - 1.0; };
  constexpr double half = 8 * R, h = 1e-3;
  int shots = 0, escaped = 0;
  for (int box = 0; box < 250; ++box) {
    NonsmoothLab lab(0.5, 0.3, 0, h);
    lab.under_gravity();
    lab.body(closed_box(half), {{}, rotation_by({u(), u(), u()})});
    const Pose pose = lab.bodies().pose.data[0];
    for (int k = 0; k < 40; ++k) {                             // on a lattice, so that none begins inside another
      const Vec3 site{double(k % 4) - 1.5, double(k / 4 % 4) - 1.5, double(k / 16) - 1.0};
      const Vec3 direction = normalized(Vec3{u(), u(), u()});
      const double diameters = 0.5 + 2.25 * (1 + u());         // v h = 0.5 .. 5 d
      lab.sphere(to_world(pose, 3.2 * R * site), (diameters * 2 * R / h) * direction);
      ++shots;
    }
    lab.model.solver.tolerance = 1e-3;
    lab.model.solver.iterations = 50;
    auto s = lab.build();
    s->start();
    for (int k = 0; k < 20; ++k) s->step();
    for (const Vec3& x : std::get<Particles>(s->world()).position.data) {
      const Vec3 in_box = to_local(pose, x);
      escaped += !(std::max({std::abs(in_box.x), std::abs(in_box.y), std::abs(in_box.z)}) < half);
    }
  }
  EXPECT_EQ(shots, 10000);
  EXPECT_EQ(escaped, 0);
}

TEST(Nonsmooth, NoneOfAThousandShotsPassesThroughAParticle) {   // as good as fixed; the shots do not all meet its middle
  std::mt19937_64 random(23);
  const auto u = [&] { return 2.0 * double(random() >> 11) * 0x1p-53 - 1.0; };
  constexpr double h = 1e-3;
  int passed = 0;
  for (int shot = 0; shot < 1000; ++shot) {
    const double diameters = 0.5 + 2.25 * (1 + u()), away = (2.5 + 10 * (1 + u())) * R, beside = 1.9 * R * u();   // v h = 0.5 .. 5 d
    const Vec3 along = normalized(Vec3{u(), u(), u()}), side = normalized(cross(along, Vec3{u(), u(), 2}));
    NonsmoothLab lab(0.5, 0.3, 0, h);
    lab.sphere({}, {}, {}, R, 1e6 * m);
    lab.sphere(beside * side - away * along, (diameters * 2 * R / h) * along);
    lab.model.solver = {};
    auto s = lab.build();
    s->start();
    const double v = norm(velocity(*s, 1));
    for (int k = 0; k < std::ceil(away / (v * h)) + 5; ++k) s->step();
    passed += dot(velocity(*s, 1), along) > 0.99 * v;
  }
  EXPECT_EQ(passed, 0);
}

// --- dynamic rigid bodies ---------------------------------------------------------------------------------------------------

constexpr double edge = 0.1, box_mass = 1;
const Vec3 box_inertia = box_mass * edge * edge / 6 * Vec3{1, 1, 1};
Shape cube() { return BoxShape{{edge / 2, edge / 2, edge / 2}}; }

Vec3 place(const Simulation& s, Index body) { return std::get<Bodies>(s.world()).pose.data[body].position; }
Vec3 speed(const Simulation& s, Index body) { return std::get<Bodies>(s.world()).velocity.data[body]; }

TEST(NonsmoothBodies, StackOfBoxesStands) {
  NonsmoothLab lab(0.18, 0.6, 0);
  lab.under_gravity();
  lab.floor();
  for (int k = 0; k < 5; ++k) lab.body(cube(), {{0, 0, (k + 0.5) * edge}}, Motion::dynamic, box_mass, box_inertia);
  lab.model.solver.tolerance = 1e-6;
  auto s = lab.build();
  run(*s, 2);
  for (Index k = 1; k <= 5; ++k) {
    EXPECT_NEAR(place(*s, k).z, (k - 0.5) * edge, 0.03 * edge);                 // they are soft
    EXPECT_LT(norm(Vec3{place(*s, k).x, place(*s, k).y, 0}), 1e-3 * edge);
    EXPECT_LT(norm(speed(*s, k)), 1e-3);
  }
}

TEST(NonsmoothBodies, BoxOnAnInclineSticksOrSlides) {
  const double mu = 0.5;
  for (const double slope : {0.45, 0.6}) {
    const double theta = std::atan(slope);
    NonsmoothLab lab(0, mu, 0);
    lab.model.gravity = g * Vec3{std::sin(theta), 0, -std::cos(theta)};
    lab.floor();
    lab.body(cube(), {{0, 0, edge / 2}}, Motion::dynamic, box_mass, box_inertia);
    lab.model.solver.tolerance = 1e-9;
    auto s = lab.build();
    run(*s, 1);
    const double expected = slope > mu ? g * (std::sin(theta) - mu * std::cos(theta)) : 0;
    EXPECT_NEAR(speed(*s, 1).x, expected, 0.005 * g * std::sin(theta)) << slope;
    if (slope < mu) {
      EXPECT_LT(std::abs(place(*s, 1).x), 1e-3 * edge);
    }
  }
}

TEST(NonsmoothBodies, AMeshIsTheBoxItLooksLike) {
  const double theta = std::atan(0.6), mu = 0.5;
  std::vector<double> slid;
  for (const Shape& shape : {cube(), closed_box(edge / 2)}) {
    NonsmoothLab lab(0, mu, 0);
    lab.model.gravity = g * Vec3{std::sin(theta), 0, -std::cos(theta)};
    lab.floor();
    lab.body(shape, {{0, 0, edge / 2}}, Motion::dynamic, box_mass, box_inertia);
    lab.model.solver.tolerance = 1e-9;
    auto s = lab.build();
    run(*s, 0.3);
    EXPECT_NEAR(speed(*s, 1).x, 0.3 * g * (std::sin(theta) - mu * std::cos(theta)), 0.005 * g * 0.3);
    slid.push_back(place(*s, 1).x);
  }
  EXPECT_NEAR(slid[0], slid[1], 1e-3 * slid[0]);
}

// A box falls on a bed of spheres and comes to rest on it; whatever it does, forces are mutual.
std::unique_ptr<Simulation> box_on_a_bed(int threads, double time) {
  NonsmoothLab lab(0.18, 0.6, 0.1);
  lab.under_gravity();
  lab.floor();
  for (const double side : {-1.0, 1.0}) {
    lab.body(PlaneShape{}, {{side * 8 * R, 0, 0}, rotation_by({0, -side * M_PI / 2, 0})});
    lab.body(PlaneShape{}, {{0, side * 8 * R, 0}, rotation_by({side * M_PI / 2, 0, 0})});
  }
  add_cloud(lab, 7, 2.05 * R, 5, 0.1);
  for (Vec3& x : lab.particles().position.data) x.z += 8 * R;
  lab.body(cube(), {{0, 0, 0.2}}, Motion::dynamic, 0.5, 0.5 * box_inertia);
  lab.model.solver.tolerance = 1e-4;
  lab.model.solver.iterations = 500;
  auto s = lab.build(threads);
  s->start();
  while (s->time() < time - 1e-9) s->step();
  return s;
}

TEST(NonsmoothBodies, BoxComesToRestOnABed) {
  const auto s = box_on_a_bed(1, 2.5);
  EXPECT_LT(norm(speed(*s, 5)), 2e-3);
  EXPECT_GT(place(*s, 5).z, edge / 2 + 2 * R);
  const Measures seen = measure(*s);
  EXPECT_NEAR(seen.loads[5].force.z / (0.5 * g), 1, 0.02);
  double weight = 0.5 * g;
  for (const double mass : std::get<Particles>(s->world()).mass.data) weight += mass * g;
  double carried = 0;                                          // by the floor, and by friction at the walls
  for (int k = 0; k < 5; ++k) carried -= seen.loads[std::size_t(k)].force.z;
  EXPECT_NEAR(carried / weight, 1, 0.01);
}

TEST(NonsmoothBodies, SameBitsForAnyThreads) {
  const auto expected = box_on_a_bed(1, 0.3)->state_hash();
  for (const int threads : {2, 4}) EXPECT_EQ(box_on_a_bed(threads, 0.3)->state_hash(), expected);
}

// A plate that lies on 400 spheres: all its contacts share one body.
TEST(NonsmoothBodies, PlateOnManyParticlesHasTheSameBitsForAnyThreads) {
  constexpr int n = 20;
  constexpr double mass = 2;
  const auto rest = [&](int threads) {
    NonsmoothLab lab(0.18, 0.6, 0.1);
    lab.under_gravity();
    lab.floor();
    for (int k = 0; k < n * n; ++k) lab.sphere({(k % n - 0.5 * (n - 1)) * 2.02 * R, (k / n - 0.5 * (n - 1)) * 2.02 * R, R}, {1e-3 * (k % 7), 0, 0});
    const Vec3 half{1.05 * n * R, 1.05 * n * R, R};
    const Vec3 inertia = mass / 3 * Vec3{half.y * half.y + half.z * half.z, half.x * half.x + half.z * half.z, half.x * half.x + half.y * half.y};
    lab.body(BoxShape{half}, {{0, 0, 3 * R}}, Motion::dynamic, mass, inertia);
    lab.model.solver = {};
    auto s = lab.build(threads);
    s->start();
    for (int k = 0; k < 300; ++k) s->step();
    return s;
  };
  auto one = rest(1);
  EXPECT_EQ(std::get<HubContacts>(one->world()).rows(), std::size_t(n * n));
  EXPECT_NEAR(measure(*one).loads[1].force.z / (mass * g), 1, 1e-3);
  const auto expected = one->state_hash();
  one.reset();                                                 // while it lives there are no more threads than it has
  for (const int threads : {2, 4}) EXPECT_EQ(rest(threads)->state_hash(), expected) << threads;
}

TEST(NonsmoothBodies, MomentumIsKept) {
  NonsmoothLab lab(0.5, 0.4, 0);
  lab.body(cube(), {{0, 0, 0}}, Motion::dynamic, 1, box_inertia);
  lab.body(cube(), {{0.15, 0.02, 0.03}, rotation_by({0.3, 0.2, 0.5})}, Motion::dynamic, 2, 2.0 * box_inertia);
  lab.bodies().velocity.data[0] = {2, 0, 0};
  lab.sphere({-0.1, 0, 0}, {3, 0, 0}, {}, 5 * R, 0.2);
  lab.model.solver.tolerance = 1e-9;
  auto s = lab.build();
  s->start();
  const auto momentum = [&] {
    return 1.0 * speed(*s, 0) + 2.0 * speed(*s, 1) + 0.2 * velocity(*s, 0);
  };
  const auto angular_momentum = [&] {                          // cubes and spheres: their inertia is a number
    const auto& spins = std::get<Bodies>(s->world()).angular_velocity.data;
    const double i = 0.4 * 0.2 * 25 * R * R;
    return cross(place(*s, 0), speed(*s, 0)) + 2.0 * cross(place(*s, 1), speed(*s, 1)) + 0.2 * cross(position(*s, 0), velocity(*s, 0)) +
           box_inertia.x * (spins[0] + 2.0 * spins[1]) + i * spin(*s, 0);
  };
  const Vec3 before = momentum(), turning_before = angular_momentum();
  for (int k = 0; k < 200; ++k) s->step();
  EXPECT_GT(speed(*s, 1).x, 0.1);
  EXPECT_GT(norm(std::get<Bodies>(s->world()).angular_velocity.data[1]), 0.1);
  EXPECT_LT(norm(momentum() - before), 1e-12);
  EXPECT_LT(norm(angular_momentum() - turning_before), 1e-12);
}

}  // namespace
}  // namespace skred
