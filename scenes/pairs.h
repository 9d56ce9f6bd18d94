// scenes/pairs.h - coefficients of every pair of a scene's materials.
#pragma once
#include "engine/material.h"
#include "scenes/scene.h"

namespace skred {

// Rows in the order of scene.materials. A coefficient that the scene does not give for a pair is the geometric mean of
// both materials' values (equal values stay, zero stays zero); E* and G* follow from the bulk properties.
PairTable resolve_pairs(const Scene&);

}  // namespace skred
