// scenes/overrides.h - `--set path=value`: changes of the tree before it is read.
#pragma once
#include <string>
#include <vector>
#include "scenes/node.h"

namespace skred {

std::vector<std::string> split_path(const std::string& path);      // at the dots

// Puts `value` at the dotted path in `root`; keys that are not there are added. `top_level`: the scene's keys; a path of
// one word that is none of them is a parameter. Errors - no such item, parameter or key - go to `diagnostics` at value.at.
void set_path(Node& root, const std::string& path, Node value, const std::vector<std::string>& top_level,
              Diagnostics& diagnostics);

}  // namespace skred
