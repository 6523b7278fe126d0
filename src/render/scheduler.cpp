#include "render/scheduler.h"

#include <algorithm>
#include <atomic>
#include <barrier>
#include <memory>

namespace whit {

void Scheduler::layOut(const Plan& plan, const RenderOptions& options, const Crop& window) {
  if (!tracers_.empty() && window_ == window) return;
  window_ = window;
  inBatches_ = options.batch == Batch::frame;
  all_ = workOf(makeTiles(window, options.tile));
  const auto workers = static_cast<std::size_t>(threads_);
  const auto side = static_cast<std::size_t>(options.tile);
  std::size_t capacity = side * side;
  if (inBatches_) {
    capacity = kBlock;
    for (const auto& batch : all_.batches) capacity = std::max(capacity, batch.size());
  }
  if (options.queue > 0) capacity = static_cast<std::size_t>(options.queue);
  if (!tracers_.empty() && capacity == capacity_) return;
  tracers_.clear();
  tracers_.reserve(workers);
  for (std::size_t i = 0; i < workers; ++i) tracers_.emplace_back(plan, capacity);
  capacity_ = capacity;
}

PixelWork Scheduler::workOf(PixelLists lists) const {
  PixelWork work{std::move(lists), {}};
  if (inBatches_) work.batches = dealOut(work.tiles, static_cast<std::size_t>(threads_));
  padForVectors(work.tiles);
  padForVectors(work.batches);
  return work;
}

FrameStats Scheduler::trace(const Frame& frame, const PixelWork& work, const Watch& watch) {
  return inBatches_ && !watch ? traceBatches(frame, work.batches)
                              : traceTiles(frame, work.tiles, watch);
}

FrameStats Scheduler::forWorkers(
    const std::function<void(std::size_t worker, FrameStats& stats)>& task) {
  std::vector<FrameStats> stats(static_cast<std::size_t>(threads_));
  pool_.run([&](int worker) {
    const auto w = static_cast<std::size_t>(worker);
    FrameStats mine;  // on this worker's stack: no cache line is shared while the frame runs
    task(w, mine);
    stats[w] = mine;
  });
  FrameStats sum;
  for (const FrameStats& s : stats) sum.add(s);
  return sum;
}

FrameStats Scheduler::traceTiles(const Frame& frame, const PixelLists& lists, const Watch& watch) {
  std::atomic<std::size_t> next{0};
  return forWorkers([&](std::size_t worker, FrameStats& stats) {
    for (std::size_t i = next++; i < lists.size() && !frame.stops(); i = next++) {
      tracers_[worker].trace(frame, lists[i], stats, nullptr, watch ? watch(i) : nullptr);
      if (frame.hooks && frame.hooks->finished) frame.hooks->finished(lists[i]);
    }
  });
}

FrameStats Scheduler::traceBatches(const Frame& frame, const PixelLists& lists) {
  std::barrier<> stageBarrier(static_cast<std::ptrdiff_t>(threads_));
  return forWorkers([&](std::size_t worker, FrameStats& stats) {
    // Also when memory runs out: the others may have deeper queues, and would wait for ever.
    const std::unique_ptr<std::barrier<>, void (*)(std::barrier<>*)> leave(
        &stageBarrier, [](std::barrier<>* barrier) { barrier->arrive_and_drop(); });
    tracers_[worker].trace(frame, lists[worker], stats, &stageBarrier);
  });
}

FrameStats Scheduler::observe(const Frame& frame, std::span<StageObserver* const> observers) {
  std::atomic<std::size_t> next{0};
  return forWorkers([&](std::size_t worker, FrameStats& stats) {
    if (worker >= observers.size()) return;
    for (std::size_t i = next++; i < all_.tiles.size() && !frame.stops(); i = next++) {
      tracers_[worker].trace(frame, all_.tiles[i], stats, nullptr, observers[worker]);
      if (frame.hooks && frame.hooks->finished) frame.hooks->finished(all_.tiles[i]);
    }
  });
}

FrameStats Scheduler::forRows(const std::function<void(int, int)>& task) {
  const int rows = window_.y1 - window_.y0;
  return forWorkers([&](std::size_t worker, FrameStats& stats) {
    StageClock clock(stats);
    const auto begin = [&](int w) { return rows * w / threads_; };
    task(begin(static_cast<int>(worker)), begin(static_cast<int>(worker) + 1));
    clock.lap(Stage::updateImage, 0);
  });
}

std::size_t Scheduler::bytes() const {
  std::size_t sum = 0;
  for (const TileTracer& tracer : tracers_) sum += tracer.bytes();
  return sum;
}

}  // namespace whit
