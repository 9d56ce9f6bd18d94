#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <fmt/format.h>
#include "profiling/readable.h"
#include "profiling/svg.h"
#include "scenes/check/plot.h"
#include "scenes/check/report.h"
#include "scenes/machine.h"

namespace skred {
namespace {

constexpr const char* style = R"css(
body { font: 15px/1.45 system-ui, sans-serif; color: #1f2328; max-width: 1060px; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.6em; } h2 { font-size: 1.25em; margin-top: 2em; border-bottom: 1px solid #d0d7de; } h3 { font-size: 1.05em; margin: 1.6em 0 .2em; }
table { border-collapse: collapse; font-size: .88em; width: 100%; } th { text-align: left; color: #5b636d; font-weight: 600; }
th, td { padding: .18em .6em .18em 0; vertical-align: top; border-bottom: 1px solid #eceef0; } td.n { font-variant-numeric: tabular-nums; white-space: nowrap; }
.pass { color: #1a7f37; } .fail { color: #fff; background: #cf222e; padding: 0 .4em; border-radius: 3px; }
.source, .note { color: #5b636d; font-size: .88em; margin: .1em 0 .5em; } .plots { display: flex; flex-wrap: wrap; gap: 8px; margin: .6em 0; }
.answers { width: auto; margin: .8em 0; } td.yes { color: #1a7f37; font-weight: 600; } td.no { color: #9a6700; }
pre { background: #f6f8fa; padding: .8em; overflow-x: auto; font-size: .82em; } summary { color: #0969da; cursor: pointer; font-size: .88em; }
)css";

// Colours that can be told apart without seeing colour [Okabe & Ito 2008].
const std::map<std::string, std::string> method_colour{{"sdem", "#0072b2"}, {"ndem", "#d55e00"}, {"both", "#009e73"}};
constexpr const char* expected_colour = "#1f2328";

std::string mark(bool passed) { return passed ? "<span class=\"pass\">pass</span>" : "<span class=\"fail\">FAIL</span>"; }

std::optional<double> as_number(const CaseRun& r, const std::string& parameter) {
  const auto found = r.parameters.find(parameter);
  return found == r.parameters.end() ? std::nullopt : std::optional(found->second);
}

// Measured and expected over the first parameter that varies, per expectation.
std::vector<Plot> plots_over_runs(const CheckedCase& c) {
  const CheckSpec& spec = c.of.spec();
  std::vector<Plot> plots;
  if (spec.vary.empty()) return plots;
  const std::string& parameter = spec.vary.front().first;
  for (std::size_t e = 0; e < spec.expect.size(); ++e) {
    if (spec.expect[e].of != Expectation::Of::run || spec.expect[e].what.ends_with('?')) continue;
    Plot plot{spec.expect[e].what, parameter, {}};
    Curve expected{"expected", expected_colour, {}, {}, true, false, true};
    for (const Method m : spec.methods) {
      Curve measured{method_title(m), method_colour.at(method_word(m)), {}, {}, false, true, false};
      for (const CaseRun& r : c.result.runs)
        for (const Reading& reading : r.readings)
          if (const auto x = as_number(r, parameter); x && reading.expectation == e && r.method == m && r.threads == spec.threads.front()) {
            measured.x.push_back(*x), measured.y.push_back(reading.measured);
            if (m == spec.methods.front() || expected.x.empty() || spec.expect[e].method != Expectation::Methods::all)
              expected.x.push_back(*x), expected.y.push_back(reading.expected);
          }
      if (!measured.x.empty()) plot.curves.push_back(std::move(measured));
    }
    if (expected.x.size() < 3) continue;
    const auto goes = [&](auto on) { return std::ranges::adjacent_find(expected.x, std::not_fn(on)) == expected.x.end(); };
    if (!goes(std::less<>{}) && !goes(std::greater<>{})) expected.line = false, expected.rings = true;   // another parameter varies too
    plot.curves.insert(plot.curves.begin(), std::move(expected));
    plots.push_back(std::move(plot));
  }
  return plots;
}

// What was followed over time: one line per run, at most a dozen.
std::vector<Plot> plots_over_time(const CheckedCase& c) {
  constexpr std::size_t most_lines = 12;
  std::vector<Plot> plots;
  for (const NamedFormula& f : c.of.spec().track) {
    Plot plot{f.name + " = " + f.formula, "time [s]", {}};
    std::map<std::string, bool> named;
    std::vector<const CaseRun*> runs;
    for (const CaseRun& r : c.result.runs)
      if (r.threads == c.of.spec().threads.front() && r.series.contains(f.name)) runs.push_back(&r);
    const std::size_t every = std::max<std::size_t>(1, (runs.size() + most_lines - 1) / most_lines);
    for (std::size_t k = 0; k < runs.size(); k += every) {
      const Series& s = runs[k]->series.at(f.name);
      const std::string method = method_word(runs[k]->method);
      plot.curves.push_back({named[method] ? "" : method_title(runs[k]->method), method_colour.at(method), s.time, s.value, true, false, false});
      named[method] = true;
    }
    plots.push_back(std::move(plot));
  }
  return plots;
}

std::string table_of(const CheckedCase& c) {
  const CheckSpec& spec = c.of.spec();
  std::string out = "<table><tr><th>method<th>what<th>expected<th>measured<th>of<th></tr>\n";
  for (const VerdictGroup& g : grouped(c.result)) {
    const Verdict& v = g.worst;
    const std::string note = v.reading.expectation < spec.expect.size() ? spec.expect[v.reading.expectation].note : "";
    std::string of = g.count > 1 ? fmt::format("{} runs, worst: {}", g.count, v.label) : v.label;
    if (g.count == 1 && v.count > 1) of = fmt::format("{} runs{}{}", v.count, v.label.empty() ? "" : ", ", v.label);
    out += fmt::format("<tr><td>{}<td>{}{}<td class=\"n\">{}<td class=\"n\">{}<td>{}<td>{}</tr>\n", v.method, escaped(v.what),
                       note.empty() ? "" : "<div class=\"note\">" + escaped(note) + "</div>", v.failure.empty() ? escaped(expected_text(v)) : "",
                       v.failure.empty() ? measured_text(v) : escaped(v.failure), escaped(of), mark(g.failed == 0));
  }
  return out + "</table>\n";
}

std::string answers_of(const CheckedCase& c) {
  const Answers table = answers(c);
  if (table.questions.empty()) return "";
  std::string out = "<table class=\"answers\"><tr><th><th>method";
  for (const std::string& q : table.questions) out += "<th>" + escaped(q);
  for (const Answers::Row& r : table.rows) {
    out += fmt::format("</tr>\n<tr><td>{}<td>{}", escaped(r.label), r.method);
    for (const std::string& a : r.answers) out += fmt::format("<td class=\"{0}\">{0}", a);
  }
  return out + "</tr></table>\n";
}

std::string section_of(const CheckedCase& c) {
  const CheckSpec& spec = c.of.spec();
  std::string out = fmt::format("<h3 id=\"{0}\">{1} {2}</h3>\n<p class=\"source\"><code>{0}</code>, {3}. {4}</p>\n", escaped(c.of.name),
                                escaped(spec.title), mark(c.result.passed()), readable_time(c.result.wall_time), escaped(spec.source));
  out += table_of(c) + answers_of(c);
  std::string pictures;
  for (const auto& plots : {plots_over_runs(c), plots_over_time(c)})
    for (const Plot& p : plots) pictures += svg_of(p);
  if (!pictures.empty()) out += "<div class=\"plots\">\n" + pictures + "</div>\n";
  return out + fmt::format("<details><summary>the scene</summary><pre>{}</pre></details>\n", [&] {
           std::string text;                          // escaped() drops line ends
           for (const char ch : c.of.text) text += ch == '\n' ? "\n" : escaped(std::string_view(&ch, 1));
           return text;
         }());
}

}  // namespace

std::string page_of(const std::vector<CheckedCase>& cases) {
  std::size_t failed = 0;
  double seconds = 0;
  for (const CheckedCase& c : cases) failed += !c.result.passed(), seconds += c.result.wall_time;
  std::string out = fmt::format("<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>skred check</title><style>{}</style></head><body>\n"
                                "<h1>skred check</h1>\n<p>{} cases, {}. Skred {}, {}, {}; {} of computing.</p>\n"
                                "<p class=\"note\">A number behind +- is the tolerance; a number in brackets is half of the 95 % confidence interval of a mean "
                                "over seeds, which has to lie within the tolerance whole. Of several runs the one nearest to its limit is shown.</p>\n",
                                style, cases.size(), failed == 0 ? "all pass" : fmt::format("{} fail", failed), SKRED_VERSION, escaped(processor_name()),
                                escaped(compiler_name()), readable_time(seconds));
  for (const auto& [group, title] : check_groups()) {
    std::string sections;
    for (const CheckedCase& c : cases)
      if (c.of.spec().group == group) sections += section_of(c);
    if (!sections.empty()) out += fmt::format("<h2>{}</h2>\n{}", title, sections);
  }
  return out + "</body></html>\n";
}

}  // namespace skred
