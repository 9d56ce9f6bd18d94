// scenes/check/spec.h - the `check` section of a scene file: what an experiment should show, and how it is judged.
//
// A case of `skred check` is a scene file with such a section: `skred run` runs the same file. Formulas are those of
// scenes/check/formula.h.
#pragma once
#include <string>
#include <utility>
#include <vector>
#include "tasks/method.h"

namespace skred {

struct NamedFormula { std::string name, formula; };

// One thing to see. Exactly one of `expected`, `at_most`, `at_least` is given.
struct Expectation {
  enum class Of { run, seeds, runs, methods };       // what the formulas speak of: one run, the mean over seeds, all runs, both methods
  enum class Methods { all, sdem, ndem };
  std::string what;                                  // "speed once it rolls [m/s]"; one that ends with '?' is answered by yes (1) or no (0)
  std::string value;                                 // formula: what is measured
  std::string expected, at_most, at_least;           // formulas
  std::string tolerance = "0";                       // formula: greatest difference from `expected`; "0.5 %": of `expected`
  Of of = Of::run;
  Methods method = Methods::all;
  std::string when;                                  // formula: runs where it is 0 are left out; empty: none is
  std::string note;                                  // why this is right, where a reader might wonder
};

struct CheckSpec {
  std::string title, group, source;
  std::vector<Method> methods{Method::sdem, Method::ndem};
  std::vector<int> threads{1};                       // the case is run with each; the bits must be the same
  bool slow = false;                                 // only with --all
  bool force = false;                                // runs even with a time step beyond the limit, as `run --force`
  int seeds = 1;                                     // runs with the scene's seed, and the seeds after it
  std::vector<std::pair<std::string, std::vector<std::string>>> vary;   // parameter: its value in each run; lists of one length
  double track_interval = 0;                         // [s] 0: 200 samples of the run
  std::vector<NamedFormula> track;                   // followed over time
  std::vector<NamedFormula> values;                  // of each run, at its end; later ones may use earlier ones
  std::vector<Expectation> expect;
};

// The groups of cases, in the order in which they are shown, each with its title.
inline const std::vector<std::pair<std::string, std::string>>& check_groups() {
  static const std::vector<std::pair<std::string, std::string>> groups{
      {"contact", "single contacts"}, {"rolling", "rolling and sliding"}, {"models", "contact models"}, {"chain", "chains and columns"},
      {"bulk", "bulk laws"},          {"hard", "hard cases"},            {"invariants", "invariants"}, {"questions", "open questions"}};
  return groups;
}

}  // namespace skred
