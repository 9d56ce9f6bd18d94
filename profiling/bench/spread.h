// profiling/bench/spread.h - the middle of a few measurements and how far they lie apart.
#pragma once
#include <vector>

namespace skred {

struct Spread { double median = 0, least = 0, most = 0; };

// Of an even number of values, the median is the mean of the two in the middle. All zero if there are none.
Spread spread_of(std::vector<double> values);

}  // namespace skred
