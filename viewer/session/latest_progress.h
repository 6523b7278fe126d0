// The latest progress of work on another thread, which can be given up.
#pragma once

#include <atomic>
#include <mutex>
#include <stdexcept>
#include <string>

#include "command_line/progress_bar.h"

namespace whit::view {

class LatestProgress : public Progress {
 public:
  void report(const std::string& phase, double fraction) override {
    if (givenUp) throw std::runtime_error("given up");
    const std::lock_guard lock(mutex_);
    text_ = cli::progressText(phase, fraction);
  }
  // A bar and what is going on; empty: nothing was reported yet.
  std::string text() const {
    const std::lock_guard lock(mutex_);
    return text_;
  }
  void clear() {
    const std::lock_guard lock(mutex_);
    text_.clear();
  }

  std::atomic<bool> givenUp = false;  // true: the work ends at its next report

 private:
  mutable std::mutex mutex_;
  std::string text_;
};

}  // namespace whit::view
