// profiling/bench/command.h - the verb `bench`: its options, and what it writes where.
#pragma once
#include <string>
#include <CLI/CLI.hpp>
#include "profiling/bench/bench.h"

namespace skred {

class BenchCommand {
 public:
  CLI::App* add_to(CLI::App& program);
  int run();                                 // returns the exit code; throws UsageError, IoError, ... (scenes/failure.h)

 private:
  void check();                              // from text to options_; throws UsageError
  int time();

  BenchOptions options_;
  std::string scenes_, threads_ = "1,auto", executions_ = "graph,list,serial", vector_ = "auto", states_, json_, csv_;
  bool list_ = false, settle_only_ = false, verbose_ = false;
};

}  // namespace skred
