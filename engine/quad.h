// engine/quad.h - a vector and a number side by side: one aligned load for four lanes of a register.
#pragma once
#include "engine/vec3.h"

namespace skred {

// A vector and a number, on half a cache line.
struct alignas(32) Quad {
  Vec3 v;
  double s = 0;
};

}  // namespace skred
