// The columns that one worker traces with: rays and radiance of each depth's queue, and what the
// chunk at hand of any depth goes through. Which of them are there follows from the plan: the
// parts that its steps write, and its features.
#pragma once

#include <array>
#include <vector>

#include "render/plan.h"
#include "stages/chunk.h"
#include "stages/columns.h"

namespace whit {

// Memory of each set of columns over all depths; 0 if the plan does not use the set.
struct BufferBytes {
  std::size_t rays = 0, radiance = 0, hits = 0, surfels = 0, unshadowed = 0, shadows = 0;
  std::size_t rayCounts = 0;
  std::size_t sum() const {
    return rays + radiance + hits + surfels + unshadowed + shadows + rayCounts;
  }
};

class Workspace {
 public:
  // Chunks hold `capacity` rays at the most. The plan must outlive the workspace.
  Workspace(const Plan& plan, std::size_t capacity);

  std::size_t capacity() const { return capacity_; }
  // Display codes of so many pixels, which chunks made from then on hold.
  void reserveCodes(std::size_t pixels);
  // Begins depth 0's queue with a ray a pixel.
  void startQueue(std::size_t rays);
  // True if the queue of this depth has rays left.
  bool hasMore(int depth) const { return level(depth).cursor < level(depth).count; }
  // Takes the queue's next chunk in hand: its columns, without children.
  void takeChunk(int depth, Chunk& chunk);
  // The depth's chunk as it was taken in hand, for when the queues below it are drained.
  void returnTo(int depth, Chunk& chunk) const;
  // The chunk of depth 0, once all queues are drained: the batch's pixels.
  void returnToPixels(Chunk& chunk);
  // Room for so many children, which become the queue of the next depth.
  void reserveChildren(std::size_t count, Chunk& chunk);
  // Notes that the chunk has got children of this kind since it had `before` of them.
  static void noteChildren(RayKind kind, std::size_t before, Chunk& chunk);
  // Makes the chunk's children the next depth's queue; false: there are none.
  bool startQueueOfChildren(const Chunk& chunk);
  // The depth's chunk is done with.
  void finishChunk(int depth) { level(depth).cursor += level(depth).chunk; }

  BufferBytes bufferBytes() const;
  std::size_t bytes() const;

 private:
  struct Level {
    ColumnStore<RayColumns> rays;
    ColumnStore<RadianceColumns> radiance;
    std::vector<std::uint32_t> rayCounts;
    std::size_t count = 0;                          // rays in the queue
    std::array<Segment, kSegmentLimit> segments{};  // of the queue
    std::size_t segmentCount = 0;
    std::size_t cursor = 0, chunk = 0;  // the chunk in hand: its first ray, its length
  };
  Level& level(int depth) { return levels_[static_cast<std::size_t>(depth)]; }
  const Level& level(int depth) const { return levels_[static_cast<std::size_t>(depth)]; }
  void reserveRays(int depth, std::size_t rays);

  const Plan& plan_;
  std::size_t capacity_;
  std::vector<Level> levels_;
  ColumnStore<HitColumns> hits_;
  ColumnStore<SurfelColumns> surfels_;
  ColumnStore<UnshadowedColumns> unshadowed_;
  ColumnStore<ShadowColumns> shadows_;
  std::vector<std::uint32_t> codes_;
};

}  // namespace whit
