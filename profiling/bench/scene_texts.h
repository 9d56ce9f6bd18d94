// profiling/bench/scene_texts.h - scene files that are part of the program. CMake writes the source from the files.
#pragma once
#include <string>

namespace skred {

// `file` is a path from the root of the sources. Throws std::logic_error if the program does not hold it.
std::string scene_text(const std::string& file);

}  // namespace skred
