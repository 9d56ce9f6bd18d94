// scenes/machine.h - what a result was computed on and with.
#pragma once
#include <string>

namespace skred {

std::string processor_name();        // as the system calls it
std::string compiler_name();
std::string compiler_flags();        // of the build, for C++
std::string build_type();            // "Release"
std::string source_commit();         // of the sources when the build was configured; empty if unknown. It sees no later change
double load_average();               // of the last minute; negative if unknown
double peak_memory();                // [byte] of this process
double resident_memory();            // [byte] of this process, now; 0 if unknown

}  // namespace skred
