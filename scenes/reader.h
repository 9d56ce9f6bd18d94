// scenes/reader.h - what reading a value needs: the parameters, the names known so far, and where errors go.
#pragma once
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>
#include "scenes/diagnostic.h"
#include "scenes/node.h"

namespace skred {

// The values a number may take.
struct Range {
  double min = -std::numeric_limits<double>::infinity(), max = std::numeric_limits<double>::infinity();
  bool min_open = false, max_open = false;       // the end itself is not allowed
  bool infinite = false;                         // .inf is allowed
  bool contains(double x) const;
  std::string text(const std::string& unit = "1") const;   // "> 0 m", "0 .. 1"; "" if anything goes
};

inline constexpr Range any_number{};
inline constexpr Range positive{.min = 0, .min_open = true};
inline constexpr Range non_negative{.min = 0};
constexpr Range between(double min, double max) { return {.min = min, .max = max}; }

using ParameterValue = std::variant<double, std::string>;
struct Parameter { ParameterValue value; std::vector<ParameterValue> choices; };   // no choices: anything goes

class Reader {
 public:
  Reader(Diagnostics& to, std::filesystem::path base) : diagnostics(to), folder(std::move(base)) {}

  Diagnostics& diagnostics;
  std::filesystem::path folder;                  // of the scene file: where its relative paths start
  std::vector<std::string> materials, bodies;    // their names, as they are read
  std::vector<std::string> flows;                // of removers, inflows and probes
  std::vector<std::string> keys;                 // of the mappings around the value being read; the last one is named in errors
  std::vector<std::string> words;                // that may stand in place of the number being read

  void error(const Mark& at, const std::string& message);          // "key: message"
  void error(const Node& node, const std::string& message) { error(node.at, message); }

  // A number, a string with a unit of the dimension of `unit`, or "= expression". Reports an error and returns nothing if
  // it is not that or not in the range.
  std::optional<double> number(const Node&, const std::string& unit, const Range&);

  // The parameters of the scene, in order; a later one may use earlier ones. None may have a name of `reserved`.
  void read_parameters(const Node& map, const std::vector<std::string>& reserved);

  // Whether a list item with this `if:` is kept: every parameter named there has the value, or one of the list of values.
  bool holds(const Node& condition);

  const std::map<std::string, double>& number_parameters() const { return numbers_; }

 private:
  std::optional<double> evaluate_at(const Node&);
  std::string or_words() const;                  // ", or auto"
  std::optional<ParameterValue> parameter_value(const Node&);
  void read_parameter(const Node::Entry&);

  std::map<std::string, Parameter> parameters_;
  std::map<std::string, double> numbers_;        // those that are numbers
  std::set<std::string> failed_;                 // those with an error, reported already: using them is not another one
};

// "the word 'x'", "a list", "a mapping", "nothing": for errors.
std::string what_it_is(const Node&);
std::string value_text(const ParameterValue&);

}  // namespace skred
