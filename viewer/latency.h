// The latency of the viewer: how long after a key or a drag the picture has changed.
#pragma once

#include <chrono>
#include <vector>

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
    start_ = std::chrono::steady_clock::now();
  }
  // The picture of that request, or of a later one, is what will be presented next.
  void fetched(int serial) {
    ++now_.frames;
    arrived_ = waitsFor_ > 0 && serial >= waitsFor_;
  }
  void presented() {
    if (!arrived_) return;
    const auto passed = std::chrono::steady_clock::now() - start_;
    now_.ms = std::chrono::duration<double, std::milli>(passed).count();
    samples_.push_back(now_);
    waitsFor_ = 0;
    arrived_ = false;
  }

  const std::vector<Sample>& samples() const { return samples_; }

 private:
  int waitsFor_ = 0;  // 0: for nothing
  bool arrived_ = false;
  Sample now_;
  std::chrono::steady_clock::time_point start_;
  std::vector<Sample> samples_;
};

}  // namespace whit::view
