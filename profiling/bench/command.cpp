#include "profiling/bench/command.h"
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include "engine/io/io_error.h"
#include "engine/io/text_file.h"
#include "profiling/bench/bench_scenes.h"
#include "profiling/bench/child.h"
#include "profiling/bench/report.h"
#include "profiling/write_file.h"
#include "scenes/errors.h"
#include "scenes/interrupt.h"
#include "scenes/thread_option.h"
#include "scenes/vector_option.h"

namespace skred {

namespace {

std::filesystem::path default_states() {
  const auto set = [](const char* name) { const char* v = std::getenv(name); return v && *v ? std::string(v) : std::string(); };
  if (const std::string cache = set("XDG_CACHE_HOME"); !cache.empty()) return cache + "/skred/bench";
  if (const std::string home = set("HOME"); !home.empty()) return home + "/.cache/skred/bench";
  throw UsageError("--states: neither XDG_CACHE_HOME nor HOME is set; name a folder for the settled states");
}

std::vector<std::string> scene_names(bool all) {
  std::vector<std::string> out;
  for (const BenchScene& s : bench_scenes())
    if (all || s.by_default) out.push_back(s.name);
  return out;
}

std::string scene_list(const std::filesystem::path& states) {
  std::string out;
  for (const BenchScene& s : bench_scenes())
    out += fmt::format("{:<12}{:>10}  {}{}{}\n", s.name, s.particles, s.what, s.by_default ? "" : "; only if named, or with all",
                       std::filesystem::exists(state_file(states, s)) ? "; state is there" : "");
  return out;
}

// graph before list before serial: rates and shares are of the first.
std::vector<Execution> parse_executions(const std::string& text) {
  const std::vector<std::string> words = split_list(text);
  for (const std::string& w : words)
    if (!execution_of(w)) throw UsageError(fmt::format("--execution: '{}' is not allowed: a list of graph, list, serial", w));
  std::vector<Execution> out;
  for (const Execution e : {Execution::graph, Execution::list, Execution::serial})
    if (std::find(words.begin(), words.end(), execution_name(e)) != words.end()) out.push_back(e);
  return out;
}

void print(const std::string& text) {
  std::cout << text << std::flush;
  if (!std::cout) throw IoError("standard output: cannot be written");
}

void write(const std::string& path, const std::string& text) {
  if (path == "-") print(text);
  else if (!path.empty()) write_text_atomically(path, text, Sync::no);
}

}  // namespace

CLI::App* BenchCommand::add_to(CLI::App& program) {
  CLI::App* verb = program.add_subcommand("bench", "time standard scenes: rates, kernels, memory, scaling");
  std::string names;
  for (const BenchScene& s : bench_scenes()) names += s.name + "|";
  verb->add_option("--scene", scenes_, "scenes by name, or scene files, separated by commas (default: all but the two largest)")
      ->type_name(names + "all|FILE");
  verb->add_option("--threads", threads_, fmt::format("thread counts: 1 .. {} or auto, separated by commas", most_threads))
      ->capture_default_str();
  verb->add_option("--vector", vector_, vector_option_help)->type_name(vector_option_words)->capture_default_str();
  verb->add_option("--execution", executions_, "what runs a step: graph, list, serial, separated by commas")
      ->capture_default_str();
  verb->add_option("--warm-up", options_.warm_up, "steps before the first window (default: 100, of nonsmooth DEM 20)")
      ->check(CLI::Range(1, 1000000));
  verb->add_option("--repeats", options_.repeats, "windows to time with every thread count")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  verb->add_option("--steps", options_.steps, "steps of a window (default: about a second of them)")
      ->check(CLI::Range(1, 100000000));
  verb->add_option("--method", options_.method, "sdem (smooth) or ndem (nonsmooth)")->check(CLI::IsMember({"sdem", "ndem"}));
  verb->add_option("--states", states_, "folder of the settled states (default: ~/.cache/skred/bench)")->type_name("DIR");
  verb->add_flag("--frames", options_.frames, "time windows with a frame too: what does writing cost?");
  verb->add_flag("--roofline", options_.roofline, "compare each kernel with what memory and arithmetic allow");
  verb->add_option("--json", json_, "write everything that was measured, - for standard output, which then holds nothing else")
      ->type_name("FILE");
  verb->add_option("--csv", csv_, "write a row per scene, thread count and way of execution, - for standard output")
      ->type_name("FILE");
  verb->add_flag("--list", list_, "list the scenes and end");
  verb->add_flag("--settle-only", settle_only_, "make the settled states that are not there, and end");
  verb->add_flag("-v,--verbose", verbose_, "a table of all kernels per scene");
  return verb;
}

void BenchCommand::check() {
  options_.states = states_.empty() ? default_states() : std::filesystem::path(states_);
  options_.threads = parse_thread_list(threads_);
  options_.vector_path = parse_vector(vector_);
  options_.executions = parse_executions(executions_);
  if (scenes_.empty() || scenes_ == "all") options_.scenes = scene_names(scenes_ == "all");
  else options_.scenes = split_list(scenes_);
  if (json_ == "-" && csv_ == "-") throw UsageError("--json and --csv: only one of them can have the standard output");
}

int BenchCommand::run() {
  check();
  if (list_) {
    print(scene_list(options_.states));
    return exit_ok;
  }
  check_scenes(options_);
  for (const std::string& file : {json_, csv_})
    if (file != "-") check_writable(file);                   // now, not after minutes
  return time();
}

int BenchCommand::time() {
  const InterruptGuard interrupt;
  std::vector<SceneResult> results;
  int code = exit_ok;
  const BenchMachine machine = bench_machine(options_);
  try {
    settle_all(options_, interrupt);
    if (settle_only_) return exit_ok;
    const bool text = json_ != "-" && csv_ != "-";
    if (text) print(text_head(machine, options_));
    time_all(options_, interrupt, [&](const SceneResult& r) {
      results.push_back(r);
      if (text) print(text_of(r, verbose_));
    });
  } catch (const Interrupted&) {
    std::fprintf(stderr, "\nskred: interrupted; %s\n",
                 results.empty() ? "nothing was timed to its end" : "scenes timed to their end are kept");
    code = exit_interrupted;
    if (settle_only_) return code;
  }
  if (!json_.empty()) write(json_, json_of(machine, options_, results, code == exit_interrupted).dump(2) + "\n");
  if (!csv_.empty()) write(csv_, csv_of(machine, results));
  return code;
}

}  // namespace skred
