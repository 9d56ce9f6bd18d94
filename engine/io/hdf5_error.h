// engine/io/hdf5_error.h - turns the error stack of the HDF5 library into one sentence.
#pragma once
#include <cstdint>
#include <string>

namespace skred {

// Keeps the library from printing; every file opened through us calls it.
void quiet_hdf5();

// Throws IoError "FILE: cannot ACTION: REASON" from the library's present error stack, and clears the stack.
[[noreturn]] void throw_hdf5_error(const std::string& file, const std::string& action);

// Passes on what a library call gave back; negative means that it failed.
template <class Result> Result hdf5_check(Result result, const std::string& file, const std::string& action) {
  if (result < 0) throw_hdf5_error(file, action);
  return result;
}

}  // namespace skred
