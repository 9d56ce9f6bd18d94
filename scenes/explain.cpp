// scenes/explain.cpp - what the table of keys says to people and to editors: `explain`, the JSON Schema, the resolved scene.
#include <algorithm>
#include <cctype>
#include <stdexcept>
#include "scenes/overrides.h"
#include "scenes/schema.h"

namespace skred {
namespace {

std::string properties(const KeyDescription& k) {
  std::string out = k.value.text;
  if (k.alternative) out += "; one of the alternatives";
  else if (k.required) out += "; required";
  else if (!k.default_text.empty()) out += "; default " + k.default_text;
  if (!k.condition.empty()) out += "; only where " + k.condition;
  return out;
}

std::string overview(const std::vector<KeyDescription>& keys, const std::string& indent) {
  std::size_t width = 0;
  for (const KeyDescription& k : keys) width = std::max(width, k.name.size());
  std::string out;
  for (const KeyDescription& k : keys)
    out += indent + k.name + std::string(width - k.name.size() + 2, ' ') + k.explanation + "\n" + indent +
           std::string(width + 2, ' ') + properties(k) + "\n";
  return out;
}

bool is_index(const std::string& word) {
  return !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isdigit(c); });
}

}  // namespace

std::string explain(const std::string& path) {
  std::vector<KeyDescription> keys = scene_keys().describe();
  if (path.empty()) return overview(keys, "");
  KeyDescription at;
  std::string where;
  bool in_list = false;
  for (const std::string& word : split_path(path)) {
    if (in_list && is_index(word)) continue;              // bodies.0.mass is bodies.mass
    const auto found = std::find_if(keys.begin(), keys.end(), [&](const KeyDescription& k) { return k.name == word; });
    if (found == keys.end()) {
      std::vector<std::string> names;
      for (const KeyDescription& k : keys) names.push_back(k.name);
      throw std::invalid_argument("there is no key '" + word + "'" + (where.empty() ? "" : " in " + where) +
                                  (keys.empty() ? ": it has no keys" : suggestion(word, names)));
    }
    where += (where.empty() ? "" : ".") + word;
    at = *found;
    keys = at.value.keys;
    in_list = at.value.text.starts_with("list");
  }
  std::string out = where + ": " + properties(at) + "\n  " + at.explanation + "\n";
  if (!keys.empty()) out += "\n" + overview(keys, "  ");
  return out;
}

std::string json_schema() {
  Node schema = map_node({{"$schema", text_node("http://json-schema.org/draft-07/schema#")},
                          {"title", text_node("Skred scene")},
                          {"description",
                           text_node("Numbers are SI; strings may carry a unit (\"6.4 mm\") or an expression on the "
                                                    "parameters (\"= 2 * a\").")}});
  for (const Node::Entry& e : mapping_schema(scene_keys().describe(), false).entries) schema.entries.push_back(e);
  return to_json(schema);
}

std::string resolved_yaml(const Scene& scene) {
  return "# A scene as Skred resolved it: every value, in SI units.\n" + to_yaml(scene_keys().write(scene));
}

}  // namespace skred
