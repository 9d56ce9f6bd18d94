// scenes/check/command.h - the verb `check`: which cases run, and where their verdicts go.
#pragma once
#include <string>
#include <vector>
#include <CLI/CLI.hpp>
#include "scenes/check/report.h"

namespace skred {

class CheckCommand {
 public:
  CLI::App* add_to(CLI::App& program);
  int run();                                          // returns the exit code; throws UsageError, SceneError, IoError

 private:
  std::vector<CheckCase> chosen(const std::vector<CheckCase>&) const;

  std::vector<std::string> files_;
  std::string only_, jobs_ = "auto", report_, json_, show_;
  bool all_ = false, list_ = false, verbose_ = false;
};

}  // namespace skred
