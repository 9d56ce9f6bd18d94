#include <algorithm>
#include <cmath>
#include <map>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include "profiling/readable.h"
#include "scenes/check/report.h"
#include "scenes/machine.h"

namespace skred {

std::string number(double v) { return fmt::format("{:.5g}", v); }

namespace {

bool is_question(const std::string& what) { return what.ends_with('?'); }
std::string yes_or_no(double v) { return v != 0 ? "yes" : "no"; }

}  // namespace

std::string expected_text(const Verdict& v) {
  const Reading& r = v.reading;
  if (is_question(v.what)) return yes_or_no(r.expected);
  if (r.relation == '=') return r.tolerance > 0 ? fmt::format("{} +- {:.2g}", number(r.expected), r.tolerance) : number(r.expected);
  return fmt::format("{}= {}", r.relation, number(r.relation == '<' ? r.expected + r.tolerance : r.expected - r.tolerance));
}

std::string measured_text(const Verdict& v) {
  if (is_question(v.what)) return yes_or_no(v.reading.measured);
  return v.confidence > 0 ? fmt::format("{} ({:.2g})", number(v.reading.measured), v.confidence) : number(v.reading.measured);
}

std::vector<VerdictGroup> grouped(const CaseResult& result) {
  std::vector<VerdictGroup> groups;
  std::map<std::tuple<std::size_t, std::string, std::string>, std::size_t> place;
  for (const Verdict& v : result.verdicts) {
    const auto [found, is_new] = place.try_emplace({v.reading.expectation, v.method, v.what}, groups.size());
    if (is_new) {
      groups.push_back({v, 1, std::size_t(!v.passed())});
      continue;
    }
    VerdictGroup& g = groups[found->second];
    ++g.count;
    g.failed += !v.passed();
    const auto badness = [](const Verdict& x) { return x.failure.empty() ? x.strain() : INFINITY; };
    if (badness(v) > badness(g.worst)) g.worst = v;
  }
  return groups;
}

namespace {

// Words in lines of at most `width` letters, each after `indent` blanks.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t width) {
  std::string out;
  std::size_t column = width + 1;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find_first_of(" \n", at), text.size());
    if (column + 1 + (end - at) > width) out += (out.empty() ? "" : "\n") + std::string(indent, ' '), column = 0;
    else out += ' ', ++column;
    out += text.substr(at, end - at);
    column += end - at;
    at = end + 1;
  }
  return out + '\n';
}

std::string row_text(const Verdict& v, const std::string& more) {
  std::string row = fmt::format("  {:<5} {:<46} {:>20} {:>18}  {:<4}  {}", v.method, v.what, v.failure.empty() ? expected_text(v) : "",
                                v.failure.empty() ? measured_text(v) : "", v.passed() ? "pass" : "FAIL", more);
  row.erase(row.find_last_not_of(' ') + 1);
  row += '\n';
  if (!v.failure.empty()) row += wrapped(v.failure, 8, 110);
  return row;
}

std::string where(const VerdictGroup& g) {
  if (g.count > 1)
    return fmt::format("{}{} runs, worst: {}", g.failed > 0 && g.failed < g.count ? fmt::format("{} of ", g.failed) : "", g.count, g.worst.label);
  if (g.worst.confidence > 0) return fmt::format("{} seeds{}{}", g.worst.count, g.worst.label.empty() ? "" : ", ", g.worst.label);
  if (g.worst.count > 1) return fmt::format("{} runs", g.worst.count);
  return g.worst.label;
}

}  // namespace

Answers answers(const CheckedCase& c) {
  Answers out;
  std::map<std::size_t, std::size_t> column;          // of an expectation
  for (std::size_t e = 0; e < c.of.spec().expect.size(); ++e) {
    const std::string& what = c.of.spec().expect[e].what;
    if (!is_question(what)) continue;
    const auto known = std::find(out.questions.begin(), out.questions.end(), what);
    column[e] = std::size_t(known - out.questions.begin());
    if (known == out.questions.end()) out.questions.push_back(what);
  }
  if (c.of.spec().vary.empty() || out.questions.empty()) return {};
  for (const CaseRun& r : c.result.runs) {
    Answers::Row row{r.label, method_word(r.method), std::vector<std::string>(out.questions.size())};
    for (const Reading& reading : r.readings)
      if (const auto at = column.find(reading.expectation); at != column.end()) row.answers[at->second] = yes_or_no(reading.measured);
    if (r.threads == c.of.spec().threads.front()) out.rows.push_back(std::move(row));
  }
  return out;
}

namespace {

std::string table_text(const Answers& table) {
  if (table.questions.empty()) return "";
  std::size_t label = 0;
  for (const Answers::Row& r : table.rows) label = std::max(label, r.label.size());
  std::string out = fmt::format("  {:<{}}        ", "", label);
  for (const std::string& q : table.questions) out += fmt::format("  {}", q);
  out += '\n';
  for (const Answers::Row& r : table.rows) {
    out += fmt::format("  {:<{}}  {:<6}", r.label, label, r.method);
    for (std::size_t k = 0; k < table.questions.size(); ++k) out += fmt::format("  {:<{}}", r.answers[k], table.questions[k].size());
    out.erase(out.find_last_not_of(' ') + 1);
    out += '\n';
  }
  return out;
}

}  // namespace

std::string text_of(const CheckedCase& c, bool every_run) {
  std::string out = fmt::format("{}: {} ({})\n", c.of.name, c.of.spec().title, readable_time(c.result.wall_time));
  if (every_run) {
    for (const Verdict& v : c.result.verdicts) out += row_text(v, v.label);
  } else {
    for (const VerdictGroup& g : grouped(c.result)) out += row_text(g.worst, where(g));
  }
  return out + table_text(answers(c));
}

std::string closing_text(const std::vector<CheckedCase>& cases) {
  std::size_t verdicts = 0, failed = 0, failed_cases = 0;
  for (const CheckedCase& c : cases) {
    verdicts += c.result.verdicts.size();
    failed += std::size_t(std::count_if(c.result.verdicts.begin(), c.result.verdicts.end(), [](const Verdict& v) { return !v.passed(); }));
    failed_cases += !c.result.passed();
  }
  if (failed == 0) return fmt::format("\nall {} cases pass: {} comparisons\n", cases.size(), verdicts);
  std::string names;
  for (const CheckedCase& c : cases)
    if (!c.result.passed()) names += " " + c.of.name;
  return fmt::format("\n{} of {} cases fail, {} of {} comparisons:{}\n", failed_cases, cases.size(), failed, verdicts, names);
}

nlohmann::json json_of(const std::vector<CheckedCase>& cases) {
  nlohmann::json out = {{"software", "skred " SKRED_VERSION}, {"processor", processor_name()}, {"compiler", compiler_name()}, {"cases", nlohmann::json::array()}};
  for (const CheckedCase& c : cases) {
    nlohmann::json one = {{"name", c.of.name}, {"group", c.of.spec().group}, {"title", c.of.spec().title}, {"source", c.of.spec().source},
                          {"passed", c.result.passed()}, {"wall_time", c.result.wall_time}, {"verdicts", nlohmann::json::array()},
                          {"runs", nlohmann::json::array()}};
    for (const Verdict& v : c.result.verdicts)
      one["verdicts"].push_back({{"what", v.what}, {"method", v.method}, {"run", v.label}, {"passed", v.passed()}, {"failure", v.failure},
                                 {"measured", v.reading.measured}, {"relation", std::string(1, v.reading.relation)},
                                 {"expected", v.reading.expected}, {"tolerance", v.reading.tolerance}, {"confidence", v.confidence}, {"runs", v.count}});
    for (const CaseRun& r : c.result.runs)
      one["runs"].push_back({{"method", method_word(r.method)}, {"run", r.label}, {"threads", r.threads}, {"particles", r.particles},
                             {"steps", r.steps}, {"wall_time", r.wall_time}, {"values", r.values}, {"state_hash", fmt::format("{:016x}", r.state_hash)},
                             {"failure", r.failure}});
    out["cases"].push_back(std::move(one));
  }
  return out;
}

}  // namespace skred
