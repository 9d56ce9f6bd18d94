// engine/io/io_error.h - a file could not be read or written: the message names the file and the system's reason.
#pragma once
#include <stdexcept>

namespace skred {

struct IoError : std::runtime_error { using std::runtime_error::runtime_error; };

}  // namespace skred
