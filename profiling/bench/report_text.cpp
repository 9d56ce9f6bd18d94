#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include "profiling/bench/bench_scenes.h"
#include "profiling/bench/report.h"
#include "profiling/readable.h"
#include "scenes/machine.h"
#include "tasks/simulation.h"

namespace skred {

namespace {

// Three digits: 0.123, 1.23, 12.3, 123, 1230.
std::string digits(double x) {
  const int decimals = x == 0 ? 0 : std::clamp(2 - int(std::floor(std::log10(std::abs(x)) + 1e-9)), 0, 3);
  return fmt::format("{:.{}f}", x, decimals);
}
std::string with_spread(const Spread& s, double scale = 1) {
  return fmt::format("{:>5} ({} - {})", digits(scale * s.median), digits(scale * s.least), digits(scale * s.most));
}
std::string count(std::size_t n) { return grouped_digits(std::int64_t(n)); }
std::string thread_text(int n) { return fmt::format("{} thread{}", n, n == 1 ? "" : "s"); }
std::size_t width(const std::string& s) {             // UTF-8
  return std::size_t(std::count_if(s.begin(), s.end(), [](unsigned char c) { return (c & 0xc0) != 0x80; }));
}
std::string right(const std::string& s, std::size_t columns) {
  return std::string(columns - std::min(columns, width(s)), ' ') + s;
}

double busy(const Summary& s) {
  double sum = 0;
  for (const KernelTime& k : s.kernels) sum += k.busy;
  return sum;
}

std::vector<KernelTime> costliest_first(std::vector<KernelTime> kernels) {
  std::stable_sort(kernels.begin(), kernels.end(), [](const KernelTime& a, const KernelTime& b) { return a.busy > b.busy; });
  return kernels;
}

std::string main_shares(const Summary& s) {
  constexpr std::size_t lines = 6;                    // the costliest
  std::string out, line = "  kernels ";
  const auto kernels = costliest_first(s.kernels);
  for (std::size_t k = 0; k < std::min(lines, kernels.size()); ++k) {
    const std::string word = fmt::format("{}{} {:.0f} %", k ? ", " : " ", kernels[k].name, 100 * kernels[k].busy / busy(s));
    if (line.size() + word.size() > 108) {
      out += line + ",\n";
      line = std::string(11, ' ') + word.substr(2);
    } else {
      line += word;
    }
  }
  return out + line + "\n";
}

// Every kernel: its share with the fewest threads, and the time of a step with each count.
std::string kernel_table(const SceneResult& r, const std::vector<Summary>& by_threads) {
  std::string head = fmt::format("  {:<38}{:>7}", "kernel", "share"), out;
  for (const Summary& s : by_threads) head += fmt::format("{:>22}", "us/step, " + thread_text(s.threads));
  out = head + fmt::format("{:>12}\n", r.threads.size() > 1 ? "efficiency" : "");
  for (const KernelTime& k : costliest_first(by_threads.front().kernels)) {
    out += fmt::format("  {:<38}{:>7}", k.name, fmt::format("{:.1f} %", 100 * k.busy / busy(by_threads.front())));
    double last = 0;
    for (const Summary& s : by_threads) {
      const auto same = std::find_if(s.kernels.begin(), s.kernels.end(), [&](const KernelTime& x) { return x.name == k.name; });
      last = same == s.kernels.end() ? 0 : same->total;
      out += fmt::format("{:>22}", digits(1e6 * last));
    }
    const double speedup = last > 0 ? k.total / last : 0;
    out += r.threads.size() > 1 ? fmt::format("{:>12.2f}\n", speedup * r.threads.front() / r.threads.back()) : "\n";
  }
  return out;
}

// Every thread count, beginning from the impulses of the last step and from none.
std::string solver_table(const SceneResult& r) {
  const SolverSummary first = summarize_solver(r, r.threads.front(), false);
  const auto percent = [](double share) { return fmt::format("{:.0f} %", 100 * share); };
  std::string out = fmt::format("  nonsmooth DEM: {} contacts, {} impact sweeps, a step of {} ms\n  a step is detection {}, setup {}, impact {}, solve {}, rest {}\n",
                                count(std::size_t(std::llround(first.contacts))), digits(first.impact_sweeps),
                                digits(1e3 * r.processes.front().time_step), percent(first.detection), percent(first.setup),
                                percent(first.impact), percent(first.solve), percent(first.rest));
  out += fmt::format("  {:>7} {:<5} {:<21} {:<20}{:>7}{:>9}{:>9}  {}\n", "threads", "start", " M contact sweeps/s", " efficiency", "sweeps", "residual",
                     "unsolved", " s/simulated s");
  for (const int threads : r.threads)
    for (const bool cold : {false, true}) {
      const SolverSummary s = summarize_solver(r, threads, cold);
      out += fmt::format("  {:>7} {:<5} {:<21} {:<20}{:>7}{:>9.1e}{:>9}  {}\n", threads, cold ? "cold" : "warm", with_spread(s.rate, 1e-6),
                         s.efficiency ? with_spread(*s.efficiency) : "", digits(s.sweeps), s.residual, fmt::format("{}/{}", s.unsolved, s.steps),
                         with_spread(s.seconds_per_second));
    }
  return out;
}

std::string roofline_table(const Roofline& f) {
  std::string out = fmt::format("  at best with {}: {} G additions and multiplications/s, {} G divisions and roots/s,\n   ",
                                thread_text(f.threads), digits(f.limits.flops * 1e-9), digits(f.limits.roots * 1e-9));
  for (const Bandwidth& b : f.limits.bandwidth)
    out += fmt::format("{} {} GB/s in {} MB", &b == &f.limits.bandwidth.front() ? "" : ",", digits(b.rate * 1e-9),
                       digits(b.bytes * 1e-6));
  out += fmt::format("\n  {:<38}{:>9}{:>9}{:>12}{:>12}{:>11}{:>7}  {}\n", "kernel", "MB/step", "Mop/step", "memory us",
                     "compute us", "measured", "ratio", "bound");
  double step = 0;
  for (const KernelBound& k : f.kernels) step += k.measured_seconds;
  for (const KernelBound& k : f.kernels) {
    if (k.measured_seconds < 0.005 * step) continue;  // half a per cent of the time is not worth a line
    const double least = std::max(k.memory_seconds, k.arithmetic_seconds);
    out += fmt::format("  {:<38}{:>9}{:>9}{:>12}{:>12}{:>11}{:>7}  {}\n", k.name, digits(k.bytes * 1e-6),
                       digits((k.flops + k.roots) * 1e-6), digits(1e6 * k.memory_seconds), digits(1e6 * k.arithmetic_seconds),
                       digits(1e6 * k.measured_seconds), least > 0 ? digits(k.measured_seconds / least) : "-",
                       k.memory_seconds > k.arithmetic_seconds ? "memory" : "arithmetic");
  }
  return out;
}

}  // namespace

BenchMachine bench_machine(const BenchOptions& o) {
  return {processor_name(),       compiler_name(),        compiler_flags(), build_type(),
          name_of(o.vector_path), "skred " SKRED_VERSION, source_commit(),  automatic_threads().threads,
          program_start_seconds()};
}

std::string text_head(const BenchMachine& m, const BenchOptions& o) {
  const std::string commit = m.commit.empty() ? "" : " (" + m.commit + ")";
  const std::string window = o.steps ? fmt::format("{} steps", o.steps) : o.method == "ndem" ? "about 1 s, at least 5 steps" : "about 1 s, at least 20 steps";
  const bool files = o.method.empty() && !std::all_of(o.scenes.begin(), o.scenes.end(), find_bench_scene);
  const char* const method = files ? "methods of the scenes" : method_title(o.method == "ndem" ? Method::ndem : Method::sdem);
  return fmt::format(
      "{}{}, {}; {}, {}; load average {:.2f}\n{}, {}; {}; vector path: {}\n"
      "median (least - most) of {} windows of {}; rates in million particle-steps per second\n",
      m.version, commit, method, m.processor, m.processors == 1 ? "1 processor" : fmt::format("{} processors", m.processors),
      load_average(), m.compiler, m.build, m.flags, m.vector_path, o.repeats, window);
}

std::string text_of(const SceneResult& r, bool all_kernels) {
  const std::size_t n = r.particles();
  std::vector<Summary> by_threads;
  for (const int t : r.threads) by_threads.push_back(summarize(r, t, r.executions.front()));
  const Summary& first = by_threads.front();

  std::string out = fmt::format("\n{}: {} particles, {}\n", r.name, count(n), r.what);
  const auto each = [&](double sum) { return digits(sum / double(n)); };
  const auto every = [&](const char* what, std::int64_t times) {
    return times ? fmt::format("a {} every {} steps", what, digits(double(first.steps) / double(times)))
                 : fmt::format("no {} in {} steps", what, first.steps);
  };
  out += fmt::format("  {} contacts a particle ({} of {} listed pairs), {} of {} at walls\n  {}, {}\n", digits(coordination(first, n)),
                     each(first.pairs), each(first.candidates), each(first.wall_contacts), each(first.wall_candidates),
                     every("search", first.searches), every("listing", first.listings));
  std::string head = fmt::format("  {:>7}  {:<21}{:>9}{:>12}  {:<20}", "threads", " rate, " + r.executions.front(), "us/step",
                                 "ns/contact", " efficiency");
  for (std::size_t e = 1; e < r.executions.size(); ++e) head += fmt::format("{:>8}", r.executions[e]);
  out += head + fmt::format("{:>15}\n", "byte/particle");
  for (std::size_t k = 0; k < by_threads.size(); ++k) {
    const Summary& s = by_threads[k];
    const Process& p = r.processes[k];
    out += fmt::format("  {:>7}  {:<21}{}{:>12}  {:<20}", s.threads, with_spread(s.rate, 1e-6),
                       right(grouped_digits(std::llround(1e6 * s.step_seconds.median)), 9), digits(s.contact_nanoseconds.median),
                       s.efficiency ? with_spread(*s.efficiency) : "");
    for (std::size_t e = 1; e < r.executions.size(); ++e) {
      const bool same_for_all = r.executions[e] == "serial" && k > 0;      // it uses one thread of however many
      out += fmt::format("{:>8}", same_for_all ? "" : digits(1e-6 * summarize(r, s.threads, r.executions[e]).rate.median));
    }
    out += right(grouped_digits(std::llround((p.peak_memory - p.memory_before) / double(n))), 15) + "\n";
  }
  if (r.nonsmooth()) out += solver_table(r);
  out += all_kernels ? kernel_table(r, by_threads) : main_shares(first);
  for (const FrameCost& c : frame_costs(r))
    out += fmt::format("  a frame adds {} ms with {}: {:.2f} % of 1000 steps\n", with_spread(c.seconds, 1e3),
                       thread_text(c.threads), 100 * c.share_of_1000_steps);
  for (const Roofline& f : r.rooflines) out += roofline_table(f);
  const Process& p = r.processes.front();
  out += fmt::format("  first step done {} after the start ({} of it reading); state hash {} after {} steps\n",
                     readable_time(p.first_step_seconds), readable_time(p.read_seconds), p.hash, r.warm_up);
  return out;
}

}  // namespace skred
