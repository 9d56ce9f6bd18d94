// profiling/bench/report.h - what was measured, for eyes, programs and spreadsheets.
#pragma once
#include <string>
#include <vector>
#include <nlohmann/json_fwd.hpp>
#include "profiling/bench/bench.h"

namespace skred {

// Where and with what; the same in every format.
struct BenchMachine {
  std::string processor, compiler, flags, build, vector_path, version, commit;
  int processors = 1;                        // that this process may use
  double program_start = 0;                  // [s] of starting the program and ending it
};
BenchMachine bench_machine(const BenchOptions&);

// Lines of at most 110 columns. The head once, then a block per scene when it is there.
std::string text_head(const BenchMachine&, const BenchOptions&);
std::string text_of(const SceneResult&, bool all_kernels);

// Keys and units: README of this folder.
nlohmann::json json_of(const BenchMachine&, const BenchOptions&, const std::vector<SceneResult>&, bool interrupted);

// A row per scene, thread count and way of execution.
std::string csv_of(const BenchMachine&, const std::vector<SceneResult>&);

}  // namespace skred
