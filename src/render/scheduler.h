// Deals the pixels of a frame to workers: tile by tile, each to the next worker that is free, or,
// with --batch frame, all at once, a batch a worker and everyone in the same stage.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/worker_pool.h"
#include "render/frame.h"
#include "render/frame_stats.h"
#include "render/plan.h"
#include "render/tile_tracer.h"
#include "render/tiles.h"

namespace whit {

// Pixels that are traced together, in lists: for workers that take one list after the other, and
// dealt out to all of them at once.
struct PixelWork {
  PixelLists tiles, batches;
};

class Scheduler {
 public:
  // Who looks on at the list of this number; null: nobody. Watched frames go tile by tile.
  using Watch = std::function<StageObserver*(std::size_t list)>;

  explicit Scheduler(int threads) : pool_(threads), threads_(threads) {}

  // Tiles, batches and tracers for frames of `window`, unless they are there already. The plan must
  // outlive them.
  void layOut(const Plan& plan, const RenderOptions& options, const Crop& window);
  // For another plan: the next layOut() makes tracers anew.
  void forgetTracers() { tracers_.clear(); }

  const Crop& window() const { return window_; }
  // Every pixel of the window that was laid out.
  const PixelWork& allPixels() const { return all_; }
  // The lists for workers, dealt out for batches where these are asked for.
  PixelWork workOf(PixelLists lists) const;

  FrameStats trace(const Frame& frame, const PixelWork& work, const Watch& watch = {});
  // All tiles, by as many workers as there are observers: each looks on at one. No more of them
  // than workers.
  FrameStats observe(const Frame& frame, std::span<StageObserver* const> observers);
  // task(first row, last row) of the window for each worker; the time is updateImage's.
  FrameStats forRows(const std::function<void(int, int)>& task);

  WorkerPool& pool() { return pool_; }
  int threads() const { return threads_; }
  const std::vector<TileTracer>& tracers() const { return tracers_; }
  std::size_t bytes() const;

 private:
  FrameStats traceTiles(const Frame& frame, const PixelLists& lists, const Watch& watch);
  FrameStats traceBatches(const Frame& frame, const PixelLists& lists);
  FrameStats forWorkers(const std::function<void(std::size_t worker, FrameStats& stats)>& task);

  WorkerPool pool_;
  int threads_;
  Crop window_;
  bool inBatches_ = false;
  PixelWork all_;
  std::vector<TileTracer> tracers_;  // one a worker; none after another plan
  std::size_t capacity_ = 0;         // rays, of each
};

}  // namespace whit
