// scenes/main.cpp - the program: verbs, options, exit codes.
#include <cstdio>
#include <cstdlib>
#include <iostream>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include "engine/io/io_error.h"
#include "profiling/bench/command.h"
#include "scenes/check/command.h"
#include "scenes/completion.h"
#include "scenes/errors.h"
#include "scenes/failure.h"
#include "scenes/prepare.h"
#include "scenes/read_scene.h"
#include "scenes/run.h"
#include "scenes/schema.h"
#include "scenes/show.h"
#include "scenes/thread_option.h"
#include "scenes/vector_option.h"

namespace {

using namespace skred;

std::pair<std::int64_t, std::int64_t> parse_steps(const std::string& text) {
  long long a = 0, b = 0;
  int used = 0;
  if (std::sscanf(text.c_str(), "%lld:%lld%n", &a, &b, &used) != 2 || used != int(text.size()) || a < 1 || b <= a)
    throw UsageError("--trace-steps: '" + text + "' is not allowed: A:B with 1 <= A < B, steps A to B - 1");
  return {a, b};
}

// Options that every verb with a scene takes.
struct SceneOptions {
  std::string path;
  std::vector<std::string> set;
  ReadOptions read;
  void add_to(CLI::App& verb) {
    verb.add_option("SCENE", path, "scene file (YAML)")->required();
    verb.add_option("--set", set, "PATH=VALUE: change a parameter or any key, e.g. a=4, materials.pellet.friction=0")->expected(1)->take_all();
    verb.add_option("--method", read.method, "sdem (smooth) or ndem (nonsmooth)")->check(CLI::IsMember({"sdem", "ndem"}));
    verb.add_option("--time-step", read.time_step, "step [s] or with a unit, or auto");
    verb.add_option("--end-time", read.end_time, "simulated time [s] or with a unit");
    verb.add_option("--seed", read.seed, "seed of the random numbers");
  }
  Scene scene() {
    for (const std::string& s : set) {
      const auto equals = s.find('=');
      if (equals == std::string::npos || equals == 0) throw UsageError("--set: '" + s + "' is not allowed: PATH=VALUE");
      read.overrides.emplace_back(s.substr(0, equals), s.substr(equals + 1));
    }
    return read_scene(path, read);
  }
};

int run_program(int argc, char** argv) {
  CLI::App app{"Skred " SKRED_VERSION ": granular matter with smooth and nonsmooth DEM.", "skred"};
  app.require_subcommand(1);
  app.set_version_flag("--version", "skred " SKRED_VERSION);
  app.set_help_all_flag("--help-all", "help of every verb");

  SceneOptions on;
  RunOptions run;
  std::string threads = "auto", vector = "auto", trace_steps, format = "text", explain_path, shell;

  CLI::App* run_verb = app.add_subcommand("run", "simulate a scene");
  on.add_to(*run_verb);
  run_verb->add_option("--threads", threads, fmt::format("1 .. {}, or auto: as many as the machine gives", most_threads))->capture_default_str();
  run_verb->add_option("--vector", vector, vector_option_help)->type_name(vector_option_words)->capture_default_str();
  run_verb->add_option("--output", run.output, "folder of the results (default: results/NAME-METHOD, numbered)");
  run_verb->add_flag("--overwrite", run.overwrite, "replace the results of an earlier run in that folder");
  run_verb->add_flag("--force", run.force, "run even with a time step beyond the limit");
  run_verb->add_option("--trace", run.trace, "write a Chrome trace (JSON) for Perfetto or chrome://tracing");
  run_verb->add_option("--timeline", run.timeline, "draw the step of median duration (SVG)");
  run_verb->add_option("--trace-steps", trace_steps, "A:B, the steps to trace (default: the last 50)");
  run_verb->add_option("--summary", run.summary, "write the summary (JSON) here too");
  auto* quiet = run_verb->add_flag("--quiet", run.quiet, "say nothing but warnings and errors");
  run_verb->add_flag("-v,--verbose", run.verbose, "say more")->excludes(quiet);

  CLI::App* graph_verb = app.add_subcommand("graph", "show the kernels a scene needs, their order and why");
  on.add_to(*graph_verb);
  graph_verb->add_option("--format", format, "text, dot or svg")->check(CLI::IsMember({"text", "dot", "svg"}))->capture_default_str();

  CLI::App* validate_verb = app.add_subcommand("validate", "check a scene without running it");
  on.add_to(*validate_verb);
  validate_verb->add_flag("--force", run.force, "accept a time step beyond the limit");

  BenchCommand bench;
  CLI::App* bench_verb = bench.add_to(app);

  CheckCommand check;
  CLI::App* check_verb = check.add_to(app);

  CLI::App* schema_verb = app.add_subcommand("schema", "print the JSON Schema of scene files, for editors");
  CLI::App* models_verb = app.add_subcommand("models", "list the contact models with parameters, units and sources");
  CLI::App* explain_verb = app.add_subcommand("explain", "explain a key of scene files, e.g. materials.youngs_modulus");
  explain_verb->add_option("PATH", explain_path, "dotted path of the key; none: the top-level keys");
  CLI::App* completion_verb = app.add_subcommand("completion", "print a completion script for a shell");
  completion_verb->add_option("SHELL", shell, "bash, zsh or fish")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? exit_ok : exit_usage;
  }

  if (*run_verb) {
    run.threads = parse_threads(threads, run.threads_reason);
    run.vector_path = parse_vector(vector);
    run.vector_reason = vector == "auto" ? "the widest that this machine has" : "";
    if (!trace_steps.empty()) {
      run.trace_steps = parse_steps(trace_steps);
      if (run.trace.empty() && run.timeline.empty()) throw UsageError("--trace-steps: needs --trace or --timeline");
    }
    return run_scene(on.scene(), run);
  }
  if (*bench_verb) return bench.run();
  if (*check_verb) return check.run();
  if (*graph_verb) {
    const Scene scene = on.scene();
    std::cout << (format == "text" ? graph_text(scene) : format == "dot" ? graph_dot(scene) : graph_svg(scene));
  }
  if (*validate_verb) {
    const Scene scene = on.scene();
    const Prepared p = prepare(scene, run.force);
    for (const std::string& w : p.warnings) std::cerr << "warning: " << w << "\n";
    for (const std::string& n : p.notes) std::cout << n << "\n";
    std::cout << findings_table(p.findings);
    std::cout << fmt::format("scene '{}' is sound: {} particles, {} bodies, {:g} s in {} steps\n", scene.name,
                             std::get<Particles>(p.world).rows(), scene.bodies.size(), scene.end_time, steps_in(scene.end_time, p.model.time_step));
  }
  if (*schema_verb) std::cout << json_schema();
  if (*models_verb) std::cout << models_text();
  if (*explain_verb) std::cout << explain(explain_path);
  if (*completion_verb) std::cout << completion_script(app, shell);
  std::cout.flush();
  if (!std::cout) throw IoError("standard output: cannot be written");
  return exit_ok;
}

// Every failure with its message and exit code.
int guarded(int argc, char** argv) {
  try {
    return run_program(argc, argv);
  } catch (const std::exception& e) {
    const Failure f = failure_of(e);
    std::fprintf(stderr, "%s\n", f.text.c_str());
    return f.code;
  }
}

}  // namespace

int main(int argc, char** argv) {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 4'000'000);      // large columns come back to the system when freed, instead of leaving holes
#endif
  const int code = guarded(argc, argv);
  if (code != exit_io) return code;
  std::fflush(nullptr);
  std::_Exit(code);      // HDF5's own handler at exit would touch the file that cannot be written again, and crash (1.10.8)
}
