// profiling/bench/child.h - work in a process of its own, so that its peak memory is that of the work alone.
//
// This program's process starts no threads before it forks, or a child could inherit a lock that nobody holds.
#pragma once
#include <functional>
#include <string>
#include <nlohmann/json.hpp>
#include <sys/types.h>

namespace skred {

class InterruptGuard;

struct Interrupted {};                       // thrown when Ctrl-C ended what was waited for

class Child {
 public:
  using Answer = std::function<nlohmann::json(const nlohmann::json&)>;

  // Forks. The child calls `start` once and then its answer for every request. It ends with this object, or with this process.
  Child(const std::function<Answer()>& start, const InterruptGuard&);
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child();

  // Sends a request and waits for the answer. Throws ToldFailure if the child threw or ended, Interrupted.
  nlohmann::json ask(const nlohmann::json& request = nullptr);

 private:
  std::string receive();
  const InterruptGuard& interrupt_;
  pid_t process_ = -1;
  int socket_ = -1;
};

// Runs work in a child and waits for its end. Throws as Child::ask does.
void in_child(const std::function<void()>& work, const InterruptGuard&);

}  // namespace skred
