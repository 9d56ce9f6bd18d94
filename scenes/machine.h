// scenes/machine.h - what a result was computed on and with.
#pragma once
#include <string>

namespace skred {

std::string processor_name();        // as the system calls it
std::string compiler_name();
double load_average();               // of the last minute; negative if unknown
double peak_memory();                // [byte] of this process

}  // namespace skred
