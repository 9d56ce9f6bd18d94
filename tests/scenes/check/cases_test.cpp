// Every quick case of `skred check`, as a test: what users verify their program with, verifies ours.
#include <gtest/gtest.h>
#include "engine/io/temporary_folder.h"
#include "scenes/check/report.h"
#include "scenes/prepare.h"

namespace skred {
namespace {

struct Cases {
  TemporaryFolder folder{"skred-cases"};
  std::vector<CheckCase> all = program_cases(folder.path.string());
};
const Cases& cases() {
  static const Cases c;
  return c;
}

std::vector<std::string> quick_cases() {
  std::vector<std::string> names;
  for (const CheckCase& c : cases().all)
    if (!c.spec().slow) names.push_back(c.name);
  return names;
}

// A case is a scene that `skred run` and `skred validate` take as it stands, by a method that the case is about.
TEST(CaseFiles, AreSoundScenes) {
  for (const CheckCase& c : cases().all) {
    const std::vector<Method>& methods = c.spec().methods;
    EXPECT_NE(std::find(methods.begin(), methods.end(), c.scene.method), methods.end()) << c.name << ": give it `method`";
    EXPECT_NO_THROW(prepare(c.scene, c.spec().force)) << c.name;
  }
}

class CheckCases : public testing::TestWithParam<std::string> {};

TEST_P(CheckCases, Passes) {
  const auto& all = cases().all;
  const auto found = std::find_if(all.begin(), all.end(), [](const CheckCase& c) { return c.name == GetParam(); });
  ASSERT_NE(found, all.end());
  const CheckedCase done{*found, run_case(*found)};
  EXPECT_FALSE(done.result.verdicts.empty());
  EXPECT_TRUE(done.result.passed()) << text_of(done, true);
}

INSTANTIATE_TEST_SUITE_P(Quick, CheckCases, testing::ValuesIn(quick_cases()), [](const auto& chosen) {
  std::string name = chosen.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace skred
