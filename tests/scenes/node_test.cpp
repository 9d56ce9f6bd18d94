// tests/scenes/node_test.cpp - YAML with places, and back to text.
#include "scenes/node.h"
#include <cmath>
#include <limits>
#include <gtest/gtest.h>

using namespace skred;

namespace {

Node parse(const std::string& text) {
  Diagnostics d;
  const int source = d.add_file("n.yaml", text);
  Node n = parse_yaml(text, source, d);
  d.throw_if_any();
  return n;
}

std::string error(const std::string& text) {
  try {
    parse(text);
    return "";
  } catch (const SceneError& e) {
    return e.what();
  }
}

}  // namespace

TEST(Node, RemembersPlacesAndQuotes) {
  const Node n = parse("a: 1\nb:\n  - \"2\"\n  - {c: ~}\n");
  EXPECT_EQ(n.find("a")->value.text, "1");
  EXPECT_FALSE(n.find("a")->value.quoted);
  const Node& list = n.find("b")->value;
  EXPECT_TRUE(list.items[0].quoted);
  EXPECT_EQ(list.items[0].at.line, 2);
  EXPECT_EQ(list.items[0].at.column, 4);
  EXPECT_EQ(list.items[1].find("c")->value.kind, Node::Kind::nothing);
  EXPECT_EQ(n.find("d"), nullptr);
}

TEST(Node, KeyGivenTwice) {
  EXPECT_EQ(error("a: 1\nb: 2\na: 3\n"), "n.yaml:3:1: error: key 'a' is given twice, first in line 1\n  a: 3\n  ^");
  EXPECT_NE(error("x: {a: 1, a: 1}"), "");
}

TEST(Node, SyntaxErrorsHaveTheirPlace) {
  EXPECT_EQ(error("a: [1, 2\nb: 3\n").substr(0, 9), "n.yaml:2:");
  EXPECT_EQ(error("a: 1\n\tb: 2\n").substr(0, 9), "n.yaml:2:");
  EXPECT_NE(error("a: 1\n---\nb: 2\n").find("a second YAML document"), std::string::npos);
  EXPECT_NE(error("{[1]: 2}").find("a key must be a word"), std::string::npos);
  EXPECT_NE(error("a: &x [*x]").find("stands inside"), std::string::npos);
}

TEST(Node, AliasesAreCopiedButNotWithoutBound) {
  EXPECT_EQ(parse("a: &x [1, 2]\nb: *x\n").find("b")->value.items[1].text, "2");
  std::string bomb = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int k = 1; k < 12; ++k) {
    const std::string x = "*a" + std::to_string(k - 1);
    bomb += "a" + std::to_string(k) + ": &a" + std::to_string(k) + " [" + x;
    for (int j = 1; j < 10; ++j) bomb += ", " + x;
    bomb += "]\n";
  }
  EXPECT_NE(error(bomb).find("more than a million"), std::string::npos);
}

TEST(Node, LongLinesAreCutAroundTheCaret) {
  const std::string text = error("{" + std::string(500, ' ') + "a: 1, a: 2" + std::string(500, ' ') + "}");
  EXPECT_LT(text.size(), 350u);
  const std::size_t caret = text.rfind('^') - text.rfind('\n') - 1, line = text.find('\n') + 1;
  EXPECT_EQ(text.substr(line + caret, 4), "a: 2");
}

TEST(Node, WritesYamlThatReadsBack) {
  const Node n = map_node({{"name", text_node("drum-1")}, {"text", text_node("two\nlines, \"quoted\" and 3 %")},
                           {"odd", text_node("yes")},
                           {"v", list_node({number_node(1), number_node(-0.5)})}, {"none", list_node({})},
                           {"list", list_node({map_node({{"a", number_node(1)}, {"b", map_node({{"c", plain("true")}})}})})}});
  const std::string text = to_yaml(n);
  EXPECT_EQ(to_yaml(parse(text)), text);
  EXPECT_EQ(parse(text).find("text")->value.text, "two\nlines, \"quoted\" and 3 %");
  EXPECT_TRUE(parse(text).find("odd")->value.quoted);
}

TEST(Node, NumbersKeepTheirBits) {
  for (const double x : {0.1, 1.0 / 3, 5e-5, 6168400.0, -0.0, 1e300, 4.9e-324, std::numeric_limits<double>::max()}) {
    EXPECT_EQ(std::strtod(number_text(x).c_str(), nullptr), x);
    EXPECT_EQ(std::signbit(std::strtod(number_text(x).c_str(), nullptr)), std::signbit(x));
  }
  EXPECT_EQ(number_text(5e-5), "5.0e-05");      // with a point: PyYAML takes 5e-05 for a word
  EXPECT_EQ(number_text(std::numeric_limits<double>::infinity()), ".inf");
}

TEST(Node, WritesJson) {
  EXPECT_EQ(to_json(parse("{a: 1, b: [true, x, '1'], c: {}, d: .5, e: +2, f: nan, g: ~, h: .inf, i: 007, j: ''}")),
            "{\n  \"a\": 1,\n  \"b\": [true, \"x\", \"1\"],\n  \"c\": {},\n  \"d\": 0.5,\n  \"e\": 2,\n  \"f\": \"nan\",\n"
            "  \"g\": null,\n  \"h\": \".inf\",\n  \"i\": 7,\n  \"j\": \"\"\n}\n");
}
