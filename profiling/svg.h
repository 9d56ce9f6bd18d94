// profiling/svg.h - text and simple figures in SVG.
#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <fmt/format.h>

namespace skred {

inline std::size_t letters(std::string_view text) {         // UTF-8: every byte but the continuing ones
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](unsigned char c) { return (c & 0xc0) != 0x80; }));
}
// The font is the reader's: 0.62 of its size per letter is wide enough for those we name, and for text, not for "WWW".
inline double text_width(std::string_view text, double size) { return 0.62 * size * double(letters(text)); }

inline std::string shortened(std::string text, double size, double room) {
  if (text_width(text, size) <= room) return text;
  while (!text.empty() && text_width(text, size) > room - size) {
    while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xc0) == 0x80) text.pop_back();
    if (!text.empty()) text.pop_back();
  }
  return text + "\u2026";
}

inline std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') out += "&amp;";
    else if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else if (c == '"') out += "&quot;";
    else if (static_cast<unsigned char>(c) < 0x20) out += ' ';       // not allowed in XML
    else out += c;
  }
  return out;
}

struct Svg {
  std::string body;

  void text(double x, double y, double size, std::string_view anchor, std::string_view colour, std::string_view what,
            bool bold = false) {
    body += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{}\" text-anchor=\"{}\" fill=\"{}\"{}>{}</text>\n", x, y,
                        size, anchor, colour, bold ? " font-weight=\"600\"" : "", escaped(what));
  }
  void rect(double x, double y, double w, double h, std::string_view fill, std::string_view more = "") {
    body += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\"{}/>\n", x, y, w, h, fill,
                        more);
  }
  void line(double x0, double y0, double x1, double y1, std::string_view colour) {
    body += fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"{}\" fill=\"none\"/>\n", x0, y0, x1, y1, colour);
  }
};

inline std::string mixed_with_white(std::string_view hex, double part) {
  std::string out = "#";
  for (std::size_t i = 1; i < 7; i += 2) {
    const double v = std::stoi(std::string(hex.substr(i, 2)), nullptr, 16);
    out += fmt::format("{:02x}", static_cast<int>(std::lround(255 + part * (v - 255))));
  }
  return out;
}

}  // namespace skred
