// engine/loop_label.h - which of many loops of a kernel a chunk belongs to, for the timeline.
#pragma once
#include <cstdint>

namespace skred {

struct LoopLabel { std::uint16_t sweep = 0, colour = 0; };   // the solver's sweep, from 1 on, and its colour; 0: no label

}  // namespace skred
