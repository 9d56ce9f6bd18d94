// scenes/show.h - what the program can tell without running a scene: its graph, its contact models.
#pragma once
#include <string>
#include "scenes/scene.h"

namespace skred {

// The kernels of a scene's step, the order that data needs between them, and every effect in or out with its reason.
std::string graph_text(const Scene&);
std::string graph_dot(const Scene&);
std::string graph_svg(const Scene&);       // drawn by Graphviz; throws UsageError if it is not installed

std::string models_text();                 // contact models with parameters, units and sources

}  // namespace skred
