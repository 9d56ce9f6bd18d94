#include "scenes/check/series.h"
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <fmt/format.h>

namespace skred {
namespace {

// The samples with from <= t <= to; times of samples are whole steps, so a hair more is allowed.
std::pair<std::span<const double>, std::span<const double>> window(const Series& s, double from, double to) {
  const double hair = 1e-9 * (s.time.back() - s.time.front());
  const auto begin = std::lower_bound(s.time.begin(), s.time.end(), from - hair), end = std::upper_bound(s.time.begin(), s.time.end(), to + hair);
  if (end - begin < 2)
    throw std::invalid_argument(fmt::format("fewer than two samples from {:g} s to {:g} s; there are some from {:g} s to {:g} s", from, to,
                                            s.time.front(), s.time.back()));
  const auto at = std::size_t(begin - s.time.begin()), count = std::size_t(end - begin);
  return {std::span(s.time).subspan(at, count), std::span(s.value).subspan(at, count)};
}

template <class Holds> double crossing(const Series& s, double level, Holds holds) {
  for (std::size_t k = 0; k < s.value.size(); ++k) {
    if (!holds(s.value[k])) continue;
    if (k == 0) return s.time[0];
    const double part = (level - s.value[k - 1]) / (s.value[k] - s.value[k - 1]);
    return s.time[k - 1] + part * (s.time[k] - s.time[k - 1]);
  }
  return -1;
}

}  // namespace

double first_of(const Series& s) { return s.value.front(); }
double last_of(const Series& s) { return s.value.back(); }
double least_of(const Series& s) { return least(s.value); }
double greatest_of(const Series& s) { return greatest(s.value); }
double at_time(const Series& s, double t) {
  if (t < s.time.front() || t > s.time.back() * (1 + 1e-9))
    throw std::invalid_argument(fmt::format("{:g} s is not between {:g} s and {:g} s", t, s.time.front(), s.time.back()));
  const auto next = std::upper_bound(s.time.begin(), s.time.end(), t);
  if (next == s.time.end()) return s.value.back();
  const auto k = std::size_t(next - s.time.begin());
  return s.value[k - 1] + (t - s.time[k - 1]) / (s.time[k] - s.time[k - 1]) * (s.value[k] - s.value[k - 1]);
}
double when_above(const Series& s, double level) { return crossing(s, level, [&](double v) { return v > level; }); }
double when_below(const Series& s, double level) { return crossing(s, level, [&](double v) { return v < level; }); }
double mean_over(const Series& s, double from, double to) { return mean_of(window(s, from, to).second); }
double deviation_over(const Series& s, double from, double to) { return deviation_of(window(s, from, to).second); }
double slope_over(const Series& s, double from, double to) {
  const auto [t, v] = window(s, from, to);
  return straight_line(t, v).slope;
}
double integral_over(const Series& s, double from, double to) {
  const auto [t, v] = window(s, from, to);
  double sum = 0;
  for (std::size_t k = 1; k < t.size(); ++k) sum += 0.5 * (v[k] + v[k - 1]) * (t[k] - t[k - 1]);
  return sum;
}
double swing_over(const Series& s, double from, double to) {
  const auto v = window(s, from, to).second;
  return greatest(v) - least(v);
}

double least(std::span<const double> v) { return *std::min_element(v.begin(), v.end()); }
double greatest(std::span<const double> v) { return *std::max_element(v.begin(), v.end()); }
double mean_of(std::span<const double> v) {
  double sum = 0;
  for (const double x : v) sum += x;
  return sum / double(v.size());
}
double deviation_of(std::span<const double> v) {
  if (v.size() < 2) return 0;
  const double mean = mean_of(v);
  double sum = 0;
  for (const double x : v) sum += (x - mean) * (x - mean);
  return std::sqrt(sum / double(v.size() - 1));
}
double count_of(std::span<const double> v) { return double(v.size()); }

double confidence_of(std::span<const double> v) {
  if (v.size() < 2) return 0;
  // Student's t, two-sided 95 %, by degrees of freedom; beyond the table 1.96 + 2.4 / n is within 0.3 %.
  constexpr double t[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145,
                          2.131,  2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042};
  const std::size_t freedom = v.size() - 1;
  const double factor = freedom <= std::size(t) ? t[freedom - 1] : 1.96 + 2.4 / double(freedom);
  return factor * deviation_of(v) / std::sqrt(double(v.size()));
}

Line straight_line(std::span<const double> x, std::span<const double> y) {
  if (x.size() != y.size() || x.size() < 2) throw std::invalid_argument("a line needs at least two points");
  const double mx = mean_of(x), my = mean_of(y);
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    xx += (x[k] - mx) * (x[k] - mx);
    xy += (x[k] - mx) * (y[k] - my);
    yy += (y[k] - my) * (y[k] - my);
  }
  if (!(xx > 0)) throw std::invalid_argument("a line needs points of different abscissae");
  const double slope = xy / xx;
  return {slope, my - slope * mx, yy > 0 ? xy * xy / (xx * yy) : 1};
}

}  // namespace skred
