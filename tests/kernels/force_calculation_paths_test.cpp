// The loop over pairs of particles: every set of vector instructions gives the bits of the scalar one, for every law, and writes
// no row but its own.
#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <random>
#include "engine/buffer.h"
#include "engine/periodic.h"
#include "kernels/force_calculation_particle_particle.h"
#include "kernels/laws.h"
#include "tests/kernels/paths.h"

namespace skred {
namespace {

constexpr double radius = 0.006, mass = 4e-3, time_step = 5e-5;      // [m], [kg], [s]
constexpr double edge = 0.5;                                         // [m] of the periodic box
constexpr LawCoefficients stiff{6e6, 2e7, 1.8e3, 3.2e3, 0.5, 0.05};

// Columns that the loop writes.
struct Results {
  Buffer<Vec3> force, spring, rolling;
  Buffer<PairSum> sums;
};

// What a pair may be up to. Neighbouring rows are alike now and then, so that some packs hold one kind only and others several.
enum Kind { apart, at_one_place, just_touching, at_rest, sticking, sliding, flying_apart, kinds };

// Contacts between particles of random rows.
struct Pairs {
  Buffer<Index> i, j;
  Buffer<Vec3> position, velocity, spin;
  Buffer<double> radii, masses;
  Buffer<Index> material;
  Buffer<SeenParticle> seen;
  std::vector<Kind> kind;
  Results start;

  template <class Space> Pairs(std::size_t count, const Space& space, bool various, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(-1, 1);
    const auto any = [&](double scale) { return scale * Vec3{u(random), u(random), u(random)}; };
    std::vector<Index> rows(2 * count);
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = Index(k);
    std::shuffle(rows.begin(), rows.end(), random);
    for (auto* c : {&position, &velocity, &spin}) c->resize(2 * count);
    for (auto* c : {&radii, &masses}) c->resize(2 * count);
    material.resize(2 * count);
    for (auto* c : {&start.force, &start.spring, &start.rolling}) c->resize(count);
    for (std::size_t k = 0; k < 2 * count; ++k) start.sums.push_back({Four{u(random), u(random), u(random), 0}, Four{u(random), u(random), u(random), 0}});
    Kind what = apart;
    for (std::size_t k = 0, change = 0; k < count; ++k) {
      if (k == change) what = Kind(random() % kinds), change += 1 + random() % (random() % 3 ? 2 : 20);
      const Index a = rows[2 * k], b = rows[2 * k + 1];
      i.push_back(a);
      j.push_back(b);
      kind.push_back(what);
      for (const Index p : {a, b}) {
        radii[p] = various ? 0.004 * (1.5 + u(random)) : radius;
        masses[p] = various ? 4e-3 * (1.5 + u(random)) : mass;
        material[p] = various ? random() % 3 : 0;
        spin[p] = any(what == at_rest || what == sticking ? 1e-3 : 50);
        velocity[p] = any(what == at_rest ? 0 : what == sticking ? 1e-4 : 1);
      }
      const double sum = radii[a] + radii[b];
      const Vec3 n = what == just_touching ? Vec3{0, 0, 1} : normalized(any(1));
      const double distance = what == apart ? sum * (1.001 + 0.5 * std::abs(u(random)))
                              : what == at_one_place ? 0 : what == just_touching ? sum : sum * (1 - 0.02 * std::abs(u(random)));
      position[b] = what == just_touching || what == at_one_place ? Vec3{} : space.wrap(any(0.5 * edge) + 0.5 * edge * Vec3{1, 1, 1});
      position[a] = what == just_touching || what == at_one_place ? distance * n : space.wrap(position[b] + distance * n);
      if (what == flying_apart) velocity[a] = velocity[b] + 3.0 * n;
      start.spring[k] = any(what == at_rest || what == sticking ? 1e-9 : 1e-3);
      start.rolling[k] = any(what == at_rest || what == sticking ? 1e-9 : 1e-2);
      start.force[k] = any(1);
    }
    for (std::size_t p = 0; p < 2 * count; ++p) seen.push_back({{position[p], radii[p]}, {velocity[p], masses[p]}, {spin[p]}});
  }

  template <class P> Results after(const P& pairs, VectorPath path, std::size_t first, std::size_t last) const {
    Results r = start;
    pair_loop<P>(path)(pairs, {i.data(), j.data(), j.data(), material.data(), r.force.data(), r.spring.data(), r.rolling.data()}, first, last,
                       {0, seen.data(), r.sums.data()});
    return r;
  }
};

template <class V> bool same_bits(const Buffer<V>& a, const Buffer<V>& b, std::size_t first, std::size_t last) {
  return std::memcmp(a.data() + first, b.data() + first, (last - first) * sizeof(V)) == 0;
}

Vec3 force_of(const PairSum& s) { return {s.force[0], s.force[1], s.force[2]}; }
Vec3 torque_of(const PairSum& s) { return {s.torque[0], s.torque[1], s.torque[2]}; }

// Whether all columns agree in these rows; the first that does not is told.
testing::AssertionResult same_bits(const Results& a, const Results& b, std::size_t first, std::size_t last) {
  const auto check = [&](const char* name, const auto& x, const auto& y) -> testing::AssertionResult {
    for (std::size_t k = first; k < last; ++k)
      if (!same_bits(x, y, k, k + 1))
        return testing::AssertionFailure() << name << " of contact " << k << ": " << testing::PrintToString(x[k]) << ", "
                                           << testing::PrintToString(y[k]);
    return testing::AssertionSuccess();
  };
  for (const auto& result : {check("force", a.force, b.force), check("spring", a.spring, b.spring), check("rolling", a.rolling, b.rolling)})
    if (!result) return result;
  return testing::AssertionSuccess();
}

// No friction between some, no damping between others.
VariousParticles three_materials() {
  VariousParticles p{3, {}};
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      LawCoefficients k = stiff;
      k.normal_stiffness *= 1 + a + b, k.tangential_stiffness *= 1 + a * b;
      if (a == b) k.friction = k.rolling_friction = 0;
      if (a + b == 3) k.normal_damping = k.tangential_damping = 0;
      p.coefficients.push_back(k);
    }
  return p;
}

template <class Law, class Kinds, class Space> void compare(const Kinds& particles, const Space& space) {
  const Pairs pairs(rows_of_paths, space, !Kinds::alike, 5);
  for (const double h : {time_step, 0.0}) {
    SCOPED_TRACE(h);
    const PairForces<Law, Kinds, Space> forces{{}, particles, space, h};
    compare_paths(
        pairs.start, [&](VectorPath path, std::size_t first, std::size_t last) { return pairs.after(forces, path, first, last); },
        [&](const Results& got, const Results& want, VectorPath path) {
          ASSERT_TRUE(same_bits(got.sums, want.sums, 0, 2 * rows_of_paths)) << name_of(path) << " sums";
        },
        [&](const Results& want, std::size_t, std::size_t) {
          for (std::size_t k = 0; k < want.sums.size(); ++k) ASSERT_TRUE(Law::rotates || torque_of(want.sums[k]) == torque_of(pairs.start.sums[k]));
          ASSERT_TRUE(Law::has_tangential || same_bits(want.spring, pairs.start.spring, 0, rows_of_paths));
          ASSERT_TRUE(Law::has_rolling || same_bits(want.rolling, pairs.start.rolling, 0, rows_of_paths));
        });
  }
}

template <class Law> void compare_everywhere() {
  const PeriodicSpace box{{0, 0, 0}, {edge, edge, std::numeric_limits<double>::infinity()}};
  const AlikeParticles alike{radius, mass, stiff};
  compare<Law>(alike, OpenSpace{});
  compare<Law>(alike, box);
  compare<Law>(three_materials(), OpenSpace{});
  compare<Law>(three_materials(), box);
}

TEST(PairForces, EveryPathGivesTheBitsOfTheScalarOne) {
#define SKRED_COMPARE(LAW) { SCOPED_TRACE(#LAW); compare_everywhere<LAW>(); }
  SKRED_FOR_EACH_LAW(SKRED_COMPARE)
}

// Hertz with springs as a law chosen at run time: the bits of the packed ones, its history in another column; the same loop for every path.
template <class Space> void compare_chosen(const Space& space) {
  constexpr std::size_t count = 500;
  const Pairs pairs(count, space, true, 6);
  const VariousParticles packed = three_materials();
  ChosenParticles particles{3, {}};
  for (const LawCoefficients& k : packed.coefficients) particles.coefficients.push_back({k});
  const Results want = pairs.after(PairForces<FrictionAndRolling<true>, VariousParticles, Space>{{}, packed, space, time_step}, VectorPath::scalar, 0, count);
  const PairForces<ChosenBothMemory, ChosenParticles, Space> chosen{{}, particles, space, time_step};
  for (const VectorPath path : vector_paths()) {
    Results got = pairs.start;
    Buffer<ContactMemory> memory(count);
    for (std::size_t k = 0; k < count; ++k) memory[k] = {0, pairs.start.spring[k], {}, pairs.start.rolling[k]};
    pair_loop<PairForces<ChosenBothMemory, ChosenParticles, Space>>(path)(
        chosen, {pairs.i.data(), pairs.j.data(), pairs.j.data(), pairs.material.data(), got.force.data(), nullptr, nullptr, memory.data()}, 0, count,
        {0, pairs.seen.data(), got.sums.data()});
    for (std::size_t k = 0; k < count; ++k) got.spring[k] = memory[k].tangential, got.rolling[k] = memory[k].rolling;
    EXPECT_TRUE(same_bits(got, want, 0, count)) << name_of(path);
    EXPECT_TRUE(same_bits(got.sums, want.sums, 0, 2 * count)) << name_of(path);
  }
}

TEST(PairForces, ChosenHertzAndSpringsHaveTheBitsOfThePackedOnes) {
  compare_chosen(OpenSpace{});
  compare_chosen(PeriodicSpace{{0, 0, 0}, {edge, edge, std::numeric_limits<double>::infinity()}});
}

// The pairs above hold every case, on the scalar path: what the others are compared with makes sense.
TEST(PairForces, CasesOfThePairs) {
  const Pairs pairs(4000, OpenSpace{}, false, 5);
  const PairForces<FrictionAndRolling<true>, AlikeParticles, OpenSpace> forces{{}, {radius, mass, stiff}, {}, time_step};
  const Results r = pairs.after(forces, VectorPath::scalar, 0, 4000);
  int slid = 0, stuck = 0, cut_off = 0, rolled_off = 0;
  std::array<int, kinds> seen{};
  for (std::size_t k = 0; k < 4000; ++k) {
    ++seen[pairs.kind[k]];
    if (pairs.kind[k] == apart || pairs.kind[k] == just_touching) {
      EXPECT_TRUE(r.force[k] == Vec3{} && r.spring[k] == Vec3{} && r.rolling[k] == Vec3{}) << k;
      continue;
    }
    const Vec3 branch = pairs.position[pairs.i[k]] - pairs.position[pairs.j[k]];
    const Vec3 n = pairs.kind[k] == at_one_place ? Vec3{0, 0, 1} : normalized(branch);
    ASSERT_TRUE(is_finite(r.force[k]) && is_finite(r.spring[k]) && is_finite(r.rolling[k])) << k;
    const double normal = dot(r.force[k], n), tangential = norm(in_tangent_plane(r.force[k], n));
    EXPECT_GE(normal, 0);
    EXPECT_LE(tangential, stiff.friction * normal * (1 + 1e-9) + 1e-12);
    EXPECT_LE(norm(r.rolling[k]), stiff.rolling_friction * 0.5 * radius * normal * (1 + 1e-9));
    if (normal == 0) ++cut_off;
    else if (tangential > stiff.friction * normal * (1 - 1e-9)) ++slid;
    else ++stuck;
    rolled_off += normal > 0 && norm(r.rolling[k]) > stiff.rolling_friction * 0.5 * radius * normal * (1 - 1e-9);
  }
  for (const int n : seen) EXPECT_GT(n, 200);
  EXPECT_TRUE(slid > 200 && stuck > 200 && cut_off > 200 && rolled_off > 200) << slid << " " << stuck << " " << cut_off << " " << rolled_off;
}

// Contact by contact: the force on both, its torque about both centres, and the rolling moment on both.
TEST(PairForces, SumsAreWhatTheContactsDo) {
  constexpr std::size_t count = 300;
  const Pairs pairs(count, OpenSpace{}, true, 8);
  const VariousParticles particles = three_materials();
  const Results r = pairs.after(PairForces<FrictionAndRolling<true>, VariousParticles, OpenSpace>{{}, particles, {}, time_step}, VectorPath::scalar, 0, count);
  std::vector<Vec3> force, torque;
  for (const PairSum& s : pairs.start.sums) force.push_back(force_of(s)), torque.push_back(torque_of(s));
  for (std::size_t k = 0; k < count; ++k) {
    const Index i = pairs.i[k], j = pairs.j[k];
    const Vec3 branch = pairs.position[i] - pairs.position[j];
    const double overlap = pairs.radii[i] + pairs.radii[j] - norm(branch);
    const Vec3 n = norm(branch) > 0 ? normalized(branch) : Vec3{0, 0, 1};
    force[i] += r.force[k];
    force[j] -= r.force[k];
    torque[i] += cross(-(pairs.radii[i] - 0.5 * overlap) * n, r.force[k]) + r.rolling[k];
    torque[j] += cross((pairs.radii[j] - 0.5 * overlap) * n, -r.force[k]) - r.rolling[k];
  }
  std::size_t turned = 0;
  for (std::size_t k = 0; k < 2 * count; ++k) {
    EXPECT_LE(norm(force_of(r.sums[k]) - force[k]), 1e-12 * (1 + norm(force[k]))) << k;
    EXPECT_LE(norm(torque_of(r.sums[k]) - torque[k]), 1e-12 * (1 + norm(torque[k]))) << k;
    turned += torque[k] != torque_of(pairs.start.sums[k]);
  }
  EXPECT_GT(turned, count / 2);
}

}  // namespace
}  // namespace skred
