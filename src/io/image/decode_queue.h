// Tasks that run beside the reading of a scene: textures that are decoded and made.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/worker_pool.h"

namespace whit {

// Starts tasks at once on up to threads - 1 workers; the caller of finish() is the last worker. A
// task that throws Error(limit) is run once more, alone, when all others have ended: what it lacked
// may have been what they held. So tasks must be fit to be run again.
class DecodeQueue {
 public:
  // threads 0: as many as the machine has for this process.
  DecodeQueue(int threads, Progress* progress, std::string phase);
  ~DecodeQueue();  // forgets tasks that have not begun, waits for those that have
  DecodeQueue(const DecodeQueue&) = delete;
  DecodeQueue& operator=(const DecodeQueue&) = delete;

  // Before finish(). Throws as WorkerPool does.
  void add(std::function<void()> task);
  // Returns when every task has ended. Rethrows the exception of the task that was added first,
  // whatever the order in which they failed.
  void finish();

 private:
  void work();
  void close();
  void runOne(std::unique_lock<std::mutex>& lock);
  void runAgain(std::unique_lock<std::mutex>& lock);
  void end(std::size_t index, std::exception_ptr failure, std::unique_lock<std::mutex>& lock);

  Progress* progress_;
  std::string phase_;
  int threads_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<std::function<void()>> tasks_;
  std::vector<std::exception_ptr> failures_;
  std::vector<std::size_t> postponed_;
  std::size_t begun_ = 0, ended_ = 0;
  bool closing_ = false;  // no more tasks come
  const std::function<void(int)> job_ = [this](int) { work(); };
  std::optional<WorkerPool> pool_;  // from the first task on
  bool running_ = false;            // the pool, between its begin() and finish()
};

}  // namespace whit
