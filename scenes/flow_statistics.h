// scenes/flow_statistics.h - what statistics and summary tell of removers, inflows and probes.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include "engine/io/frame.h"
#include "scenes/scene.h"
#include "tasks/simulation.h"

namespace skred {

// Appends the columns NAME.QUANTITY; and the number of particles, where they come and go.
void add_flow_statistics(const Scene&, const Simulation&, StatisticsRow&);

// Adds what came, went and crossed, by name.
void add_flow_summary(const Scene&, const Simulation&, nlohmann::json&);

}  // namespace skred
