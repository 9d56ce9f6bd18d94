// engine/vector_path.h - which vector instructions the hot loops use. Chosen at run time; every path gives the same bits.
//
// A loop is a template on its number type R: double on the scalar path, else the compiler's vector of doubles of that
// instruction set (engine/pack.h). It is compiled once per path, in translation units of their own with their own flags.
#pragma once
#include <optional>
#include <string_view>
#include <vector>

namespace skred {

enum class VectorPath { scalar, sse2, avx2, avx512 };

// The widest that this processor has.
VectorPath best_vector_path();
bool has_vector_path(VectorPath);
std::vector<VectorPath> vector_paths();                            // all that it has, the widest last

const char* name_of(VectorPath);                                   // "scalar", "sse2", "avx2", "avx512"
std::optional<VectorPath> vector_path(std::string_view name);

// A vector register as the compiler sees it.
typedef double Two __attribute__((vector_size(16)));
typedef double Four __attribute__((vector_size(32)));
typedef double Eight __attribute__((vector_size(64)));

// What `choice.template operator()<path>()` gives for a path known at run time only.
template <class Choice> auto for_path(VectorPath path, const Choice& choice) {
  switch (path) {
#if defined(__x86_64__)
    case VectorPath::avx512: return choice.template operator()<VectorPath::avx512>();
    case VectorPath::avx2: return choice.template operator()<VectorPath::avx2>();
    case VectorPath::sse2: return choice.template operator()<VectorPath::sse2>();
#endif
    default: return choice.template operator()<VectorPath::scalar>();
  }
}

}  // namespace skred
