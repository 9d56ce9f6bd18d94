// tests/profiling/timeline_svg_test.cpp
#include "profiling/timeline_svg.h"
#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include "engine/io/temporary_folder.h"
#include "profiling/readable.h"
#include "tests/profiling/fake_run.h"

using namespace skred;
using testing::HasSubstr;
using testing::Not;

namespace {

// Well-formed as far as we write XML: tags balance, and text has no bare < or &.
std::string malformed(const std::string& xml) {
  std::vector<std::string> open;
  std::size_t at = 0;
  while (at < xml.size()) {
    if (xml[at] == '&') {
      const auto is = [&](const char* entity) { return xml.compare(at, std::string(entity).size(), entity) == 0; };
      if (!is("&amp;") && !is("&lt;") && !is("&gt;") && !is("&quot;")) return "bare & at " + xml.substr(at, 20);
      ++at;
    } else if (xml[at] == '<') {
      const auto end = xml.find('>', at);
      if (end == std::string::npos) return "open tag";
      const std::string tag = xml.substr(at + 1, end - at - 1);
      const std::string name = tag.substr(0, tag.find(' '));
      if (std::count(tag.begin(), tag.end(), '"') % 2 != 0 || tag.find('<') != std::string::npos) return "attributes of " + tag;
      if (tag[0] == '/') {
        if (open.empty() || open.back() != tag.substr(1)) return "unexpected " + tag;
        open.pop_back();
      } else if (tag.back() != '/') {
        open.push_back(name);
      }
      at = end + 1;
    } else {
      if (xml[at] == '>') return "bare >";
      ++at;
    }
  }
  return open.empty() ? "" : "not closed: " + open.back();
}

struct Text { double x0, x1, y0, y1; std::string what; };

std::string attribute(const std::string& tag, const std::string& name) {
  const auto begin = tag.find(" " + name + "=\"") + name.size() + 3;
  return tag.substr(begin, tag.find('"', begin) - begin);
}

// Where texts lie, for a font of 0.6 of its size per letter.
std::vector<Text> texts(const std::string& svg) {
  std::vector<Text> out;
  for (auto at = svg.find("<text"); at != std::string::npos; at = svg.find("<text", at + 1)) {
    const auto inside = svg.find('>', at) + 1;
    const std::string tag = svg.substr(at, inside - at), anchor = attribute(tag, "text-anchor");
    const double x = std::stod(attribute(tag, "x")), y = std::stod(attribute(tag, "y"));
    const double size = std::stod(attribute(tag, "font-size"));
    const std::string what = svg.substr(inside, svg.find('<', inside) - inside);
    double letters = 0;
    bool entity = false;
    for (const unsigned char c : what) {
      if (c == '&') entity = true;
      if (c == ';') entity = false;
      letters += !entity && (c & 0xc0) != 0x80;
    }
    const double w = 0.6 * size * letters;
    const double x0 = anchor == "start" ? x : anchor == "end" ? x - w : x - w / 2;
    out.push_back({x0, x0 + w, y - 0.75 * size, y + 0.22 * size, what});
  }
  return out;
}

void expect_tidy(const std::string& svg) {
  EXPECT_EQ(malformed(svg), "");
  const double w = std::stod(attribute(svg, "width")), h = std::stod(attribute(svg, "height"));
  const auto all = texts(svg);
  EXPECT_GT(all.size(), 10u);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Text& a = all[i];
    EXPECT_TRUE(a.x0 >= 0 && a.x1 <= w && a.y0 >= 0 && a.y1 <= h) << a.what << " runs out of the picture";
    for (std::size_t j = 0; j < i; ++j) {
      const Text& b = all[j];
      EXPECT_FALSE(a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1) << a.what << " overlaps " << b.what;
    }
  }
}

TimelineCaption drum_caption() {
  return {.scene = "drum", .method = "sdem", .processor = "a processor", .particles = 95052, .contacts = 412345, .parts = {
      {"collision detection",
       {"check_motion", "reorder", "broadphase", "contact_hashing", "broadphase_body", "contact_geometry_body"}},
      {"forces",
       {"force_calculation_particle_particle", "force_calculation_particle_body", "force_application_particle",
        "force_application_body"}}}};
}

}  // namespace

TEST(TimelineSvg, DrawsTheStepOfMedianDuration) {
  Timeline t(2);
  test::FakeRun run(t, test::drum_kernels());
  t.trace(0, 5);
  int step = 0;
  for (double slowness : {0.30, 0.05, 0.15, 0.40, 0.10}) run.step(step++, slowness);
  auto steps = t.steps();                                       // on a busy machine a step may take longer than it was meant to
  std::sort(steps.begin(), steps.end(), [](auto& a, auto& b) { return a.end - a.begin < b.end - b.begin; });
  const std::string svg = timeline_svg(t, drum_caption());
  expect_tidy(svg);
  EXPECT_THAT(svg, HasSubstr(">step " + std::to_string(steps[2].step) + ": "));
  EXPECT_THAT(svg, HasSubstr("the median of 5 traced steps"));
  EXPECT_THAT(svg, HasSubstr("95\u00a0052 particles"));
  EXPECT_THAT(svg, HasSubstr("412\u00a0345 contacts"));
  EXPECT_THAT(svg, HasSubstr("2 threads"));
  EXPECT_THAT(svg, HasSubstr("One time step of drum"));
  EXPECT_THAT(svg, HasSubstr("thread 0 (main)"));
  EXPECT_THAT(svg, HasSubstr(">thread 1<"));
  EXPECT_THAT(svg, HasSubstr(">collision detection: 5"));       // 18.2 of 34.2 ms
  EXPECT_THAT(svg, HasSubstr(">forces: 4"));                    // 14.6 of 34.2 ms
  EXPECT_THAT(svg, Not(HasSubstr(">writer<")));
  EXPECT_THAT(svg, Not(HasSubstr("<script")));
  for (const auto& k : test::drum_kernels()) EXPECT_THAT(svg, HasSubstr(std::string(">") + k.name + "<")) << "in the legend";
  // Sorted by share: the force calculation, then the broadphase.
  const auto legend = svg.find("share of the busy time");
  EXPECT_LT(svg.find(">force_calculation_particle_particle<", legend), svg.find(">broadphase<", legend));
  EXPECT_LT(svg.find(">broadphase<", legend), svg.find(">contact_hashing<", legend));
}

TEST(TimelineSvg, IdleShareAndSharesAreThoseOfTheSpans) {
  Timeline t(2);
  const KernelId a = t.kernel("broadphase"), b = t.kernel("integrate"), frame = t.kernel("write_frame");
  t.trace(0, 1);
  t.begin_step(0);
  const Ticks begin = Timeline::now();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const Ticks end = Timeline::now(), quarter = (end - begin) / 4;
  t.chunk(0, a, begin, begin + 3 * quarter, 1);
  t.chunk(1, b, begin, begin + quarter, 1);
  t.chunk(2, frame, begin, end, 1);
  t.call(0, a, begin, begin + 3 * quarter, 1);
  t.call(1, b, begin, begin + quarter, 1);
  t.end_step();
  const std::string svg = timeline_svg(t, {});
  expect_tidy(svg);
  EXPECT_THAT(svg, HasSubstr(">75.0 %<"));                     // broadphase
  EXPECT_THAT(svg, HasSubstr(">25.0 %<"));                     // integrate
  const auto step = t.steps().at(0);
  const double idle = 1 - 2.0 * double(quarter) / double(step.end - step.begin);   // half, and a little for the rest of the step
  EXPECT_THAT(svg, HasSubstr("idle " + readable_share(idle)));
  EXPECT_THAT(svg, HasSubstr(">writer<"));
  EXPECT_THAT(svg, HasSubstr(">write_frame<"));
}

TEST(TimelineSvg, TidyForManyThreadsManyKernelsAndLongNames) {
  for (int threads : {1, 3, 8, 16, 32, 64}) {
    std::vector<test::FakeKernel> kernels = test::drum_kernels();
    static const char* more[] = {
        "a_kernel_with_a_very_long_name_that_somebody_thought_was_clear_enough_for_everyone_who_reads_it", "constraint_setup",
        "impact_solve", "contact_solve", "impulse_application", "<odd> & \"quoted\"", "k"};
    for (const char* name : more) kernels.push_back({name, 0.4e-3, 5});
    Timeline t(threads);
    test::FakeRun run(t, kernels);
    t.trace(0, 1);
    run.step(0, 0.2);
    TimelineCaption c = drum_caption();
    c.processor = "A Processor Of Many Words And Of A Name That No Line Of A Picture Was Ever Meant To Hold In One Piece, "
                  "64 Cores At 2.6 GHz, And More Of Them On Request";
    c.scene = "a scene & its <name>";
    c.parts.push_back({"a part whose label is much longer than its time", {"k"}});
    c.parts.push_back({"another one at the same place, long as well", {"impulse_application", "k"}});
    const std::string svg = timeline_svg(t, c);
    expect_tidy(svg);
    EXPECT_LT(svg.size(), 500'000u) << threads;
    EXPECT_THAT(svg, HasSubstr("a scene &amp; its &lt;name&gt;"));
  }
}

TEST(TimelineSvg, ManyChunksStaySmall) {
  std::vector<test::FakeKernel> kernels;
  for (const auto& k : test::drum_kernels()) kernels.push_back({k.name, k.time, k.chunks * 100});
  Timeline t(4);
  test::FakeRun run(t, kernels);
  t.trace(0, 2);
  run.step(0, 0.5);
  run.step(1, 0.5);
  const std::string svg = timeline_svg(t, drum_caption());
  expect_tidy(svg);
  EXPECT_LT(svg.size(), 500'000u);
}

TEST(TimelineSvg, NothingTracedIsAnError) {
  Timeline t(1);
  EXPECT_THROW(timeline_svg(t, {}), std::runtime_error);
}

TEST(TimelineSvg, FilesAndTheirErrors) {
  Timeline t(1);
  test::FakeRun run(t, test::drum_kernels());
  t.trace(0, 1);
  run.step(0, 0.01);
  const TemporaryFolder folder;
  write_timeline_svg(folder / "step.svg", t, drum_caption());
  std::ifstream file(folder / "step.svg");
  // Only the figures of a second picture may differ, in their last digits: the clock is calibrated anew at each call.
  const std::string written(std::istreambuf_iterator<char>(file), {}), again = timeline_svg(t, drum_caption());
  EXPECT_EQ(malformed(written), "");
  EXPECT_EQ(texts(written).size(), texts(again).size());
  EXPECT_THAT(written, HasSubstr("One time step of drum"));
  EXPECT_THAT(written, testing::EndsWith("</svg>\n"));
  EXPECT_THROW(write_timeline_svg("/no/such/folder/step.svg", t, drum_caption()), std::runtime_error);
}
