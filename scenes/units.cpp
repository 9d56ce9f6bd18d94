// scenes/units.cpp - the table of units and the parser of products and powers of them.
//
// Values: BIPM, The International System of Units, 9th edition 2019, tables 2, 4, 7 and 8; g_n is the standard acceleration
// of free fall (CGPM 1901).
#include "scenes/units.h"
#include <cctype>
#include <charconv>
#include <numbers>
#include <vector>
#include "scenes/diagnostic.h"

namespace skred {
namespace {

// factor * 10^ten times the SI unit of the dimension
struct Unit { double factor = 1; int ten = 0; Dimension dimension; };
struct NamedUnit { const char* name; Unit unit; bool prefixes; };
struct Prefix { const char* name; int ten; };

constexpr double pi = std::numbers::pi;

const NamedUnit named_units[] = {
    //  name    factor  10^     m  kg  s rad   SI prefixes
    {"m",     {1,        0,  {{ 1, 0, 0, 0}}}, true},
    {"g",     {1,       -3,  {{ 0, 1, 0, 0}}}, true},
    {"s",     {1,        0,  {{ 0, 0, 1, 0}}}, true},
    {"rad",   {1,        0,  {{ 0, 0, 0, 1}}}, true},
    {"N",     {1,        0,  {{ 1, 1,-2, 0}}}, true},
    {"Pa",    {1,        0,  {{-1, 1,-2, 0}}}, true},
    {"J",     {1,        0,  {{ 2, 1,-2, 0}}}, true},
    {"W",     {1,        0,  {{ 2, 1,-3, 0}}}, true},
    {"Hz",    {1,        0,  {{ 0, 0,-1, 0}}}, true},
    {"t",     {1,        3,  {{ 0, 1, 0, 0}}}, false},
    {"bar",   {1,        5,  {{-1, 1,-2, 0}}}, false},
    {"min",   {60,       0,  {{ 0, 0, 1, 0}}}, false},
    {"h",     {3600,     0,  {{ 0, 0, 1, 0}}}, false},
    {"deg",   {pi / 180, 0,  {{ 0, 0, 0, 1}}}, false},
    {"rev",   {2 * pi,   0,  {{ 0, 0, 0, 1}}}, false},
    {"rpm",   {pi / 30,  0,  {{ 0, 0,-1, 1}}}, false},
    {"g_n",   {9.80665,  0,  {{ 1, 0,-2, 0}}}, false},
    {"%",     {1,       -2,  {{ 0, 0, 0, 0}}}, false},
    {"1",     {1,        0,  {{ 0, 0, 0, 0}}}, false},
};

const Prefix prefixes[] = {{"n", -9}, {"u", -6}, {"\u00b5", -6}, {"\u03bc", -6}, {"m", -3},
                           {"c", -2}, {"d", -1}, {"k", 3},       {"M", 6},       {"G", 9}, {"T", 12}};

struct NamedDimension { const char* name; const char* unit; };
const NamedDimension named_dimensions[] = {
    {"a length", "m"}, {"a mass", "kg"}, {"a time", "s"}, {"an angle", "rad"}, {"an area", "m^2"}, {"a volume", "m^3"},
    {"a velocity", "m/s"}, {"an acceleration", "m/s^2"}, {"an angular velocity", "rad/s"}, {"a frequency", "1/s"},
    {"a density", "kg/m^3"}, {"a pressure", "Pa"}, {"a force", "N"}, {"a torque or energy", "N m"},
    {"a moment of inertia", "kg m^2"}, {"a stiffness", "N/m"}, {"a power", "W"},
};

Unit find_unit(std::string_view name) {
  for (const NamedUnit& u : named_units)
    if (name == u.name) return u.unit;
  for (const Prefix& p : prefixes)
    for (const NamedUnit& u : named_units)
      if (u.prefixes && name.starts_with(p.name) && name.substr(std::string_view(p.name).size()) == u.name)
        return {u.unit.factor, u.unit.ten + p.ten, u.unit.dimension};
  std::vector<std::string> known = {"mm", "cm", "km", "kg", "us", "ms", "kN", "mN", "kPa", "MPa", "GPa"};
  for (const NamedUnit& u : named_units) known.push_back(u.name);
  throw std::invalid_argument("unknown unit '" + std::string(name) + "'" + suggestion(name, known));
}

void multiply(Unit& product, const Unit& u, int power) {
  for (int k = 0; k < std::abs(power); ++k) {
    if (power > 0) product.factor *= u.factor;
    else product.factor /= u.factor;
  }
  product.ten += power * u.ten;
  for (std::size_t d = 0; d < 4; ++d) product.dimension.power[d] += power * u.dimension.power[d];
}

// Units joined by spaces, '*' or '/' (which inverts the next one only), each with an optional power: m^3, m3, s^-1.
Unit parse_unit(std::string_view text) {
  Unit product;
  int sign = 1;
  const auto is_name = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_' || c == '%' || (c & 0x80); };
  for (std::size_t k = 0; k < text.size();) {
    if (text[k] == ' ' || text[k] == '*') { ++k; continue; }
    if (text[k] == '/') { sign = -1; ++k; continue; }
    const std::size_t first = k;
    if (text[k] == '1') ++k;
    else while (k < text.size() && is_name(text[k])) ++k;
    std::string_view name = text.substr(first, k - first);
    if (name.empty()) throw std::invalid_argument("'" + std::string(text) + "' is not a unit");
    int power = 1;
    for (const auto& [superscript, value] : {std::pair{"\u00b2", 2}, std::pair{"\u00b3", 3}})
      if (name.ends_with(superscript)) { name.remove_suffix(2); power = value; }
    if (k < text.size() && text[k] == '^') ++k;
    if (k < text.size() && (text[k] == '-' || std::isdigit(static_cast<unsigned char>(text[k])))) {
      const auto read = std::from_chars(text.data() + k, text.data() + text.size(), power);
      if (read.ec != std::errc() || std::abs(power) > 9)
        throw std::invalid_argument("'" + std::string(text) + "': a power is an integer from -9 to 9");
      k = std::size_t(read.ptr - text.data());
    }
    multiply(product, find_unit(name), sign * power);
    sign = 1;
  }
  if (sign < 0) throw std::invalid_argument("'" + std::string(text) + "': no unit after '/'");
  return product;
}

}  // namespace

Quantity parse_quantity(std::string_view text) {
  const auto fail = [&](const char* why) { return std::invalid_argument("'" + std::string(text) + "' is not a number" + why); };
  std::string_view rest = text;
  if (rest.starts_with('+')) rest.remove_prefix(1);
  // from_chars would take the words inf and nan.
  const std::size_t digit = rest.starts_with('-') ? 1 : 0;
  if (digit >= rest.size() || !(std::isdigit(static_cast<unsigned char>(rest[digit])) || rest[digit] == '.')) throw fail("");
  double value = 0;
  const auto read = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (read.ec == std::errc::invalid_argument) throw fail("");
  if (read.ec == std::errc::result_out_of_range) throw fail(" that a double can hold");
  const std::string_view number = rest.substr(0, std::size_t(read.ptr - rest.data()));
  rest.remove_prefix(number.size());
  const Unit unit = parse_unit(rest);
  const bool has_unit = rest.find_first_not_of(' ') != std::string_view::npos;
  if (unit.ten) {
    const std::size_t e = number.find_first_of("eE");
    int exponent = 0;
    if (e != std::string_view::npos)
      std::from_chars(number.data() + e + (number[e + 1] == '+' ? 2 : 1), number.data() + number.size(), exponent);
    const std::string shifted = std::string(number.substr(0, e)) + "e" + std::to_string(exponent + unit.ten);
    const auto again = std::from_chars(shifted.data(), shifted.data() + shifted.size(), value);
    if (again.ec != std::errc()) throw fail(" that a double can hold");
  }
  return {unit.factor == 1 ? value : value * unit.factor, unit.dimension, has_unit};
}

Dimension parse_dimension(std::string_view unit) { return parse_unit(unit).dimension; }

std::string dimension_name(const Dimension& d) {
  if (d == Dimension{}) return "a plain number";
  for (const NamedDimension& n : named_dimensions)
    if (parse_dimension(n.unit) == d) return std::string(n.name) + " [" + n.unit + "]";
  std::string out;
  for (std::size_t k = 0; k < 4; ++k)
    if (d.power[k]) {
      static const char* base[] = {"m", "kg", "s", "rad"};
      out += " " + std::string(base[k]) + (d.power[k] == 1 ? "" : "^" + std::to_string(d.power[k]));
    }
  return "a quantity in" + out;
}

}  // namespace skred
