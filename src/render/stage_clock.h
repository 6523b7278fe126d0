// Splits a worker's time among the stages.
#pragma once

#include <chrono>

#include "render/frame_stats.h"

namespace whit {

class StageClock {
 public:
  explicit StageClock(FrameStats& stats) : stats_(stats), last_(std::chrono::steady_clock::now()) {}

  // The time since the last lap belongs to `stage`; below depth 0 all of it is addImpulses.
  void lap(Stage stage, int depth) {
    const auto now = std::chrono::steady_clock::now();
    const Stage account = depth == 0 || stage == Stage::updateImage ? stage : Stage::addImpulses;
    stats_.stageWorkerMs[static_cast<std::size_t>(account)] +=
        std::chrono::duration<double, std::milli>(now - last_).count();
    ++stats_.stageCalls[static_cast<std::size_t>(stage)];
    last_ = now;
  }
  // Time that no stage should be charged with, such as waiting for the others.
  void skip() { last_ = std::chrono::steady_clock::now(); }

 private:
  FrameStats& stats_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace whit
