// tests/scenes/units_test.cpp - numbers with units.
#include "scenes/units.h"
#include <cmath>
#include <numbers>
#include <gtest/gtest.h>

using namespace skred;

namespace {
std::string reason(const std::string& text) {
  try {
    parse_quantity(text);
    return "";
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
}
}  // namespace

TEST(Units, ConvertToSi) {
  const double pi = std::numbers::pi;
  struct Case { const char* text; double value; const char* unit; };
  const Case cases[] = {
      {"6.36665 mm", 0.00636665, "m"}, {"6.1684 MPa", 6168400, "Pa"}, {"50 us", 50e-6, "s"}, {"50 µs", 50e-6, "s"},
      {"3700 kg/m^3", 3700, "kg/m^3"}, {"3.7 g/cm^3", 3700, "kg/m^3"}, {"9.81 m/s^2", 9.81, "m/s^2"},
      {"9.81 m s^-2", 9.81, "m/s^2"},
      {"1 g", 1e-3, "kg"}, {"1 g_n", 9.80665, "m/s^2"}, {"2 t", 2000, "kg"}, {"1 bar", 1e5, "Pa"}, {"1 GPa", 1e9, "N/m^2"},
      {"30 rpm", pi, "rad/s"}, {"180 deg", pi, "rad"}, {"2 rev/min", 4 * pi / 60, "rad/s"}, {"1 h", 3600, "s"},
      {"5 %", 0.05, "1"}, {"1e-3", 1e-3, "1"}, {"+2 m", 2, "m"}, {"-.5 cm", -5e-3, "m"}, {"3m", 3, "m"}, {"1.5e+2 mm", 0.15, "m"},
      {"2 N m", 2, "J"}, {"4 kN*mm", 4, "N m"}, {"7 kg m^2", 7, "kg m^2"}, {"1 m³", 1, "m^3"}, {"1 1/s", 1, "Hz"},
      {"10 mHz", 0.01, "1/s"},
  };
  for (const Case& c : cases) {
    const Quantity q = parse_quantity(c.text);
    EXPECT_NEAR(q.value, c.value, 4e-16 * std::abs(c.value)) << c.text;
    EXPECT_EQ(q.dimension, parse_dimension(c.unit)) << c.text;
  }
}

TEST(Units, PowersOfTenGiveTheBitsOfTheSiNumber) {
  EXPECT_EQ(parse_quantity("6.36665 mm").value, 0.00636665);
  EXPECT_EQ(parse_quantity("6.1684 MPa").value, 6.1684e6);
  EXPECT_EQ(parse_quantity("0.3 us").value, 0.3e-6);
  EXPECT_EQ(parse_quantity("10 %").value, 0.1);
  EXPECT_EQ(parse_quantity("3.7 g/cm^3").value, 3700);
}

TEST(Units, AFrequencyIsNotAnAngularVelocity) { EXPECT_NE(parse_dimension("1/s"), parse_dimension("rad/s")); }

TEST(Units, SayWhatIsWrong) {
  EXPECT_EQ(reason("5 mmm"), "unknown unit 'mmm'; did you mean 'mm'?");
  EXPECT_EQ(reason("5 Mpa"), "unknown unit 'Mpa'; did you mean 'MPa'?");
  EXPECT_EQ(reason("wide"), "'wide' is not a number");
  EXPECT_EQ(reason("nan"), "'nan' is not a number");
  EXPECT_EQ(reason("-inf"), "'-inf' is not a number");
  EXPECT_EQ(reason(""), "'' is not a number");
  EXPECT_EQ(reason("."), "'.' is not a number");
  EXPECT_EQ(reason("1e999"), "'1e999' is not a number that a double can hold");
  EXPECT_EQ(reason("1e306 GPa"), "'1e306 GPa' is not a number that a double can hold");
  EXPECT_NE(reason("1 m/"), "");
  EXPECT_NE(reason("1 m^99"), "");
  EXPECT_NE(reason("1 (m)"), "");
}

TEST(Units, DimensionsHaveNames) {
  EXPECT_EQ(dimension_name(parse_dimension("mm")), "a length [m]");
  EXPECT_EQ(dimension_name(parse_dimension("1")), "a plain number");
  EXPECT_EQ(dimension_name(parse_dimension("kg/m")), "a quantity in m^-1 kg");
}
