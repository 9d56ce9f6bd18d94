// engine/io/writer_thread.cpp - a bounded queue and the thread that empties it.
#include "engine/io/writer_thread.h"
#include <stdexcept>
#include <utility>

namespace skred {

WriterThread::WriterThread(std::size_t capacity, Hooks hooks) : capacity_(capacity), hooks_(std::move(hooks)) {
  if (capacity < 1) throw std::invalid_argument("WriterThread: a capacity of 0 lets no job wait; at least 1");
  thread_ = std::thread([this] { run(); });
}

WriterThread::~WriterThread() { end(); }

void WriterThread::run() {
  for (std::unique_lock lock(mutex_);;) {
    work_.wait(lock, [&] { return ending_ || !jobs_.empty(); });
    if (jobs_.empty()) return;
    Job job = std::move(jobs_.front());
    jobs_.pop_front();
    room_.notify_one();
    if (failure_) continue;              // what follows a lost frame is not written
    busy_ = true;
    lock.unlock();
    std::exception_ptr failure;
    if (hooks_.before) hooks_.before();
    try {
      job();
    } catch (...) {
      failure = std::current_exception();
    }
    if (hooks_.after) hooks_.after();
    job = nullptr;                       // frees the frame it holds before the wait for the next
    lock.lock();
    busy_ = false;
    if (failure) failure_ = failure;
    room_.notify_all();
  }
}

void WriterThread::push(Job job) {
  std::unique_lock lock(mutex_);
  if (ending_) throw std::logic_error("WriterThread: push() after finish()");
  room_.wait(lock, [&] { return failure_ || jobs_.size() < capacity_; });
  rethrow();
  jobs_.push_back(std::move(job));
  work_.notify_one();
}

void WriterThread::drain() {
  std::unique_lock lock(mutex_);
  room_.wait(lock, [&] { return failure_ || (jobs_.empty() && !busy_); });
  rethrow();
}

void WriterThread::rethrow() {
  if (!failure_) return;
  told_ = true;
  std::rethrow_exception(failure_);
}

void WriterThread::end() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  work_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void WriterThread::finish() {
  end();
  if (failure_ && !std::exchange(told_, true)) std::rethrow_exception(failure_);
}

}  // namespace skred
