// tests/engine/io/statistics_test.cpp - the same numbers, to the last bit, in both files.
#include "engine/io/statistics.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include <fstream>
#include <limits>
#include "tests/engine/io/faults.h"
#include "tests/engine/io/sample.h"

using namespace skred;
using faults::message_of;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {

StatisticsRow row(double time, double energy) { return {{{"time", "s", time}, {"kinetic_energy", "J", energy}}}; }

std::vector<std::string> lines(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> all;
  for (std::string line; std::getline(file, line);) all.push_back(line);
  return all;
}

}  // namespace

TEST(Statistics, NumbersReadBackToTheBit) {
  const TemporaryFolder folder;
  const std::vector<double> values{0.1, 1.0 / 3, 1e-310, -1.7976931348623157e308, 12345678901234567.0, 5e-5};
  {
    StatisticsWriter writer(folder.path.string());
    for (std::size_t k = 0; k < values.size(); ++k) writer.append(row(double(k) * 5e-5, values[k]));
    EXPECT_EQ(lines(folder / "statistics.csv").size(), values.size() + 1);   // up to date while the run goes on
    writer.close();
  }
  const auto text = lines(folder / "statistics.csv");
  EXPECT_EQ(text[0], "time [s],kinetic_energy [J]");
  for (std::size_t k = 0; k < values.size(); ++k) {
    const std::string& line = text[k + 1];
    EXPECT_EQ(std::strtod(line.c_str() + line.find(',') + 1, nullptr), values[k]);
  }
  const Hdf5Reader read(folder / "statistics.h5");
  EXPECT_EQ(read.read_doubles("/kinetic_energy"), values);
  EXPECT_EQ(read.read_doubles("/time")[3], 3 * 5e-5);
  EXPECT_EQ(read.text_attribute("/kinetic_energy", "units"), "J");
}

TEST(Statistics, NoRowsAtAllIsFine) {
  const TemporaryFolder folder;
  StatisticsWriter(folder.path.string()).close();
  EXPECT_TRUE(Hdf5Reader(folder / "statistics.h5").datasets().empty());
}

TEST(Statistics, InfinityAndNanAreWrittenAsSuch) {
  const TemporaryFolder folder;
  StatisticsWriter writer(folder.path.string());
  writer.append(row(0, std::numeric_limits<double>::infinity()));
  writer.append(row(1, std::numeric_limits<double>::quiet_NaN()));
  writer.close();
  EXPECT_THAT(lines(folder / "statistics.csv"), ElementsAre(testing::_, "0,inf", "1,nan"));
}

TEST(Statistics, EveryRowHasTheSameNames) {
  const TemporaryFolder folder;
  StatisticsWriter writer(folder.path.string());
  writer.append(row(0, 1));
  EXPECT_THROW(writer.append({{{"time", "s", 1}}}), std::invalid_argument);
  EXPECT_THROW(writer.append({{{"time", "s", 1}, {"potential_energy", "J", 1}}}), std::invalid_argument);
  writer.append(row(1, 2));                                      // the mistakes left no trace
  writer.close();
  EXPECT_EQ(lines(folder / "statistics.csv").size(), 3u);
  EXPECT_THROW(writer.append(row(2, 3)), std::logic_error);
  StatisticsWriter other(folder.path.string());
  EXPECT_THROW(other.append({{{"a,b", "s", 1}}}), std::invalid_argument);
}

TEST(Statistics, AFullDiskIsTold) {
  const TemporaryFolder folder;
  EXPECT_THAT(message_of<IoError>([&] { StatisticsWriter(folder / "none"); }),
              HasSubstr("statistics.csv: cannot create the file: No such file"));
  const std::string message = faults::in_child([&] {
    faults::limit_file_size(8192);       // the CSV reaches it first: the HDF5 file is written once a second
    StatisticsWriter writer(folder.path.string());
    return message_of<IoError>([&] { for (int k = 0; k < 10000; ++k) writer.append(row(k / 3.0, 1 / 3.0)); });
  });
  EXPECT_THAT(message, testing::AllOf(HasSubstr("statistics."), HasSubstr("cannot write"), HasSubstr("File too large")));
}
