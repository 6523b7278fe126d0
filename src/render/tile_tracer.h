// Walks a frame's plan over batches of pixels: one worker's part of a frame.
//
// A batch's rays form the queue of depth 0. A queue is worked off in chunks of at most the
// capacity; the children of a chunk become the queue of the next depth, which is drained completely
// before the chunk is finished. So memory is bounded by capacity times depth, whatever the number
// of paths, and nothing recurses. A finished chunk hands its radiance, times weight, to its
// parents: each surfel sums local radiance, then what its children bring, in the order of the
// queue, whatever the capacity, tile or number of workers.
//
// The tracer knows steps, queues and depths, and no effect.
#pragma once

#include <barrier>
#include <chrono>
#include <span>
#include <vector>

#include "render/frame.h"
#include "render/plan.h"
#include "render/workspace.h"

namespace whit {

// Splits a worker's time among the stages.
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

class TileTracer {
 public:
  // The plan must outlive the tracer.
  TileTracer(const Plan& plan, std::size_t capacity);

  // Traces all samples of the pixels and writes them to the film. `stageBarrier`, if any, is waited
  // at after each stage (--batch frame); `observer`, if any, sees each stage, and its time is not
  // the frame's.
  void trace(const Frame& frame, std::span<const std::uint32_t> pixels, FrameStats& stats,
             std::barrier<>* stageBarrier = nullptr, StageObserver* observer = nullptr);
  BufferBytes bufferBytes() const { return work_.bufferBytes(); }
  std::size_t bytes() const;

 private:
  // Who looks at the walk of the batch at hand.
  struct Watch {
    FrameStats& stats;
    StageClock& clock;
    std::barrier<>* stageBarrier;
    StageObserver *frameObserver, *observer;
  };

  bool traceSamples(const Frame& frame, const Watch& watch);
  void addSample(const Frame& frame);
  // Loads the sums of the earlier samples.
  void takeUpSums(const Frame& frame);
  void leaveSums(const Frame& frame);
  void keepProbeCodes(const Frame& frame);
  void traceSample(const Watch& watch);
  void shadeChunk(int depth, const Watch& watch);
  void addImpulses(const Watch& watch);
  void finishChunk(int depth, const Watch& watch);
  void runSteps(const std::vector<Step>& steps, const Watch& watch);
  void run(const Step& step, FrameStats& stats);
  void endStage(Stage stage, const Watch& watch);

  const Plan& plan_;
  Workspace work_;
  Chunk chunk_;                  // the one in hand
  std::vector<SampleSum> sums_;  // a pixel each, when there are several samples
};

}  // namespace whit
