// scenes/check/report.h - what `skred check` tells: a table for the terminal, JSON for programs, a page with curves.
#pragma once
#include <string>
#include <vector>
#include <nlohmann/json_fwd.hpp>
#include "scenes/check/run_case.h"

namespace skred {

struct CheckedCase { CheckCase of; CaseResult result; };

// The verdicts of one expectation and method together: the one that strains its tolerance most, and of how many it is the worst.
struct VerdictGroup { Verdict worst; std::size_t count = 1, failed = 0; };
std::vector<VerdictGroup> grouped(const CaseResult&);

// Questions, and their answers by run: the rows of a table.
struct Answers {
  struct Row { std::string label, method; std::vector<std::string> answers; };   // "yes", "no", "" where not asked
  std::vector<std::string> questions;
  std::vector<Row> rows;
};
Answers answers(const CheckedCase&);

std::string text_of(const CheckedCase&, bool every_run);           // a case of the table
std::string closing_text(const std::vector<CheckedCase>&);
nlohmann::json json_of(const std::vector<CheckedCase>&);
std::string page_of(const std::vector<CheckedCase>&);              // HTML, self-contained

// Pieces of a row, as people read them.
std::string number(double);                                         // five digits
std::string expected_text(const Verdict&);                          // "0.18 +- 0.002", "<= 0.05"
std::string measured_text(const Verdict&);                          // with its confidence interval

}  // namespace skred
