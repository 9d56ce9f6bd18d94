// scenes/check/case.h - the cases: scene files with a `check` section, those of the program and a user's own.
#pragma once
#include <map>
#include <string>
#include <vector>
#include "scenes/scene.h"

namespace skred {

struct CheckCase {
  std::string name;                                  // of the file, without its ending
  std::string text, path;                            // path: names it in errors; where its meshes are looked for
  Scene scene;                                       // as the file stands, with its `check`
  const CheckSpec& spec() const { return *scene.check; }
};

// The files that are part of the program, by name: cases (*.yaml) and what they refer to. CMake writes the source from them.
const std::map<std::string, std::string>& case_files();

// All cases of the program, by group, then name. `folder`: their files are written there, so that meshes are found.
std::vector<CheckCase> program_cases(const std::string& folder);

// A case of a user. Throws SceneError, also where the file has no `check` section.
CheckCase read_case(const std::string& path);

}  // namespace skred
