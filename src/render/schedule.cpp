// Which worker traces which pixels.
#include <algorithm>
#include <atomic>
#include <barrier>
#include <memory>

#include "core/stopwatch.h"
#include "render/renderer_parts.h"

namespace whit {

void Renderer::Parts::layOut(const Crop& window) {
  if (!tracers.empty() && laidOut == window) return;
  laidOut = window;
  tiles = makeTiles(laidOut, options.tile);
  batches.clear();
  const auto workers = static_cast<std::size_t>(machine.threads);
  const auto side = static_cast<std::size_t>(options.tile);
  std::size_t capacity = side * side;
  if (options.batch == Batch::frame) {
    batches = dealOut(tiles, workers);
    capacity = kBlock;
    for (const auto& batch : batches) capacity = std::max(capacity, batch.size());
  }
  if (options.queue > 0) capacity = static_cast<std::size_t>(options.queue);
  if (tracers.empty() || capacity != tracerCapacity) {
    tracers.clear();
    tracers.reserve(workers);
    for (std::size_t i = 0; i < workers; ++i) tracers.emplace_back(plan, capacity);
    tracerCapacity = capacity;
  }
  padForVectors(tiles);
  padForVectors(batches);
}

FrameStats Renderer::Parts::renderTiles(FrameJob& job, const PixelLists& lists,
                                        std::vector<RayLog>* logs) {
  std::atomic<std::size_t> next{0};
  std::vector<FrameStats> stats(tracers.size());
  const std::size_t firstLog = logs ? logs->size() : 0;
  if (logs) logs->resize(firstLog + lists.size());
  pool->run([&](int worker) {
    const auto w = static_cast<std::size_t>(worker);
    FrameStats mine;  // on this worker's stack: no cache line is shared while the frame runs
    for (std::size_t i = next++; i < lists.size(); i = next++) {
      tracers[w].trace(job, lists[i], mine, logs ? &(*logs)[firstLog + i] : nullptr);
    }
    stats[w] = mine;
  });
  FrameStats sum;
  for (const FrameStats& s : stats) sum.add(s);
  return sum;
}

FrameStats Renderer::Parts::renderBatches(FrameJob& job, const PixelLists& lists) {
  std::barrier<> stageBarrier(static_cast<std::ptrdiff_t>(tracers.size()));
  job.stageBarrier = &stageBarrier;
  std::vector<FrameStats> stats(tracers.size());
  pool->run([&](int worker) {
    const auto w = static_cast<std::size_t>(worker);
    FrameStats mine;
    // Also when memory runs out: the others may have deeper queues, and would wait for ever.
    const std::unique_ptr<std::barrier<>, void (*)(std::barrier<>*)> leave(
        &stageBarrier, [](std::barrier<>* barrier) { barrier->arrive_and_drop(); });
    tracers[w].trace(job, lists[w], mine, nullptr);
    stats[w] = mine;
  });
  job.stageBarrier = nullptr;
  FrameStats sum;
  for (const FrameStats& s : stats) sum.add(s);
  return sum;
}

FrameStats Renderer::Parts::renderLists(FrameJob& job, const PixelLists& tileLists,
                                        const PixelLists& batchLists, std::vector<RayLog>* logs) {
  return options.batch == Batch::frame && !logs ? renderBatches(job, batchLists)
                                                : renderTiles(job, tileLists, logs);
}

FrameStats Renderer::Parts::renderFrame(FrameJob& job, std::vector<RayLog>* logs) {
  const Stopwatch stopwatch;
  FrameStats stats =
      adaptive() ? renderInPasses(job, logs) : renderLists(job, tiles, batches, logs);
  stats.frameMs = stopwatch.ms();
  stats.workers = machine.threads;
  return stats;
}

FrameStats Renderer::Parts::renderObserved(const FrameJob& job,
                                           std::span<StageObserver* const> observers) {
  std::atomic<std::size_t> next{0};
  std::vector<FrameStats> stats(observers.size());
  const Stopwatch stopwatch;
  pool->run([&](int worker) {
    const auto w = static_cast<std::size_t>(worker);
    if (w >= observers.size()) return;
    FrameJob mine = job;
    mine.observer = observers[w];
    for (std::size_t i = next++; i < tiles.size(); i = next++) {
      tracers[w].trace(mine, tiles[i], stats[w], nullptr);
    }
  });
  FrameStats sum;
  for (const FrameStats& s : stats) sum.add(s);
  sum.frameMs = stopwatch.ms();
  return sum;
}

}  // namespace whit
