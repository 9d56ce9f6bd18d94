// scenes/node_text.cpp - from the tree to YAML and JSON text.
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>
#include "scenes/node.h"

namespace skred {
namespace {

std::string in_quotes(const std::string& text) {
  static const char* hex = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    switch (c) {
      case '"': out += "\\\""; break;
      case '\\': out += "\\\\"; break;
      case '\n': out += "\\n"; break;
      case '\t': out += "\\t"; break;
      default:
        if (static_cast<unsigned char>(c) < 0x20) ((out += "\\u00") += hex[c >> 4]) += hex[c & 15];
        else out += c;
    }
  }
  return out + "\"";
}

// Words that any YAML reader takes as they stand.
bool is_plain_word(const std::string& text) {
  const auto letter = [](unsigned char c) { return std::isalpha(c) || c == '_'; };
  const auto inner = [&](unsigned char c) { return letter(c) || std::isdigit(c) || std::strchr("./-", c); };
  if (text.empty() || !letter(static_cast<unsigned char>(text[0])) || !std::all_of(text.begin(), text.end(), inner)) return false;
  std::string low = text;
  for (char& c : low) c = char(std::tolower(static_cast<unsigned char>(c)));
  const char* taken[] = {"true", "false", "yes", "no", "on", "off", "null"};
  return std::find(std::begin(taken), std::end(taken), low) == std::end(taken);
}

bool is_line(const Node& n) {
  const auto scalar = [](const Node& i) { return i.kind == Node::Kind::scalar || i.kind == Node::Kind::nothing; };
  if (n.kind == Node::Kind::list) return std::all_of(n.items.begin(), n.items.end(), scalar);
  return n.kind != Node::Kind::map || n.entries.empty();
}

void write_block(const Node& n, std::string& out, const std::string& indent) {
  for (const Node::Entry& e : n.entries) {
    out += (out.empty() || out.back() == '\n' ? indent : "") + (is_plain_word(e.key) ? e.key : in_quotes(e.key)) + ":";
    if (is_line(e.value)) { out += " " + to_yaml_line(e.value) + "\n"; continue; }
    out += "\n";
    write_block(e.value, out, indent + "  ");
  }
  for (const Node& i : n.items) {
    out += indent + "- ";
    if (is_line(i)) { out += to_yaml_line(i) + "\n"; continue; }
    write_block(i, out, indent + "  ");      // the first key stands behind the dash
  }
}

std::string json_scalar(const Node& n) {
  if (n.kind == Node::Kind::nothing) return "null";
  if (n.quoted || n.text.empty()) return in_quotes(n.text);
  const bool digits_only = std::all_of(n.text.begin(), n.text.end(), [](unsigned char c) { return std::isdigit(c); });
  if (n.text == "true" || n.text == "false" || (digits_only && (n.text[0] != '0' || n.text.size() == 1))) return n.text;
  const std::string digits = n.text.starts_with('+') ? n.text.substr(1) : n.text;
  double value = 0;
  const char* end = digits.data() + digits.size();
  const auto read = std::from_chars(digits.data(), end, value);
  const bool is_number = read.ec == std::errc() && read.ptr == end && !std::isalpha(static_cast<unsigned char>(digits.back()));
  return is_number ? number_text(value) : in_quotes(n.text);
}

void write_json(const Node& n, std::string& out, const std::string& indent) {
  const bool list = n.kind == Node::Kind::list;
  if (!list && n.kind != Node::Kind::map) { out += json_scalar(n); return; }
  if (n.items.empty() && n.entries.empty()) { out += list ? "[]" : "{}"; return; }
  if (list && is_line(n)) {
    for (std::size_t k = 0; k < n.items.size(); ++k) out += (k ? ", " : "[") + json_scalar(n.items[k]);
    out += "]";
    return;
  }
  const std::string inner = indent + "  ";
  const char* separator = list ? "[\n" : "{\n";
  for (const Node& i : n.items) {
    out += separator + inner;
    write_json(i, out, inner);
    separator = ",\n";
  }
  for (const Node::Entry& e : n.entries) {
    out += separator + inner + in_quotes(e.key) + ": ";
    write_json(e.value, out, inner);
    separator = ",\n";
  }
  out += "\n" + indent + (list ? "]" : "}");
}

}  // namespace

std::string to_yaml(const Node& n) {
  if (is_line(n)) return to_yaml_line(n) + "\n";
  std::string out;
  write_block(n, out, "");
  return out;
}

std::string to_yaml_line(const Node& n) {
  std::string out;
  switch (n.kind) {
    case Node::Kind::nothing: return "null";
    case Node::Kind::scalar: return n.quoted && !is_plain_word(n.text) ? in_quotes(n.text) : n.text;
    case Node::Kind::list:
      for (const Node& i : n.items) out += (out.empty() ? "" : ", ") + to_yaml_line(i);
      return "[" + out + "]";
    case Node::Kind::map:
      for (const Node::Entry& e : n.entries) out += (out.empty() ? "" : ", ") + e.key + ": " + to_yaml_line(e.value);
      return "{" + out + "}";
  }
  return out;
}

std::string to_json(const Node& n) {
  std::string out;
  write_json(n, out, "");
  return out + "\n";
}

}  // namespace skred
