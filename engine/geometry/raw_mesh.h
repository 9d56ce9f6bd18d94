// engine/geometry/raw_mesh.h - what the mesh readers read before the mesh is checked, and the text tools they share.
#pragma once
#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>
#include "engine/geometry/mesh.h"

namespace skred {

struct RawMesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::size_t> lines;   // where each triangle was read, counted from 1; empty for binary files
};

RawMesh read_obj(const std::string& path, std::string_view content);
RawMesh read_stl(const std::string& path, std::string_view content);

// The lines of a text and their words.
class TextLines {
 public:
  TextLines(const std::string& path, std::string_view text) : path_(path), rest_(text) {}

  // Goes to the next line that has words; false at the end. What follows `#` is a comment.
  bool next() {
    while (!rest_.empty()) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      line_ = rest_.substr(0, end);
      line_ = line_.substr(0, line_.find('#'));
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++number_;
      if (line_.find_first_not_of(blanks) != line_.npos) return true;
    }
    line_ = {};
    return false;
  }

  // The next word of the line; empty at its end.
  std::string_view word() {
    const std::size_t begin = std::min(line_.find_first_not_of(blanks), line_.size());
    const std::size_t end = std::min(line_.find_first_of(blanks, begin), line_.size());
    const std::string_view w = line_.substr(begin, end - begin);
    line_.remove_prefix(end);
    return w;
  }

  // Three words as finite numbers.
  Vec3 point() {
    const double x = coordinate(), y = coordinate(), z = coordinate();
    return {x, y, z};
  }

  std::size_t number() const { return number_; }

  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(path_ + ":" + std::to_string(number_) + ": " + what);
  }

  // A word as a whole number or a floating-point one; false if it is none. `from_chars` knows no leading plus.
  template <class Number> static bool parse(std::string_view word, Number& value) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc{} && end == word.data() + word.size();
  }

 private:
  static constexpr const char* blanks = " \t\r\v\f";

  double coordinate() {
    const std::string_view w = word();
    double value = 0;
    if (w.empty()) fail("a vertex needs three coordinates");
    if (!parse(w, value) || !std::isfinite(value)) fail("coordinate '" + std::string(w) + "' is not a finite number");
    return value;
  }

  std::string path_;
  std::string_view rest_, line_;
  std::size_t number_ = 0;
};

}  // namespace skred
