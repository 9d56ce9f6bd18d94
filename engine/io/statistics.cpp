// engine/io/statistics.cpp - a line of text per row, and datasets that grow about once a second.
#include "engine/io/statistics.h"
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace skred {
namespace {

constexpr std::int64_t write_interval = 1'000'000'000;     // [ns]
std::int64_t now() { return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::string text_of(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};     // shortest text that reads back the same
}

std::FILE* create(const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "we");
  if (!file) throw IoError(path + ": cannot create the file: " + std::strerror(errno));
  return file;
}

std::string path_in(const std::string& folder, const char* name) { return (std::filesystem::path(folder) / name).string(); }

}  // namespace

StatisticsWriter::StatisticsWriter(const std::string& folder)
    : csv_path_(path_in(folder, "statistics.csv")), csv_(create(csv_path_)), hdf5_(path_in(folder, "statistics.h5")) {
  hdf5_.commit();
}

StatisticsWriter::~StatisticsWriter() {
  try {
    close();
  } catch (...) {                        // close() is the way to hear of it
  }
}

void StatisticsWriter::write_line(const std::string& line) {
  if (std::fwrite(line.data(), 1, line.size(), csv_.get()) == line.size() && std::fflush(csv_.get()) == 0) return;
  throw IoError(csv_path_ + ": cannot write the file: " + std::strerror(errno));
}

void StatisticsWriter::start(const StatisticsRow& row) {
  std::string header;
  if (row.values.empty()) throw std::invalid_argument("statistics: a row without values");
  for (const auto& [name, unit, value] : row.values) {
    if (name.empty() || name.find('/') != std::string::npos || (name + unit).find_first_of(",\"\r\n") != std::string::npos)
      throw std::invalid_argument("statistics: '" + name + "' cannot name a column");
    header += (header.empty() ? "" : ",") + name + " [" + unit + "]";
    names_.push_back(name);
  }
  for (const auto& [name, unit, value] : row.values)
    datasets_.push_back(hdf5_.dataset("/" + name, Hdf5Number::real64, {.unit = unit}));
  waiting_.resize(names_.size());
  write_line(header + "\n");
}

void StatisticsWriter::append(const StatisticsRow& row) {
  if (!csv_) throw std::logic_error("StatisticsWriter: append() after close()");
  if (failed_) throw IoError(csv_path_ + ": an earlier row could not be written");
  bool same = names_.empty() || names_.size() == row.values.size();
  for (std::size_t k = 0; same && k < names_.size(); ++k) same = names_[k] == row.values[k].name;
  if (!same) throw std::invalid_argument("statistics: the row's names are not those of the first row");
  try {
    if (names_.empty()) start(row);
    std::string line;
    for (std::size_t k = 0; k < names_.size(); ++k) {
      line += (k ? "," : "") + text_of(row.values[k].value);
      waiting_[k].push_back(row.values[k].value);
    }
    write_line(line + "\n");
    if (now() - written_at_ >= write_interval) write_waiting();
  } catch (...) {
    failed_ = true;
    throw;
  }
}

void StatisticsWriter::write_waiting() {
  for (std::size_t k = 0; k < datasets_.size(); ++k) {
    datasets_[k].append(waiting_[k]);
    waiting_[k].clear();
  }
  hdf5_.commit();
  written_at_ = now();
}

void StatisticsWriter::close() {
  if (!csv_) return;
  csv_.reset();                          // every row was flushed
  if (failed_) return;
  write_waiting();
  hdf5_.close();
}

}  // namespace skred
