#include "scenes/machine.h"
#include <cstdlib>
#include <fstream>
#include <sys/resource.h>
#include <unistd.h>

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

std::string compiler_flags() { return SKRED_COMPILER_FLAGS; }
std::string build_type() { return SKRED_BUILD_TYPE; }
std::string source_commit() { return SKRED_COMMIT; }

double load_average() {
  double load = -1;
  return getloadavg(&load, 1) == 1 ? load : -1;
}

double peak_memory() {
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  return 1024.0 * double(use.ru_maxrss);
}

double resident_memory() {
  std::ifstream statm("/proc/self/statm");           // pages: all, resident, ...
  double all = 0, resident = 0;
  return statm >> all >> resident ? resident * double(sysconf(_SC_PAGESIZE)) : 0;
}

}  // namespace skred
