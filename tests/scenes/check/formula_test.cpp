#include "scenes/check/formula.h"
#include <stdexcept>
#include <gmock/gmock.h>

namespace skred {
namespace {

std::string error_of(const std::string& text, Scope& scope) {
  try {
    Formula(text, scope, "expect.0.value")();
    return "";
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
}

TEST(CheckFormula, NumbersChangeUnderIt) {
  Scope scope;
  scope.numbers = {{"a", 2}, {"floor.force_z", -3}};
  const Formula f("a * floor.force_z + 2.5", scope, "f");
  EXPECT_EQ(f(), -3.5);
  scope.numbers["a"] = 4;
  EXPECT_EQ(f(), -9.5);
  EXPECT_EQ(Formula("a > 3 ? 1 : 0", scope, "f")(), 1);
}

TEST(CheckFormula, SeriesAndRunsByName) {
  Scope scope;
  scope.series["h"] = {{0, 1, 2}, {5, 7, 9}};
  EXPECT_EQ(Formula("slope(\"h\", 0, 2) + last(\"h\")", scope, "f")(), 11);
  EXPECT_EQ(Formula("mean(\"h\", 0, 1)", scope, "f")(), 6);
  Scope over;
  over.runs = {{"v", {1, 3, 5}}, {"w", {0, 1, 2}}};
  EXPECT_EQ(Formula("slope(\"v against w\") + mean(\"v\") + of(\"v\", 2)", over, "f")(), 10);
  Scope both;
  both.methods["v"] = {2, 3};
  EXPECT_EQ(Formula("ndem(\"v\") - sdem(\"v\")", both, "f")(), 1);
}

TEST(CheckFormula, ErrorsNameTheFormulaAndTheNearestName) {
  Scope scope;
  scope.numbers["friction"] = 1;
  scope.series["height"] = {{0}, {1}};
  EXPECT_THAT(error_of("fricton * 2", scope), testing::AllOf(testing::HasSubstr("expect.0.value"), testing::HasSubstr("did you mean 'friction'")));
  EXPECT_THAT(error_of("last(\"heigt\")", scope), testing::HasSubstr("did you mean 'height'"));
  EXPECT_THAT(error_of("1 / 0", scope), testing::HasSubstr("gives inf"));
  EXPECT_THAT(error_of("1 +", scope), testing::HasSubstr("'1 +'"));
  EXPECT_THAT(error_of("x(0)", scope), testing::HasSubstr("not known here"));
}

}  // namespace
}  // namespace skred
