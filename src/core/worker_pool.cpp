#include "core/worker_pool.h"

#include <algorithm>
#include <atomic>
#include <optional>
#include <string>
#include <system_error>
#include <thread>

#include "core/error.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace whit {

WorkerPool::WorkerPool(int workers, Denormals denormals)
    : workers_(workers), denormals_(denormals) {
  startCrew();
}

WorkerPool::~WorkerPool() {
  if (hasCrew()) sendHome();
  forgetDeadCrew();
}

void WorkerPool::startCrew() {
  forgetDeadCrew();
  crew_ = std::make_unique<Crew>(workers_);
  std::vector<std::thread>& threads = crew_->threads;

  const auto turnBack = [&] {
    // The workers that have started leave the barrier; nobody waits for the missing ones.
    for (int i = static_cast<int>(threads.size()) + 1; i < workers_; ++i) {
      crew_->start.arrive_and_drop();
    }

    sendHome();
    crew_.reset();
  };

  try {
    threads.reserve(static_cast<std::size_t>(workers_));
    for (int i = 1; i < workers_; ++i) threads.emplace_back([this, i] { work(i); });
  } catch (const std::system_error& error) {
    turnBack();
    throwLimit("cannot start " + std::to_string(workers_) + " threads: " + error.what());
  } catch (...) {
    turnBack();
    throw;
  }
}

void WorkerPool::sendHome() {
  job_ = nullptr;
  crew_->start.arrive_and_wait();
  for (std::thread& thread : crew_->threads) thread.join();
}

void WorkerPool::run(const std::function<void(int)>& job) {
  begin(job);
  finish();
}

void WorkerPool::begin(const std::function<void(int)>& job) {
  if (!hasCrew()) startCrew();

  job_ = &job;
  error_ = nullptr;
  // The workers wait at this barrier for a job.
  crew_->start.arrive_and_wait();
}

void WorkerPool::finish() {
  call(0);
  // A child process has only the thread that forked it, so the barrier would wait for ever.
  if (!hasCrew()) throwUsage("this process was forked while its worker threads had work to do");
  crew_->finish.arrive_and_wait();
  if (error_) std::rethrow_exception(error_);
}

void WorkerPool::work(int worker) {
  for (;;) {
    crew_->start.arrive_and_wait();
    // A null job ends the worker.
    if (!job_) return;
    call(worker);
    crew_->finish.arrive_and_wait();
  }
}

void WorkerPool::call(int worker) noexcept {
  try {
    std::optional<FlushDenormals> flush;
    if (denormals_ == Denormals::flushed) flush.emplace();
    (*job_)(worker);
  } catch (...) {
    const std::lock_guard lock(crew_->mutex);
    if (!error_) error_ = std::current_exception();
  }
}

void parallelFor(int threads, std::size_t count,
                 const std::function<void(std::size_t i, int worker)>& task) {
  std::atomic<std::size_t> next{0};
  const auto most = static_cast<std::size_t>(std::max(threads, 1));
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

#if defined(__x86_64__)

FlushDenormals::FlushDenormals() : saved_(_mm_getcsr()) {
  constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040;
  _mm_setcsr(static_cast<unsigned>(saved_) | kFlushToZero | kDenormalsAreZero);
}
FlushDenormals::~FlushDenormals() { _mm_setcsr(static_cast<unsigned>(saved_)); }

#elif defined(__aarch64__)

FlushDenormals::FlushDenormals() {
  asm volatile("mrs %0, fpcr" : "=r"(saved_));
  constexpr unsigned long long kFlushToZero = 1ull << 24;
  asm volatile("msr fpcr, %0" : : "r"(saved_ | kFlushToZero));
}
FlushDenormals::~FlushDenormals() { asm volatile("msr fpcr, %0" : : "r"(saved_)); }

#else

FlushDenormals::FlushDenormals() : saved_(0) {}
FlushDenormals::~FlushDenormals() = default;

#endif

}  // namespace whit
