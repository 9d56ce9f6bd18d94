// profiling/timeline_svg.cpp - chooses the step, lays it out, draws it.
#include "profiling/timeline_svg.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string_view>
#include <fmt/format.h>
#include "profiling/palette.h"
#include "profiling/readable.h"
#include "profiling/svg.h"
#include "profiling/write_file.h"

namespace skred {

namespace {

constexpr double width = 1200, left = 132, right = 64, plot = width - left - right;   // [px]
constexpr std::string_view ink = "#1f2328", soft = "#5b636d", idle_grey = "#e9eaec";

// ---- the step ---------------------------------------------------------------------------------------------------------

struct Block { double begin, end; KernelId kernel; };   // [s] from the start of the step

struct Step {
  std::int64_t number = 0;
  std::size_t traced = 0;
  double duration = 0;                                 // [s]
  std::vector<std::vector<Block>> chunks;              // by lane; the writer's last
  std::vector<Block> calls;                            // of the arena's threads, in order of begin
  std::vector<double> lane_busy;                       // [s]
  std::map<KernelId, double> busy, written;            // [s] by kernel: of the threads, of the writer
  double all_busy = 0;
};

Step typical_step(const Timeline& timeline) {
  auto steps = timeline.steps();
  if (steps.empty()) throw std::runtime_error("timeline picture: no step was traced; trace at least one that the run reaches");
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>((steps.size() - 1) / 2);
  std::nth_element(steps.begin(), middle, steps.end(),
                   [](const auto& a, const auto& b) { return a.end - a.begin < b.end - b.begin; });
  const Timeline::StepSpan span = *middle;
  const double tick = Timeline::seconds_per_tick();

  Step step;
  step.number = span.step;
  step.traced = steps.size();
  step.duration = double(span.end - span.begin) * tick;
  const auto lanes = timeline.events();
  for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
    const bool writers = lane + 1 == lanes.size();
    auto& chunks = step.chunks.emplace_back();
    double& lane_busy = step.lane_busy.emplace_back(0);
    for (const Timeline::Event& e : lanes[lane]) {
      if (e.end < span.begin || e.begin > span.end || (!writers && e.step != span.step)) continue;
      const Block block{double(std::max(e.begin, span.begin) - span.begin) * tick,
                        double(std::min(e.end, span.end) - span.begin) * tick, e.kernel};
      if (e.whole_call) {
        if (writers) continue;
        step.calls.push_back(block);
        step.busy.try_emplace(e.kernel, 0);            // in the legend even if it had nothing to do
        continue;
      }
      chunks.push_back(block);
      lane_busy += block.end - block.begin;
      (writers ? step.written : step.busy)[e.kernel] += block.end - block.begin;
    }
    if (!writers) step.all_busy += lane_busy;
  }
  std::sort(step.calls.begin(), step.calls.end(), [](const Block& a, const Block& b) { return a.begin < b.begin; });
  return step;
}

// ---- layout -----------------------------------------------------------------------------------------------------------

// For intervals in order of begin: the first row in which each does not overlap its predecessors.
struct Stack {
  std::vector<double> ends;
  std::size_t place(double begin, double end) {
    std::size_t row = 0;
    while (row < ends.size() && ends[row] > begin) ++row;
    if (row == ends.size()) ends.push_back(0);
    ends[row] = end;
    return row;
  }
};

struct RowStyle { double height, gap, font; };
RowStyle row_style(int rows) {
  if (rows <= 5) return {44, 9, 13};
  if (rows <= 9) return {32, 6, 13};
  if (rows <= 17) return {20, 4, 12};
  if (rows <= 33) return {14, 3, 10};
  return {9, 2, 8};
}

// Joins blocks of one kernel that are close, where at least one is too narrow to be seen as a block of its own.
std::vector<Block> joined(const std::vector<Block>& blocks, double px, double narrow) {
  constexpr double close = 0.3;                        // [px]
  std::vector<Block> out;
  double last_width = 0;
  for (const Block& b : blocks) {
    const double w = (b.end - b.begin) * px;
    if (!out.empty() && out.back().kernel == b.kernel && (b.begin - out.back().end) * px < close * narrow &&
        std::min(w, last_width) < narrow)
      out.back().end = std::max(out.back().end, b.end);
    else
      out.push_back(b);
    last_width = w;
  }
  return out;
}

// Coarser only for steps of very many chunks on very many threads.
std::vector<std::vector<Block>> joined_lanes(const Step& step, double px) {
  constexpr std::size_t most = 9000;                   // blocks, about 30 bytes each
  for (double narrow = 2;; narrow *= 2) {
    std::vector<std::vector<Block>> out;
    std::size_t count = 0;
    for (const auto& lane : step.chunks) count += out.emplace_back(joined(lane, px, narrow)).size();
    if (count <= most || narrow > plot) return out;
  }
}

struct TimeUnit { double per_second; std::string_view name; };
TimeUnit unit_for(double seconds) {
  if (seconds < 1e-3) return {1e6, "\u00b5s"};
  if (seconds < 10) return {1e3, "ms"};
  return {1, "s"};
}
double nice_interval(double range) {                   // 1, 2 or 5 times a power of ten: 5 to 12 ticks
  const double raw = range / 10, power = std::pow(10, std::floor(std::log10(raw)));
  for (const double m : {1.0, 2.0, 5.0}) if (m * power >= raw) return m * power;
  return 10 * power;
}

// ---- drawing ----------------------------------------------------------------------------------------------------------

class Drawing {
 public:
  Drawing(const Timeline& timeline, const TimelineCaption& caption)
      : timeline_(timeline), caption_(caption), step_(typical_step(timeline)),
        px_(plot / std::max(step_.duration, 1e-12)) {}

  std::string draw() {
    head();
    parts();
    const double top = y_;
    calls();
    rows();
    axis(top);
    legend();
    return fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1:.0f}\" viewBox=\"0 0 {0} {1:.0f}\" "
                       "font-family=\"Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif\">\n"
                       "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{2}{3}</svg>\n",
                       width, y_ + 20, under_.body, svg_.body);
  }

 private:
  double x_of(double time) const { return left + time * px_; }
  const std::string& name(KernelId k) const { return timeline_.names()[k]; }
  std::string_view colour(KernelId k) const { return kernel_colour(name(k)).hex; }
  double share(double busy) const { return step_.all_busy > 0 ? busy / step_.all_busy : 0; }
  double idle() const {
    const double offered = timeline_.threads() * step_.duration;
    return offered > 0 ? std::clamp(1 - step_.all_busy / offered, 0.0, 1.0) : 0;
  }

  void caption_line(const std::vector<std::string>& items) {
    constexpr double size = 13;
    std::string line;
    const auto put = [&] {
      y_ += 19;
      svg_.text(24, y_, size, "start", soft, shortened(line, size, width - 48));
      line.clear();
    };
    for (const std::string& item : items) {
      if (!line.empty() && text_width(line + "  \u00b7  " + item, size) > width - 48) put();
      line += (line.empty() ? "" : "  \u00b7  ") + item;
    }
    if (!line.empty()) put();
  }

  void head() {
    y_ = 36;
    std::string title = caption_.title;
    if (title.empty()) title = "One time step" + (caption_.scene.empty() ? "" : " of " + caption_.scene);
    svg_.text(24, y_, 21, "start", ink, shortened(title, 21 * 1.06, width - 48), true);
    y_ += 4;
    std::vector<std::string> items;
    if (!caption_.scene.empty()) items.push_back("scene " + caption_.scene);
    if (!caption_.method.empty()) items.push_back("method " + caption_.method);
    if (caption_.particles > 0) items.push_back(grouped_digits(caption_.particles) + " particles");
    if (caption_.contacts > 0) items.push_back(grouped_digits(caption_.contacts) + " contacts");
    items.push_back(fmt::format("{} thread{}", timeline_.threads(), timeline_.threads() == 1 ? "" : "s"));
    if (!caption_.processor.empty()) items.push_back(caption_.processor);
    caption_line(items);
    items = {fmt::format("step {}: {}", grouped_digits(step_.number), readable_time(step_.duration, "\u00b5"))};
    if (step_.traced > 1) items.back() += fmt::format(", the median of {} traced steps", step_.traced);
    items.push_back(fmt::format("threads idle {} of the time", readable_share(idle())));
    caption_line(items);
    y_ += 22;
  }

  // Brackets over parts of the step, stacked where they or their labels would overlap.
  void parts() {
    struct Part { double begin, end; std::string label; };
    std::vector<Part> found;
    for (const auto& p : caption_.parts) {
      const auto in = [&](KernelId k) { return std::find(p.kernels.begin(), p.kernels.end(), name(k)) != p.kernels.end(); };
      double begin = step_.duration, end = 0, busy = 0;
      for (const Block& c : step_.calls)
        if (in(c.kernel)) begin = std::min(begin, c.begin), end = std::max(end, c.end);
      for (const auto& [k, b] : step_.busy)
        if (in(k)) busy += b;
      if (end > begin) found.push_back({begin, end, fmt::format("{}: {:.0f} %", p.label, 100 * share(busy))});
    }
    std::sort(found.begin(), found.end(), [](const Part& a, const Part& b) { return a.begin < b.begin; });
    constexpr double size = 13, pitch = 30;
    Stack stack;
    for (const Part& p : found) {
      const double x0 = x_of(p.begin), x1 = x_of(p.end);
      const std::string label = shortened(p.label, size, plot);
      const double half = text_width(label, size) / 2;
      const double middle = std::clamp((x0 + x1) / 2, left + half, left + plot - half);
      const double y = y_ + pitch * double(stack.place(std::min(x0, middle - half), std::max(x1, middle + half + 8)));
      svg_.text(middle, y + 10, size, "middle", ink, label, true);
      svg_.body += fmt::format("<path d=\"M{:.1f} {:.1f}v-6H{:.1f}v6\" stroke=\"{}\" fill=\"none\"/>\n", x0 + 1.5, y + 23,
                               x1 - 1.5, soft);
    }
    y_ += pitch * double(stack.ends.size());
  }

  // A bar per kernel call, in as many rows as calls ran side by side, with its name where there is room.
  void calls() {
    constexpr double height = 18, pitch = 21, size = 11;
    Stack stack;
    for (const Block& c : step_.calls) {
      const double x0 = x_of(c.begin), w = std::max(1.0, x_of(c.end) - x0);
      const double y = y_ + pitch * double(stack.place(c.begin, c.end));
      svg_.rect(x0, y, w > 3 ? w - 0.6 : w, height, mixed_with_white(colour(c.kernel), 0.30));
      svg_.rect(x0, y + height - 3, w > 3 ? w - 0.6 : w, 3, colour(c.kernel));
      if (text_width(name(c.kernel), size) + 6 < w) svg_.text(x0 + w / 2, y + 11.5, size, "middle", ink, name(c.kernel));
    }
    if (stack.ends.empty()) return;
    svg_.text(left - 10, y_ + 13, 12, "end", soft, "kernel calls");
    svg_.text(left + plot + 10, y_ + 13, 12, "start", soft, "busy");
    y_ += pitch * double(stack.ends.size()) + 8;
  }

  void rows() {
    const bool writer = !step_.chunks.back().empty();
    const int threads = timeline_.threads();
    const RowStyle style = row_style(threads + 1);
    const auto lanes = joined_lanes(step_, px_);
    for (int lane = 0; lane < threads + writer; ++lane) {
      if (lane == threads) y_ += style.gap;
      const double text_y = y_ + style.height / 2 + 0.36 * style.font;
      svg_.text(left - 10, text_y, style.font, "end", ink,
                lane == threads ? "writer" : fmt::format("thread {}{}", lane, lane == 0 ? " (main)" : ""));
      svg_.text(left + plot + 10, text_y, std::min(style.font, 12.0), "start", soft,
                fmt::format("{:.0f} %", 100 * std::min(1.0, step_.lane_busy[lane] / step_.duration)));
      svg_.rect(left, y_, plot, style.height, idle_grey);
      blocks(lanes[lane], style.height);
      y_ += style.height + style.gap;
    }
  }

  // One path per kernel; those of less time last, on top, so that their thin blocks are not covered.
  void blocks(const std::vector<Block>& chunks, double height) {
    std::map<KernelId, std::pair<double, std::string>> drawn;
    for (const Block& b : chunks) {
      auto& [time, path] = drawn[b.kernel];
      time += b.end - b.begin;
      const double w = (b.end - b.begin) * px_;
      const double visible = w > 2.5 ? w - std::min(0.6, 0.08 * w) : std::max(w, 0.8);
      const double x = std::min(x_of(b.begin), left + plot - visible);
      path += fmt::format("M{:.1f} {:.0f}h{:.2f}v{}h-{:.2f}z", x, y_, visible, height, visible);
    }
    std::vector<std::pair<double, KernelId>> order;
    for (const auto& [k, d] : drawn) order.push_back({d.first, k});
    std::sort(order.rbegin(), order.rend());
    for (const auto& [time, k] : order)
      svg_.body += fmt::format("<path fill=\"{}\" d=\"{}\"><title>{} {}</title></path>\n", colour(k), drawn[k].second,
                               escaped(name(k)), readable_time(time, "\u00b5"));
  }

  void axis(double top) {
    const TimeUnit unit = unit_for(step_.duration);
    const double range = step_.duration * unit.per_second;
    const double interval = nice_interval(std::max(range, 1e-9));
    svg_.line(left, y_, left + plot, y_, soft);
    for (int i = 0; i * interval <= range; ++i) {
      const double x = left + plot * i * interval / range;
      under_.line(x, top, x, y_, "#d9dce0");
      svg_.line(x, y_, x, y_ + 5, soft);
      svg_.text(x, y_ + 19, 12, "middle", ink, fmt::format("{:g}", i * interval));
    }
    svg_.text(left + plot / 2, y_ + 38, 12, "middle", soft, fmt::format("time since the start of the step [{}]", unit.name));
    y_ += 70;
  }

  // Kernels by their share, down the columns.
  void legend() {
    struct Entry { std::string share, name; std::string_view colour; };
    std::vector<std::pair<double, KernelId>> order;
    for (const auto& [k, b] : step_.busy) order.push_back({b, k});
    std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<Entry> entries;
    for (const auto& [b, k] : order) entries.push_back({readable_share(share(b)), name(k), colour(k)});
    for (const auto& [k, b] : step_.written) entries.push_back({"writer", name(k), colour(k)});
    entries.push_back({readable_share(idle()), "idle, of all threads' time", idle_grey});

    constexpr double size = 12, pitch = 21, x0 = 24, before_name = 90;
    svg_.text(x0, y_, size, "start", soft, "share of the busy time");
    y_ += 10;
    double longest = 0;
    for (const Entry& e : entries) longest = std::max(longest, text_width(e.name, size));
    const double room = width - 2 * x0;
    const double column = std::min(room, before_name + longest + 16);
    const auto columns = static_cast<std::size_t>(std::clamp(std::floor(room / column), 1.0, 4.0));
    const std::size_t per_column = (entries.size() + columns - 1) / columns;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const double x = x0 + (columns == 1 ? 0 : room / double(columns) * double(i / per_column));
      const double y = y_ + pitch * double(i % per_column + 1);
      svg_.rect(x, y - 11, 14, 14, entries[i].colour, entries[i].colour == idle_grey ? " stroke=\"#b6bbc1\"" : "");
      svg_.text(x + before_name - 10, y, size, "end", soft, entries[i].share);
      svg_.text(x + before_name, y, size, "start", ink, shortened(entries[i].name, size, column - before_name));
    }
    y_ += pitch * double(per_column);
  }

  const Timeline& timeline_;
  const TimelineCaption& caption_;
  Step step_;
  double px_;                                          // pixels per second
  double y_ = 0;                                       // [px] where the next part starts
  Svg under_, svg_;                                    // grid lines below everything else
};

}  // namespace

std::string timeline_svg(const Timeline& timeline, const TimelineCaption& caption) { return Drawing(timeline, caption).draw(); }

void write_timeline_svg(const std::string& path, const Timeline& timeline, const TimelineCaption& caption) {
  const std::string text = timeline_svg(timeline, caption);
  write_file(path, [&](std::ostream& os) { os << text; });
}

}  // namespace skred
