#include <fmt/format.h>
#include "profiling/bench/report.h"

namespace skred {

namespace {
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}
}  // namespace

std::string csv_of(const BenchMachine& m, const std::vector<SceneResult>& results) {
  struct Cell { std::string column, value; };
  std::string head, rows;
  for (const SceneResult& r : results)
    for (std::size_t t = 0; t < r.threads.size(); ++t)
      for (const std::string& e : r.executions) {
        const Summary s = summarize(r, r.threads[t], e);
        const Process& p = r.processes[t];
        const auto n = double(r.particles());
        const auto number = [](double x) { return fmt::format("{}", x); };
        const bool of_solver = r.nonsmooth() && e == r.executions.front();
        const SolverSummary warm = of_solver ? summarize_solver(r, s.threads, false) : SolverSummary{};
        const SolverSummary cold = of_solver ? summarize_solver(r, s.threads, true) : SolverSummary{};
        const auto of = [&](double x) { return of_solver ? number(x) : ""; };
        const Cell cells[] = {{"scene", quoted(r.name)},
                              {"particles", std::to_string(r.particles())},
                              {"threads", std::to_string(s.threads)},
                              {"execution", e},
                              {"particle_steps_per_second", number(s.rate.median)},
                              {"least", number(s.rate.least)},
                              {"most", number(s.rate.most)},
                              {"seconds_per_step", number(s.step_seconds.median)},
                              {"ns_per_contact_and_step", number(s.contact_nanoseconds.median)},
                              {"efficiency", s.efficiency ? number(s.efficiency->median) : ""},
                              {"contacts_per_particle", number(coordination(s, r.particles()))},
                              {"wall_contacts_per_particle", number(s.wall_contacts / n)},
                              {"candidates_per_particle", number(s.candidates / n)},
                              {"steps_per_search", s.searches ? number(double(s.steps) / double(s.searches)) : ""},
                              {"steps_per_listing", s.listings ? number(double(s.steps) / double(s.listings)) : ""},
                              {"peak_bytes_per_particle", number((p.peak_memory - p.memory_before) / n)},
                              {"method", r.nonsmooth() ? "ndem" : "sdem"},
                              {"time_step", number(p.time_step)},
                              {"contact_sweeps_per_second", of(warm.rate.median)},
                              {"sweep_efficiency", warm.efficiency ? number(warm.efficiency->median) : ""},
                              {"sweeps_per_step", of(warm.sweeps)},
                              {"residual", of(warm.residual)},
                              {"wall_seconds_per_simulated_second", of(warm.seconds_per_second.median)},
                              {"sweeps_per_step_cold", of(cold.sweeps)},
                              {"wall_seconds_per_simulated_second_cold", of(cold.seconds_per_second.median)},
                              {"share_detection", of(warm.detection)},
                              {"share_setup", of(warm.setup)},
                              {"share_impact", of(warm.impact)},
                              {"share_solve", of(warm.solve)},
                              {"state_hash", p.hash},
                              {"load_average_before", number(r.load_before)},
                              {"load_average_after", number(r.load_after)},
                              {"processor", quoted(m.processor)},
                              {"compiler", quoted(m.compiler)},
                              {"flags", quoted(m.flags)},
                              {"vector_path", quoted(m.vector_path)},
                              {"commit", m.commit}};
        std::string names, values;
        for (const Cell& c : cells) {
          names += (names.empty() ? "" : ",") + c.column;
          values += (values.empty() ? "" : ",") + c.value;
        }
        head = names + "\n";
        rows += values + "\n";
      }
  return head + rows;
}

}  // namespace skred
