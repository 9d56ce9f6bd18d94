// tests/engine/io/write_sample.cpp - writes the sample run into a folder for check_output.py: write_sample FOLDER float|double
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include "engine/io/statistics.h"
#include "engine/io/trajectory.h"
#include "tests/engine/io/sample.h"

using namespace skred;

int main(int argc, char** argv) {
  if (argc != 3) return EXIT_FAILURE;
  std::filesystem::create_directories(argv[1]);
  FrameHeader header = sample::header();
  header.single_precision = std::strcmp(argv[2], "float") == 0;
  TrajectoryWriter trajectory(argv[1], header);
  StatisticsWriter statistics(argv[1]);
  for (int k = 0; k < 3; ++k) {
    Frame frame = sample::frame(k, header);
    for (std::size_t p = 0; p < sample::particles; ++p) frame.orientation.push_back(rotation_by({0, 0, 0.1 * double(p) * k}));
    if (k > 0) {                         // the first frame has no contacts, the last has two
      for (int c = 0; c < k; ++c) frame.contacts.push_back({std::uint32_t(c), std::uint32_t(c + 1), {1.0 * k, 0, 0.5}});
      frame.body_contacts.push_back({2, 0, {0.2, 0, 0}, {0, 0, 3.0 * k}});
    }
    trajectory.append(frame);
    statistics.append({{{"time", "s", frame.time}, {"kinetic_energy", "J", 0.1 * k}, {"contacts", "1", double(k)}}});
  }
  trajectory.close();
  statistics.close();
}
