// How many pictures a second there are to be seen while something moves.
#pragma once

#include <utility>

#include "core/stopwatch.h"

namespace whit::view {

class FrameRate {
 public:
  // A picture has come; `moving`: of a view that moves.
  void fetched(bool moving) {
    const double ms = std::exchange(since_, Stopwatch()).ms();
    if (moving && moving_) {
      constexpr double kNewest = 0.2;  // weight of the newest picture
      meanMs_ = meanMs_ > 0 ? meanMs_ + kNewest * (ms - meanMs_) : ms;
    } else {
      meanMs_ = 0;
    }
    moving_ = moving;
  }
  // 0: nothing moves.
  double perSecond() const { return moving_ && meanMs_ > 0 ? 1000 / meanMs_ : 0; }

 private:
  Stopwatch since_;  // the last one
  double meanMs_ = 0;
  bool moving_ = false;
};

}  // namespace whit::view
