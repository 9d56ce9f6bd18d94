// profiling/write_file.h - writes a text file and tells why if it cannot.
#pragma once
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <stdexcept>
#include <string>

namespace skred {

// Calls write(stream) on the opened file. Throws std::runtime_error with the path and the reason, a full disk included.
template <class Write> void write_file(const std::string& path, const Write& write) {
  const auto fail = [&](const char* what) {
    const char* reason = errno ? std::strerror(errno) : "unknown reason";
    throw std::runtime_error(std::string("cannot ") + what + " '" + path + "': " + reason);
  };
  errno = 0;
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  if (!file) fail("create");
  write(static_cast<std::ostream&>(file));
  file.close();
  if (!file) fail("write");
}

// May a file be written there? Leaves it as it is. No path, no file. Throws std::runtime_error with the path and the reason.
inline void check_writable(const std::string& path) {
  if (path.empty()) return;
  std::error_code ignored;
  const bool there = std::filesystem::exists(path, ignored);
  errno = 0;
  if (!std::ofstream(path, std::ios::app)) throw std::runtime_error(path + ": cannot be written: " + std::strerror(errno));
  if (!there) std::filesystem::remove(path, ignored);
}

}  // namespace skred
