// scenes/check/series.h - numbers from a time series, and from the values of several runs.
#pragma once
#include <span>
#include "scenes/check/formula.h"

namespace skred {

double first_of(const Series&);
double last_of(const Series&);
double least_of(const Series&);
double greatest_of(const Series&);
double at_time(const Series&, double t);                       // linear between samples
double when_above(const Series&, double level);                // [s]; -1: never
double when_below(const Series&, double level);
// Over the samples with from <= t <= to; throw std::invalid_argument if there are fewer than two.
double mean_over(const Series&, double from, double to);
double deviation_over(const Series&, double from, double to);  // standard deviation
double slope_over(const Series&, double from, double to);      // least squares [1/s]
double integral_over(const Series&, double from, double to);   // trapezoids [s]
double swing_over(const Series&, double from, double to);      // greatest less least

double least(std::span<const double>);
double greatest(std::span<const double>);
double mean_of(std::span<const double>);
double deviation_of(std::span<const double>);                  // of the sample: n - 1
double count_of(std::span<const double>);
// Half of the 95 % confidence interval of the mean: Student's t times the standard error; 0 for one value.
double confidence_of(std::span<const double>);

struct Line { double slope = 0, offset = 0, determination = 0; };   // R^2
Line straight_line(std::span<const double> x, std::span<const double> y);   // least squares

}  // namespace skred
