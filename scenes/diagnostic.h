// scenes/diagnostic.h - errors in scene files, in the manner of a compiler: all of them at once, each with its place.
#pragma once
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace skred {

// A place in one of the texts a scene is made of: the file, or what a command-line option sets. Counted from 0.
struct Mark { int source = 0, line = 0, column = 0; };

struct Diagnostic {
  std::string place;         // "drum.yaml:12:7", "--set a=x", "pellets.csv:3"
  std::string message;       // one line
  std::string line;          // of the source; empty where there is none to show
  int column = 0;            // of the caret under that line
  std::string text() const;  // "place: error: message", the line, the caret
};

// What is wrong with a scene; what() holds every diagnostic.
class SceneError : public std::runtime_error {
 public:
  static constexpr std::size_t most = 20;                       // more are counted, not shown
  explicit SceneError(std::vector<Diagnostic> diagnostics, std::size_t left_out = 0);
  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

// Collects errors while a scene is read.
class Diagnostics {
 public:
  // A file, of which lines are shown, or an option, which is shown whole as the place. Returns the `source` of marks into it.
  int add_file(std::string name, std::string_view text);
  int add_option(std::string shown);

  void error(Mark at, std::string message);
  std::size_t count() const { return found_.size(); }
  void throw_if_any() const;                                    // SceneError, in the order of the texts

 private:
  struct Source { std::string name; bool is_file; std::vector<std::string> lines; };
  struct Found { Mark at; std::string message; };
  std::vector<Source> sources_;
  std::vector<Found> found_;
};

// The candidate with the fewest edits (insert, delete, replace, swap neighbours), or "" if none is near.
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

// "; did you mean 'x'?", or "; known: a, b, c" if none is near.
std::string suggestion(std::string_view name, std::span<const std::string> candidates);

std::string joined(std::span<const std::string> words, std::string_view separator = ", ");

}  // namespace skred
