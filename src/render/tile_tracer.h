// Runs the steps of a frame's plan on batches of pixels: one worker's part of a frame.
//
// A batch's rays form the queue of depth 0. A queue is processed in chunks of at most the
// capacity; the children of a chunk become the queue of the next depth, which is drained completely
// before the chunk is finished. So memory is bounded by capacity times depth, whatever the number
// of paths, and nothing recurses. A finished chunk hands its radiance, times weight, to its
// parents: each surfel sums local radiance, then what its children bring, in the order of the
// queue, whatever the capacity, tile or number of workers.
//
// The tracer knows steps, queues and depths, and no effect.
#pragma once

#include <array>
#include <barrier>
#include <span>
#include <vector>

#include "core/stopwatch.h"
#include "render/frame.h"
#include "render/plan.h"
#include "stages/chunk.h"
#include "stages/columns.h"

namespace whit {

// Splits a worker's time among the stages.
class StageClock {
 public:
  explicit StageClock(FrameStats& stats) : stats_(stats) {}

  // The time since the last lap belongs to `stage`; below depth 0 all of it is addImpulses.
  void lap(Stage stage, int depth) {
    const Stage account = depth == 0 || stage == Stage::updateImage ? stage : Stage::addImpulses;
    entryOf(stats_.stageWorkerMs, account) += last_.restart();
    ++entryOf(stats_.stageCalls, stage);
  }
  // Time that no stage should be charged with, such as waiting for the others.
  void skip() { last_.restart(); }

 private:
  FrameStats& stats_;
  Stopwatch last_;
};

// Memory of each set of columns over all depths; 0 if the plan does not use the set.
struct BufferBytes {
  std::size_t rays = 0, radiance = 0, hits = 0, surfels = 0, unshadowed = 0, shadows = 0;
  std::size_t rayCounts = 0;
  std::size_t sum() const {
    return rays + radiance + hits + surfels + unshadowed + shadows + rayCounts;
  }
};

// The columns that one worker traces with: rays and radiance of each depth's queue, and the columns
// of the current chunk, whatever its depth. Columns exist only if a step of the plan writes them or
// a feature needs them.
class Workspace {
 public:
  // Chunks hold at most `capacity` rays. The plan must outlive the workspace.
  Workspace(const Plan& plan, std::size_t capacity);

  std::size_t capacity() const { return capacity_; }
  // Makes room for the display codes of `pixels` pixels.
  void reserveCodes(std::size_t pixels);
  // Starts the queue of depth 0, with one ray per pixel.
  void startQueue(std::size_t rays);
  // True if the queue of this depth has rays left.
  bool hasMore(int depth) const { return level(depth).cursor < level(depth).count; }
  // Makes `chunk` the queue's next chunk, which has no children yet.
  void takeChunk(int depth, Chunk& chunk);
  // Makes `chunk` the depth's current chunk again, after the queues of its children are drained.
  void returnTo(int depth, Chunk& chunk);
  // Makes `chunk` the pixels of the whole batch, after all queues are drained.
  void returnToPixels(Chunk& chunk);
  // Makes room for `count` children, which become the queue of the next depth.
  void reserveChildren(std::size_t count, Chunk& chunk);
  // Notes that all children after the first `before` are of this kind.
  static void noteChildren(RayKind kind, std::size_t before, Chunk& chunk);
  // Makes the chunk's children the queue of the next depth. Returns false if there are none.
  bool startQueueOfChildren(const Chunk& chunk);
  // Set while samples are traced again as narrower trees (sampling/ray_limit.h).
  void setNarrows(bool narrows) { narrows_ = narrows; }
  // Removes the depth's current chunk from its queue.
  void finishChunk(int depth) { level(depth).cursor += level(depth).chunk; }

  BufferBytes bufferBytes() const;
  std::size_t bytes() const;

 private:
  struct Level {
    ColumnStore<RayColumns> rays;
    ColumnStore<RadianceColumns> radiance;
    std::vector<std::uint32_t> rayCounts, pixelSlots;
    std::vector<Narrowing> narrowings;
    std::size_t count = 0;                          // rays in the queue
    std::array<Segment, kSegmentLimit> segments{};  // kinds of the queue's rays
    std::size_t segmentCount = 0;
    std::size_t cursor = 0, chunk = 0;  // first ray and length of the current chunk
  };
  Level& level(int depth) { return entryOf(levels_, depth); }
  const Level& level(int depth) const { return entryOf(levels_, depth); }
  void reserveRays(int depth, std::size_t rays);

  const Plan& plan_;
  std::size_t capacity_;
  std::vector<Level> levels_;
  ColumnStore<HitColumns> hits_;
  ColumnStore<SurfelColumns> surfels_;
  ColumnStore<UnshadowedColumns> unshadowed_;
  ColumnStore<ShadowColumns> shadows_;
  std::vector<std::uint32_t> codes_;
  std::vector<std::uint32_t> followed_;  // number of impulses by the slot of depth 0
  bool narrows_ = false;
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
  // Statistics and observers of the current batch.
  struct Watch {
    FrameStats& stats;
    StageClock& clock;
    std::barrier<>* stageBarrier;
    StageObserver *frameObserver, *observer;
  };

  bool traceSamples(const Frame& frame, const Watch& watch);
  void addSample(const Frame& frame);
  bool keepsErrors(const Frame& frame) const {
    return frame.constants.channels.layers && plan_.channels.has(Channel::error);
  }
  void keepErrors(const Frame& frame);
  // Load and store the sums that a picture keeps between its passes.
  void loadSums(const Frame& frame);
  void storeSums(const Frame& frame);
  void keepProbeCodes(const Frame& frame);
  void traceSample(const Watch& watch);
  void traceNarrowed(const std::vector<std::uint32_t>& slots, const Watch& watch);
  void traceTrees(const Watch& watch);
  void shadeChunk(int depth, const Watch& watch);
  void addImpulses(const Watch& watch);
  void finishChunk(int depth, const Watch& watch);
  void runSteps(const std::vector<Step>& steps, const Watch& watch);
  void run(const Step& step, FrameStats& stats);
  void endStage(Stage stage, const Watch& watch);

  const Plan& plan_;
  Workspace work_;
  Chunk chunk_;                        // the current chunk
  std::vector<SampleSum> sums_;        // sums of each pixel, if there are several samples
  std::vector<std::uint8_t> limited_;  // 1 for pixels with a sample that was traced again
};

}  // namespace whit
