// scenes/table.h - the shape of the table of keys: a Section lists the keys of one struct, a Key ties a name in the file to
// a member of that struct by way of a kind of value (scenes/kinds.h).
//
// One line per key is all there is: from it come the reader, unknown-key suggestions, the JSON Schema, `explain` and the
// resolved scene. A default is the value of the member in a default-constructed struct.
#pragma once
#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>
#include "scenes/node.h"
#include "scenes/reader.h"

namespace skred {

struct KeyDescription;

// What a kind of value says about itself.
struct Description {
  std::string text;                        // "number in m, > 0"
  Node schema;                             // JSON Schema, draft-07
  std::vector<KeyDescription> keys = {};   // of a mapping, or of the mappings in a list
};

struct KeyDescription {
  std::string name, explanation, condition;   // condition: "motion: dynamic"; "" if the key always applies
  bool required = false, alternative = false; // alternative: exactly one of these keys must be given
  std::optional<Node> default_value;
  std::string default_text;
  Description value;
};

// One key of the mapping that fills a T.
template <class T> struct Key {
  std::string name, explanation;
  std::function<bool(Reader&, const Node&, T&)> read;          // false after an error
  std::function<std::optional<Node>(const T&)> write;          // nothing: not to be written
  std::function<Description()> describe;
  bool is_required = false, is_alternative = false;
  std::function<bool(const T&)> applies = nullptr;             // none: always
  std::string condition = "", default_text = "";

  Key&& required() && { is_required = true; return std::move(*this); }
  Key&& alternative() && { is_alternative = true; return std::move(*this); }
  Key&& when(bool (*holds)(const T&), std::string text) && {
    applies = holds;
    condition = std::move(text);
    return std::move(*this);
  }
  Key&& by_default(std::string text) && { default_text = std::move(text); return std::move(*this); }
};

// `member`: a pointer to a member, or a lambda from a T to a reference.
template <class K, class M, class C> Key<C> key(std::string name, K kind, M C::*member, std::string explanation) {
  return {std::move(name), std::move(explanation),
          [=](Reader& r, const Node& n, C& t) { return kind.read(r, n, t.*member); },
          [=](const C& t) -> std::optional<Node> { return kind.write(t.*member); }, [=] { return kind.describe(); }};
}

// A value that is not simply a member. get(const T&) gives the kind's value, or an optional of it; set takes (T&, value) or
// (Reader&, const Node&, T&, value).
template <class T, class K, class Get, class Set>
Key<T> property(std::string name, K kind, Get get, Set set, std::string explanation) {
  using Value = typename K::Value;
  const auto read = [=](Reader& r, const Node& n, T& t) {
    Value value{};
    const std::size_t errors = r.diagnostics.count();
    if (!kind.read(r, n, value)) return false;
    if constexpr (std::is_invocable_v<Set, Reader&, const Node&, T&, Value>) set(r, n, t, std::move(value));
    else set(t, std::move(value));
    return r.diagnostics.count() == errors;
  };
  const auto write = [=](const T& t) -> std::optional<Node> {
    if constexpr (std::is_convertible_v<decltype(get(t)), Value>) return kind.write(get(t));
    else if (const auto value = get(t)) return kind.write(*value);
    else return {};
  };
  return {std::move(name), std::move(explanation), read, write, [=] { return kind.describe(); }};
}

// A member of a member: `at` is a lambda `[](auto& t) -> auto& { return t.bulk.density; }`.
template <class T, class K, class At> Key<T> nested(std::string name, K kind, At at, std::string explanation) {
  return {std::move(name), std::move(explanation),
          [=](Reader& r, const Node& n, T& t) { return kind.read(r, n, at(t)); },
          [=](const T& t) -> std::optional<Node> { return kind.write(at(t)); }, [=] { return kind.describe(); }};
}

// The keys of one mapping, read and written in this order.
template <class T> struct Section {
  std::vector<Key<T>> keys;
  std::function<void(Reader&, const Node&, T&)> check = nullptr;   // after all keys, if they are well

  bool read(Reader& r, const Node& node, T& out, bool conditional) const {
    if (node.kind != Node::Kind::map && node.kind != Node::Kind::nothing) {
      r.error(node, "expected a mapping, got " + what_it_is(node));
      return false;
    }
    const std::size_t errors = r.diagnostics.count();
    const std::vector<std::string> words_of_mapping = std::exchange(r.words, {});
    reject_unknown(r, node, conditional);
    for (const Key<T>& k : keys) {
      const Node::Entry* entry = node.find(k.name);
      const bool applies = !k.applies || k.applies(out);
      if (entry && !applies) r.error(entry->at, "key '" + k.name + "' applies only where " + k.condition);
      else if (!entry && k.is_required && applies)
        r.error(node, "missing key '" + k.name + "' (" + k.describe().text + ")");
      if (!entry || !applies) continue;
      r.keys.push_back(k.name);
      k.read(r, entry->value, out);
      r.keys.pop_back();
    }
    r.words = words_of_mapping;
    if (check && r.diagnostics.count() == errors) check(r, node, out);
    return r.diagnostics.count() == errors;
  }

  Node write(const T& value) const {
    Node out = map_node({});
    for (const Key<T>& k : keys)
      if (!k.applies || k.applies(value))
        if (auto node = k.write(value)) out.entries.push_back({k.name, {}, std::move(*node)});
    return out;
  }

  std::vector<KeyDescription> describe() const {
    std::vector<KeyDescription> out;
    for (const Key<T>& k : keys) {
      KeyDescription d{k.name, k.explanation, k.condition, k.is_required, k.is_alternative, {}, k.default_text, k.describe()};
      if (!k.is_required && !k.is_alternative && k.default_text.empty()) {
        d.default_value = k.write(T{});
        if (d.default_value) d.default_text = to_yaml_line(*d.default_value);
      }
      out.push_back(std::move(d));
    }
    return out;
  }

 private:
  void reject_unknown(Reader& r, const Node& node, bool conditional) const {
    std::vector<std::string> known, alternatives;
    for (const Key<T>& k : keys) {
      known.push_back(k.name);
      if (k.is_alternative) alternatives.push_back(k.name);
    }
    std::vector<const Node::Entry*> given;
    bool misspelt = false;
    for (const Node::Entry& e : node.entries) {
      if (std::find(alternatives.begin(), alternatives.end(), e.key) != alternatives.end()) given.push_back(&e);
      if ((conditional && e.key == "if") || std::find(known.begin(), known.end(), e.key) != known.end()) continue;
      r.error(e.at, "unknown key '" + e.key + "'" + suggestion(e.key, known));
      misspelt = true;
    }
    if (alternatives.empty()) return;
    if (given.empty() && !misspelt) r.error(node, "needs one of the keys " + joined(alternatives));
    if (given.size() > 1)
      r.error(given[1]->at, "'" + given[0]->key + "' and '" + given[1]->key + "' are alternatives; give one of them");
  }
};

// The JSON Schema of a mapping with these keys; `conditional`: an item of a list, which may have an `if`.
Node mapping_schema(const std::vector<KeyDescription>& keys, bool conditional);

}  // namespace skred
