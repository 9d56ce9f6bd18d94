// profiling/chrome_trace.h - the traced steps as Chrome trace-event JSON, for Perfetto and chrome://tracing.
//
// Format: "Trace Event Format" of the Chromium project; ts and dur are in microseconds.
#pragma once
#include <map>
#include <ostream>
#include <string>
#include "profiling/timeline.h"

namespace skred {

struct TraceInfo {
  std::string title;                            // of the process; empty: scene, method and threads
  std::string scene, method;
  std::string software;                         // "skred 0.1.0"
  std::string processor;
  std::map<std::string, std::string> other;     // whatever else describes the run: particles, compiler, ...
};

// Rows "thread 0 (main)" .. "writer" with a span per kernel call and, inside it, one per chunk; a row "steps"; counter tracks.
// Times count from the first traced step. Spans of a row nest: one that would stick out of its parent by a rounding is clipped.
void write_chrome_trace(std::ostream& os, const Timeline& timeline, const TraceInfo& info);

// Throws std::runtime_error with the path and the reason.
void write_chrome_trace(const std::string& path, const Timeline& timeline, const TraceInfo& info);

}  // namespace skred
