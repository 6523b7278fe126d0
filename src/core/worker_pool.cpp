#include "core/worker_pool.h"

#include <algorithm>
#include <atomic>
#include <optional>
#include <string>
#include <system_error>

#include "core/error.h"
#include "core/flush_denormals.h"
#include "core/text.h"

namespace whit {

WorkerPool::WorkerPool(int workers, Denormals denormals)
    : workers_(workers), denormals_(denormals) {
  startWorkers();
}

WorkerPool::~WorkerPool() {
  if (hasTeam()) stopWorkers();
  forgetParentsTeam();
}

void WorkerPool::startWorkers() {
  forgetParentsTeam();
  team_ = std::make_unique<Team>(workers_);
  std::vector<std::thread>& threads = team_->threads;

  const auto undo = [&] {
    // The workers that have started leave the barrier; nobody waits for the missing ones.
    for (int i = static_cast<int>(threads.size()) + 1; i < workers_; ++i) {
      team_->start.arrive_and_drop();
    }

    stopWorkers();
    team_.reset();
  };

  try {
    threads.reserve(workers_);
    for (int i = 1; i < workers_; ++i) threads.emplace_back([this, i] { work(i); });
  } catch (const std::system_error& error) {
    undo();
    throwLimit(concat("cannot start ", workers_, " threads: ", error.what()));
  } catch (...) {
    undo();
    throw;
  }
}

void WorkerPool::stopWorkers() {
  job_ = nullptr;
  team_->start.arrive_and_wait();
  for (std::thread& thread : team_->threads) thread.join();
}

void WorkerPool::run(const std::function<void(int)>& job) {
  begin(job);
  finish();
}

void WorkerPool::begin(const std::function<void(int)>& job) {
  if (!hasTeam()) startWorkers();

  job_ = &job;
  error_ = nullptr;
  // The workers wait at this barrier for a job.
  team_->start.arrive_and_wait();
}

void WorkerPool::finish() {
  call(0);
  // A child process has only the thread that forked it, so the barrier would wait for ever.
  if (!hasTeam()) throwUsage("this process was forked while its worker threads had work to do");
  team_->finish.arrive_and_wait();
  if (error_) std::rethrow_exception(error_);
}

void WorkerPool::work(int worker) {
  for (;;) {
    team_->start.arrive_and_wait();
    // A null job ends the worker.
    if (!job_) return;
    call(worker);
    team_->finish.arrive_and_wait();
  }
}

void WorkerPool::call(int worker) noexcept {
  try {
    std::optional<FlushDenormals> flush;
    if (denormals_ == Denormals::flushed) flush.emplace();
    (*job_)(worker);
  } catch (...) {
    const std::lock_guard lock(team_->mutex);
    if (!error_) error_ = std::current_exception();
  }
}

void parallelFor(int threads, std::size_t count,
                 const std::function<void(std::size_t i, int worker)>& task) {
  std::atomic<std::size_t> next{0};
  const std::size_t most = std::max(threads, 1);
  WorkerPool pool(static_cast<int>(std::clamp<std::size_t>(count, 1, most)), Denormals::kept);

  pool.run([&](int worker) {
    try {
      for (std::size_t i = next++; i < count; i = next++) task(i, worker);
    } catch (...) {
      // No other worker gets an index from now on.
      next = count;
      throw;
    }
  });
}

}  // namespace whit
