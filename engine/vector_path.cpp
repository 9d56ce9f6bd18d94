#include "engine/vector_path.h"
#include <array>

namespace skred {

namespace {
constexpr std::array all{VectorPath::scalar, VectorPath::sse2, VectorPath::avx2, VectorPath::avx512};
}

bool has_vector_path(VectorPath p) {
#if defined(__x86_64__)
  switch (p) {
    case VectorPath::avx512: return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
    case VectorPath::avx2: return __builtin_cpu_supports("avx2");
    default: return true;
  }
#else
  return p == VectorPath::scalar;
#endif
}

std::vector<VectorPath> vector_paths() {
  std::vector<VectorPath> out;
  for (const VectorPath p : all)
    if (has_vector_path(p)) out.push_back(p);
  return out;
}

VectorPath best_vector_path() { return vector_paths().back(); }

const char* name_of(VectorPath p) {
  switch (p) {
    case VectorPath::avx512: return "avx512";
    case VectorPath::avx2: return "avx2";
    case VectorPath::sse2: return "sse2";
    default: return "scalar";
  }
}

std::optional<VectorPath> vector_path(std::string_view name) {
  for (const VectorPath p : all)
    if (name == name_of(p)) return p;
  return {};
}

}  // namespace skred
