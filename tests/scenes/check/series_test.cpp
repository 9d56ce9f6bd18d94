#include "scenes/check/series.h"
#include <cmath>
#include <stdexcept>
#include <gtest/gtest.h>

namespace skred {
namespace {

Series parabola() {                                   // t^2 at 0, 0.1, ..., 1
  Series s;
  for (int k = 0; k <= 10; ++k) s.time.push_back(0.1 * k), s.value.push_back(0.01 * k * k);
  return s;
}

TEST(CheckSeries, PointsAndExtremes) {
  const Series s = parabola();
  EXPECT_EQ(first_of(s), 0);
  EXPECT_EQ(last_of(s), 1);
  EXPECT_EQ(least_of(s), 0);
  EXPECT_EQ(greatest_of(s), 1);
  EXPECT_NEAR(at_time(s, 0.25), 0.5 * (0.04 + 0.09), 1e-12);
  EXPECT_NEAR(at_time(s, 1), 1, 1e-12);
  EXPECT_THROW(at_time(s, 1.1), std::invalid_argument);
}

TEST(CheckSeries, Crossings) {
  const Series s = parabola();
  EXPECT_NEAR(when_above(s, 0.20), 0.4 + 0.1 * (0.20 - 0.16) / (0.25 - 0.16), 1e-12);
  EXPECT_EQ(when_above(s, 2), -1);
  EXPECT_EQ(when_below(s, 0.5), 0);
  EXPECT_EQ(when_below(s, -1), -1);
}

TEST(CheckSeries, Windows) {
  const Series s = parabola();
  EXPECT_NEAR(mean_over(s, 0.1, 0.3), (0.01 + 0.04 + 0.09) / 3, 1e-12);
  EXPECT_NEAR(swing_over(s, 0.1, 0.3), 0.08, 1e-12);
  EXPECT_NEAR(slope_over(s, 0.1, 0.3), 0.4, 1e-12);   // of a parabola over a symmetric window: the derivative in its middle
  EXPECT_NEAR(integral_over(s, 0, 1), 1.0 / 3 + 0.01 / 6, 1e-12);   // trapezoids: h^2/12 (f'(1) - f'(0)) too much
  EXPECT_THROW(mean_over(s, 0.11, 0.19), std::invalid_argument);
}

TEST(CheckSeries, StatisticsOfSeveralRuns) {
  const std::vector<double> v{1, 2, 4, 5};
  EXPECT_EQ(mean_of(v), 3);
  EXPECT_NEAR(deviation_of(v), std::sqrt(10.0 / 3), 1e-12);
  EXPECT_NEAR(confidence_of(v), 3.182 * std::sqrt(10.0 / 3) / 2, 1e-12);   // Student's t, 3 degrees of freedom
  EXPECT_EQ(confidence_of(std::vector<double>{7}), 0);
  EXPECT_NEAR(confidence_of(std::vector<double>(100, 2.0)), 0, 1e-12);
}

TEST(CheckSeries, StraightLine) {
  const std::vector<double> x{0, 1, 2, 3}, y{1, 3, 5, 7.4};
  const Line line = straight_line(x, y);
  EXPECT_NEAR(line.slope, 2.12, 1e-12);
  EXPECT_NEAR(line.offset, 0.92, 1e-12);
  EXPECT_NEAR(line.determination, 10.6 * 10.6 / (5 * 22.52), 1e-12);   // (sum dx dy)^2 / (sum dx^2 sum dy^2)
  EXPECT_THROW(straight_line(std::vector<double>{1, 1}, std::vector<double>{1, 2}), std::invalid_argument);
}

}  // namespace
}  // namespace skred
