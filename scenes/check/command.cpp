#include "scenes/check/command.h"
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <functional>
#include <iostream>
#include <mutex>
#include <optional>
#include <thread>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include "engine/io/temporary_folder.h"
#include "profiling/write_file.h"
#include "scenes/diagnostic.h"
#include "scenes/errors.h"
#include "scenes/interrupt.h"
#include "scenes/thread_option.h"

namespace skred {
namespace {

// Runs the cases on some threads; tells of each in order. Cases of several threads of their own come last, one at a time.
// Returns false if it was interrupted.
bool run_all(const std::vector<CheckCase>& cases, int jobs, const std::function<void(std::size_t, CaseResult)>& tell) {
  const InterruptGuard interrupt;
  const auto stop = [&] { return interrupt.asked(); };
  std::vector<std::size_t> alone;
  std::vector<std::size_t> together;
  for (std::size_t k = 0; k < cases.size(); ++k)
    (cases[k].spec().threads == std::vector<int>{1} ? together : alone).push_back(k);

  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::condition_variable ready;
  std::vector<std::optional<CaseResult>> results(cases.size());
  const auto work = [&] {
    for (std::size_t k; (k = next++) < together.size() && !stop();) {
      CaseResult r = run_case(cases[together[k]], stop);
      const std::lock_guard lock(mutex);
      results[together[k]] = std::move(r);
      ready.notify_all();
    }
  };
  std::vector<std::jthread> workers;
  for (int k = 0; k < jobs; ++k) workers.emplace_back(work);
  std::vector<std::size_t> order = together;
  order.insert(order.end(), alone.begin(), alone.end());
  for (const std::size_t k : order) {
    if (cases[k].spec().threads != std::vector<int>{1}) {
      workers.clear();                                // joined
      if (!stop()) results[k] = run_case(cases[k], stop);
    } else {
      std::unique_lock lock(mutex);
      while (!results[k] && !stop()) ready.wait_for(lock, std::chrono::milliseconds(100));
    }
    if (stop()) return false;
    tell(k, std::move(*results[k]));
  }
  return true;
}

std::vector<std::string> names_of(const std::vector<CheckCase>& cases) {
  std::vector<std::string> out;
  for (const CheckCase& c : cases) out.push_back(c.name);
  return out;
}

std::string list_text(const std::vector<CheckCase>& cases) {
  std::string out;
  for (const auto& [group, title] : check_groups()) {
    std::string lines;
    for (const CheckCase& c : cases)
      if (c.spec().group == group) lines += fmt::format("  {:<28} {}{}\n", c.name, c.spec().title, c.spec().slow ? " (--all)" : "");
    if (!lines.empty()) out += fmt::format("{}\n{}", title, lines);
  }
  return out;
}

}  // namespace

CLI::App* CheckCommand::add_to(CLI::App& program) {
  CLI::App* verb = program.add_subcommand("check", "verify the program: cases with known answers, and what it makes of them");
  verb->add_option("CASE", files_, "scene files with a `check` section (default: the program's own cases)");
  verb->add_option("--only", only_, "names of cases, separated by commas; a part that ends with * stands for all names that begin so")->type_name("NAME");
  verb->add_flag("--all", all_, "the long ones too");
  verb->add_option("--jobs", jobs_, "cases to run at a time, or auto")->capture_default_str();
  verb->add_option("--report", report_, "write a page with tables and curves (HTML)")->type_name("FILE");
  verb->add_option("--json", json_, "write everything that was measured")->type_name("FILE");
  verb->add_flag("--list", list_, "list the cases and end");
  verb->add_option("--show", show_, "print the scene of a case, which `skred run` can run, and end")->type_name("NAME");
  verb->add_flag("-v,--verbose", verbose_, "a line for every run, not only the worst");
  return verb;
}

// Those that the options choose. Throws UsageError for a name that is none.
std::vector<CheckCase> CheckCommand::chosen(const std::vector<CheckCase>& cases) const {
  std::vector<CheckCase> out;
  if (only_.empty()) {
    for (const CheckCase& c : cases)
      if (all_ || !c.spec().slow || !files_.empty()) out.push_back(c);
    return out;
  }
  for (const std::string& part : split_list(only_)) {
    const bool begins = part.ends_with('*');
    const auto matches = [&](const CheckCase& c) { return begins ? c.name.starts_with(part.substr(0, part.size() - 1)) : c.name == part; };
    if (std::none_of(cases.begin(), cases.end(), matches)) throw UsageError("--only: there is no case '" + part + "'" + suggestion(part, names_of(cases)));
    std::copy_if(cases.begin(), cases.end(), std::back_inserter(out), matches);
  }
  return out;
}

int CheckCommand::run() {
  const TemporaryFolder folder("skred-check");
  std::vector<CheckCase> cases;
  if (files_.empty()) cases = program_cases(folder.path.string());
  for (const std::string& f : files_) cases.push_back(read_case(f));
  if (!show_.empty()) {
    const auto found = std::find_if(cases.begin(), cases.end(), [&](const CheckCase& c) { return c.name == show_; });
    if (found == cases.end()) throw UsageError("--show: there is no case '" + show_ + "'" + suggestion(show_, names_of(cases)));
    std::cout << found->text;
    return exit_ok;
  }
  if (list_) {
    std::cout << list_text(cases);
    return exit_ok;
  }
  const std::vector<CheckCase> selected = chosen(cases);
  for (const std::string& file : {report_, json_})
    if (!file.empty()) check_writable(file);
  std::string reason;
  const int jobs = parse_threads(jobs_, reason);

  std::vector<CheckedCase> done;
  const bool finished = run_all(selected, jobs, [&](std::size_t k, CaseResult result) {
    done.push_back({selected[k], std::move(result)});
    std::cout << text_of(done.back(), verbose_) << std::flush;
  });
  if (!report_.empty()) write_file(report_, [&](std::ostream& out) { out << page_of(done); });
  if (!json_.empty()) write_file(json_, [&](std::ostream& out) { out << json_of(done).dump(2) << "\n"; });
  if (!finished) {
    std::cerr << fmt::format("skred: interrupted after {} of {} cases\n", done.size(), selected.size());
    return exit_interrupted;
  }
  std::cout << closing_text(done);
  const bool passed = std::all_of(done.begin(), done.end(), [](const CheckedCase& c) { return c.result.passed(); });
  return passed ? exit_ok : exit_check;
}

}  // namespace skred
