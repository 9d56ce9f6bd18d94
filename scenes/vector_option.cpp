#include "scenes/vector_option.h"
#include <algorithm>
#include <fmt/format.h>
#include "scenes/errors.h"

namespace skred {

VectorPath parse_vector(const std::string& text, const std::vector<VectorPath>& here) {
  if (text == "auto") return here.back();
  const std::optional<VectorPath> path = vector_path(text);
  if (path && std::find(here.begin(), here.end(), *path) != here.end()) return *path;
  std::string names;
  for (const VectorPath p : here) names += std::string(", ") + name_of(p);
  throw UsageError(fmt::format("--vector: {}; this machine has auto{}",
                               path ? fmt::format("the processor has no '{}'", text) : fmt::format("'{}' is not allowed", text), names));
}

}  // namespace skred
