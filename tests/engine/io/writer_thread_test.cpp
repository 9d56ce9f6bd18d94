// tests/engine/io/writer_thread_test.cpp - order, blocking, failures.
#include "engine/io/writer_thread.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <atomic>
#include <chrono>
#include <future>
#include <numeric>
#include <vector>
#include "engine/io/io_error.h"

using namespace skred;
using namespace std::chrono_literals;

TEST(WriterThread, DoesAllJobsInOrderOnOneOtherThread) {
  std::vector<int> done;
  std::thread::id writer;
  WriterThread thread;
  for (int k = 0; k < 100; ++k)
    thread.push([&, k] {
      done.push_back(k);
      writer = std::this_thread::get_id();
    });
  thread.finish();
  std::vector<int> expected(100);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(done, expected);
  EXPECT_NE(writer, std::this_thread::get_id());
  EXPECT_THROW(thread.push([] {}), std::logic_error);
  EXPECT_NO_THROW(thread.finish());
}

TEST(WriterThread, PushBlocksWhileTwoJobsWait) {
  std::promise<void> gate, started;
  WriterThread thread(2);
  thread.push([&] {
    started.set_value();
    gate.get_future().wait();
  });
  started.get_future().wait();           // the first job is being done: two more may wait
  thread.push([] {});
  thread.push([] {});
  std::atomic<bool> pushed = false;
  std::thread fourth([&] {
    thread.push([] {});
    pushed = true;
  });
  std::this_thread::sleep_for(50ms);
  EXPECT_FALSE(pushed);
  gate.set_value();
  fourth.join();
  EXPECT_TRUE(pushed);
  thread.finish();
}

TEST(WriterThread, DrainWaitsForTheJobThatIsBeingDone) {
  std::atomic<int> done = 0;
  WriterThread thread;
  thread.drain();
  for (int k = 0; k < 2; ++k)
    thread.push([&] {
      std::this_thread::sleep_for(10ms);
      ++done;
    });
  thread.drain();
  EXPECT_EQ(done, 2);
  thread.push([] { throw IoError("disk full"); });
  EXPECT_THROW(thread.drain(), IoError);
  EXPECT_NO_THROW(thread.finish());
}

TEST(WriterThread, AFailureReachesThePusherAndStopsTheRest) {
  std::atomic<int> done = 0;
  WriterThread thread;
  thread.push([] { throw IoError("disk full"); });
  int pushes = 0;
  std::string message;
  while (message.empty() && pushes < 1000) {
    try {
      thread.push([&] { ++done; });
      ++pushes;
      std::this_thread::sleep_for(1ms);
    } catch (const IoError& e) {
      message = e.what();
    }
  }
  EXPECT_EQ(message, "disk full");
  EXPECT_THROW(thread.push([&] { ++done; }), IoError);           // and again
  EXPECT_NO_THROW(thread.finish());                              // told already
  EXPECT_EQ(done, 0);
}

TEST(WriterThread, FinishTellsOfAFailureOfTheLastJob) {
  WriterThread thread;
  thread.push([] { throw IoError("disk full"); });
  EXPECT_THROW(thread.finish(), IoError);
  EXPECT_NO_THROW(thread.finish());
}

TEST(WriterThread, APusherThatWaitsHearsOfAFailure) {
  std::promise<void> gate;
  WriterThread thread(1);
  thread.push([&] {
    gate.get_future().wait();
    throw IoError("disk full");
  });
  std::thread opener([&] {
    std::this_thread::sleep_for(20ms);
    gate.set_value();
  });
  EXPECT_THROW(for (int k = 0; k < 3; ++k) thread.push([] {}), IoError);
  opener.join();
}

TEST(WriterThread, HooksSurroundEveryJob) {
  std::vector<std::string> events;
  {
    WriterThread thread(2, {[&] { events.push_back("before"); }, [&] { events.push_back("after"); }});
    thread.push([&] { events.push_back("job"); });
    thread.push([&] {
      events.push_back("bad job");
      throw IoError("disk full");
    });
  }                                      // the destructor does what is waiting and throws nothing
  EXPECT_THAT(events, testing::ElementsAre("before", "job", "after", "before", "bad job", "after"));
  EXPECT_THROW(WriterThread(0), std::invalid_argument);
}
