#include "scenes/check/case.h"
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include "scenes/read_scene.h"

namespace skred {
namespace {

CheckCase make_case(const std::string& path, const std::string& text) {
  CheckCase c{std::filesystem::path(path).stem().string(), text, path, parse_scene(text, path)};
  if (!c.scene.check) throw SceneError({{path, "the scene has no 'check' section: nothing says what it should show", "", 0}});
  return c;
}

std::size_t rank_of(const CheckCase& c) {
  const auto& groups = check_groups();
  return std::size_t(std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == c.spec().group; }) - groups.begin());
}

}  // namespace

std::vector<CheckCase> program_cases(const std::string& folder) {
  std::vector<CheckCase> cases;
  for (const auto& [name, text] : case_files()) std::ofstream(std::filesystem::path(folder) / name, std::ios::binary) << text;
  for (const auto& [name, text] : case_files())
    if (name.ends_with(".yaml")) cases.push_back(make_case((std::filesystem::path(folder) / name).string(), text));
  std::stable_sort(cases.begin(), cases.end(), [](const CheckCase& a, const CheckCase& b) { return rank_of(a) < rank_of(b); });
  return cases;
}

CheckCase read_case(const std::string& path) {
  read_scene(path);                                  // tells of a file that cannot be read
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return make_case(path, text.str());
}

}  // namespace skred
