// Files are written while the main thread goes on: a picture while the next one is traced.
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <utility>
#include <vector>

#include "cli/app/program.h"
#include "core/stopwatch.h"

namespace whit::cli {

// One job at a time, on a thread of its own, in the order in which they come: at most one picture
// is held beside the one that is traced, and a file is there only if all before it are.
// Interruptions wait for a job that was started, and for no more (app/program.h).
class BackgroundWriter {
 public:
  BackgroundWriter() = default;
  // Waits for the job; what it throws is lost. Call finish() first.
  ~BackgroundWriter() {
    if (job_.valid()) job_.wait();
  }
  BackgroundWriter(const BackgroundWriter&) = delete;
  BackgroundWriter& operator=(const BackgroundWriter&) = delete;

  // As finish(), then starts `write`. From the main thread.
  void start(std::function<void()> write) {
    finish();
    // The scope is opened here and not by the job: an interruption between the two would not know
    // of the files.
    job_ = std::async(std::launch::async,
                      [write = std::move(write), scope = std::make_shared<WriteScope>()]() mutable {
                        const std::shared_ptr<WriteScope> held = std::move(scope);
                        const Stopwatch stopwatch;
                        write();
                        return stopwatch.ms();
                      });
  }

  // Waits for the job that was started last, and throws what it threw.
  void finish() {
    if (!job_.valid()) return;
    const Stopwatch waiting;
    job_.wait();
    const double waitedMs = waiting.ms();
    times_.push_back({job_.get(), waitedMs});
  }

  // How long each finished job took, and how long start() or finish() waited for it.
  struct Times {
    double spentMs = 0, waitedMs = 0;
  };
  const std::vector<Times>& times() const { return times_; }

 private:
  std::future<double> job_;  // milliseconds
  std::vector<Times> times_;
};

}  // namespace whit::cli
