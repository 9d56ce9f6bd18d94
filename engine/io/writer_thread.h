// engine/io/writer_thread.h - one thread that does the slow writing, in order, while the simulation goes on.
//
// A failed job (a full disk) stops the rest: its exception comes out of the next push() or finish().
#pragma once
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace skred {

class WriterThread {
 public:
  using Job = std::function<void()>;
  // Called on the writer's thread around every job, also around one that fails; must not throw. For the timeline.
  struct Hooks { std::function<void()> before, after; };

  explicit WriterThread(std::size_t capacity = 2, Hooks hooks = {});   // jobs that may wait, >= 1
  ~WriterThread();                       // does what is waiting; an exception not told yet is lost, so call finish()
  WriterThread(const WriterThread&) = delete;
  WriterThread& operator=(const WriterThread&) = delete;

  // Blocks while `capacity` jobs wait. Throws what an earlier job threw (again at every call; the new job is dropped), and
  // std::logic_error after finish().
  void push(Job job);
  // Waits until no job waits or is being done. Throws what an earlier job threw.
  void drain();
  // Waits for all jobs and ends the thread. Throws what a job threw, unless push() has told of it.
  void finish();

 private:
  void run();
  void end();
  void rethrow();                        // the failure, if there is one
  const std::size_t capacity_;
  const Hooks hooks_;
  std::mutex mutex_;
  std::condition_variable room_, work_;
  std::deque<Job> jobs_;
  std::exception_ptr failure_;
  bool told_ = false, ending_ = false, busy_ = false;
  std::thread thread_;                   // last: it uses all of the above
};

}  // namespace skred
