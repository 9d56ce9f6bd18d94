// scenes/kinds.h - kinds of values. Each has a Value, reads it from a node (false after an error), writes it so that it
// reads back as the same value, and describes itself.
#pragma once
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>
#include "engine/vec3.h"
#include "scenes/scene.h"
#include "scenes/table.h"

namespace skred {

struct Number {
  using Value = double;
  std::string unit = "1";
  Range range = any_number;
  bool read(Reader&, const Node&, double&) const;
  Node write(double value) const { return number_node(value); }
  Description describe() const;
};

// std::uint64_t or int; the whole range of 64 bits can be written.
template <std::integral I> struct Integer {
  using Value = I;
  I min = 0, max = std::numeric_limits<I>::max();
  bool read(Reader&, const Node&, I&) const;
  Node write(I value) const { return plain(std::to_string(value)); }
  Description describe() const;
};
extern template struct Integer<std::uint64_t>;
extern template struct Integer<int>;

struct Flag {
  using Value = bool;
  bool read(Reader&, const Node&, bool&) const;
  Node write(bool value) const { return plain(value ? "true" : "false"); }
  Description describe() const;
};

struct Text {
  using Value = std::string;
  bool read(Reader&, const Node&, std::string&) const;
  Node write(const std::string& value) const { return text_node(value); }
  Description describe() const;
};

// A name that paths of --set can hold: a letter or '_', then letters, digits, '-' and '_' (and '.' with `dots`).
struct Name {
  using Value = std::string;
  bool dots = false;
  bool read(Reader&, const Node&, std::string&) const;
  Node write(const std::string& value) const { return text_node(value); }
  Description describe() const;
};

// The name of one of the scene's materials.
struct MaterialName {
  using Value = std::string;
  bool read(Reader&, const Node&, std::string&) const;
  Node write(const std::string& value) const { return text_node(value); }
  Description describe() const;
};

// A scene of one material need not repeat its name: fills in an empty `material`, or reports that it is missing.
void default_material(Reader&, const Node&, std::string& material);

// A path, relative to the scene file; absolute once read. The file must exist.
struct FilePath {
  using Value = std::string;
  bool read(Reader&, const Node&, std::string&) const;
  Node write(const std::string& value) const { return text_node(value); }
  Description describe() const;
};

bool read_word(Reader&, const Node&, const std::vector<std::string>& words, std::size_t& which);
Description describe_words(const std::vector<std::string>& words);

// One of a few words, each standing for a value of E.
template <class E> struct Word {
  using Value = E;
  std::vector<std::pair<std::string, E>> words;
  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const auto& [name, value] : words) out.push_back(name);
    return out;
  }
  bool read(Reader& r, const Node& node, E& out) const {
    std::size_t which = 0;
    if (!read_word(r, node, names(), which)) return false;
    out = words[which].second;
    return true;
  }
  Node write(const E& value) const {
    for (const auto& [name, e] : words)
      if (e == value) return plain(name);
    return {};
  }
  Description describe() const { return describe_words(names()); }
};

struct Vector {                             // [x, y, z]
  using Value = Vec3;
  std::string unit = "1";
  Range range = any_number;                 // of each component
  bool read(Reader&, const Node&, Vec3&) const;
  Node write(const Vec3& v) const { return list_node({number_node(v.x), number_node(v.y), number_node(v.z)}); }
  Description describe() const;
};

struct Direction {                          // [x, y, z], not zero; of length 1 once read
  using Value = Vec3;
  bool read(Reader&, const Node&, Vec3&) const;
  Node write(const Vec3& v) const { return Vector{}.write(v); }
  Description describe() const;
};

struct Scale {                              // a number > 0, or [x, y, z]
  using Value = Vec3;
  bool read(Reader&, const Node&, Vec3&) const;
  Node write(const Vec3& v) const { return Vector{}.write(v); }
  Description describe() const;
};

struct Orientation {                        // {axis, angle}, or the unit quaternion [w, x, y, z]
  using Value = Quaternion;
  bool read(Reader&, const Node&, Quaternion&) const;
  Node write(const Quaternion& q) const;
  Description describe() const;
};

struct Radius {                             // a number, or {min, max}
  using Value = RadiusSpec;
  bool read(Reader&, const Node&, RadiusSpec&) const;
  Node write(const RadiusSpec&) const;
  Description describe() const;
};

struct Period {                             // [low, high], or none
  using Value = PeriodicSpec;
  bool read(Reader&, const Node&, PeriodicSpec&) const;
  Node write(const PeriodicSpec&) const;
  Description describe() const;
};

struct MaterialPair {                       // [first, second]
  using Value = std::pair<std::string, std::string>;
  bool read(Reader&, const Node&, Value&) const;
  Node write(const Value& v) const { return list_node({text_node(v.first), text_node(v.second)}); }
  Description describe() const;
};

// The scene's parameters: read before everything else, gone from the resolved scene.
struct Parameters {
  using Value = bool;
  bool read(Reader&, const Node&, bool&) const { return true; }
  Node write(bool) const { return {}; }
  Description describe() const;
};

// What K reads, or a word that means its absence. May be nested, for two words.
template <class K> struct Or {
  using Value = std::optional<typename K::Value>;
  std::string word;                         // auto, none
  K kind;
  bool read(Reader& r, const Node& node, Value& out) const {
    if (node.kind == Node::Kind::scalar && node.text == word) { out.reset(); return true; }
    r.words.insert(r.words.begin(), word);
    const bool good = kind.read(r, node, out.emplace());
    r.words.erase(r.words.begin());
    return good;
  }
  Node write(const Value& value) const { return value ? kind.write(*value) : plain(word); }
  Description describe() const {
    Description d = kind.describe();
    d.text += ", or " + word;
    d.schema = map_node({{"anyOf", list_node({map_node({{"const", text_node(word)}}), std::move(d.schema)})}});
    return d;
  }
};

// A mapping with the keys of a section.
template <class T> struct Map {
  using Value = T;
  const Section<T>& (*section)();
  bool conditional = false;                 // may have an `if`: an item of a list
  bool read(Reader& r, const Node& node, T& out) const { return section().read(r, node, out, conditional); }
  Node write(const T& value) const { return section().write(value); }
  Description describe() const {
    Description d{"mapping", {}, section().describe()};
    d.schema = mapping_schema(d.keys, conditional);
    return d;
  }
};

// A list of mappings; items whose `if` does not hold are left out.
template <class T> struct List {
  using Value = std::vector<T>;
  const Section<T>& (*section)();
  std::string what;                         // "material": names an item in errors
  bool may_be_empty = true;

  bool read(Reader& r, const Node& node, Value& out) const {
    if (node.kind != Node::Kind::list) {
      r.error(node, "expected a list, got " + what_it_is(node));
      return false;
    }
    bool good = true;
    out.clear();
    for (const Node& item : node.items) {
      if (item.kind == Node::Kind::map)
        if (const Node::Entry* condition = item.find("if"); condition && !r.holds(condition->value)) continue;
      T value{};
      good = section().read(r, item, value, true) && good;
      out.push_back(std::move(value));
    }
    if (good && out.empty() && !may_be_empty) {
      r.error(node, "empty; at least one " + what + " is needed");
      return false;
    }
    return good;
  }
  Node write(const Value& values) const {
    std::vector<Node> items;
    for (const T& v : values) items.push_back(section().write(v));
    return list_node(std::move(items));
  }
  Description describe() const {
    Description d{"list of mappings", {}, section().describe()};
    d.schema = map_node({{"type", text_node("array")}, {"items", mapping_schema(d.keys, true)}});
    if (!may_be_empty) d.schema.entries.push_back({"minItems", {}, plain("1")});
    return d;
  }
};

}  // namespace skred
