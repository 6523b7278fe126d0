// Work shared among threads: a fixed team of threads that runs one function together, and loops
// shared out one index at a time.
#pragma once

#include <sys/types.h>
#include <unistd.h>

#include <barrier>
#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace whit {

// Treatment of denormal numbers by the workers.
enum class Denormals { kept, flushed };

// A run has two barriers. Threads that wait at one sleep rather than spin on, so that a core taken
// by another program costs no more than its share. In a child that was forked between two runs, the
// next run starts new workers.
class WorkerPool {
 public:
  // `workers` including the calling thread; at least 1. Throws Error(limit) where the system has no
  // room for so many.
  explicit WorkerPool(int workers, Denormals denormals = Denormals::flushed);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  int workers() const { return workers_; }

  // Calls job(0) .. job(workers() - 1), each on a thread of its own (0 on the caller's), and
  // returns when all are done. Rethrows the first exception. Not reentrant.
  void run(const std::function<void(int)>& job);

  // The two halves of run(), for a caller that has something else to do in between: begin() lets
  // workers 1 and up go, finish() calls job(0), waits for them and rethrows. `job` must live until
  // then; between the two the pool must not be destroyed.
  void begin(const std::function<void(int)>& job);
  void begin(const std::function<void(int)>&& job) = delete;
  void finish();

 private:
  struct Team {
    explicit Team(int workers) : start(workers), finish(workers) {}
    std::barrier<> start, finish;
    std::mutex mutex;
    std::vector<std::thread> threads;
    pid_t process = getpid();  // a child of this process has no threads of the team
  };

  void work(int worker);
  void call(int worker) noexcept;
  void startWorkers();
  void stopWorkers();

  // Leaks the team of a parent process, because destructors would wait for its threads.
  void forgetParentsTeam() {
    if (!hasTeam()) static_cast<void>(team_.release());
  }
  bool hasTeam() const { return team_ && team_->process == getpid(); }

  int workers_;
  Denormals denormals_;
  const std::function<void(int)>* job_ = nullptr;  // null: the workers end
  std::exception_ptr error_;
  std::unique_ptr<Team> team_;  // null after it could not be started
};

// Calls task(i, worker) once for every i below `count`, in this order as workers become free, on
// up to `threads` threads; worker is below that. An exception ends the loop; the first one is
// rethrown to the caller. Denormals are kept. Throws as WorkerPool does.
void parallelFor(int threads, std::size_t count,
                 const std::function<void(std::size_t i, int worker)>& task);

}  // namespace whit
