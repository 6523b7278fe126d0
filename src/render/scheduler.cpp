#include "render/scheduler.h"

#include <algorithm>
#include <atomic>
#include <barrier>

#include "core/image.h"
#include "core/index.h"

namespace whit {

namespace {

// The even bits of a Morton code.
int evenBits(std::uint32_t code) {
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < 16; ++i) bits |= (code >> (2 * i) & 1u) << i;
  return bits;
}

// Offsets within a tile, packed as its pixels.
std::vector<std::uint32_t> mortonOrder(int side) {
  int power = 1;
  while (power < side) power *= 2;

  std::vector<std::uint32_t> order;
  for (std::uint32_t code = 0; code < static_cast<std::uint32_t>(power * power); ++code) {
    const int x = evenBits(code), y = evenBits(code >> 1);
    if (x < side && y < side) order.push_back(packedPixel(x, y));
  }
  return order;
}

// The lists dealt out in turn, so that every worker gets its share of each part of the image.
PixelLists dealOut(const PixelLists& lists, std::size_t workers) {
  PixelLists shares(workers);
  for (const auto i : indices(lists)) {
    std::vector<std::uint32_t>& share = shares[i % workers];
    share.insert(share.end(), lists[i].begin(), lists[i].end());
  }

  for (auto& share : shares) share.reserve(share.size() + kListPadding);
  return shares;
}

}  // namespace

PixelLists makeTiles(const Crop& window, int side) {
  const std::vector<std::uint32_t> order = mortonOrder(side);
  PixelLists tiles;

  for (int y0 = window.y0; y0 < window.y1; y0 += side) {
    for (int x0 = window.x0; x0 < window.x1; x0 += side) {
      std::vector<std::uint32_t>& tile = tiles.emplace_back();
      tile.reserve(order.size() + kListPadding);
      for (const std::uint32_t offset : order) {
        const int x = x0 + pixelX(offset), y = y0 + pixelY(offset);
        if (x >= window.x1 || y >= window.y1) continue;
        tile.push_back(packedPixel(x, y));
      }
    }
  }
  return tiles;
}

void Scheduler::layOut(const Plan& plan, const RenderOptions& options, const Crop& window) {
  if (!tracers_.empty() && window_ == window) return;

  window_ = window;
  inBatches_ = options.batch == Batch::frame;
  tiles_ = makeTiles(window, options.tile);

  const std::size_t workers = threads_;
  const std::size_t side = options.tile;
  // Deep queues of two tiles fill their chunks better; longer ones gain no more.
  std::size_t capacity = 2 * side * side;
  if (inBatches_) {
    // A batch is the whole share of a worker.
    capacity = kBlock;
    for (const auto& batch : dealOut(tiles_, workers)) capacity = std::max(capacity, batch.size());
  }
  if (options.queue > 0) capacity = options.queue;

  if (!tracers_.empty() && capacity == capacity_) return;
  tracers_.clear();
  Tracers made(workers);
  // Each worker makes its own, so that the system can put the memory near it.
  pool_.run(
      [&](int worker) { entryOf(made, worker) = std::make_unique<TileTracer>(plan, capacity); });

  tracers_ = std::move(made);
  capacity_ = capacity;
}

FrameStats Scheduler::trace(const Frame& frame, const PixelLists& lists) {
  if (!inBatches_ || !frame.observers.empty()) return traceTiles(frame, lists);
  return traceBatches(frame, dealOut(lists, threads_));
}

FrameStats Scheduler::forWorkers(
    const std::function<void(std::size_t worker, FrameStats& stats)>& task) {
  std::vector<FrameStats> stats(threads_);

  pool_.run([&](int worker) {
    const std::size_t w = worker;
    FrameStats mine;  // on this worker's stack: no cache line is shared while the frame runs
    task(w, mine);
    stats[w] = mine;
  });

  FrameStats sum;
  for (const FrameStats& s : stats) sum.add(s);
  return sum;
}

FrameStats Scheduler::traceTiles(const Frame& frame, const PixelLists& lists) {
  std::atomic<std::size_t> next{0};
  const bool observed = !frame.observers.empty();

  return forWorkers([&](std::size_t worker, FrameStats& stats) {
    if (observed && worker >= frame.observers.size()) return;
    StageObserver* const observer = observed ? frame.observers[worker] : nullptr;

    for (std::size_t i = next++; i < lists.size() && !frame.stops(); i = next++) {
      tracers_[worker]->trace(frame, lists[i], stats, nullptr, observer);
      if (frame.hooks && frame.hooks->finished) frame.hooks->finished(lists[i]);
    }
  });
}

FrameStats Scheduler::traceBatches(const Frame& frame, const PixelLists& lists) {
  std::barrier<> stageBarrier(static_cast<std::ptrdiff_t>(threads_));
  return forWorkers([&](std::size_t worker, FrameStats& stats) {
    // A worker leaves the barrier even if memory runs out: the others may have deeper queues, and
    // would wait for ever.
    const std::unique_ptr<std::barrier<>, void (*)(std::barrier<>*)> leave(
        &stageBarrier, [](std::barrier<>* barrier) { barrier->arrive_and_drop(); });

    tracers_[worker]->trace(frame, lists[worker], stats, &stageBarrier);
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
  for (const auto& tracer : tracers_) sum += tracer->bytes();
  return sum;
}

}  // namespace whit
