#include "scenes/interrupt.h"
#include <csignal>
#include <unistd.h>
#include "scenes/errors.h"

namespace skred {

namespace {

volatile std::sig_atomic_t signals = 0;
struct sigaction old_interrupt, old_terminate;

void on_signal(int) {
  if (signals) {
    constexpr char text[] = "\nskred: interrupted twice, ending at once; the last frame may be missing\n";
    [[maybe_unused]] const auto written = write(STDERR_FILENO, text, sizeof text - 1);
    _exit(exit_interrupted);
  }
  signals = 1;
}

}  // namespace

InterruptGuard::InterruptGuard() {
  signals = 0;
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, &old_interrupt);
  sigaction(SIGTERM, &action, &old_terminate);
}

InterruptGuard::~InterruptGuard() {
  sigaction(SIGINT, &old_interrupt, nullptr);
  sigaction(SIGTERM, &old_terminate, nullptr);
}

bool InterruptGuard::asked() const { return signals != 0; }

}  // namespace skred
