// scenes/particle_csv.cpp - particles from comma-separated text: a header line, then a line per particle. Empty lines and
// lines that begin with '#' do not count; cells may stand in double quotes.
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include "scenes/particle_file.h"

namespace skred {
namespace {

struct Cell { std::string text; int column; };    // column: where it begins in the line, from 0

std::vector<Cell> split(const std::string& line) {
  std::vector<Cell> cells;
  for (std::size_t first = 0; first <= line.size();) {
    const std::size_t comma = std::min(line.find(',', first), line.size());
    std::size_t a = first, b = comma;
    const auto space = [&](std::size_t k) { return std::strchr(" \t\r", line[k]) != nullptr; };
    while (a < b && space(a)) ++a;
    while (b > a && space(b - 1)) --b;
    const int column = int(a);
    if (b - a >= 2 && line[a] == '"' && line[b - 1] == '"') { ++a; --b; }
    cells.push_back({line.substr(a, b - a), column});
    first = comma + 1;
  }
  return cells;
}

template <class V> bool parse(const std::string& text, V& value) {
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(begin, end, value);
  return read.ec == std::errc() && read.ptr == end;
}

class CsvLoader {
 public:
  CsvLoader(const std::string& path, std::vector<Diagnostic>& errors) : path_(path), errors_(errors) {}

  ParticleColumns load() {
    std::ifstream in(path_, std::ios::binary);
    if (!in) {
      errors_.push_back({path_, std::string("cannot read: ") + std::strerror(errno), "", 0});
      return {};
    }
    while (std::getline(in, text_)) {
      if (++line_ == 1 && text_.starts_with("\xef\xbb\xbf")) text_.erase(0, 3);   // byte order mark
      if (text_.find_first_not_of(" \t\r") == std::string::npos || text_.starts_with('#')) continue;
      if (header_.empty()) read_header();
      else read_row();
      if (header_.empty()) return {};
    }
    if (header_.empty() && errors_.empty())
      errors_.push_back({path_, "the file is empty; its first line must name the columns", "", 0});
    return std::move(columns_);
  }

 private:
  void error(const std::string& message, int column) {
    std::string line = text_;
    if (line.ends_with('\r')) line.pop_back();
    errors_.push_back({path_ + ":" + std::to_string(line_), message, std::move(line), column});
  }

  void read_header() {
    std::vector<std::string> known = particle_number_columns;
    known.insert(known.end(), {"material", "id"});
    bool good = true;
    for (const Cell& cell : split(text_)) {
      std::string problem;
      if (std::find(header_.begin(), header_.end(), cell.text) != header_.end())
        problem = "column '" + cell.text + "' is given twice";
      else if (std::find(known.begin(), known.end(), cell.text) == known.end())
        problem = "unknown column '" + cell.text + "'" + suggestion(cell.text, known);
      if (!problem.empty()) { error(problem, cell.column); good = false; }
      header_.push_back(cell.text);
      if (std::find(particle_number_columns.begin(), particle_number_columns.end(), cell.text) != particle_number_columns.end())
        columns_.numbers[cell.text];
    }
    if (!good) header_.clear();
  }

  void read_row() {
    const std::vector<Cell> cells = split(text_);
    if (cells.size() != header_.size())
      return error("the line has " + std::to_string(cells.size()) + " cells; the header has " +
                       std::to_string(header_.size()), 0);
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const std::string& name = header_[k];
      const Cell& cell = cells[k];
      if (name == "material") {
        columns_.materials.push_back(cell.text);
      } else if (name == "id") {
        columns_.ids.emplace_back();
        if (!parse(cell.text, columns_.ids.back())) error("column id: '" + cell.text + "' is not an integer", cell.column);
      } else {
        double& value = columns_.numbers[name].emplace_back();
        if (!parse(cell.text, value) || !std::isfinite(value))
          error("column " + name + ": '" + cell.text + "' is not a finite number", cell.column);
      }
    }
    columns_.lines.push_back(line_);
    ++columns_.rows;
  }

  const std::string& path_;
  std::vector<Diagnostic>& errors_;
  std::string text_;
  std::size_t line_ = 0;
  std::vector<std::string> header_;
  ParticleColumns columns_;
};

}  // namespace

ParticleColumns load_particle_csv(const std::string& path, std::vector<Diagnostic>& errors) {
  return CsvLoader(path, errors).load();
}

}  // namespace skred
