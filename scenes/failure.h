// scenes/failure.h - what a failure says on standard error, and the exit code it ends with.
#pragma once
#include <exception>
#include <stdexcept>
#include <string>

namespace skred {

struct Failure { int code; std::string text; };      // the text is whole: with the program's name, or with its own places
Failure failure_of(const std::exception&);

// A failure that was put into words elsewhere: in another process.
struct ToldFailure : std::runtime_error {
  explicit ToldFailure(const Failure& f) : std::runtime_error(f.text), code(f.code) {}
  int code;
};

}  // namespace skred
