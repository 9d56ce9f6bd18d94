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

std::string models_text() {
  return
      "contact models of smooth DEM; coefficients belong to a pair of materials\n"
      "\n"
      "contact.normal\n"
      "  hertz    F_n = max(0, 4/3 E* sqrt(R_eff) g^(3/2) + gamma_n dg/dt),  gamma_n = beta sqrt(2 E* sqrt(R_eff g) m_eff)\n"
      "           beta = sqrt(10/3) zeta, zeta from e = exp(-2 zeta arccos(zeta) / sqrt(1 - zeta^2)): the restitution is exactly e\n"
      "           at every speed although the force never pulls\n"
      "             youngs_modulus  Pa  > 0        poissons_ratio  1  > -1 .. 0.5     restitution  1  0.01 .. 1\n"
      "           Hertz 1882; Pettersson 2015, eq (3.1), (3.2), repaired; Schwager & Poeschel 2007\n"
      "  none     no contact forces at all\n"
      "\n"
      "contact.tangential\n"
      "  spring   F_t = -k_t x - gamma_t u_t, |F_t| <= mu F_n,  k_t = 8 G* sqrt(R_eff g),  gamma_t = beta sqrt(k_t m_eff)\n"
      "           x: displacement of the contact point since first touch, kept in the tangent plane and within mu F_n / k_t\n"
      "             friction  1  >= 0\n"
      "           Cundall & Strack 1979; Mindlin 1949; Pettersson 2015, eq (3.3)-(3.7)\n"
      "  none     no friction\n"
      "\n"
      "contact.rolling\n"
      "  spring   dM = -k_r w_t dt, |M| <= mu_r R_eff F_n,  k_r = k_t R_eff^2  (elastic-plastic, no damping, no twist)\n"
      "             rolling_friction  1  >= 0\n"
      "           Ai et al. 2011, model C; Pettersson 2015, eq (2.29), (2.30), (3.8)\n"
      "  none     no rolling resistance\n"
      "\n"
      "g overlap, R_eff and m_eff reduced radius and mass (a wall: R and m of the particle), E* and G* effective moduli,\n"
      "u_t velocity of the contact point, w_t relative spin, both in the tangent plane. The contact lies at R - g/2 from a centre.\n"
      "Two rigid bodies: the normal and tangential law at every corner of the patch where they touch; R_eff from spheres of equal\n"
      "volume (Podlozhnyuk et al. 2017; the own radius of a sphere on something flat), 1/m_eff = sum of 1/m + (r x n) I^-1 (r x n).\n";
}

}  // namespace skred
