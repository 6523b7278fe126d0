// Runs the tasks that decode and make the textures of a scene.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/progress.h"
#include "core/usable_threads.h"
#include "core/worker_pool.h"

namespace whit {

class DecodeQueue {
 public:
  // With 0 threads, it uses as many as this process may use.
  DecodeQueue(int threads, Progress* progress, std::string phase)
      : progress_(progress),
        phase_(std::move(phase)),
        threads_(threads > 0 ? threads : usableThreads()) {}

  void add(std::function<void()> task) { tasks_.push_back(std::move(task)); }

  // Runs all tasks. A task that throws Error(limit) is run once more, alone, after all others have
  // ended and given their memory back. Of several failed tasks, the one added first has its
  // exception rethrown, in whatever order they failed.
  void finish() {
    std::vector<std::exception_ptr> failures(tasks_.size());
    std::vector<char> lackedMemory(tasks_.size());
    const auto run = [&](std::size_t i) {
      try {
        failures[i] = nullptr;
        tasks_[i]();
      } catch (const Error& error) {
        failures[i] = std::current_exception();
        lackedMemory[i] = error.status() == ExitStatus::limit;
      } catch (...) {
        failures[i] = std::current_exception();
      }
    };
    std::atomic<std::size_t> ended{0};
    parallelFor(threads_, tasks_.size(), [&](std::size_t i, int) {
      run(i);
      const auto count = static_cast<double>(tasks_.size());
      reportProgress(progress_, phase_, static_cast<double>(++ended) / count);
    });
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
      if (lackedMemory[i]) run(i);
    }
    for (const std::exception_ptr& failure : failures) {
      if (failure) std::rethrow_exception(failure);
    }
  }

 private:
  Progress* progress_;
  std::string phase_;
  int threads_;
  std::vector<std::function<void()>> tasks_;
};

}  // namespace whit
