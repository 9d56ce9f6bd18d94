// profiling/bench/kernels_benchmark.cpp - single kernels under Google Benchmark: skred_benchmarks --benchmark_filter=broadphase
//
// Every kernel of a step of smooth DEM, on one thread, on a dense periodic bed over a plane, with friction and rolling
// resistance. A kernel runs again and again on the same state, with a search always due, so kernels of the search do all their
// work. What a kernel costs inside a step, where others empty its caches, is for `skred bench`.
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <vector>
#include <benchmark/benchmark.h>
#include "engine/random.h"
#include "profiling/bench/bench_scenes.h"
#include "profiling/bench/spawn.h"
#include "tasks/sampling.h"
#include "tasks/simulation.h"

namespace {

using namespace skred;

constexpr std::size_t layers = 20;
constexpr double pellet_density = 3700;                    // [kg/m^3]

// Square layers on top of each other, so close that neighbours overlap by one per cent of the radius: six contacts per particle.
// Particles move at random, so that contacts slide and roll.
World dense_bed(std::size_t side) {
  const double spacing = 1.99 * pellet_radius;
  const auto random = [](std::size_t particle, std::uint64_t draw) { return 2 * uniform(1, 0, particle, draw) - 1; };
  World w;
  Particles& p = std::get<Particles>(w);
  for (std::size_t k = 0; k < layers; ++k)
    for (std::size_t j = 0; j < side; ++j)
      for (std::size_t i = 0; i < side; ++i) {
        const std::size_t n = p.rows();
        p.position.data.push_back(spacing * Vec3{double(i) + 0.5, double(j) + 0.5, double(k) + 0.5});
        p.velocity.data.push_back(0.1 * Vec3{random(n, 0), random(n, 1), random(n, 2)});
        p.angular_velocity.data.push_back(10.0 * Vec3{random(n, 3), random(n, 4), random(n, 5)});
      }
  const std::size_t n = p.rows();
  p.radius.data.assign(n, pellet_radius);
  p.mass.data.assign(n, pellet_density * 4.0 / 3 * std::numbers::pi * pellet_radius * pellet_radius * pellet_radius);
  p.material.data.assign(n, 0);
  Bodies& b = std::get<Bodies>(w);
  b.motion.data = {Motion::fixed};
  b.pose.data = {{}};
  Geometries& g = std::get<Geometries>(w);
  g.body.data = {0};
  g.shape.data = {PlaneShape{}};
  g.local.data = {{}};
  g.material.data = {0};
  return w;
}

Model pellets(std::size_t side) {
  Model m;
  m.time_step = 5e-5;
  const Material pellet{pellet_density, 6.1684e6, 0.25};   // Pettersson 2015, table 4.1; Poisson's ratio is ours
  m.pairs.values[0] = elastic_pair(pellet, pellet);
  m.pairs.values[0].restitution = 0.18;
  m.pairs.values[0].friction = 0.91;
  m.pairs.values[0].rolling_friction = 0.3211;
  m.reorder_every = 1;                                     // so that every call of `reorder` sorts
  const double length = 1.99 * pellet_radius * double(side), infinite = std::numeric_limits<double>::infinity();
  m.periodic = PeriodicSpace{{}, {length, length, infinite}};
  return m;
}

void search_is_due(Simulation& sim) {
  Search& s = std::get<Search>(sim.world());
  s.due.data[0] = s.list_due.data[0] = 1;
}

// A second search, so that there is a list before the present one, and contacts have a history to carry over.
void search_again(Simulation& sim) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < sim.task().size(); ++k)
    if (std::strcmp(sim.task().name(k), "check_motion") != 0) order.push_back(k);
  search_is_due(sim);
  sim.step_in_order(order);
}

void run_kernel(benchmark::State& state, std::size_t kernel) {
  const auto side = std::size_t(std::lround(std::sqrt(double(state.range(0)) / layers)));
  Simulation sim(dense_bed(side), pellets(side), 1);
  sim.start();
  search_again(sim);
  // Called a million times without the other kernels, the one that moves particles would carry them away.
  if (std::strcmp(sim.task().name(kernel), "integrate") == 0) {
    Particles& p = std::get<Particles>(sim.world());
    for (auto* column : {&p.velocity, &p.angular_velocity, &p.force, &p.torque, &p.previous_force, &p.previous_torque})
      column->data.assign(p.rows(), Vec3{});
  }
  const Measures m = measure(sim);
  const std::array order{kernel};
  for (auto _ : state) {
    search_is_due(sim);
    sim.step_in_order(order);
    benchmark::ClobberMemory();
  }
  const auto particles = double(std::get<Particles>(sim.world()).rows());
  using benchmark::Counter;
  state.SetItemsProcessed(std::int64_t(particles) * state.iterations());                 // items: particles
  const double contacts = double(m.contacts + m.body_contacts);
  state.counters["time/contact"] = Counter(contacts, Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["contacts"] = 2 * double(m.contacts) / particles;                        // of a particle, with others
}

void register_kernels() {
  Simulation step(dense_bed(4), pellets(4), 1);
  for (std::size_t k = 0; k < step.task().size(); ++k) {
    benchmark::RegisterBenchmark(step.task().name(k), run_kernel, k)
        ->Arg(2000)->Arg(32000)->Arg(128000)->Unit(benchmark::kMicrosecond);
  }
}

}  // namespace

int main(int argc, char** argv) {
  register_kernels();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
}
