// The latency of the viewer: how long after a key or a drag the picture has changed, and how long
// it ever stays the same while there is something to come.
#pragma once

#include <algorithm>
#include <vector>

#include "core/stopwatch.h"

namespace whit::view {

class LatencyMeter {
 public:
  struct Sample {
    int frames = 0;  // traced since, the changed one included
    double ms = 0;
  };

  // The user changed the view; the next request has this number. Passed over while the answer to an
  // earlier one is awaited.
  void changed(int serial) {
    if (waitsFor_ > 0) return;
    waitsFor_ = serial;
    now_ = Sample();
    since_ = Stopwatch();
  }
  // The picture of that request, or of a later one, is what will be presented next.
  void fetched(int serial) {
    ++now_.frames;
    arrived_ = waitsFor_ > 0 && serial >= waitsFor_;
  }
  void presented() {
    if (!arrived_) return;
    now_.ms = since_.ms();
    samples_.push_back(now_);
    waitsFor_ = 0;
    arrived_ = false;
  }

  const std::vector<Sample>& samples() const { return samples_; }

 private:
  int waitsFor_ = 0;  // 0: for nothing
  bool arrived_ = false;
  Sample now_;
  Stopwatch since_;  // the change
  std::vector<Sample> samples_;
};

class NewsMeter {
 public:
  // `fresh`: with something that was not there before. `sharp`: nothing more is to come.
  void presented(bool fresh, bool sharp) {
    if (fresh && waits_) longestMs_ = std::max(longestMs_, since_.ms());
    if (fresh || !waits_) since_ = Stopwatch();
    waits_ = !sharp;
  }
  double longestMs() const { return longestMs_; }

 private:
  bool waits_ = false;
  Stopwatch since_;  // something new was presented
  double longestMs_ = 0;
};

}  // namespace whit::view
