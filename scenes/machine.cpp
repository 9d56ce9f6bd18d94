#include "scenes/machine.h"
#include <cstdlib>
#include <fstream>
#include <sys/resource.h>

namespace skred {

std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name"))
      if (const auto colon = line.find(": "); colon != std::string::npos) return line.substr(colon + 2);
  return "unknown processor";
}

std::string compiler_name() {
#if defined(__clang__)
  return "clang " __clang_version__;
#else
  return "g++ " __VERSION__;
#endif
}

double load_average() {
  double load = -1;
  return getloadavg(&load, 1) == 1 ? load : -1;
}

double peak_memory() {
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  return 1024.0 * double(use.ru_maxrss);
}

}  // namespace skred
