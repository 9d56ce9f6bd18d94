// profiling/chrome_trace.cpp
#include "profiling/chrome_trace.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include "profiling/palette.h"
#include "profiling/write_file.h"

namespace skred {

namespace {

std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

// Writes one event per line. Times are whole nanoseconds, so that rounding keeps the order of any two of them.
class Writer {
 public:
  Writer(std::ostream& os, Ticks origin) : os_(os), origin_(origin), tick_(1e9 * Timeline::seconds_per_tick()) {}
  ~Writer() { flush(); }

  std::int64_t nanoseconds(Ticks at) const {
    return std::llround((at >= origin_ ? double(at - origin_) : -double(origin_ - at)) * tick_);
  }
  template <class... Args> void event(fmt::format_string<Args...> format, Args&&... args) {
    text_.append(std::string_view(first_ ? "\n" : ",\n"));
    first_ = false;
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    if (text_.size() > 1 << 20) flush();
  }
  void name(std::string_view what, int row, const std::string& value) {
    event(R"({{"name":"{}","ph":"M","pid":1,"tid":{},"args":{{"name":{}}}}})", what, row, quoted(value));
  }
  void sort_index(int row, int index) {
    event(R"({{"name":"thread_sort_index","ph":"M","pid":1,"tid":{},"args":{{"sort_index":{}}}}})", row, index);
  }

 private:
  void flush() {
    os_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
    text_.clear();
  }
  std::ostream& os_;
  Ticks origin_;
  double tick_;
  bool first_ = true;
  fmt::memory_buffer text_;
};

// A time in microseconds with three decimals.
std::string microseconds(std::int64_t ns) {
  const std::int64_t a = ns < 0 ? -ns : ns;
  return fmt::format("{}{}.{:03}", ns < 0 ? "-" : "", a / 1000, a % 1000);
}

void write_lane(Writer& out, int lane, const std::vector<Timeline::Event>& events, const std::vector<std::string>& names,
                const std::vector<std::string_view>& colours) {
  std::vector<std::int64_t> open;                    // ends of the spans around the present one
  for (const Timeline::Event& e : events) {
    const std::int64_t begin = out.nanoseconds(e.begin);
    std::int64_t end = std::max(begin, out.nanoseconds(e.end));
    while (!open.empty() && open.back() <= begin) open.pop_back();
    if (!open.empty()) end = std::min(end, open.back());
    open.push_back(end);
    const std::string loop = e.label.sweep > 0 ? fmt::format(R"(,"sweep":{},"colour":{})", e.label.sweep, e.label.colour) : "";
    out.event(R"({{"name":{},"cat":"{}","ph":"X","ts":{},"dur":{},"pid":1,"tid":{},"cname":"{}",)"
              R"("args":{{"step":{},"rows":{}{}}}}})",
              names[e.kernel], e.whole_call ? "call" : "chunk", microseconds(begin), microseconds(end - begin), lane,
              colours[e.kernel], e.step, e.rows, loop);
  }
}

}  // namespace

void write_chrome_trace(std::ostream& os, const Timeline& timeline, const TraceInfo& info) {
  const auto steps = timeline.steps();
  const auto lanes = timeline.events();
  const auto counters = timeline.counters();
  const int threads = timeline.threads(), writer = threads, step_row = threads + 1;

  Ticks origin = ~Ticks{0};
  if (!steps.empty()) origin = steps.front().begin;
  else for (const auto& lane : lanes) if (!lane.empty()) origin = std::min(origin, lane.front().begin);

  std::vector<std::string> names;
  std::vector<std::string_view> colours;
  for (const std::string& n : timeline.names()) {
    names.push_back(quoted(n));
    colours.push_back(kernel_colour(n).trace);
  }

  os << "{\"traceEvents\":[";
  {
    Writer out(os, origin);
    const std::string run = fmt::format("{} {}, {} thread{}", info.scene, info.method, threads, threads == 1 ? "" : "s");
    out.name("process_name", 0, info.title.empty() ? run : info.title);
    out.name("thread_name", step_row, "steps");
    out.sort_index(step_row, 0);
    for (int i = 0; i < threads; ++i) {
      out.name("thread_name", i, fmt::format("thread {}{}", i, i == 0 ? " (main)" : ""));
      out.sort_index(i, i + 1);
    }
    out.name("thread_name", writer, "writer");
    out.sort_index(writer, threads + 1);

    for (const auto& s : steps) {
      const std::int64_t begin = out.nanoseconds(s.begin), end = std::max(begin, out.nanoseconds(s.end));
      out.event(R"({{"name":"step {}","cat":"step","ph":"X","ts":{},"dur":{},"pid":1,"tid":{},"args":{{"step":{}}}}})", s.step,
                microseconds(begin), microseconds(end - begin), step_row, s.step);
    }
    for (int lane = 0; lane <= threads; ++lane) write_lane(out, lane, lanes[lane], names, colours);
    for (const auto& c : counters)
      if (std::isfinite(c.value))                    // JSON has no other numbers
        out.event(R"({{"name":{},"ph":"C","ts":{},"pid":1,"tid":0,"args":{{"value":{}}}}})", quoted(c.name),
                  microseconds(out.nanoseconds(c.at)), c.value);
  }
  nlohmann::json other(info.other);
  other["scene"] = info.scene;
  other["method"] = info.method;
  other["software"] = info.software;
  other["processor"] = info.processor;
  other["threads"] = std::to_string(threads);
  os << "\n],\n\"displayTimeUnit\":\"ns\",\n\"otherData\":"
     << other.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << "}\n";
}

void write_chrome_trace(const std::string& path, const Timeline& timeline, const TraceInfo& info) {
  write_file(path, [&](std::ostream& os) { write_chrome_trace(os, timeline, info); });
}

}  // namespace skred
