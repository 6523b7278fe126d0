// Writes files on a thread of its own, while the next picture is traced.
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <utility>
#include <vector>

#include "command_line/program.h"
#include "core/stopwatch.h"

namespace whit {

// Runs jobs one at a time on a thread of its own, in the order in which they come. So at most one
// picture is held besides the one that is traced, and a file exists only if all files before it do.
// An interruption waits for the job that was started, and for no other (command_line/program.h).
class BackgroundWriter {
 public:
  BackgroundWriter() = default;
  // Waits for the job. What the job throws is lost unless finish() was called before.
  ~BackgroundWriter() {
    if (job_.valid()) job_.wait();
  }
  BackgroundWriter(const BackgroundWriter&) = delete;
  BackgroundWriter& operator=(const BackgroundWriter&) = delete;

  // Waits as finish() does, and then starts `write`. Call it from the main thread.
  void start(std::function<void()> write) {
    finish();

    // The scope is opened here and not by the job, because an interruption in between would not
    // wait for the files.
    job_ = std::async(std::launch::async, [write = std::move(write),
                                           scope = std::make_shared<cli::WriteScope>()]() mutable {
      const std::shared_ptr<cli::WriteScope> held = std::move(scope);
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

}  // namespace whit
