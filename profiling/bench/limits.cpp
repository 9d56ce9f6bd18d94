#include "profiling/bench/limits.h"
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <thread>
#include <vector>

namespace skred {

namespace {

using Clock = std::chrono::steady_clock;

// Runs `work` on so many threads at once, again and again for a while, and returns the calls per second of all of them together.
double calls_per_second(int threads, const std::function<void(int)>& work) {
  constexpr auto duration = std::chrono::milliseconds(100);
  std::atomic<int> ready{0};
  std::atomic<long> calls{0};
  std::vector<std::thread> team;
  std::atomic<Clock::rep> first{0}, last{0};
  for (int t = 0; t < threads; ++t)
    team.emplace_back([&, t] {
      work(t);                                   // touches its memory, wakes its core
      ++ready;
      while (ready < threads) {
      }
      const auto begin = Clock::now();
      long own = 0;
      for (; Clock::now() - begin < duration; ++own) work(t);
      calls += own;
      Clock::rep zero = 0;
      first.compare_exchange_strong(zero, begin.time_since_epoch().count());
      last = Clock::now().time_since_epoch().count();
    });
  for (std::thread& t : team) t.join();
  return double(calls) / std::chrono::duration<double>(Clock::duration(last - first)).count();
}

volatile double sink;                            // what is computed is used

// Independent chains, enough to fill the pipelines. One call: `rounds` operations of each kind on every chain.
constexpr int chains = 48, rounds = 2000;
[[gnu::always_inline]] inline void add_and_multiply() {
  double x[chains];
  for (int k = 0; k < chains; ++k) x[k] = 1 + 1e-3 * k;
  for (int r = 0; r < rounds; ++r)
    for (int k = 0; k < chains; ++k) x[k] = x[k] * 0.999 + 1e-3;
  for (const double v : x) sink = v;
}
[[gnu::always_inline]] inline void divide_and_root() {
  double x[chains];
  for (int k = 0; k < chains; ++k) x[k] = 1 + 1e-3 * k;
  for (int r = 0; r < rounds; ++r)
    for (int k = 0; k < chains; ++k) x[k] = std::sqrt(2.0 / x[k]);
  for (const double v : x) sink = v;
}

void flops_baseline(int) { add_and_multiply(); }
void roots_baseline(int) { divide_and_root(); }
#if defined(__x86_64__)
[[gnu::target("avx2")]] void flops_avx2(int) { add_and_multiply(); }
[[gnu::target("avx2")]] void roots_avx2(int) { divide_and_root(); }
const bool wide = __builtin_cpu_supports("avx2");
#else
constexpr auto flops_avx2 = flops_baseline, roots_avx2 = roots_baseline;
const bool wide = false;
#endif

double triad(int threads, double working_set) {
  const auto n = std::max<std::size_t>(1024, std::size_t(working_set / (3 * sizeof(double) * threads)));
  struct Arrays { std::vector<double> a, b, c; };
  std::vector<Arrays> own(static_cast<std::size_t>(threads));
  const double triads = calls_per_second(threads, [&](int t) {
    auto& [a, b, c] = own[static_cast<std::size_t>(t)];
    if (a.empty()) a.assign(n, 0), b.assign(n, 1), c.assign(n, 2);
    double* to = a.data();
    const double *x = b.data(), *y = c.data();
    for (std::size_t k = 0; k < n; ++k) to[k] = x[k] + 3.0 * y[k];
    sink = to[n / 2];
  });
  return triads * 3 * sizeof(double) * double(n);
}

}  // namespace

double Limits::bandwidth_for(double bytes) const {
  double rate = bandwidth.front().rate;
  for (const Bandwidth& b : bandwidth)
    if (b.bytes <= bytes) rate = b.rate;
  return rate;
}

Limits measure_limits(int threads, double largest) {
  constexpr double least = 1 << 18, most = 1 << 30;  // [byte] fits into a core's own cache; does not take the machine's memory
  Limits best;
  for (double bytes = std::clamp(largest, least, most); bytes >= least; bytes /= 4)
    best.bandwidth.insert(best.bandwidth.begin(), {bytes, 0});
  for (int k = 0; k < 3; ++k) {                            // the best of three: what disturbs only slows down
    for (Bandwidth& b : best.bandwidth) b.rate = std::max(b.rate, triad(threads, b.bytes));
    best.flops = std::max(best.flops, 2.0 * chains * rounds * calls_per_second(threads, wide ? flops_avx2 : flops_baseline));
    best.roots = std::max(best.roots, 2.0 * chains * rounds * calls_per_second(threads, wide ? roots_avx2 : roots_baseline));
  }
  return best;
}

}  // namespace skred
