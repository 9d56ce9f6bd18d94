// engine/io/hdf5_error.cpp - finds the system's reason in the error stack.
#include "engine/io/hdf5_error.h"
#include <hdf5.h>
#include "engine/io/io_error.h"

namespace skred {
namespace {

struct Story { std::string reason, innermost; };

// The file driver describes a failed system call in words like "..., errno = 28, error message = 'No space left on device', ...".
extern "C" herr_t collect(unsigned, const H5E_error2_t* entry, void* data) {
  auto& story = *static_cast<Story*>(data);
  const std::string text = entry->desc ? entry->desc : "";
  constexpr const char* mark = "error message = '";
  if (const auto at = text.find(mark); at != std::string::npos) {
    const auto begin = at + std::char_traits<char>::length(mark);
    story.reason = text.substr(begin, text.find('\'', begin) - begin);
  }
  if (!text.empty()) story.innermost = text;
  return 0;
}

}  // namespace

void quiet_hdf5() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

void throw_hdf5_error(const std::string& file, const std::string& action) {
  Story story;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, collect, &story);
  H5Eclear2(H5E_DEFAULT);
  std::string message = file + ": cannot " + action + ": ";
  message += !story.reason.empty() ? story.reason : !story.innermost.empty() ? story.innermost : "unknown HDF5 error";
  if (story.innermost.find(" lock ") != std::string::npos)
    message += " (the file system may not support locks, or another program has the file open; try HDF5_USE_FILE_LOCKING=FALSE)";
  throw IoError(message);
}

}  // namespace skred
