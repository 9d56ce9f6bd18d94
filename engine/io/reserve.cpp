// engine/io/reserve.cpp - fallocate(2), and statvfs(3) where it is not supported.
#include "engine/io/reserve.h"
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include "engine/io/io_error.h"

namespace skred {
namespace {

// 0, or why not.
int set_aside(const std::string& file, std::size_t bytes) {
#ifdef __linux__
  const int fd = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
  if (fd < 0) return EOPNOTSUPP;
  struct stat now {};
  int reason = ::fstat(fd, &now) == 0 ? 0 : errno;
  rlimit most{};           // of the process; fallocate does not look at it where the size stays
  if (reason == 0 && ::getrlimit(RLIMIT_FSIZE, &most) == 0 && std::uint64_t(now.st_size) + bytes > most.rlim_cur) reason = EFBIG;
  if (reason == 0 && ::fallocate(fd, FALLOC_FL_KEEP_SIZE, now.st_size, off_t(bytes)) != 0) reason = errno;
  ::close(fd);
  return reason;
#else
  return EOPNOTSUPP;
#endif
}

}  // namespace

void reserve_space(const std::string& file, std::size_t bytes, const std::string& action) {
  const int reason = set_aside(file, bytes);
  if (reason == 0) return;
  std::error_code error;
  const auto space = std::filesystem::space(file, error);
  const bool full = reason == ENOSPC || reason == EDQUOT || reason == EFBIG;
  if (!full && (error || space.available >= bytes)) return;
  const auto kib = [](std::uintmax_t n) { return std::to_string(n >> 10) + " KiB"; };
  throw IoError(file + ": cannot write " + action + ": " + std::strerror(full ? reason : ENOSPC) + " (needs " +
                kib(bytes + 1023) + (error || reason == EFBIG ? "" : ", " + kib(space.available) + " are free") + ")");
}

}  // namespace skred
