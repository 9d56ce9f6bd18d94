// Hard cases for the solver of nonsmooth DEM: warm starts, mass ratios, wedges, forces that are not unique, packs, energy.
#include <algorithm>
#include <map>
#include <numeric>
#include "tests/physics/nonsmooth_lab.h"

namespace skred {
namespace {

using namespace lab;

// A tower a thousand times stiffer than the pellets, at rest from the start, with far fewer sweeps than it needs: after a
// second nothing may move. Impulses of the last step that are far from the solution must not be taken whole.   T4
double greatest_speed_of_tower(const SolverOptions& solver) {
  constexpr int n = 50;
  NonsmoothLab lab(0.18, 0, 0);
  lab.model.pairs = one_pair(0.18, 0, 0, {pellet_density, 1e3 * pellet.youngs_modulus, pellet.poissons_ratio});
  lab.under_gravity();
  lab.floor();
  for (const double z : column_at_rest(lab, n)) lab.sphere({0, 0, z});
  lab.model.solver = solver;
  auto s = lab.build();
  run(*s, 0.9);
  double speed = 0;
  while (s->time() < 1 - 1e-9) {
    s->step(Execution::list);
    speed = std::max(speed, measure(*s).max_speed);
  }
  return speed;
}
SolverOptions few_sweeps(double trusted_residual) {
  SolverOptions o;
  o.iterations = 20;
  o.tolerance = 0;
  o.trusted_residual = trusted_residual;
  return o;
}

TEST(HardCases, GuardedWarmStartKeepsAStiffTowerStill) {
  const double speed = greatest_speed_of_tower(few_sweeps(SolverOptions{}.trusted_residual));
  RecordProperty("speed", std::to_string(speed));
  EXPECT_LT(speed, 1e-3);
}
TEST(HardCases, UnguardedWarmStartDoesNot) {
  const double speed = greatest_speed_of_tower(few_sweeps(std::numeric_limits<double>::infinity()));
  RecordProperty("speed", std::to_string(speed));
  EXPECT_FALSE(speed < 1e-3);
}
// As it comes: the tolerance bounds the error, and not what the last of many slow sweeps changed.
TEST(HardCases, ProductionSettingsKeepAStiffTowerStill) {
  const double speed = greatest_speed_of_tower({});
  RecordProperty("speed", std::to_string(speed));
  EXPECT_LT(speed, 1e-3);
  SolverOptions by_change;
  by_change.error_tolerance = std::numeric_limits<double>::infinity();
  EXPECT_GT(greatest_speed_of_tower(by_change), 1e-3);
}

// What is told of the error: the sum of changes that go on to fall as they did; rounding where they are tiny and do not; else nothing.
TEST(HardCases, ErrorThatIsTold) {
  NonsmoothLab lab(0, 0, 0);
  lab.sphere({0, 0, R});
  auto s = lab.build();
  const auto error = [&](std::int64_t sweeps, double residual, double ratio) {
    Solver& solver = std::get<Solver>(s->world());
    solver.sweeps.data[0] = sweeps, solver.residual.data[0] = residual, solver.error_left.data[0] = std::pow(ratio, double(sweeps));
    return solver_error(s->world());
  };
  EXPECT_EQ(error(0, 1, 1), 0);
  EXPECT_NEAR(error(40, 1e-3, 0.75), 3e-3, 1e-15);
  EXPECT_NEAR(error(40, 1e-12, 0.75), 3e-12, 1e-24);
  EXPECT_EQ(error(500, 2.353e-13, 1), 2.353e-13);
  EXPECT_EQ(error(500, 1e-15, 0.999), 1e-15);
  EXPECT_EQ(error(500, 1e-9, 1), std::numeric_limits<double>::infinity());
}

// A heavy sphere on a light one on a floor, as good as rigid, started cold: the error falls by 1 + m/M per sweep.   T5
TEST(HardCases, HeavyOnLightConvergesAtTheRateOfTheMassRatio) {
  for (const double ratio : {10.0, 100.0, 1000.0}) {
    NonsmoothLab lab(0, 0, 0);
    lab.model.pairs = one_pair(0, 0, 0, {pellet_density, 1e18, 0.25});
    lab.under_gravity();
    lab.floor();
    lab.sphere({0, 0, R - 1e-12});
    lab.sphere({0, 0, 3 * R - 2e-12}, {}, {}, R, ratio * m);
    lab.model.solver.warm_start = false;
    lab.model.solver.tolerance = 0;
    const double weight = (1 + ratio) * m * g;
    const auto error = [&](int sweeps) { return floor_error(lab, sweeps, weight); };
    const int expected = static_cast<int>(std::log(1e3) / std::log1p(1 / ratio));
    EXPECT_NEAR(std::log(error(expected / 2) / error(expected)) / (expected - expected / 2) / std::log1p(1 / ratio), 1, 0.02) << ratio;
    EXPECT_NEAR(sweeps_needed(lab, 3 * expected, weight), expected, std::max(1.0, 0.02 * expected)) << ratio;
  }
}

TEST(HardCases, HeavyOnLightRestsAtTheOverlapsOfHertz) {       // T5, both methods
  for (const double ratio : {10.0, 100.0, 1000.0})
    for (const Method method : {Method::sdem, Method::ndem}) {
      NonsmoothLab lab(0.18, 0, 0);
      lab.model.method = method;
      if (method == Method::sdem) lab.model.time_step = thesis_step;
      lab.under_gravity();
      lab.floor();
      const double below = std::pow((1 + ratio) * m * g / hertz(lab, R), 2.0 / 3.0), above = std::pow(ratio * m * g / hertz(lab, R / 2), 2.0 / 3.0);
      lab.sphere({0, 0, R - 0.99 * below});
      lab.sphere({0, 0, 3 * R - 0.99 * below - 1.01 * above}, {}, {}, R, ratio * m);
      auto s = lab.build();
      run(*s, 16);
      EXPECT_NEAR(measure(*s).body_normal_force / ((1 + ratio) * m * g), 1, 1e-6) << ratio;
      EXPECT_NEAR(pair_forces(*s)[0] / (ratio * m * g), 1, 1e-6) << ratio;
      EXPECT_NEAR((R - position(*s, 0).z) / below, 1, 1e-6) << ratio;
      EXPECT_NEAR((2 * R - position(*s, 1).z + position(*s, 0).z) / above, 1, 1e-6) << ratio;
    }
}

// Two planes with the half angle alpha to the vertical between them.
void add_wedge(Lab& lab, double alpha) {
  for (const double side : {-1.0, 1.0}) lab.body(PlaneShape{}, {{}, rotation_by({0, side * (M_PI / 2 - alpha), 0})});
}

TEST(HardCases, WedgeCarriesASphereWithTheForcesOfStatics) {   // T14, both methods
  for (const Method method : {Method::sdem, Method::ndem})
    for (const double degrees : {10.0, 30.0, 60.0}) {
      const double alpha = degrees * M_PI / 180;
      NonsmoothLab lab(0.18, 0, 0);
      lab.model.method = method;
      if (method == Method::sdem) lab.model.time_step = thesis_step;
      lab.under_gravity();
      add_wedge(lab, alpha);
      lab.sphere({0, 0, R / std::sin(alpha)});
      auto s = lab.build();
      run(*s, 3);
      const Measures seen = measure(*s);
      for (const BodyLoad& load : seen.loads) EXPECT_NEAR(norm(load.force) / (m * g / (2 * std::sin(alpha))), 1, 1e-6) << degrees;
      EXPECT_EQ(seen.body_contacts, 2u);
    }
}

// A sphere pressed into a wedge and let go, without gravity: it stays, under stress, if mu > tan(alpha).   T15, both methods
TEST(HardCases, WedgeHoldsASphereThatWasPressedIn) {
  const double alpha = 10 * M_PI / 180, overlap = 0.02 * R;
  for (const Method method : {Method::sdem, Method::ndem})
    for (const double mu : {0.0, 0.1, 0.17, 0.18, 0.3, 0.91}) {
      NonsmoothLab lab(0.18, mu, 0);
      lab.model.method = method;
      if (method == Method::sdem) lab.model.time_step = thesis_step;
      add_wedge(lab, alpha);
      lab.sphere({0, 0, (R - overlap) / std::sin(alpha)});
      auto s = lab.build();
      run(*s, 2);
      const Measures seen = measure(*s);
      const double stress = seen.body_normal_force / 2 / (hertz(lab, R) * std::pow(overlap, 1.5));
      RecordProperty((method == Method::sdem ? "sdem_" : "ndem_") + std::to_string(int(std::round(100 * mu))), std::to_string(stress));
      ASSERT_TRUE(is_finite(position(*s, 0)));
      if (mu > std::tan(alpha)) {
        EXPECT_GT(stress, 0.1) << mu;
        EXPECT_LT(seen.max_speed, 1e-6) << mu;
        if (method == Method::ndem) { EXPECT_NEAR(stress, 1, 1e-6) << mu; }   // friction holds it where it is
      } else {
        EXPECT_EQ(seen.body_contacts, 0u) << mu;
        EXPECT_GT(velocity(*s, 0).z, 0) << mu;
      }
    }
}

// A pack of rows of n and n - 1 spheres between walls, in one plane; `order` numbers the spheres.
struct Pack {
  static constexpr int wide = 8, rows = 8;
  std::vector<Vec3> place;
  Pack() {
    const double gap = 1.98 * R;                               // squeezed sideways
    for (int k = 0; k < rows; ++k)
      for (int i = 0; i < wide - k % 2; ++i) place.push_back({gap * (i + 0.5 * (k % 2)), 0, 0.99 * R + k * gap * std::sqrt(0.75)});
  }
  NonsmoothLab lab(const std::vector<Index>& order, double friction) const {
    NonsmoothLab lab(0.18, friction, 0);
    lab.under_gravity();
    lab.floor();
    lab.body(PlaneShape{}, {{-0.99 * R, 0, 0}, rotation_by({0, M_PI / 2, 0})});
    lab.body(PlaneShape{}, {{1.98 * R * (wide - 1) + 0.99 * R, 0, 0}, rotation_by({0, -M_PI / 2, 0})});
    for (const Index k : order) lab.sphere(place[k]);
    return lab;
  }
  std::vector<Index> in_order() const {
    std::vector<Index> order(place.size());
    std::iota(order.begin(), order.end(), Index{0});
    return order;
  }
};

// Normal forces by the places that touch; body contacts have a negative second.
std::map<std::pair<int, int>, double> normal_forces(const Simulation& s, const std::vector<Index>& order) {
  std::map<std::pair<int, int>, double> out;
  const Particles& p = std::get<Particles>(s.world());
  const Contacts& c = std::get<Contacts>(s.world());
  const BodyContacts& bc = std::get<BodyContacts>(s.world());
  const auto put = [&](int a, int b, double f) { if (f != 0) out[{a, b}] = f; };
  for (std::size_t k = 0; k < c.rows(); ++k) {
    const Index i = c.i.data[k], j = c.j.data[k];
    const auto a = int(order[p.id.data[i]]), b = int(order[p.id.data[j]]);
    put(std::min(a, b), std::max(a, b), std::abs(dot(c.force.data[k], normalized(p.position.data[i] - p.position.data[j]))));
  }
  for (std::size_t k = 0; k < bc.rows(); ++k)
    put(int(order[p.id.data[bc.particle.data[k]]]), -1 - int(bc.geometry.data[k]), std::abs(dot(bc.force.data[k], bc.normal.data[k])));
  return out;
}

// More contacts than equations of balance; with their compliance the normal forces are unique all the same.   T16
TEST(HardCases, ForcesOfAPackDoNotDependOnTheOrderOfContacts) {
  const Pack pack;
  for (const double friction : {0.0, 0.5}) {
    std::map<std::pair<int, int>, double> low, high;
    std::vector<Index> order = pack.in_order();
    std::mt19937_64 random(3);
    for (int trial = 0; trial < 10; ++trial) {
      NonsmoothLab lab = pack.lab(order, friction);
      lab.model.solver.tolerance = 1e-9;
      auto s = lab.build();
      s->start();
      s->step();
      EXPECT_LE(std::get<Solver>(s->world()).residual.data[0], 1e-9);
      for (const auto& [at, f] : normal_forces(*s, order)) {
        if (trial == 0) low[at] = high[at] = f;
        low.at(at) = std::min(low.at(at), f), high.at(at) = std::max(high.at(at), f);
      }
      std::shuffle(order.begin(), order.end(), random);
    }
    double spread = 0, mean = 0;
    for (const auto& [at, f] : low) spread = std::max(spread, high[at] - f), mean += f / double(low.size());
    EXPECT_GT(low.size(), 2 * pack.place.size());
    RecordProperty(friction > 0 ? "spread_with_friction" : "spread", std::to_string(spread / mean * 1e9) + "e-9");
    if (friction == 0) { EXPECT_LT(spread / mean, 1e-6); }
  }
}

TEST(HardCases, PackStandsOnItsFloorWithItsWeight) {           // T17
  const Pack pack;
  const double weight = double(pack.place.size()) * m * g;
  for (const bool converged : {true, false}) {
    NonsmoothLab lab = pack.lab(pack.in_order(), 0);
    if (!converged) lab.model.solver = {};
    auto s = lab.build();
    run(*s, 4);
    const Measures seen = measure(*s);
    const double allowed = converged ? 1e-6 : 1e-3;
    RecordProperty(converged ? "bottom" : "bottom_production", std::to_string((-seen.loads[0].force.z / weight - 1) * 1e9) + "e-9");
    EXPECT_NEAR(-seen.loads[0].force.z / weight, 1, allowed);
    EXPECT_NEAR((seen.loads[1].force.x + seen.loads[2].force.x) / weight, 0, allowed);
    EXPECT_GT(seen.loads[2].force.x / weight, 0.1);
  }
}

// A squeezed pile that is its own mirror image: so are its forces, as far as the solver was driven. The automatic error tolerance is that
// of all scenes without friction; with friction it has to be asked for.   T23
TEST(HardCases, MirroredPileHasMirroredForces) {
  for (const double friction : {0.0, 0.5})
    for (const double tolerance : {1e-6, 1e-9}) {
      NonsmoothLab lab(0.18, friction, 0);
      lab.under_gravity();
      lab.floor();
      constexpr int base = 8;                                  // even: without friction the middle one of an odd row is not stable
      constexpr double gap = 1.98 * R;
      for (const double side : {-1.0, 1.0})
        lab.body(PlaneShape{}, {{side * base * gap / 2, 0, 0}, rotation_by({0, -side * M_PI / 2, 0})});
      std::vector<Index> mirror;
      for (int k = 0, first = 0; k < base; first += base - k, ++k)
        for (int i = 0; i < base - k; ++i) {
          lab.sphere({(i - 0.5 * (base - k - 1)) * gap, 0, 0.99 * R + k * gap * std::sqrt(0.75)});
          mirror.push_back(static_cast<Index>(first + base - k - 1 - i));
        }
      lab.model.solver.tolerance = tolerance;
      if (friction > 0) lab.model.solver.error_tolerance = tolerance;
      auto s = lab.build();
      const auto asymmetry = [&] {                             // of all forces
        std::vector<Index> order(mirror.size());
        std::iota(order.begin(), order.end(), Index{0});
        const auto here = normal_forces(*s, order), there = normal_forces(*s, mirror);
        double apart = 0, total = 0;
        for (const auto& [at, f] : here) {
          const auto at_mirror = at.second >= -1 ? at : std::pair(at.first, at.second == -2 ? -3 : -2);   // walls change sides
          const auto found = there.find(at_mirror);
          apart += std::abs(f - (found == there.end() ? 0 : found->second)), total += f;
        }
        EXPECT_GT(total, 3 * double(mirror.size()) * m * g);
        return apart / total;
      };
      s->start();
      s->step();
      const Solver& solver = std::get<Solver>(s->world());
      const double once = asymmetry();
      const auto sweeps = solver.sweeps.data[0];
      EXPECT_EQ(solver.unsolved.data[0], 0);
      EXPECT_LT(once, tolerance) << friction;
      while (s->time() < 1) s->step();
      const double later = asymmetry();                        // of all the errors until then
      RecordProperty((friction > 0 ? "friction_" : "smooth_") + std::string(tolerance > 1e-8 ? "1e-6" : "1e-9"),
                     std::to_string(sweeps) + " sweeps, " + std::to_string(once / tolerance) + ", after a second " + std::to_string(later / tolerance));
    }
}

// A bin of spheres without friction: its forces settle and stay.   T19
TEST(HardCases, FrictionlessBinComesToRest) {
  NonsmoothLab lab(0.18, 0, 0);
  lab.under_gravity();
  lab.floor();
  lab.body(HollowCylinderShape{6.5 * R, 60 * R, 0.01}, {{0, 0, 30 * R}, {}});
  add_cloud(lab, 6, 2.1 * R, 5, 0.1);
  Vec3 low;
  for (const Vec3& x : lab.particles().position.data) low.z = std::min(low.z, x.z);
  for (Vec3& x : lab.particles().position.data) x = 0.6 * Vec3{x.x, x.y, 0} + Vec3{0, 0, 2.2 * (x.z - low.z) + 2 * R};
  lab.model.solver = {};
  auto s = lab.build();
  run(*s, 3);                                                  // filled within the first
  const double weight = [&] { double w = 0; for (const double mass : lab.particles().mass.data) w += mass * g; return w; }();
  std::vector<double> sums;
  Measures seen;
  for (int k = 0; k < 500; ++k) {
    s->step();
    seen = measure(*s);
    sums.push_back(seen.normal_force + seen.body_normal_force);
  }
  const double mean = std::accumulate(sums.begin(), sums.end(), 0.0) / double(sums.size());
  double square = 0;
  for (const double f : sums) square += (f - mean) * (f - mean) / double(sums.size());
  RecordProperty("fluctuation", std::to_string(std::sqrt(square) / mean * 1e6) + "e-6");
  RecordProperty("kinetic_energy", std::to_string(seen.kinetic_energy / (weight * 2 * R) * 1e9) + "e-9");
  RecordProperty("bottom", std::to_string(-seen.loads[0].force.z / weight));
  EXPECT_LT(std::sqrt(square) / mean, 0.01);
  EXPECT_LT(seen.kinetic_energy, 1e-6 * weight * 2 * R);
  EXPECT_NEAR(-seen.loads[0].force.z / weight, 1, 1e-3);
}

// Slow impacts have no impact stage: SPOOK without damping keeps the energy, in the mean over where in a step they begin.   T21
TEST(HardCases, UndampedContactsKeepTheEnergy) {
  const double speed = 0.5;
  for (const double part_of_contact : {0.02, 0.08, 0.16}) {
    NonsmoothLab lab(1, 0, 0);
    const double deepest = std::pow(5 * m / 2 * speed * speed / (4 * hertz(lab, R / 2)), 0.4);
    lab.model.time_step = part_of_contact * 2.9432 * deepest / speed;
    lab.model.solver.damping_steps = 0;
    lab.model.solver.impact_speed = 10;
    double mean = 0, low = 2, high = 0;
    constexpr int phases = 40;
    for (int k = 0; k < phases; ++k) {
      Lab shot = lab;
      shot.sphere({0, 0, 0}, {speed, 0, 0});
      shot.sphere({2 * R + (2 + (k + 0.5) / phases) * speed * lab.model.time_step, 0, 0});
      auto s = shot.build();
      run(*s, 4 * 2.9432 * deepest / speed);
      const double e = (velocity(*s, 1).x - velocity(*s, 0).x) / speed;
      mean += e / phases, low = std::min(low, e), high = std::max(high, e);
    }
    RecordProperty("mean_" + std::to_string(int(100 * part_of_contact)), std::to_string(mean) + " from " + std::to_string(low) + " to " + std::to_string(high));
    EXPECT_NEAR(mean, 1, 1e-3) << part_of_contact;
    EXPECT_NEAR(low, 1, 0.006) << part_of_contact;
    EXPECT_NEAR(high, 1, 0.006) << part_of_contact;
  }
}

// A ball that falls on a column of thirty at rest, in one step. Rigid, each contact would hand the shock on to all below, and 30 of them
// need 0.4 n^2 sweeps per factor e; with the compliance of rest it stays above.
TEST(HardCases, ImpactsOnABedNeedFewSweeps) {
  constexpr int n = 30;
  NonsmoothLab lab(0.18, 0.5, 0.1);
  lab.under_gravity();
  lab.floor();
  const std::vector<double> z = column_at_rest(lab, n);
  for (const double height : z) lab.sphere({0, 0, height});
  lab.sphere({0, 0, z.back() + 2 * R}, {0, 0, -1});
  lab.model.solver = {};
  auto s = lab.build();
  s->start();
  s->step();
  const Solver& solver = std::get<Solver>(s->world());
  EXPECT_EQ(solver.impacts.data[0], 1);
  EXPECT_EQ(solver.impacts_unsolved.data[0], 0);
  RecordProperty("sweeps", std::to_string(solver.impact_sweeps.data[0]));
  EXPECT_LT(solver.impact_sweeps.data[0], 30);
  EXPECT_LT(norm(velocity(*s, 0)), 1e-3);                      // the lowest has not felt it yet
}

// Spheres that all touch and move at random: whatever the restitution, the impacts of one step give no energy.
TEST(HardCases, ImpactsNeverGiveEnergy) {
  for (const double restitution : {0.18, 0.5, 1.0})
    for (const double friction : {0.0, 0.5})
      for (unsigned seed = 1; seed <= 5; ++seed) {
        NonsmoothLab lab(restitution, friction, 0);
        add_cloud(lab, 4, 1.8 * R, seed, 0, false);            // of radius 0.9 R
        std::mt19937_64 random(seed);
        std::normal_distribution<double> u(0, 0.3);
        Index k = 0;
        for (Vec3& x : lab.particles().position.data) {
          const Vec3 site{double(k % 4), double(k / 4 % 4), double(k / 16)};
          x = 1.8 * R * site;                                  // without add_cloud's disorder: all touch, none overlaps
          lab.particles().velocity.data[k] = {u(random), u(random), u(random)};
          ++k;
        }
        lab.model.solver.impact_iterations = 20000;
        lab.model.solver.impact_speed = 0.2;
        auto s = lab.build();
        s->start();
        const auto energy = [&] { const Measures seen = measure(*s); return seen.kinetic_energy + seen.rotational_energy; };
        const double before = energy();
        s->step();
        EXPECT_GT(std::get<Solver>(s->world()).impacts.data[0], 20);
        EXPECT_EQ(std::get<Solver>(s->world()).impacts_unsolved.data[0], 0);
        EXPECT_LE(energy(), before * (1 + 1e-9)) << restitution << " " << friction << " " << seed;
      }
}

// Rolling resistance in impacts, where it is asked for: |L| <= mu_r R p_n, and no more than stops the spin.
TEST(HardCases, RollingResistanceMayActInImpacts) {
  const double e = 0.5, mu_r = 0.3, vn = 0.5, limit = 2.5 * mu_r * (1 + e) * vn / R;   // of the change of spin
  for (const bool acts : {false, true})
    for (const double w : {0.5 * limit, 3 * limit}) {
      NonsmoothLab lab(e, 0, mu_r);
      lab.floor();
      lab.sphere({0, 0, R + 1e-10}, {0, 0, -vn}, {0, w, 0});
      lab.model.solver.impact_speed = 0.1;
      lab.model.solver.impact_rolling = acts;
      auto s = lab.build();
      s->start();
      s->step();
      EXPECT_NEAR(spin(*s, 0).y, acts ? std::max(0.0, w - limit) : w, 1e-6 * w);
      EXPECT_NEAR(velocity(*s, 0).z, e * vn, 1e-9);
    }
}

// --- gross sliding, exactly: Chung & Ooi 2011, tests 4 to 8, for a rigid contact -------------------------------------------------

struct Shot {
  NonsmoothLab lab;
  explicit Shot(double e, double mu) : lab(e, mu, 0) {
    lab.model.solver.impact_speed = 1e-3;
    lab.model.solver.impact_iterations = 2000;
  }
  std::unique_ptr<Simulation> hit() {
    auto s = lab.build();
    s->start();
    s->step();
    EXPECT_EQ(std::get<Solver>(s->world()).impacts.data[0], 1);
    return s;
  }
};

TEST(ObliqueImpact, SphereOnAWall) {                           // tests 4 and 5
  struct Case { double e, mu, speed; };
  for (const Case c : {Case{0.98, 0.092, 3.9}, Case{1, 0.3, 5}})
    for (int k = 1; k < 18; ++k) {
      const double theta = k * 5 * M_PI / 180, vn = c.speed * std::cos(theta), vt = c.speed * std::sin(theta);
      Shot shot(c.e, c.mu);
      shot.lab.floor();
      shot.lab.sphere({0, 0, R + 1e-10}, {vt, 0, -vn});
      const auto s = shot.hit();
      const double drop = std::min(c.mu * (1 + c.e) * vn, 2.0 / 7 * vt);       // sliding, or sticking
      EXPECT_NEAR(velocity(*s, 0).z / (c.e * vn), 1, 1e-6);
      EXPECT_NEAR(velocity(*s, 0).x / vt, 1 - drop / vt, 1e-6) << theta;
      EXPECT_NEAR(spin(*s, 0).y * R / vt, 2.5 * drop / vt, 1e-6) << theta;
    }
}

TEST(ObliqueImpact, SpinningSphereOnAWallOrAHugeOne) {         // tests 6 and 8
  const double e = 0.5, mu = 0.4, vn = 0.2;
  for (const bool on_sphere : {false, true})
    for (int k = 1; k < 18; ++k) {
      const double surface = vn * std::tan(k * 5 * M_PI / 180);
      Shot shot(e, mu);
      if (on_sphere) shot.lab.sphere({0, 0, -5 * R}, {}, {}, 5 * R, 1e12 * m);
      else shot.lab.floor();
      shot.lab.sphere({0, 0, R + 1e-10}, {0, 0, -vn}, {0, surface / R, 0});
      const auto s = shot.hit();
      const Index id = on_sphere ? 1 : 0;
      const double push = std::min(mu * (1 + e) * vn, 2.0 / 7 * surface);
      EXPECT_NEAR(velocity(*s, id).z / (e * vn), 1, 1e-6);
      EXPECT_NEAR(velocity(*s, id).x / surface, push / surface, 1e-6) << k;
      EXPECT_NEAR(spin(*s, id).y * R / surface, 1 - 2.5 * push / surface, 1e-6) << k;
    }
}

TEST(ObliqueImpact, TwoSpheresThatDoNotSlipKeepTheirSpin) {    // test 7
  for (const double w : {0.17498, 1.0, 5.0, 22.860}) {
    Shot shot(0.5, 0.4);
    shot.lab.sphere({0, 0, 0}, {0.2, 0, 0}, {0, w, 0});
    shot.lab.sphere({2 * R + 1e-10, 0, 0}, {-0.2, 0, 0}, {0, -w, 0});
    const auto s = shot.hit();
    for (const Index k : {0u, 1u}) {
      const double side = k == 0 ? 1 : -1;
      EXPECT_NEAR(velocity(*s, k).x, -side * 0.1, 1e-9);
      EXPECT_LT(norm(velocity(*s, k) - Vec3{velocity(*s, k).x, 0, 0}), 1e-12);
      EXPECT_NEAR(spin(*s, k).y, side * w, 1e-12 * w);
    }
  }
}

}  // namespace
}  // namespace skred
