// scenes/check/plot.h - a small diagram with lines and points, in SVG.
#pragma once
#include <string>
#include <vector>

namespace skred {

struct Curve {
  std::string name, colour;                          // "#rrggbb"; an empty name stays out of the legend
  std::vector<double> x, y;
  bool line = true, points = false, dashed = false, rings = false;   // rings leave room for points within
};

struct Plot {
  std::string title, x_label;
  std::vector<Curve> curves;
};

// 480 x 260 px; empty if there is nothing finite to draw.
std::string svg_of(const Plot&);

}  // namespace skred
