// profiling/readable.h - durations and counts as people read them.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <fmt/format.h>

namespace skred {

// Three digits and a unit from ns to s: "12.3 ms". `micro` is the sign of a millionth: "u" on a terminal.
inline std::string readable_time(double seconds, std::string_view micro = "u") {
  static constexpr std::array<std::string_view, 4> prefix{"", "m", "", "n"};
  double value = seconds;
  std::size_t unit = 0;
  // 999.5 would be written 1000.
  while (value > 0 && value < 0.9995 && unit + 1 < prefix.size()) value *= 1e3, ++unit;
  const int decimals = value >= 99.95 || value == 0 ? 0 : value >= 9.995 ? 1 : 2;
  return fmt::format("{:.{}f} {}s", value, decimals, unit == 2 ? micro : prefix[unit]);
}

// "312", "45.1 k", "1.23 M", "4.56 G"
inline std::string readable_count(double count) {
  static constexpr std::array<std::string_view, 4> suffix{"", " k", " M", " G"};
  std::size_t unit = 0;
  while (count >= 999.5 && unit + 1 < suffix.size()) count /= 1e3, ++unit;
  const int decimals = unit == 0 || count >= 99.95 ? 0 : count >= 9.995 ? 1 : 2;
  return fmt::format("{:.{}f}{}", count, decimals, suffix[unit]);
}

// "95 052", with no-break spaces between groups of three digits
inline std::string grouped_digits(std::int64_t count) {
  std::string digits = std::to_string(count < 0 ? -count : count);
  for (std::size_t i = digits.size(); i > 3;) digits.insert(i -= 3, "\u00a0");
  return (count < 0 ? "-" : "") + digits;
}

// A share in per cent: "12.3 %", "0.04 %", "< 0.01 %".
inline std::string readable_share(double share) {
  const double percent = 100 * share;
  if (percent == 0) return "0 %";
  if (percent < 0.01) return "< 0.01 %";
  return fmt::format("{:.{}f} %", percent, percent < 0.0995 ? 2 : 1);
}

}  // namespace skred
