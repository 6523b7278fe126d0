// A fixed crew of threads that run one function together. Two barriers a run; nobody spins for
// ever, so a stolen core costs its share and no more.
#pragma once

#include <barrier>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace whit {

class WorkerPool {
 public:
  // `workers` including the calling thread; at least 1. Throws Error(limit) where the system has no
  // room for so many.
  explicit WorkerPool(int workers);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  int workers() const { return workers_; }

  // Calls job(0) .. job(workers() - 1), each on a thread of its own (0 on the caller's), and
  // returns when all are done. Rethrows the first exception. While it runs, every worker flushes
  // denormals to zero. Not reentrant.
  void run(const std::function<void(int)>& job);

 private:
  void work(int worker);
  void call(int worker) noexcept;
  void sendHome();

  int workers_;
  std::barrier<> start_, finish_;
  const std::function<void(int)>* job_ = nullptr;  // null: the crew goes home
  std::mutex mutex_;
  std::exception_ptr error_;
  std::vector<std::thread> threads_;
};

// Sets flush-to-zero and denormals-are-zero for the current thread while it lives.
class FlushDenormals {
 public:
  FlushDenormals();
  ~FlushDenormals();
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned long long saved_;
};

// Threads that this process may use at once: its affinity mask, bounded by the cgroup's CPU quota.
int usableThreads();

}  // namespace whit
