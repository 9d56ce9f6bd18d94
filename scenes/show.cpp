#include "scenes/show.h"
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <fmt/format.h>
#include "engine/io/temporary_folder.h"
#include "scenes/build.h"
#include "scenes/errors.h"
#include "scenes/prepare.h"
#include "tasks/simulation.h"

namespace skred {

namespace {

// A simulation of the scene's start, on one thread, that is never run.
struct Shown {
  Simulation sim;
  explicit Shown(const Scene& scene) : sim(checked(scene), build_model(scene), 1) {}

 private:
  static World checked(const Scene& scene) {
    return build_world(scene, make_particles(scene));
  }
};

std::string dot_of(Simulation& sim) {
  std::ostringstream out;
  sim.task().write_dot(out);
  return out.str();
}

}  // namespace

std::string graph_text(const Scene& scene) {
  Shown shown(scene);
  Task& task = shown.sim.task();
  std::string out = fmt::format("scene '{}', {}: {} kernels\n\nkernels, in order (after: what each has to wait for, and the data)\n",
                                scene.name, method_title(scene.method), task.size());
  const auto edges = task.edges();
  for (std::size_t k = 0; k < task.size(); ++k) {
    std::string after;
    for (const Task::Edge& e : edges)
      if (e.to == k) after += fmt::format("{}{} ({})", after.empty() ? "" : ", ", task.name(e.from), e.because);
    out += fmt::format("  {:2}  {:<37} {}\n", k + 1, task.name(k), after.empty() ? "" : "after " + after);
  }
  out += "\neffects\n";
  for (const Effects::Reason& r : shown.sim.effects().reasons)
    out += fmt::format("  {:<40} {:<4} {}\n", r.effect, r.in ? "in" : "out", r.why);
  return out;
}

std::string graph_dot(const Scene& scene) {
  Shown shown(scene);
  return dot_of(shown.sim);
}

std::string graph_svg(const Scene& scene) {
  const TemporaryFolder folder = [] {
    try {
      return TemporaryFolder("skred-graph");
    } catch (const std::filesystem::filesystem_error& e) {
      throw UsageError("graph: no temporary file can be made in " + e.path1().parent_path().string());
    }
  }();
  const std::string name = folder / "graph.dot";
  std::ofstream(name) << graph_dot(scene);
  std::string svg;
  FILE* pipe = popen(("dot -Tsvg '" + name + "' 2>/dev/null").c_str(), "r");
  for (char buffer[4096]; pipe && std::fgets(buffer, sizeof buffer, pipe);) svg += buffer;
  const bool drawn = pipe && pclose(pipe) == 0 && !svg.empty();
  if (!drawn) throw UsageError("graph: --format svg needs the program 'dot' (Debian package graphviz); --format dot needs nothing");
  return svg;
}

}  // namespace skred
