// scenes/units.h - numbers with units, checked by dimension. Everything becomes SI.
#pragma once
#include <array>
#include <stdexcept>
#include <string>
#include <string_view>

namespace skred {

// Powers of metre, kilogram, second and radian. The plane angle counts as a dimension of its own, so that a frequency
// (1/s) is not taken for an angular velocity (rad/s): they differ by 2 pi.
struct Dimension {
  std::array<int, 4> power{};
  friend bool operator==(const Dimension&, const Dimension&) = default;
};

struct Quantity { double value; Dimension dimension; bool has_unit; };   // value in SI units

// "6.36665 mm", "3700 kg/m^3", "30 rpm", "1e-3", "9.81 m s^-2". A factor of ten is applied to the decimal text, so that
// "6.36665 mm" and 0.00636665 give the same bits. Throws std::invalid_argument with the reason: not a number, not
// representable, unknown unit (with the nearest known one).
Quantity parse_quantity(std::string_view text);

// The dimension of an SI unit: "m/s^2", "1". Throws std::invalid_argument.
Dimension parse_dimension(std::string_view unit);

// "a length [m]", "a plain number", "a quantity in kg m^2 s^-1".
std::string dimension_name(const Dimension&);

}  // namespace skred
