// scenes/diagnostic.cpp - places, carets and nearest names.
#include "scenes/diagnostic.h"
#include <algorithm>
#include <cctype>
#include <tuple>
#include <utility>

namespace skred {
namespace {

std::string all_texts(const std::vector<Diagnostic>& diagnostics, std::size_t left_out) {
  std::string out;
  for (const Diagnostic& d : diagnostics) out += (out.empty() ? "" : "\n") + d.text();
  if (left_out) out += "\n... and " + std::to_string(left_out) + " more errors";
  return out;
}

// A long line is shown around the caret only.
void shorten(std::string& line, int& column) {
  constexpr int width = 120, before = 60;
  if (int(line.size()) <= width) return;
  const int first = std::clamp(column - before, 0, int(line.size()) - width);
  line = line.substr(std::size_t(first), width);
  column -= first;
}

}  // namespace

std::string Diagnostic::text() const {
  std::string out = place + ": error: " + message;
  if (line.empty()) return out;
  out += "\n  " + line + "\n  ";
  for (int k = 0; k < column && k < int(line.size()); ++k) {
    const auto c = static_cast<unsigned char>(line[std::size_t(k)]);
    if ((c & 0xc0) != 0x80) out += c == '\t' ? '\t' : ' ';   // a character of several bytes is one column wide
  }
  return out + "^";
}

SceneError::SceneError(std::vector<Diagnostic> diagnostics, std::size_t left_out)
    : std::runtime_error(all_texts(diagnostics, left_out)), diagnostics_(std::move(diagnostics)) {}

int Diagnostics::add_file(std::string name, std::string_view text) {
  Source source{std::move(name), true, {}};
  for (std::size_t first = 0; first <= text.size();) {
    const std::size_t last = std::min(text.find('\n', first), text.size());
    std::string line(text.substr(first, last - first));
    if (!line.empty() && line.back() == '\r') line.pop_back();
    source.lines.push_back(std::move(line));
    first = last + 1;
  }
  sources_.push_back(std::move(source));
  return int(sources_.size()) - 1;
}

int Diagnostics::add_option(std::string shown) {
  sources_.push_back({std::move(shown), false, {}});
  return int(sources_.size()) - 1;
}

void Diagnostics::error(Mark at, std::string message) { found_.push_back({at, std::move(message)}); }

void Diagnostics::throw_if_any() const {
  if (found_.empty()) return;
  std::vector<Found> sorted = found_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Found& a, const Found& b) {
    return std::tuple(a.at.source, a.at.line, a.at.column) < std::tuple(b.at.source, b.at.line, b.at.column);
  });
  std::vector<Diagnostic> shown;
  for (const Found& f : sorted) {
    if (shown.size() == SceneError::most) break;
    const Source& source = sources_.at(std::size_t(f.at.source));
    Diagnostic d{source.name, f.message, "", f.at.column};
    if (source.is_file) {
      d.place += ":" + std::to_string(f.at.line + 1) + ":" + std::to_string(f.at.column + 1);
      if (f.at.line >= 0 && f.at.line < int(source.lines.size())) d.line = source.lines[std::size_t(f.at.line)];
      shorten(d.line, d.column);
    }
    shown.push_back(std::move(d));
  }
  const std::size_t left_out = sorted.size() - shown.size();
  throw SceneError(std::move(shown), left_out);
}

std::string nearest_name(std::string_view name, std::span<const std::string> candidates) {
  const auto low = [](char c) { return char(std::tolower(static_cast<unsigned char>(c))); };
  const auto edits = [&](std::string_view a, std::string_view b) {
    std::vector<std::size_t> older, old(b.size() + 1), now(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) now[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
      older = std::exchange(old, now);
      now[0] = i;
      for (std::size_t j = 1; j <= b.size(); ++j) {
        const bool same = low(a[i - 1]) == low(b[j - 1]);
        now[j] = std::min({old[j] + 1, now[j - 1] + 1, old[j - 1] + !same});
        if (i > 1 && j > 1 && low(a[i - 1]) == low(b[j - 2]) && low(a[i - 2]) == low(b[j - 1]))
          now[j] = std::min(now[j], older[j - 2] + 1);
      }
    }
    return now[b.size()];
  };
  std::string best;
  std::size_t fewest = std::max<std::size_t>(1, name.size() / 3) + 1;   // strictly less: a third of the name may be wrong
  for (const std::string& c : candidates)
    if (const std::size_t n = edits(name, c); n < fewest) { fewest = n; best = c; }
  return best;
}

std::string suggestion(std::string_view name, std::span<const std::string> candidates) {
  if (const std::string best = nearest_name(name, candidates); !best.empty()) return "; did you mean '" + best + "'?";
  return candidates.empty() ? "" : "; known: " + joined(candidates);
}

std::string joined(std::span<const std::string> words, std::string_view separator) {
  std::string out;
  for (const std::string& w : words) (out += out.empty() ? "" : std::string(separator)) += w;
  return out;
}

}  // namespace skred
