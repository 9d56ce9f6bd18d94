// scenes/build.h - from a scene to the world and the model that a simulation starts from.
#pragma once
#include "scenes/fill.h"
#include "scenes/scene.h"
#include "tasks/model.h"

namespace skred {

World build_world(const Scene&, const ParticleSet&);
Model build_model(const Scene&);                    // without the time step

// The place of a probe: one of the two.
std::optional<Region> region_of(const ProbeSpec&);
std::optional<Area> area_of(const ProbeSpec&);

}  // namespace skred
