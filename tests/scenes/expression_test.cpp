// tests/scenes/expression_test.cpp - arithmetic on parameters.
#include "scenes/expression.h"
#include <cmath>
#include <numbers>
#include <gtest/gtest.h>

using namespace skred;

TEST(Expression, Arithmetic) {
  const std::map<std::string, double> p = {{"a", 10}, {"width", 0.2}};
  EXPECT_EQ(evaluate("0.225 * a", p), 0.225 * 10);
  EXPECT_EQ(evaluate(" min(0.027 * a, width)", p), 0.2);
  EXPECT_EQ(evaluate("-(a - 2)^2 / 4", p), -16);
  EXPECT_EQ(evaluate("sqrt(2) * a / 10", p), std::sqrt(2) * 10 / 10);
  EXPECT_EQ(evaluate("floor(2.9) + ceil(2.1) + round(2.4) + max(1, a)", p), 2 + 3 + 2 + 10);
  EXPECT_EQ(evaluate("cos(pi) + sin(90 * deg)", p), std::cos(std::numbers::pi) + 1);
  EXPECT_EQ(evaluate("a > 4 ? 1 : 2", p), 1);
}

TEST(Expression, SaysWhatIsWrongAndWhere) {
  const std::map<std::string, double> p = {{"width", 0.2}};
  const auto error = [&](const char* text) -> ExpressionError {
    try {
      evaluate(text, p);
    } catch (const ExpressionError& e) {
      return e;
    }
    return {"none", -1};
  };
  EXPECT_STREQ(error("2 * widht").what(), "unknown name 'widht' in the expression; did you mean 'width'?");
  EXPECT_EQ(error("2 * widht").position, 4);
  EXPECT_EQ(error("2 * widht").unknown, "widht");
  EXPECT_STREQ(error("1 / 0").what(), "the expression gives inf");
  EXPECT_STREQ(error("1, 2").what(), "an expression has one result; this has several");
  EXPECT_NE(error("2 *").position, -1);
  EXPECT_NE(error("").position, -1);
  EXPECT_NE(error("(1").position, -1);
}

TEST(Expression, ParameterNames) {
  EXPECT_TRUE(is_parameter_name("pellet_radius"));
  EXPECT_FALSE(is_parameter_name("2a"));
  EXPECT_FALSE(is_parameter_name("a-b"));
  EXPECT_FALSE(is_parameter_name("sqrt"));
  EXPECT_FALSE(is_parameter_name("pi"));
  EXPECT_FALSE(is_parameter_name(""));
}
