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
  std::string out =
      "scene,particles,threads,execution,particle_steps_per_second,least,most,seconds_per_step,ns_per_contact_and_step,efficiency,"
      "contacts_per_particle,wall_contacts_per_particle,candidates_per_particle,steps_per_search,peak_bytes_per_particle,state_hash,"
      "load_average_before,load_average_after,processor,compiler,flags,vector_path,commit\n";
  for (const SceneResult& r : results)
    for (std::size_t t = 0; t < r.threads.size(); ++t)
      for (const std::string& e : r.executions) {
        const Summary s = summarize(r, r.threads[t], e);
        const Process& p = r.processes[t];
        const auto n = double(r.particles());
        out += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", quoted(r.name), r.particles(), s.threads, e,
                           s.rate.median, s.rate.least, s.rate.most, s.step_seconds.median, s.contact_nanoseconds.median,
                           s.efficiency ? fmt::format("{}", s.efficiency->median) : "", coordination(s, r.particles()), s.wall_contacts / n,
                           s.candidates / n, s.searches ? fmt::format("{}", double(s.steps) / double(s.searches)) : "",
                           (p.peak_memory - p.memory_before) / n, p.hash, r.load_before, r.load_after, quoted(m.processor),
                           quoted(m.compiler), quoted(m.flags), quoted(m.vectors), m.commit);
      }
  return out;
}

}  // namespace skred
