#include "core/worker_pool.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/error.h"
#include "sanitized.h"

namespace whit::test {
namespace {

using Job = std::function<void(int)>;

TEST(WorkerPool, EveryWorkerRunsOnceARun) {
  for (const int workers : {1, 2, 3, 8}) {
    WorkerPool pool(workers);
    // The integers are plain, one a worker, so that the thread sanitizer sees a missing barrier as
    // a data race.
    std::vector<int> calls(workers);

    for (int round = 1; round <= 200; ++round) {
      pool.run([&](int worker) { ++calls[worker]; });
      ASSERT_EQ(calls, std::vector<int>(workers, round));
    }
  }
}

TEST(WorkerPool, AnExceptionReachesTheCallerAndThePoolLivesOn) {
  WorkerPool pool(2);
  for (const int thrower : {0, 1}) {
    EXPECT_THROW(pool.run([&](int worker) {
      if (worker == thrower) throw std::runtime_error("from a worker");
    }),
                 std::runtime_error);
  }

  std::atomic<int> calls{0};
  pool.run([&](int) { ++calls; });
  EXPECT_EQ(calls, 2);
}

// Calls `body` in a forked child and returns the child's exit status: that of body, or -1 if a
// signal ended the child, also that of the alarm after ten seconds.
int statusOfChild(const std::function<int()>& body) {
  const pid_t child = fork();
  if (child == 0) {
    alarm(10);
    _exit(body());
  }

  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(WorkerPool, AForkedChildStartsWorkersOfItsOwn) {
  if (kSanitized) GTEST_SKIP() << "sanitizers allow no threads in a forked child";
  WorkerPool pool(3);
  std::vector<int> calls(3);
  const Job job = [&](int w) { ++calls[w]; };
  pool.run(job);
  EXPECT_EQ(statusOfChild([&] {
              WorkerPool copy(2);  // the parent's pool is left alone while others are used
              copy.run(job);
              for (int round = 0; round < 3; ++round) pool.run(job);
              return calls == std::vector<int>{5, 5, 4} ? 0 : 1;
            }),
            0);

  pool.run(job);
  EXPECT_EQ(calls, (std::vector<int>{2, 2, 2}));
}

TEST(WorkerPool, AForkedChildCannotFinishTheWorkOfItsParent) {
  if (kSanitized) GTEST_SKIP() << "sanitizers allow no threads in a forked child";
  auto pool = std::make_unique<WorkerPool>(2);
  const Job job = [](int) {};

  pool->begin(job);
  EXPECT_EQ(statusOfChild([&] {
              try {
                pool->finish();
              } catch (const Error& error) {
                pool.reset();
                return static_cast<int>(error.status());
              }
              return 0;
            }),
            static_cast<int>(ExitStatus::usage));
  pool->finish();
}

TEST(WorkerPool, TheCallerMayWorkBetweenBeginAndFinish) {
  for (const int workers : {1, 2, 4}) {
    WorkerPool pool(workers);
    for (int round = 0; round < 20; ++round) {
      std::vector<int> calls(workers);
      std::atomic<bool> ready{false};
      const Job job = [&](int worker) {
        while (!ready) std::this_thread::yield();
        ++calls[worker];
      };

      pool.begin(job);
      ready = true;  // a begin() that waited for the job would never get here
      EXPECT_EQ(calls[0], 0);
      pool.finish();
      EXPECT_EQ(calls, std::vector<int>(workers, 1));
    }
  }
}

TEST(ParallelFor, EveryIndexOnceByWorkersOfTheirOwn) {
  for (const int threads : {0, 1, 3, 8}) {
    for (const std::size_t count : {0, 1, 1000}) {
      std::vector<int> done(count);
      std::vector<std::size_t> ofWorker(std::max(threads, 1));

      parallelFor(threads, count, [&](std::size_t i, int worker) {
        ++done.at(i);
        ++ofWorker.at(worker);
      });

      EXPECT_EQ(done, std::vector<int>(count, 1));
      EXPECT_EQ(std::accumulate(ofWorker.begin(), ofWorker.end(), std::size_t{0}), count);
    }
  }
}

TEST(ParallelFor, WhatIsThrownEndsTheLoopAndReachesTheCaller) {
  for (const int threads : {1, 2, 5}) {
    std::atomic<int> calls{0};
    EXPECT_THROW(parallelFor(threads, 1000000,
                             [&](std::size_t i, int) {
                               ++calls;
                               if (i == 3) throw std::runtime_error("at three");
                             }),
                 std::runtime_error);
    EXPECT_LT(calls, 1000000) << threads;
  }
}

// Returns a denormal product of factors that the compiler cannot see.
float denormalProduct() {
  const volatile float tiny = std::numeric_limits<float>::min();
  const volatile float half = 0.5f;
  return tiny * half;
}

TEST(WorkerPool, H55_denormalsAreFlushedInEveryWorkerAndNowhereElse) {
  const auto products = [](WorkerPool&& pool) {
    std::vector<float> ofWorkers(3, -1);
    pool.run([&](int worker) { ofWorkers[worker] = denormalProduct(); });
    return ofWorkers;
  };
  const std::vector<float> kept(3, denormalProduct());
  ASSERT_GT(kept[0], 0);
  EXPECT_EQ(products(WorkerPool(3)), std::vector<float>(3));
  EXPECT_GT(denormalProduct(), 0);
  EXPECT_EQ(products(WorkerPool(3, Denormals::kept)), kept);
}

// Some threads can be started and others cannot. The started ones are ended in order.
TEST(WorkerPoolDeathTest, NoRoomForThreadsIsALimit) {
  if (kSanitized) GTEST_SKIP() << "addresses cannot be limited under this sanitizer";
  const auto fillUp = [] {
    rlimit stack{};
    getrlimit(RLIMIT_STACK, &stack);
    const rlim_t room = stack.rlim_cur == RLIM_INFINITY ? rlim_t{64} << 20 : 8 * stack.rlim_cur;
    const rlimit addresses{room, room};
    setrlimit(RLIMIT_AS, &addresses);

    try {
      const WorkerPool pool(1000);
    } catch (const Error& error) {
      std::exit(error.status() == ExitStatus::limit ? 7 : 8);
    }
    std::exit(9);
  };
  EXPECT_EXIT(fillUp(), testing::ExitedWithCode(7), "");
}

}  // namespace
}  // namespace whit::test
