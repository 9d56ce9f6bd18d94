#include "scenes/check/keys.h"
#include <algorithm>
#include "scenes/expression.h"
#include "scenes/kinds.h"

namespace skred {
namespace {

bool expect_map(Reader& r, const Node& node) {
  if (node.kind == Node::Kind::map) return true;
  r.error(node, "expected a mapping, got " + what_it_is(node));
  return false;
}

// name: formula
struct Formulas {
  using Value = std::vector<NamedFormula>;
  bool read(Reader& r, const Node& node, Value& out) const {
    if (!expect_map(r, node)) return false;
    const std::size_t errors = r.diagnostics.count();
    for (const Node::Entry& e : node.entries) {
      if (!is_parameter_name(e.key)) r.error(e.at, "'" + e.key + "' is not a name: a letter, then letters, digits and '_'");
      if (e.value.kind != Node::Kind::scalar) r.error(e.value, "expected a formula, got " + what_it_is(e.value));
      out.push_back({e.key, e.value.text});
    }
    return r.diagnostics.count() == errors;
  }
  Node write(const Value& value) const {
    std::vector<std::pair<std::string, Node>> entries;
    for (const NamedFormula& f : value) entries.push_back({f.name, text_node(f.formula)});
    return map_node(std::move(entries));
  }
  Description describe() const {
    return {"mapping from names to formulas",
            map_node({{"type", text_node("object")}, {"additionalProperties", map_node({{"type", list_node({text_node("string"), text_node("number")})}})}})};
  }
};

// parameter: [its value in each run]
struct Columns {
  using Value = std::vector<std::pair<std::string, std::vector<std::string>>>;
  bool read(Reader& r, const Node& node, Value& out) const {
    if (!expect_map(r, node)) return false;
    const std::size_t errors = r.diagnostics.count();
    for (const Node::Entry& e : node.entries) {
      if (e.value.kind != Node::Kind::list || e.value.items.empty()) {
        r.error(e.value, "expected a list of values, got " + (e.value.kind == Node::Kind::list ? "an empty list" : what_it_is(e.value)));
        continue;
      }
      std::vector<std::string> column;
      for (const Node& item : e.value.items) {
        if (item.kind != Node::Kind::scalar) r.error(item, "expected a value, got " + what_it_is(item));
        column.push_back(item.text);
      }
      if (!out.empty() && column.size() != out.front().second.size())
        r.error(e.value, std::to_string(column.size()) + " values, but '" + out.front().first + "' has " + std::to_string(out.front().second.size()));
      out.push_back({e.key, std::move(column)});
    }
    return r.diagnostics.count() == errors;
  }
  Node write(const Value& value) const {
    std::vector<std::pair<std::string, Node>> entries;
    for (const auto& [name, column] : value) {
      std::vector<Node> items;
      for (const std::string& v : column) items.push_back(plain(v));
      entries.push_back({name, list_node(std::move(items))});
    }
    return map_node(std::move(entries));
  }
  Description describe() const {
    return {"mapping from parameters to lists of values",
            map_node({{"type", text_node("object")}, {"additionalProperties", map_node({{"type", text_node("array")}, {"minItems", plain("1")}})}})};
  }
};

// [a, b, ...] of what K reads, at least one.
template <class K> struct ListOf {
  using Value = std::vector<typename K::Value>;
  K kind;
  bool read(Reader& r, const Node& node, Value& out) const {
    if (node.kind != Node::Kind::list || node.items.empty()) {
      r.error(node, "expected a list, got " + (node.kind == Node::Kind::list ? "an empty one" : what_it_is(node)));
      return false;
    }
    out.clear();
    bool good = true;
    for (const Node& item : node.items) {
      typename K::Value value{};
      good = kind.read(r, item, value) && good;
      out.push_back(std::move(value));
    }
    return good;
  }
  Node write(const Value& values) const {
    std::vector<Node> items;
    for (const auto& v : values) items.push_back(kind.write(v));
    return list_node(std::move(items));
  }
  Description describe() const {
    Description d = kind.describe();
    return {"list of " + d.text, map_node({{"type", text_node("array")}, {"items", std::move(d.schema)}, {"minItems", plain("1")}})};
  }
};

struct GroupName {
  using Value = std::string;
  static std::vector<std::string> names() {
    std::vector<std::string> out;
    for (const auto& [name, title] : check_groups()) out.push_back(name);
    return out;
  }
  bool read(Reader& r, const Node& node, std::string& out) const {
    std::size_t which = 0;
    if (!read_word(r, node, names(), which)) return false;
    out = names()[which];
    return true;
  }
  Node write(const std::string& value) const { return plain(value); }
  Description describe() const { return describe_words(names()); }
};

void check_expectation(Reader& r, const Node& node, Expectation& e) {
  const int given = !e.expected.empty() + !e.at_most.empty() + !e.at_least.empty();
  if (given != 1) r.error(node, "give one of expected, at_most and at_least");
  if (e.of == Expectation::Of::methods && e.method != Expectation::Methods::all)
    r.error(node, "method: an expectation of both methods has none of its own");
}

const Section<Expectation>& expectation_keys() {
  using E = Expectation;
  static const Section<E> section{{
      key("what", Text{}, &E::what, "What is looked at, with its unit; a question, which ends with '?', is answered by yes (1) or no (0).").required(),
      key("value", Text{}, &E::value, "Formula: what is measured.").required(),
      key("expected", Text{}, &E::expected, "Formula: what it should be."),
      key("tolerance", Text{}, &E::tolerance, "Formula: greatest difference from what is expected; with %: of what is expected."),
      key("at_most", Text{}, &E::at_most, "Formula: greatest value that is right."),
      key("at_least", Text{}, &E::at_least, "Formula: least value that is right."),
      key("of", Word<E::Of>{{{"run", E::Of::run}, {"seeds", E::Of::seeds}, {"runs", E::Of::runs}, {"methods", E::Of::methods}}}, &E::of,
          "run: every run on its own; seeds: the mean over the seeds, whose confidence interval of 95 % must lie within the tolerance; "
          "runs: the formulas see the values of all runs, as mean(\"v\") or slope(\"v against w\"); methods: those of both methods, means over the seeds, as "
          "sdem(\"v\") and ndem(\"v\")."),
      key("method", Word<E::Methods>{{{"all", E::Methods::all}, {"sdem", E::Methods::sdem}, {"ndem", E::Methods::ndem}}}, &E::method,
          "Only of this method."),
      key("when", Text{}, &E::when, "Formula: runs where it is 0 are left out."),
      key("note", Text{}, &E::note, "Why this is right, where a reader might wonder."),
  }, check_expectation};
  return section;
}

}  // namespace

const Section<CheckSpec>& check_keys() {
  using C = CheckSpec;
  static const Section<C> section{{
      key("title", Text{}, &C::title, "What the case shows, in a few words.").required(),
      key("group", GroupName{}, &C::group, "Where it belongs.").required(),
      key("source", Text{}, &C::source, "Where the expectations come from: author, year, equation.").required(),
      key("methods", ListOf<Word<Method>>{{{{"sdem", Method::sdem}, {"ndem", Method::ndem}}}}, &C::methods, "Methods to run it with."),
      key("threads", ListOf<Integer<int>>{{1, 1024}}, &C::threads, "Thread counts to run it with; all must give the same bits."),
      key("slow", Flag{}, &C::slow, "Run only with --all."),
      key("force", Flag{}, &C::force, "Run even with a time step beyond the limit, as run --force does."),
      key("seeds", Integer<int>{1, 1000}, &C::seeds, "Runs with the scene's seed and the seeds after it."),
      key("vary", Columns{}, &C::vary, "Parameters and their values; one run for each place in the lists, which have one length."),
      nested<C>("track_interval", Number{"s", non_negative}, [](auto& c) -> auto& { return c.track_interval; },
                "Time between samples of what is tracked; 0: a two-hundredth of the end time."),
      key("track", Formulas{}, &C::track, "What is followed over time."),
      key("values", Formulas{}, &C::values, "What is worked out at the end of a run; later ones may use earlier ones."),
      key("expect", List<Expectation>{expectation_keys, "expectation", false}, &C::expect, "What should be seen.").required(),
  }};
  return section;
}

}  // namespace skred
