#include "profiling/bench/child.h"
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include "engine/io/io_error.h"
#include "scenes/errors.h"
#include "scenes/failure.h"
#include "scenes/interrupt.h"

namespace skred {

using nlohmann::json;

namespace {

// One message is one line. False: the other end is gone.
bool send_line(int socket, const json& message) {
  const std::string text = message.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t n = ::send(socket, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    sent += std::size_t(n);
  }
  return true;
}

// "" at the end. `stop` is asked when a signal came while waiting.
std::string receive_line(int socket, const std::function<bool()>& stop) {
  std::string line;
  char buffer[65536];
  while (true) {
    pollfd waiting{socket, POLLIN, 0};
    if (::poll(&waiting, 1, 500) < 0 && errno != EINTR) return "";
    if (stop()) return "";
    if (!(waiting.revents & (POLLIN | POLLHUP | POLLERR))) continue;
    const ssize_t n = ::recv(socket, buffer, sizeof buffer, 0);      // requests and answers take turns: at most one line waits
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return "";
    line.append(buffer, std::size_t(n));
    if (line.back() == '\n') return line;
  }
}

[[noreturn]] void serve(int socket, const std::function<Child::Answer()>& start) {
  ::signal(SIGINT, SIG_DFL);                         // the parent tells what was interrupted
  ::signal(SIGTERM, SIG_DFL);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const auto attempt = [](const std::function<json()>& work) -> json {
    try {
      return {{"answer", work()}};
    } catch (const std::exception& e) {
      const Failure f = failure_of(e);
      return {{"code", f.code}, {"text", f.text}};
    }
  };
  Child::Answer answer;
  for (std::string line; !(line = receive_line(socket, [] { return false; })).empty();) {
    const json reply = attempt([&] {
      if (!answer) answer = start();
      return answer(json::parse(line));
    });
    std::fflush(nullptr);
    if (!send_line(socket, reply)) break;
  }
  ::_exit(0);                                        // the parent's buffers and handlers at exit are not ours
}

}  // namespace

Child::Child(const std::function<Answer()>& start, const InterruptGuard& interrupt) : interrupt_(interrupt) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0)
    throw IoError(std::string("cannot start a process: ") + std::strerror(errno));
  std::fflush(nullptr);
  process_ = ::fork();
  if (process_ == 0) {
    ::close(ends[0]);
    serve(ends[1], start);
  }
  const int reason = errno;
  ::close(ends[1]);
  socket_ = ends[0];
  if (process_ > 0) return;
  ::close(socket_);
  throw IoError(std::string("cannot start a process: ") + std::strerror(reason));
}

Child::~Child() {
  if (interrupt_.asked()) ::kill(process_, SIGKILL);
  ::shutdown(socket_, SHUT_RDWR);                    // close() alone leaves it open in children that were forked later
  ::close(socket_);
  ::waitpid(process_, nullptr, 0);
}

json Child::ask(const json& request) {
  const bool sent = send_line(socket_, request);
  const std::string line = sent ? receive_line(socket_, [&] { return interrupt_.asked(); }) : "";
  if (interrupt_.asked()) throw Interrupted{};
  if (line.empty()) throw ToldFailure({exit_io, "skred: error: the process that ran the scene was killed; out of memory?"});
  const json reply = json::parse(line);
  if (reply.contains("code")) throw ToldFailure({reply["code"].get<int>(), reply["text"].get<std::string>()});
  return reply["answer"];
}

void in_child(const std::function<void()>& work, const InterruptGuard& interrupt) {
  Child child([&] { return [&](const json&) { work(); return json(); }; }, interrupt);
  child.ask();
}

}  // namespace skred
