// scenes/kinds.cpp - how each kind of value is read and described.
#include "scenes/kinds.h"
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace skred {
namespace {

// How a string begins that may stand for a number: "= expression", or a number with a unit.
Node number_string_pattern() { return text_node(R"(^(=|[-+]?\.?[0-9]|\.?inf$))"); }

Node number_schema(const Range& range, const char* type = "number") {
  Node n = map_node({{"type", list_node({text_node(type), text_node("string")})}, {"pattern", number_string_pattern()}});
  const auto add = [&](const char* name, double value) { n.entries.push_back({name, {}, number_node(value)}); };
  if (std::isfinite(range.min)) add(range.min_open ? "exclusiveMinimum" : "minimum", range.min);
  if (std::isfinite(range.max)) add(range.max_open ? "exclusiveMaximum" : "maximum", range.max);
  return n;
}

Node list_schema(Node items, int count) {
  return map_node({{"type", text_node("array")}, {"items", std::move(items)},
                   {"minItems", plain(std::to_string(count))}, {"maxItems", plain(std::to_string(count))}});
}

Node string_schema() { return map_node({{"type", text_node("string")}}); }

Node any_of(std::vector<Node> schemas) { return map_node({{"anyOf", list_node(std::move(schemas))}}); }

// A mapping with exactly these keys, each of which is a number or vector.
Node fixed_mapping_schema(std::vector<std::pair<std::string, Node>> keys) {
  std::vector<Node> names;
  for (const auto& [name, schema] : keys) names.push_back(text_node(name));
  return map_node({{"type", text_node("object")}, {"properties", map_node(std::move(keys))},
                   {"required", list_node(std::move(names))}, {"additionalProperties", plain("false")}});
}

// The nodes of a mapping with exactly these keys, or nothing after an error.
std::optional<std::vector<const Node*>> fixed_mapping(Reader& r, const Node& node, const std::vector<std::string>& keys) {
  std::vector<const Node*> out;
  const std::size_t errors = r.diagnostics.count();
  for (const Node::Entry& e : node.entries)
    if (std::find(keys.begin(), keys.end(), e.key) == keys.end())
      r.error(e.at, "unknown key '" + e.key + "'" + suggestion(e.key, keys));
  for (const std::string& k : keys) {
    if (const Node::Entry* e = node.find(k)) out.push_back(&e->value);
    else r.error(node, "missing key '" + k + "'");
  }
  if (r.diagnostics.count() != errors) return {};
  return out;
}

bool read_numbers(Reader& r, const Node& node, const std::string& unit, const Range& range, const char* what, double* out,
                  std::size_t count) {
  if (node.kind != Node::Kind::list || node.items.size() != count) {
    const std::string got = node.kind == Node::Kind::list ? "a list of " + std::to_string(node.items.size()) : what_it_is(node);
    r.error(node, std::string("expected ") + what + ", got " + got);
    return false;
  }
  bool good = true;
  for (std::size_t k = 0; k < count; ++k) {
    if (const auto x = r.number(node.items[k], unit, range)) out[k] = *x;
    else good = false;
  }
  return good;
}

bool is_text(Reader& r, const Node& node, const char* what) {
  if (node.kind == Node::Kind::scalar) return true;
  r.error(node, std::string("expected ") + what + ", got " + what_it_is(node));
  return false;
}

std::string and_range(const Range& range) {
  const std::string text = range.text();
  return text.empty() ? "" : ", " + text;
}

std::string in_unit(const std::string& unit) { return unit == "1" ? "" : " in " + unit; }

constexpr double unit_tolerance = 16 * 2.220446049250313e-16;   // of a squared length that has just been made 1

}  // namespace

bool Number::read(Reader& r, const Node& node, double& out) const {
  const auto x = r.number(node, unit, range);
  if (x) out = *x;
  return x.has_value();
}
Description Number::describe() const { return {"number" + in_unit(unit) + and_range(range), number_schema(range)}; }

template <std::integral I> bool Integer<I>::read(Reader& r, const Node& node, I& out) const {
  const std::string& t = node.text;
  I whole{};
  const auto exact = std::from_chars(t.data(), t.data() + t.size(), whole);
  if (node.kind == Node::Kind::scalar && !t.empty() && exact.ec == std::errc() && exact.ptr == t.data() + t.size() &&
      whole >= min && whole <= max) {
    out = whole;
    return true;
  }
  const auto x = r.number(node, "1", {.min = double(min)});
  if (!x) return false;
  if (*x >= double(max) + 1) r.error(node, number_text(*x) + " is too large: must be <= " + std::to_string(max));
  else if (*x != std::floor(*x)) r.error(node, number_text(*x) + " is not an integer");
  else {
    out = I(*x);
    return true;
  }
  return false;
}
template <std::integral I> Description Integer<I>::describe() const {
  const bool bounded = max != std::numeric_limits<I>::max();
  const Range range{.min = double(min), .max = bounded ? double(max) : Range{}.max};
  return {"integer, " + range.text(), number_schema(range, "integer")};
}
template struct Integer<std::uint64_t>;
template struct Integer<int>;

bool Flag::read(Reader& r, const Node& node, bool& out) const {
  const bool good = node.kind == Node::Kind::scalar && !node.quoted && (node.text == "true" || node.text == "false");
  if (good) out = node.text == "true";
  else r.error(node, "expected true or false, got " + what_it_is(node));
  return good;
}
Description Flag::describe() const { return {"true or false", map_node({{"type", text_node("boolean")}})}; }

bool Text::read(Reader& r, const Node& node, std::string& out) const {
  if (!is_text(r, node, "text")) return false;
  out = node.text;
  return true;
}
Description Text::describe() const { return {"text", string_schema()}; }

bool Name::read(Reader& r, const Node& node, std::string& out) const {
  if (!is_text(r, node, "a name")) return false;
  const auto inner = [&](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-' || (dots && c == '.'); };
  const unsigned char first = node.text.empty() ? ' ' : static_cast<unsigned char>(node.text[0]);
  const bool begins_well = dots || std::isalpha(first) || first == '_';
  if (node.text.empty() || !begins_well || !std::all_of(node.text.begin(), node.text.end(), inner)) {
    r.error(node, "'" + node.text + "' is not a name: " + describe().text);
    return false;
  }
  out = node.text;
  return true;
}
Description Name::describe() const {
  Node schema = string_schema();
  schema.entries.push_back({"pattern", {}, text_node(dots ? "^[A-Za-z0-9_.-]+$" : "^[A-Za-z_][A-Za-z0-9_-]*$")});
  return {dots ? "letters, digits, '-', '_' and '.'" : "a letter or '_', then letters, digits, '-' and '_'", std::move(schema)};
}

bool MaterialName::read(Reader& r, const Node& node, std::string& out) const {
  if (!is_text(r, node, "the name of a material")) return false;
  if (std::find(r.materials.begin(), r.materials.end(), node.text) == r.materials.end()) {
    r.error(node, "there is no material '" + node.text + "'" + suggestion(node.text, r.materials));
    return false;
  }
  out = node.text;
  return true;
}
void default_material(Reader& r, const Node& node, std::string& material) {
  if (!material.empty()) return;
  if (r.materials.size() == 1) material = r.materials.front();
  else if (!r.materials.empty()) r.error(node, "missing key 'material': the scene has several, " + joined(r.materials));
}
Description MaterialName::describe() const { return {"name of a material", string_schema()}; }

bool FilePath::read(Reader& r, const Node& node, std::string& out) const {
  if (!is_text(r, node, "the path of a file")) return false;
  const auto path = std::filesystem::absolute(r.folder / node.text).lexically_normal();
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    r.error(node, "there is no file '" + path.string() + "'");
    return false;
  }
  out = path.string();
  return true;
}
Description FilePath::describe() const { return {"path of a file, relative to the scene file", string_schema()}; }

bool read_word(Reader& r, const Node& node, const std::vector<std::string>& words, std::size_t& which) {
  const auto found = std::find(words.begin(), words.end(), node.text);
  if (node.kind == Node::Kind::scalar && found != words.end()) {
    which = std::size_t(found - words.begin());
    return true;
  }
  const std::string nearest = nearest_name(node.text, words);
  r.error(node, what_it_is(node) + " is not one of " + joined(words) +
                    (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
  return false;
}
Description describe_words(const std::vector<std::string>& words) {
  std::vector<Node> nodes;
  for (const std::string& w : words) nodes.push_back(text_node(w));
  return {"one of " + joined(words), map_node({{"enum", list_node(std::move(nodes))}})};
}

bool Vector::read(Reader& r, const Node& node, Vec3& out) const {
  double v[3];
  if (!read_numbers(r, node, unit, range, "three numbers [x, y, z]", v, 3)) return false;
  out = {v[0], v[1], v[2]};
  return true;
}
Description Vector::describe() const {
  return {"[x, y, z]" + in_unit(unit) + and_range(range), list_schema(number_schema(range), 3)};
}

bool Direction::read(Reader& r, const Node& node, Vec3& out) const {
  Vec3 v;
  if (!Vector{}.read(r, node, v)) return false;
  const double length = norm(v);
  if (!(length > 0) || !std::isfinite(length)) {
    r.error(node, "a direction must not be zero");
    return false;
  }
  out = std::abs(dot(v, v) - 1) <= unit_tolerance ? v : normalized(v);   // so that a resolved scene keeps its bits
  return true;
}
Description Direction::describe() const { return {"direction [x, y, z], not zero", Vector{}.describe().schema}; }

bool Scale::read(Reader& r, const Node& node, Vec3& out) const {
  if (node.kind == Node::Kind::list) return Vector{"1", positive}.read(r, node, out);
  const auto s = r.number(node, "1", positive);
  if (s) out = {*s, *s, *s};
  return s.has_value();
}
Description Scale::describe() const {
  return {"number or [x, y, z], > 0", any_of({number_schema(positive), Vector{"1", positive}.describe().schema})};
}

bool Orientation::read(Reader& r, const Node& node, Quaternion& out) const {
  if (node.kind == Node::Kind::map) {
    const auto values = fixed_mapping(r, node, {"axis", "angle"});
    Vec3 axis;
    if (!values || !Direction{}.read(r, *(*values)[0], axis)) return false;
    const auto angle = r.number(*(*values)[1], "rad", any_number);
    if (angle) out = rotation_by(*angle * axis);
    return angle.has_value();
  }
  double q[4];
  if (!read_numbers(r, node, "1", any_number, "{axis: [x, y, z], angle: 30 deg} or a quaternion [w, x, y, z]", q, 4))
    return false;
  const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  if (!(std::abs(square - 1) <= 1e-6)) {
    r.error(node, "a quaternion must have length 1; this one has " + number_text(std::sqrt(square)));
    return false;
  }
  out = {q[0], q[1], q[2], q[3]};
  if (std::abs(square - 1) > unit_tolerance) out = normalized(out);
  return true;
}
Node Orientation::write(const Quaternion& q) const {
  return list_node({number_node(q.w), number_node(q.x), number_node(q.y), number_node(q.z)});
}
Description Orientation::describe() const {
  return {"{axis: [x, y, z], angle: in rad}, or a quaternion [w, x, y, z]",
          any_of({fixed_mapping_schema({{"axis", Vector{}.describe().schema}, {"angle", number_schema({})}}),
                  list_schema(number_schema({}), 4)})};
}

bool Radius::read(Reader& r, const Node& node, RadiusSpec& out) const {
  if (node.kind == Node::Kind::map) {
    const auto values = fixed_mapping(r, node, {"min", "max"});
    if (!values) return false;
    const auto min = r.number(*(*values)[0], "m", positive), max = r.number(*(*values)[1], "m", positive);
    if (!min || !max) return false;
    if (*min > *max) r.error(node, "min " + number_text(*min) + " m is greater than max " + number_text(*max) + " m");
    out = {*min, *max};
    return *min <= *max;
  }
  const auto radius = r.number(node, "m", positive);
  if (radius) out = {*radius, *radius};
  return radius.has_value();
}
Node Radius::write(const RadiusSpec& v) const {
  return v.min == v.max ? number_node(v.min) : map_node({{"min", number_node(v.min)}, {"max", number_node(v.max)}});
}
Description Radius::describe() const {
  return {"number in m, > 0, or {min, max} for sizes between them",
          any_of({number_schema(positive),
                  fixed_mapping_schema({{"min", number_schema(positive)}, {"max", number_schema(positive)}})})};
}

bool Period::read(Reader& r, const Node& node, PeriodicSpec& out) const {
  if (node.kind == Node::Kind::scalar && node.text == "none") { out = {}; return true; }
  double ends[2];
  if (!read_numbers(r, node, "m", any_number, "[low, high] or none", ends, 2)) return false;
  if (!(ends[0] < ends[1])) {
    r.error(node, "low " + number_text(ends[0]) + " m must be less than high " + number_text(ends[1]) + " m");
    return false;
  }
  out = {true, ends[0], ends[1]};
  return true;
}
Node Period::write(const PeriodicSpec& v) const {
  return v.on ? list_node({number_node(v.min), number_node(v.max)}) : plain("none");
}
Description Period::describe() const {
  return {"[low, high] in m, or none", any_of({map_node({{"const", text_node("none")}}), list_schema(number_schema({}), 2)})};
}

bool MaterialPair::read(Reader& r, const Node& node, Value& out) const {
  if (node.kind != Node::Kind::list || node.items.size() != 2) {
    r.error(node, "expected the names of two materials, [first, second]");
    return false;
  }
  const bool first = MaterialName{}.read(r, node.items[0], out.first);
  return MaterialName{}.read(r, node.items[1], out.second) && first;
}
Description MaterialPair::describe() const { return {"names of two materials", list_schema(string_schema(), 2)}; }

Description Parameters::describe() const {
  const Node scalar = map_node({{"type", list_node({text_node("number"), text_node("string")})}});
  const Node choices = map_node({{"type", text_node("array")}, {"items", scalar}});
  const Node full = map_node({{"type", text_node("object")},
                              {"properties", map_node({{"value", scalar}, {"choices", choices},
                                                       {"description", string_schema()}})},
                              {"required", list_node({text_node("value")})},
                              {"additionalProperties", plain("false")}});
  return {"mapping from names to numbers, words, \"= expression\", or {value, choices, description}",
          map_node({{"type", text_node("object")}, {"additionalProperties", any_of({scalar, full})}})};
}

Node mapping_schema(const std::vector<KeyDescription>& keys, bool conditional) {
  Node properties = map_node({}), required = list_node({}), alternatives = list_node({});
  for (const KeyDescription& k : keys) {
    std::string text = k.explanation + " (" + k.value.text + (k.condition.empty() ? "" : "; where " + k.condition) + ")";
    Node schema = map_node({{"description", text_node(std::move(text))}});
    if (k.default_value && k.default_value->kind != Node::Kind::nothing)
      schema.entries.push_back({"default", {}, *k.default_value});
    for (const Node::Entry& e : k.value.schema.entries) schema.entries.push_back(e);
    properties.entries.push_back({k.name, {}, std::move(schema)});
    if (k.required && k.condition.empty()) required.items.push_back(text_node(k.name));
    if (k.alternative) alternatives.items.push_back(map_node({{"required", list_node({text_node(k.name)})}}));
  }
  if (conditional) {
    const char* text = "Keep this item only if each parameter named here has the value, or one of the list of values.";
    properties.entries.push_back({"if", {}, map_node({{"description", text_node(text)}, {"type", text_node("object")}})});
  }
  Node schema = map_node({{"type", text_node("object")}, {"properties", std::move(properties)},
                          {"additionalProperties", plain("false")}});
  if (!required.items.empty()) schema.entries.push_back({"required", {}, std::move(required)});
  if (!alternatives.items.empty()) schema.entries.push_back({"oneOf", {}, std::move(alternatives)});
  return schema;
}

}  // namespace skred
