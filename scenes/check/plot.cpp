#include "scenes/check/plot.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include "profiling/svg.h"

namespace skred {
namespace {

constexpr double width = 480, height = 260, left = 62, right = 12, top = 44, bottom = 40;   // [px]
constexpr const char *ink = "#1f2328", *soft = "#5b636d", *grid = "#e9eaec";
constexpr std::size_t most_points = 600;               // of a line: more cannot be seen

struct Range { double low = INFINITY, high = -INFINITY; };

void widen(Range& r, double v) {
  if (!std::isfinite(v)) return;
  r.low = std::min(r.low, v);
  r.high = std::max(r.high, v);
}

// 1, 2 or 5 times a power of ten: about five ticks.
double tick_of(double span) {
  const double raw = span / 5, power = std::pow(10, std::floor(std::log10(raw))), digit = raw / power;
  return power * (digit < 1.5 ? 1 : digit < 3.5 ? 2 : digit < 7.5 ? 5 : 10);
}

void give_room(Range& r) {
  if (r.high - r.low <= 1e-7 * std::max(std::abs(r.low), std::abs(r.high))) {   // of less, labels would not tell
    const double half = r.low == 0 ? 1 : 0.1 * std::abs(r.low);
    r.low -= half, r.high += half;
  }
}

}  // namespace

std::string svg_of(const Plot& plot) {
  Range x, y;
  for (const Curve& c : plot.curves) {
    for (const double v : c.x) widen(x, v);
    for (const double v : c.y) widen(y, v);
  }
  if (!(x.low <= x.high) || !(y.low <= y.high)) return "";
  give_room(x);
  give_room(y);
  const double margin = 0.06 * (y.high - y.low);
  y.low -= margin, y.high += margin;
  const auto px = [&](double v) { return left + (v - x.low) / (x.high - x.low) * (width - left - right); };
  const auto py = [&](double v) { return height - bottom - (v - y.low) / (y.high - y.low) * (height - top - bottom); };

  Svg svg;
  svg.text(left, 16, 12, "start", ink, shortened(plot.title, 12, width - left), true);
  const double dx = tick_of(x.high - x.low), dy = tick_of(y.high - y.low);
  const auto label = [](double v, double tick) {         // as many digits as tell one tick from the next
    return std::abs(v) < 1e-9 * tick ? "0" : fmt::format("{:.{}g}", v, std::max(6, 1 + int(std::ceil(std::log10(std::abs(v) / tick)))));
  };
  for (double v = std::ceil(x.low / dx) * dx; v <= x.high + 1e-9 * dx; v += dx) {
    const std::string words = label(v, dx);
    svg.line(px(v), top, px(v), height - bottom, grid);
    svg.text(std::min(px(v), width - text_width(words, 10) / 2), height - bottom + 15, 10, "middle", soft, words);   // the last one stays inside
  }
  for (double v = std::ceil(y.low / dy) * dy; v <= y.high + 1e-9 * dy; v += dy) {
    svg.line(left, py(v), width - right, py(v), grid);
    svg.text(left - 6, py(v) + 3.5, 10, "end", soft, label(v, dy));
  }
  svg.text((left + width - right) / 2, height - 8, 11, "middle", soft, plot.x_label);

  double at = left;
  for (const Curve& c : plot.curves) {
    if (c.line) {
      std::string path;
      const std::size_t every = std::max<std::size_t>(1, c.x.size() / most_points);
      for (std::size_t k = 0; k < c.x.size(); k += every)
        if (std::isfinite(c.x[k]) && std::isfinite(c.y[k])) path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", px(c.x[k]), py(c.y[k]));
      svg.body += fmt::format("<path d=\"{}\" stroke=\"{}\" stroke-width=\"1.4\" fill=\"none\"{}/>\n", path, c.colour,
                              c.dashed ? " stroke-dasharray=\"5 3\"" : "");
    }
    for (std::size_t k = 0; k < c.x.size(); ++k) {
      if (!std::isfinite(c.x[k]) || !std::isfinite(c.y[k])) continue;
      const std::string at_point = fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\"", px(c.x[k]), py(c.y[k]));
      if (c.points) svg.body += fmt::format("{} r=\"3\" fill=\"{}\" fill-opacity=\"0.8\"/>\n", at_point, c.colour);
      if (c.rings) svg.body += fmt::format("{} r=\"5\" stroke=\"{}\" fill=\"none\"/>\n", at_point, c.colour);
    }
    if (c.name.empty()) continue;
    svg.rect(at, 26, 14, 3, c.colour);
    svg.text(at + 18, 31, 10.5, "start", soft, c.name);
    at += 30 + text_width(c.name, 10.5);
  }
  return fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" font-family=\"sans-serif\">\n{2}</svg>\n",
                     width, height, svg.body);
}

}  // namespace skred
