// Runs tasks while a scene is read: textures are decoded and made.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "core/progress.h"
#include "core/worker_pool.h"

namespace whit {

// Starts tasks at once on up to threads - 1 workers; the caller of finish() is the last worker. A
// task that throws Error(limit) is run once more, alone, after all others have ended and given
// their memory back. Tasks must allow to be run again.
class DecodeQueue {
 public:
  // With 0 threads, it uses as many as this process may use.
  DecodeQueue(int threads, Progress* progress, std::string phase);
  ~DecodeQueue();  // drops tasks that have not begun and waits for the others
  DecodeQueue(const DecodeQueue&) = delete;
  DecodeQueue& operator=(const DecodeQueue&) = delete;

  // Call before finish(). Throws as WorkerPool does.
  void add(std::function<void()> task);
  // Returns when every task has ended. Of several failed tasks, the one added first has its
  // exception rethrown, in whatever order they failed.
  void finish();

 private:
  struct Task {
    std::function<void()> work;  // empty after it has ended
    std::exception_ptr failure;
  };

  void work();
  void close();
  void run(Task& task, std::unique_lock<std::mutex>& lock);

  Progress* progress_;
  std::string phase_;
  int threads_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Task> tasks_;  // a deque: references stay valid while more are added
  std::size_t begun_ = 0, ended_ = 0;
  bool closing_ = false;  // no more tasks will be added
  const std::function<void(int)> job_ = [this](int) { work(); };
  std::optional<WorkerPool> pool_;  // from the first task on
  bool running_ = false;            // between begin() and finish() of the pool
};

}  // namespace whit
