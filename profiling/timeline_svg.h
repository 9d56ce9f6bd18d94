// profiling/timeline_svg.h - one time step as a picture: a row per thread, a colour per kernel [Pettersson 2015, fig. 3.1].
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "profiling/timeline.h"

namespace skred {

struct TimelineCaption {
  std::string title;                            // empty: "One time step of SCENE"
  std::string scene, method, processor;         // empty ones are left out
  std::int64_t particles = 0, contacts = 0;     // 0 is left out
  // Parts of the step to bracket: from the first call to the last one of its kernels, with their share of the busy time.
  struct Part { std::string label; std::vector<std::string> kernels; };
  std::vector<Part> parts;
};

// The traced step of median duration, as SVG text without scripts. A chunk is a block in its kernel's colour, a kernel's call
// (waiting included) a bar above the threads; idle time is left grey. Chunks too narrow to be told apart are joined, so
// that the file stays below 500 kB. Throws std::runtime_error if no step was traced.
std::string timeline_svg(const Timeline& timeline, const TimelineCaption& caption);

// Throws std::runtime_error, also with the path and the reason if it cannot be written.
void write_timeline_svg(const std::string& path, const Timeline& timeline, const TimelineCaption& caption);

}  // namespace skred
