// tests/engine/io/faults.h - makes writing fail, in a child process so that nothing else suffers.
#pragma once
#include <functional>
#include <gtest/gtest.h>
#include <sched.h>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace skred::faults {

inline constexpr int not_permitted = 77;

// Runs `body` in a child; it returns "" if all is well, else what is wrong. Gives the same back; "killed" if it died.
inline std::string in_child(const std::function<std::string()>& body) {
  int ends[2];
  if (::pipe(ends) != 0) return "no pipe";
  const pid_t child = ::fork();
  if (child == 0) {
    std::string wrong;
    try {
      wrong = body();
    } catch (const std::exception& e) {
      wrong = std::string("exception: ") + e.what();
    }
    const bool told = ::write(ends[1], wrong.data(), wrong.size()) == ssize_t(wrong.size());
    ::_exit(told ? 0 : 1);               // no destructors: they belong to the parent's test
  }
  ::close(ends[1]);
  std::string wrong;
  char buffer[4096];
  for (ssize_t n; (n = ::read(ends[0], buffer, sizeof buffer)) > 0;) wrong.append(buffer, std::size_t(n));
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? wrong : wrong + " (killed)";
}

// No file may grow beyond this: write() then fails with "File too large". For a child.
inline void limit_file_size(rlim_t bytes) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{bytes, bytes};
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

// Puts a file system of that size on `folder`, seen by this process only. For a child; false where that is not permitted.
inline bool mount_small_disk(const std::string& folder, std::size_t bytes) {
  if (::unshare(CLONE_NEWNS) != 0 || ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) return false;
  return ::mount("skred_test", folder.c_str(), "tmpfs", 0, ("size=" + std::to_string(bytes)).c_str()) == 0;
}

// The message that `action` throws as an Error; "" if it throws nothing.
template <class Error> std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

}  // namespace skred::faults
