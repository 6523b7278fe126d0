#include "io/texture_loader.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

namespace whit {
namespace {

class Recorder : public Progress {
 public:
  void report(const std::string&, double fraction) override {
    const std::lock_guard lock(mutex_);
    last_ = std::max(last_, fraction);
    ++reports_;
  }

  std::mutex mutex_;
  double last_ = 0;
  int reports_ = 0;
};

TEST(DecodeQueue, RunsEveryTaskOnceForAnyNumberOfThreads) {
  for (const int threads : {1, 2, 8}) {
    Recorder progress;
    std::vector<std::atomic<int>> runs(100);
    DecodeQueue queue(threads, &progress, "counting");
    for (auto& run : runs) queue.add([&run] { ++run; });
    queue.finish();
    for (const auto& run : runs) EXPECT_EQ(run, 1);
    EXPECT_EQ(progress.last_, 1.0);
    EXPECT_EQ(progress.reports_, 100);
  }
}

TEST(DecodeQueue, ReportsTheFirstFailureInTheOrderOfAdding) {
  for (const int threads : {1, 4}) {
    DecodeQueue queue(threads, nullptr, "failing");
    for (int i = 0; i < 20; ++i) {
      queue.add([i] {
        if (i >= 5) throw std::runtime_error(std::to_string(i));
      });
    }

    try {
      queue.finish();
      FAIL();
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "5");
    }
  }
}

// An observer may end the work by an exception, on any thread.
class Impatient : public Progress {
 public:
  void report(const std::string&, double) override { throw std::runtime_error("enough"); }
};

TEST(DecodeQueue, WhatAnObserverThrowsReachesTheCallerOfFinish) {
  for (const int threads : {1, 2, 8}) {
    Impatient progress;
    std::atomic<int> runs{0};
    DecodeQueue queue(threads, &progress, "counting");

    for (int i = 0; i < 50; ++i) queue.add([&] { ++runs; });
    EXPECT_THROW(queue.finish(), std::runtime_error) << threads;
    // Each thread ends with the first task that it reports; no other task is begun then.
    EXPECT_GE(runs, 1);
    EXPECT_LE(runs, threads);
  }
}

TEST(DecodeQueue, WithoutTasksReportsNothing) {
  Recorder progress;
  {
    DecodeQueue dropped(2, &progress, "never asked for");
    DecodeQueue finished(2, &progress, "asked for");
    finished.finish();
  }
  EXPECT_EQ(progress.reports_, 0);
}

TEST(DecodeQueue, MayBeDroppedUnfinished) {
  std::atomic<int> runs{0};
  {
    DecodeQueue queue(3, nullptr, "dropped");
    for (int i = 0; i < 50; ++i) {
      queue.add([&] {
        ++runs;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
      });
    }
  }

  // Tasks that were not started when the queue was dropped are not run; all would take 0.8 s.
  EXPECT_LT(runs, 50);
}

}  // namespace
}  // namespace whit
