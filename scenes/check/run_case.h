// scenes/check/run_case.h - runs a case: every method, row of `vary`, seed and thread count, and judges what was seen.
#pragma once
#include <functional>
#include <string>
#include <vector>
#include "scenes/check/case.h"
#include "scenes/check/formula.h"

namespace skred {

// One comparison of a measured value.
struct Reading {
  std::size_t expectation = 0;                       // of the spec
  double measured = 0, expected = 0;                 // expected: or the bound
  double tolerance = 0;                              // absolute
  char relation = '=';                               // '=', '<' (at most), '>' (at least)
};

// One run of a case.
struct CaseRun {
  Method method = Method::sdem;
  std::size_t row = 0;                               // of `vary`
  std::uint64_t seed = 1;
  int threads = 1;
  std::string label;                                 // "angle = 30, seed 2"; empty where there is one run
  std::string failure;                               // why it ended early; empty: it did not
  std::map<std::string, double> parameters, values;
  std::map<std::string, Series> series;
  std::vector<Reading> readings;                     // of single runs
  std::uint64_t state_hash = 0;
  std::int64_t particles = 0, steps = 0;
  double wall_time = 0;                              // [s]
};

struct Verdict {
  Reading reading;
  std::string what, method, label;                   // method: "sdem", "ndem" or "both"
  std::string failure;                               // instead of a reading: a run or a formula that failed, bits that differ
  double confidence = 0;                             // half of the 95 % interval of a mean over seeds
  std::size_t count = 1;                             // of runs behind the reading
  bool passed() const { return failure.empty() && strain() <= 1; }
  double strain() const;                             // how much of the tolerance is used
};

struct CaseResult {
  std::vector<CaseRun> runs;
  std::vector<Verdict> verdicts;
  double wall_time = 0;                              // [s]
  bool passed() const;
};

// `stop` is asked between steps; true ends the case, and the result is empty. Scenes that cannot be run and formulas without
// meaning are verdicts, not exceptions.
CaseResult run_case(const CheckCase&, const std::function<bool()>& stop = [] { return false; });

}  // namespace skred
