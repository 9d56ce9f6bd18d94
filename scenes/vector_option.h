// scenes/vector_option.h - what --vector takes.
#pragma once
#include <string>
#include <vector>
#include "engine/vector_path.h"

namespace skred {

inline constexpr const char* vector_option_words = "auto|scalar|sse2|avx2|avx512";   // for help and completion
inline constexpr const char* vector_option_help = "instructions of the hot loops, which leave no trace in the results; auto: the widest here";

// "avx2", or "auto": the last of those that this machine has. Throws UsageError.
VectorPath parse_vector(const std::string& text, const std::vector<VectorPath>& here = vector_paths());

}  // namespace skred
