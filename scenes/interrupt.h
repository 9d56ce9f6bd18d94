// scenes/interrupt.h - Ctrl-C and SIGTERM: the first asks the run to finish its step, write and end; the second ends it at once.
#pragma once

namespace skred {

class InterruptGuard {
 public:
  InterruptGuard();                 // takes the signals over, and gives them back at the end
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  bool asked() const;               // a signal has come
};

}  // namespace skred
