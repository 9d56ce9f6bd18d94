#include "engine/vector_path.h"
#include <array>

namespace skred {

namespace {
constexpr std::array all{VectorPath::avx512, VectorPath::avx2, VectorPath::sse2, VectorPath::scalar};
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

VectorPath best_vector_path() {
  for (const VectorPath p : all)
    if (has_vector_path(p)) return p;
  return VectorPath::scalar;
}

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
