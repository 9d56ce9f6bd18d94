// profiling/profile_table.cpp
#include "profiling/profile_table.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include "profiling/readable.h"

namespace skred {

namespace {

constexpr std::size_t columns = 8;
using Cells = std::array<std::string, columns>;

// "1.20 s " below "12.3 ms": units of one and of two letters end in the same column.
std::string time_cell(double seconds) {
  std::string text = readable_time(seconds);
  return text.ends_with(" s") ? text + " " : text;
}

Cells cells_of(const Timeline::Line& l) {
  return {l.name,
          fmt::format("{}", l.count),
          time_cell(l.total),
          time_cell(l.mean),
          time_cell(l.median),
          l.writer ? "beside" : readable_share(l.share),
          readable_share(l.efficiency),
          l.writer ? "-  " : time_cell(l.idle)};
}

std::string line_of(const Cells& cells, const std::array<std::size_t, columns>& width) {
  std::string line = fmt::format("{:<{}}", cells[0], width[0]);
  for (std::size_t c = 1; c < columns; ++c) line += fmt::format("  {:>{}}", cells[c], width[c]);
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

}  // namespace

std::string profile_table(const Timeline::Totals& totals, int threads) {
  std::vector<Timeline::Line> lines = totals.lines;
  std::stable_sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) {
    return a.writer != b.writer ? b.writer : a.busy > b.busy;
  });
  std::vector<Cells> table{{"kernel", "count", "total", "mean", "median", "share", "efficiency", "idle"}};
  for (const auto& l : lines) table.push_back(cells_of(l));

  std::array<std::size_t, columns> width{};
  for (const Cells& row : table)
    for (std::size_t c = 0; c < columns; ++c) width[c] = std::max(width[c], row[c].size());

  std::string out;
  for (std::size_t r = 0; r < table.size(); ++r) {
    out += line_of(table[r], width);
    if (r > 0) continue;
    std::size_t whole = 2 * (columns - 1);
    for (const std::size_t w : width) whole += w;
    out += std::string(whole, '-') + "\n";
  }

  const double offered = threads * totals.wall;
  const double busy = offered > 0 ? std::min(1.0, totals.busy / offered) : 0;
  out += fmt::format("total: {} step{} in {} on {} thread{}, {} a step; busy {}, idle {}\n", totals.steps,
                     totals.steps == 1 ? "" : "s", readable_time(totals.wall), threads, threads == 1 ? "" : "s",
                     readable_time(totals.steps > 0 ? totals.wall / double(totals.steps) : 0), readable_share(busy),
                     readable_share(1 - busy));
  out += fmt::format("profiling: {} spans, {} each, {} of the wall time\n", readable_count(double(totals.spans)),
                     readable_time(totals.span_cost), readable_share(totals.cost));
  if (totals.dropped > 0)
    out += fmt::format("profiling: {} spans found no room and are missing in the trace\n", totals.dropped);
  return out;
}

nlohmann::json profile_json(const Timeline::Totals& totals) {
  auto out = nlohmann::json::array();
  for (const auto& l : totals.lines)
    out.push_back({{"name", l.name}, {"count", l.count}, {"total", l.total}, {"mean", l.mean}, {"median", l.median},
                   {"p95", l.p95}, {"max", l.max}, {"share", l.share}, {"efficiency", l.efficiency}, {"idle", l.idle},
                   {"rows", l.rows}});
  return out;
}

}  // namespace skred
