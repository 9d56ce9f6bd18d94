// tests/profiling/fake_run.h - a made-up run of a drum: realistic kernels and chunks, with times that are known exactly.
#pragma once
#include <algorithm>
#include <string>
#include <vector>
#include "profiling/timeline.h"

namespace skred::test {

struct FakeKernel { const char* name; double time; int chunks; };   // [s] of work; chunks shared by the threads

// About 34 ms of work and 300 chunks.
inline const std::vector<FakeKernel>& drum_kernels() {
  static const std::vector<FakeKernel> kernels{
      {"integrate", 1.1e-3, 24},
      {"move_bodies", 0.002e-3, 1},
      {"check_motion", 0.5e-3, 24},
      {"reorder", 1.3e-3, 12},
      {"broadphase", 8.9e-3, 48},
      {"contact_hashing", 5.2e-3, 48},
      {"broadphase_body", 1.2e-3, 12},
      {"contact_geometry_body", 1.1e-3, 12},
      {"force_calculation_particle_particle", 11.3e-3, 96},
      {"force_calculation_particle_body", 0.9e-3, 12},
      {"force_application_particle", 2.2e-3, 24},
      {"force_application_body", 0.15e-3, 2},
      {"sample", 0.3e-3, 4}};
  return kernels;
}

class FakeRun {
 public:
  FakeRun(Timeline& timeline, std::vector<FakeKernel> kernels) : timeline_(timeline), kernels_(std::move(kernels)) {}

  // One step; `slowness` multiplies its work. Spans lie in the past of now(), so steps are written after each other's real time.
  void step(std::int64_t number, double slowness = 1) {
    const double tick = Timeline::seconds_per_tick();
    const int threads = timeline_.threads();
    double at = 0;                                                  // [s] since the start of the step
    timeline_.begin_step(number);
    const Ticks start = Timeline::now();
    const auto ticks = [&](double t) { return start + static_cast<Ticks>(t / tick); };
    for (const FakeKernel& k : kernels_) {
      const KernelId id = timeline_.kernel(k.name);
      const double begin = at;
      std::vector<double> free(static_cast<std::size_t>(threads), begin + 2e-6);
      for (int i = 1; i < threads; ++i) free[i] += 3e-6 * i;        // later threads wake up later
      for (int c = 0; c < k.chunks; ++c) {
        const auto lane = std::min_element(free.begin(), free.end()) - free.begin();
        const double uneven = 0.6 + 0.8 * random();                 // of the mean
        const double from = free[lane], to = from + slowness * uneven * k.time / k.chunks;
        timeline_.chunk(static_cast<int>(lane), id, ticks(from), ticks(to), 1024);
        free[lane] = to + 0.2e-6;
      }
      at = *std::max_element(free.begin(), free.end()) + 2e-6;
      timeline_.call(0, id, ticks(begin), ticks(at), 1024u * static_cast<unsigned>(k.chunks));
      at += 1e-6;
    }
    timeline_.counter("contacts", 400000 + double(number));
    while (Timeline::now() < ticks(at)) {
    }
    timeline_.end_step();
  }

 private:
  double random() { return double((state_ = state_ * 6364136223846793005u + 1442695040888963407u) >> 40) / double(1 << 24); }
  Timeline& timeline_;
  std::vector<FakeKernel> kernels_;
  std::uint64_t state_ = 1;
};

}  // namespace skred::test
