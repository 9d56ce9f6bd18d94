// engine/io/text_file.cpp - temporary file, fsync, rename, fsync of the folder (Pillai et al. 2014 on why all four).
#include "engine/io/text_file.h"
#include <fcntl.h>
#include <unistd.h>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>
#include "engine/io/io_error.h"

namespace skred {
namespace {

struct Descriptor {
  int fd;
  ~Descriptor() { if (fd >= 0) ::close(fd); }
};

}  // namespace

void write_text_atomically(const std::filesystem::path& path, std::string_view text, Sync sync) {
  const std::string temporary = path.string() + ".tmp";
  const auto fail = [&](const char* action) {
    const int reason = errno;
    ::unlink(temporary.c_str());
    throw IoError(path.string() + ": cannot " + action + ": " + std::strerror(reason));
  };
  Descriptor file{::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)};
  if (file.fd < 0) fail("create the file");
  while (!text.empty()) {
    const ssize_t written = ::write(file.fd, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("write the file");
    text.remove_prefix(std::size_t(written));
  }
  if (sync == Sync::yes && ::fsync(file.fd) != 0) fail("write the file");
  if (::close(std::exchange(file.fd, -1)) != 0) fail("write the file");
  if (std::rename(temporary.c_str(), path.c_str()) != 0) fail("rename the temporary file");
  if (sync == Sync::no) return;
  const auto parent = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  const Descriptor folder{::open(parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  if (folder.fd >= 0) ::fsync(folder.fd);      // some file systems refuse it: the file itself is safe by now
}

}  // namespace skred
