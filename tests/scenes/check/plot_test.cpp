// The diagrams of the page of `skred check`.
#include "scenes/check/plot.h"
#include <gtest/gtest.h>
#include <set>
#include "profiling/svg.h"

namespace skred {
namespace {

// The words of every text in the middle of which x lies, with that x [px].
std::vector<std::pair<double, std::string>> centred_texts(const std::string& svg) {
  std::vector<std::pair<double, std::string>> out;
  for (std::size_t at = svg.find("<text"); at != std::string::npos; at = svg.find("<text", at + 1)) {
    const std::string text = svg.substr(at, svg.find("</text>", at) - at);
    if (text.find("\"middle\"") == std::string::npos) continue;
    out.emplace_back(std::stod(text.substr(text.find("x=\"") + 3)), text.substr(text.find('>') + 1));
  }
  return out;
}

TEST(Plot, LabelsUnderTheAxisStayInside) {
  for (const double end : {0.0008, 0.8, 8e5, -2e-5}) {
    const std::string svg = svg_of({"title", "x [m]", {{"line", "#000000", {0, end}, {0, 1}}}});
    const auto texts = centred_texts(svg);
    ASSERT_GE(texts.size(), 4u);
    for (const auto& [x, words] : texts) {
      EXPECT_LE(x + text_width(words, 10) / 2, 480.05) << words;
      EXPECT_GE(x - text_width(words, 10) / 2, 0) << words;
    }
  }
}

TEST(Plot, LabelsTellTicksApart) {
  for (const double span : {1.0, 1e-3, 1e-5, 3e-7, 1e-9, 0.0}) {
    const auto texts = centred_texts(svg_of({"title", "", {{"line", "#000000", {1 - span, 1}, {0, 1}}}}));
    std::set<std::string> words;
    for (const auto& text : texts) words.insert(text.second);
    EXPECT_EQ(words.size(), texts.size()) << span;
    EXPECT_GE(words.size(), 4u) << span;
  }
}

TEST(Plot, RingsAndPoints) {
  const auto circles = [](const Curve& c) {
    const std::string svg = svg_of({"title", "x", {c}});
    std::size_t count = 0;
    for (std::size_t at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1)) ++count;
    return count;
  };
  EXPECT_EQ(circles({"line", "#000000", {0, 1, 2}, {0, 1, 0}}), 0u);
  EXPECT_EQ(circles({"points", "#000000", {0, 1, 2}, {0, 1, 0}, false, true}), 3u);
  EXPECT_EQ(circles({"rings", "#000000", {0, 1, NAN}, {0, 1, 0}, false, false, false, true}), 2u);
}

TEST(Plot, NothingFiniteIsNoPicture) {
  EXPECT_EQ(svg_of({"title", "x", {}}), "");
  EXPECT_EQ(svg_of({"title", "x", {{"line", "#000000", {0, 1}, {NAN, NAN}}}}), "");
}

}  // namespace
}  // namespace skred
