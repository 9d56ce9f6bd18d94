// scenes/reader.cpp - numbers, parameters and conditions.
#include "scenes/reader.h"
#include <algorithm>
#include <cmath>
#include "scenes/expression.h"
#include "scenes/units.h"

namespace skred {
namespace {

bool is_expression(const Node& n) { return n.kind == Node::Kind::scalar && n.text.starts_with('='); }

std::vector<std::string> texts(const std::vector<ParameterValue>& values) {
  std::vector<std::string> out;
  for (const ParameterValue& v : values) out.push_back(value_text(v));
  return out;
}

bool among(const ParameterValue& value, const std::vector<ParameterValue>& values) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

}  // namespace

bool Range::contains(double x) const {
  if (std::isinf(x)) return infinite && x > 0;
  return (min_open ? x > min : x >= min) && (max_open ? x < max : x <= max);
}

std::string Range::text(const std::string& unit) const {
  const std::string suffix = unit == "1" ? "" : " " + unit;
  const bool low = std::isfinite(min), high = std::isfinite(max);
  if (low && high && !min_open && !max_open) return number_text(min) + " .. " + number_text(max) + suffix;
  std::string out;
  if (low) out += (min_open ? "> " : ">= ") + number_text(min) + suffix;
  if (high) out += (low ? " and " : "") + std::string(max_open ? "< " : "<= ") + number_text(max) + suffix;
  return out;
}

std::string what_it_is(const Node& n) {
  switch (n.kind) {
    case Node::Kind::nothing: return "nothing";
    case Node::Kind::scalar: return "'" + n.text + "'";
    case Node::Kind::list: return "a list";
    case Node::Kind::map: return "a mapping";
  }
  return "";
}

std::string value_text(const ParameterValue& v) {
  return std::holds_alternative<double>(v) ? number_text(std::get<double>(v)) : std::get<std::string>(v);
}

void Reader::error(const Mark& at, const std::string& message) {
  diagnostics.error(at, (keys.empty() ? "" : keys.back() + ": ") + message);
}

std::string Reader::or_words() const {
  std::string out;
  for (const std::string& word : words) out += ", or " + word;
  return out;
}

std::optional<double> Reader::evaluate_at(const Node& node) {
  try {
    return evaluate(node.text.substr(1), numbers_);
  } catch (const ExpressionError& e) {
    if (failed_.contains(e.unknown)) return {};
    Mark at = node.at;
    if (node.text.find('\n') == std::string::npos) at.column += e.position + 1 + node.quoted;
    error(at, e.what());
    return {};
  }
}

std::optional<double> Reader::number(const Node& node, const std::string& unit, const Range& range) {
  const std::string in = unit == "1" ? "" : " in " + unit;
  if (node.kind != Node::Kind::scalar) {
    error(node, "expected a number" + in + or_words() + ", got " + what_it_is(node));
    return {};
  }
  double value = 0;
  if (is_expression(node)) {
    const auto result = evaluate_at(node);
    if (!result) return {};
    value = *result;
  } else if (range.infinite && (node.text == ".inf" || node.text == "inf")) {
    value = std::numeric_limits<double>::infinity();
  } else {
    try {
      const Quantity q = parse_quantity(node.text);
      if (q.has_unit && q.dimension != parse_dimension(unit)) {
        std::string message = "'" + node.text + "' is " + dimension_name(q.dimension) + "; expected " +
                              dimension_name(parse_dimension(unit));
        if (unit == "m/s^2" && q.dimension == parse_dimension("kg")) message += " (g is the gram; standard gravity is g_n)";
        error(node, message);
        return {};
      }
      value = q.value;
    } catch (const std::invalid_argument& e) {
      error(node, std::string(e.what()) + "; expected a number" + in + " such as 0.5" +
                      (unit == "1" ? "" : ", \"0.5 " + unit + "\"") + " or \"= 2 * a\"" + or_words());
      return {};
    }
  }
  if (range.contains(value)) return value;
  error(node, (is_expression(node) ? "'" + node.text + "' = " + number_text(value) : node.text) +
                  " is out of range: must be " + range.text(unit) + or_words());
  return {};
}

std::optional<ParameterValue> Reader::parameter_value(const Node& node) {
  if (node.kind != Node::Kind::scalar) {
    error(node, "expected a number, a word or \"= expression\", got " + what_it_is(node));
    return {};
  }
  if (is_expression(node)) {
    const auto result = evaluate_at(node);
    return result ? std::optional<ParameterValue>(*result) : std::nullopt;
  }
  if (const char first = node.text.empty() ? ' ' : node.text[0]; std::isalpha(static_cast<unsigned char>(first)))
    return node.text;
  try {
    return parse_quantity(node.text).value;
  } catch (const std::invalid_argument& e) {
    error(node, e.what());
    return {};
  }
}

void Reader::read_parameter(const Node::Entry& entry) {
  keys.push_back(entry.key);
  if (!is_parameter_name(entry.key))
    error(entry.at,
          "a parameter's name is a letter followed by letters, digits and '_', and not the name of a function or constant");
  const Node* value = &entry.value;
  Parameter parameter;
  bool good = true;
  if (entry.value.kind == Node::Kind::map) {
    const std::vector<std::string> known = {"value", "choices", "description"};
    for (const Node::Entry& e : entry.value.entries)
      if (std::find(known.begin(), known.end(), e.key) == known.end())
        error(e.at, "unknown key '" + e.key + "'" + suggestion(e.key, known));
    const Node::Entry* given = entry.value.find("value");
    if (!given) error(entry.at, "missing key 'value'");
    value = given ? &given->value : nullptr;
    if (const Node::Entry* choices = entry.value.find("choices")) {
      if (choices->value.kind != Node::Kind::list)
        error(choices->value, "choices: expected a list, got " + what_it_is(choices->value));
      for (const Node& item : choices->value.items) {
        if (auto v = parameter_value(item)) parameter.choices.push_back(*v);
        else good = false;
      }
    }
  }
  if (const auto v = value ? parameter_value(*value) : std::nullopt) {
    parameter.value = *v;
    if (good && !parameter.choices.empty() && !among(*v, parameter.choices))
      error(*value, value_text(*v) + " is not one of " + joined(texts(parameter.choices)));
    if (std::holds_alternative<double>(*v)) numbers_[entry.key] = std::get<double>(*v);
    parameters_[entry.key] = std::move(parameter);
  } else {
    failed_.insert(entry.key);
  }
  keys.pop_back();
}

void Reader::read_parameters(const Node& map, const std::vector<std::string>& reserved) {
  if (map.kind == Node::Kind::nothing) return;
  if (map.kind != Node::Kind::map) {
    error(map, "parameters: expected a mapping, got " + what_it_is(map));
    return;
  }
  for (const Node::Entry& entry : map.entries) {
    if (std::find(reserved.begin(), reserved.end(), entry.key) != reserved.end())
      error(entry.at, entry.key + ": a key of the scene has this name, and --set would not know which is meant");
    read_parameter(entry);
  }
}

bool Reader::holds(const Node& condition) {
  if (condition.kind != Node::Kind::map) {
    error(condition, "if: expected a mapping from parameters to values, got " + what_it_is(condition));
    return true;
  }
  bool all = true;
  for (const Node::Entry& e : condition.entries) {
    const auto found = parameters_.find(e.key);
    if (found == parameters_.end()) {
      if (failed_.contains(e.key)) continue;
      std::vector<std::string> names;
      for (const auto& [name, parameter] : parameters_) names.push_back(name);
      error(e.at, "if: unknown parameter '" + e.key + "'" + suggestion(e.key, names));
      continue;
    }
    const Parameter& parameter = found->second;
    bool any = false;
    const auto compare = [&](const Node& item) {
      const auto value = parameter_value(item);
      if (!value) return;
      if (!parameter.choices.empty() && !among(*value, parameter.choices))
        error(item, "if: " + value_text(*value) + " is not a choice of " + e.key +
              suggestion(value_text(*value), texts(parameter.choices)));
      any = any || *value == parameter.value;
    };
    if (e.value.kind == Node::Kind::list) for (const Node& item : e.value.items) compare(item);
    else compare(e.value);
    all = all && any;
  }
  return all;
}

}  // namespace skred
