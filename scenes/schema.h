// scenes/schema.h - the table of keys of scene files, and what is made from it. To add a key, add its line to
// scenes/schema.cpp (the scene, materials, particles) scenes/body_keys.cpp (rigid bodies) or
// scenes/flow_keys.cpp (removal, inflow, probes).
#pragma once
#include <string>
#include <vector>
#include "scenes/scene.h"
#include "scenes/table.h"

namespace skred {

const Section<Scene>& scene_keys();
const Section<BodySpec>& body_keys();
const Section<RemoveSpec>& remove_keys();
const Section<InflowSpec>& inflow_keys();
const Section<ProbeSpec>& probe_keys();

// JSON Schema, draft-07, of a scene file: editors complete and check with it.
std::string json_schema();

// What a key means, its range and default: "materials.youngs_modulus". Without a path: the top-level keys.
// Throws std::invalid_argument, naming the nearest key, if there is no such path.
std::string explain(const std::string& path = "");

// The scene with every default filled in, in plain SI numbers: a scene file that reads back as the same scene, bit for bit.
std::string resolved_yaml(const Scene&);

}  // namespace skred
