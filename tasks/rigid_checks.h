// tasks/rigid_checks.h - what must be told of the contacts between bodies before a run.
#pragma once
#include <string>
#include <vector>
#include "tasks/model.h"

namespace skred {

// Pairs of bodies, one of them dynamic, whose contact cannot be computed, and why: "a mesh ... and a box: ...".
struct UnsupportedPair { Index body_a, body_b; std::string why; };
std::vector<UnsupportedPair> unsupported_pairs(const World&, const Model&);

// The contact between two bodies, one of them dynamic, whose overlap is greatest as part of the outer radius of the smaller shape.
struct RigidOverlap { double ratio = 0; Index body_a = no_index, body_b = no_index; };
RigidOverlap greatest_rigid_overlap(const World&);               // of the contacts in the table
RigidOverlap rigid_overlap_at_start(const World&, const Model&);

}  // namespace skred
