// A gas of smooth inelastic spheres cools by Haff's law: sqrt(T0/T) = 1 + t/tau, 1/tau = (1-e^2)/3 nu,
// nu = 2 sqrt(pi) n d^2 g0 sqrt(T0), with Enskog's g0 = (1 - phi/2) / (1 - phi)^3 and T = <v^2>/3 [Haff 1983; Brilliantov & Poeschel 2004].
#include "tests/physics/nonsmooth_lab.h"

namespace skred {
namespace {

using namespace lab;

double temperature(const Simulation& s) {
  double sum = 0;
  for (const Vec3& v : std::get<Particles>(s.world()).velocity.data) sum += dot(v, v);
  return sum / 3 / double(std::get<Particles>(s.world()).rows());
}

// The measured 1/tau as a part of Enskog's, for a step in which the mean particle goes `part` of its diameter.
double cooling_rate(double part) {
  constexpr int edge = 16;
  const double e = 0.9, filling = 0.1, d = 2 * R, spacing = std::cbrt(M_PI / 6 / filling) * d, speed = 1;
  NonsmoothLab lab(e, 0, 0, part * d / (1.6 * speed));
  std::mt19937_64 random(12);
  std::normal_distribution<double> gauss(0, speed);
  Vec3 mean;
  for (int k = 0; k < edge * edge * edge; ++k) {
    lab.sphere(spacing * Vec3{double(k % edge), double(k / edge % edge), double(k / (edge * edge))}, {gauss(random), gauss(random), gauss(random)});
    mean += (1.0 / (edge * edge * edge)) * lab.particles().velocity.data.back();
  }
  for (Vec3& v : lab.particles().velocity.data) v -= mean;
  lab.model.periodic = PeriodicSpace{{0, 0, 0}, edge * spacing * Vec3{1, 1, 1}};
  lab.model.solver.tolerance = 1e-3;
  auto s = lab.build(2);
  s->start();
  const double n = 1 / (spacing * spacing * spacing), g0 = (1 - filling / 2) / std::pow(1 - filling, 3);
  const auto enskog = [&](double t) { return (1 - e * e) / 3 * 2 * std::sqrt(M_PI) * n * d * d * g0 * std::sqrt(t); };
  while (s->time() < 0.15 / enskog(speed * speed)) s->step();  // the lattice is forgotten: two collisions each
  const double t0 = temperature(*s), from = s->time(), tau = 1 / enskog(t0);
  while (s->time() < from + tau) s->step();
  return (std::sqrt(t0 / temperature(*s)) - 1) / ((s->time() - from) / tau);
}

TEST(CoolingGas, FollowsHaffsLawWithTheRateOfEnskog) {
  const double rate = cooling_rate(0.01);
  RecordProperty("rate", std::to_string(rate));
  EXPECT_NEAR(rate, 1, 0.03);
}

}  // namespace
}  // namespace skred
