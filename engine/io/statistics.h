// engine/io/statistics.h - time series of a run: statistics.csv for eyes and spreadsheets, statistics.h5 for programs.
#pragma once
#include <cstdio>
#include <memory>
#include <string>
#include <vector>
#include "engine/io/frame.h"
#include "engine/io/hdf5.h"

namespace skred {

class StatisticsWriter {
 public:
  // Makes both files in the folder. Throws IoError.
  explicit StatisticsWriter(const std::string& folder);
  ~StatisticsWriter();                   // closes as well as it can

  // Adds a row. The first row names the columns: `name [unit]` in the CSV, a dataset `name` with attribute "units" in HDF5.
  // Numbers are written so that they read back as the same bits. The CSV is up to date after every row, the HDF5 file within
  // a second. Throws std::invalid_argument if names differ from the first row's or would not do as a CSV header, IoError.
  void append(const StatisticsRow& row);
  void close();                          // throws IoError, unless append() has already told of one

 private:
  struct CloseFile { void operator()(std::FILE* f) const { std::fclose(f); } };
  void start(const StatisticsRow& row);
  void write_line(const std::string& line);
  void write_waiting();

  std::string csv_path_;
  std::unique_ptr<std::FILE, CloseFile> csv_;
  Hdf5File hdf5_;
  std::vector<std::string> names_;
  std::vector<Hdf5Dataset> datasets_;
  std::vector<std::vector<double>> waiting_;         // by column: rows not yet in the HDF5 file
  std::int64_t written_at_ = 0;          // [ns] steady clock
  bool failed_ = false;
};

}  // namespace skred
