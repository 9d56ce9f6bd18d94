// profiling/write_file.h - writes a text file and tells why if it cannot.
#pragma once
#include <cerrno>
#include <cstring>
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

}  // namespace skred
