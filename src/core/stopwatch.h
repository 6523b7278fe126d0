// How long something takes.
#pragma once

#include <chrono>
#include <utility>

namespace whit {

// Runs from when it is made.
class Stopwatch {
 public:
  double ms() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
  }
  // The same, and runs from now on.
  double restart() {
    const Clock::time_point start = std::exchange(start_, Clock::now());
    return std::chrono::duration<double, std::milli>(start_ - start).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace whit
