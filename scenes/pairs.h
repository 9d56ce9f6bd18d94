// scenes/pairs.h - coefficients of every pair of a scene's materials.
#pragma once
#include "engine/material.h"
#include "scenes/scene.h"

namespace skred {

// Rows in the order of scene.materials. A coefficient that the scene does not give for a pair is the geometric mean of
// both materials' values (equal values stay, zero stays zero); E* and G* follow from the bulk properties.
PairTable resolve_pairs(const Scene&);

// A coefficient that only some contact laws need, of the materials in these rows, by the same rule; nothing if the pair does not
// give it and one of the materials has none.
std::optional<double> coefficient_of_pair(const Scene&, std::size_t i, std::size_t j, std::optional<double> MaterialSpec::* own,
                                          std::optional<double> PairSpec::* of_pair);

}  // namespace skred
