// Deals the pixels of a frame to workers: tile by tile, each to the next worker that is free, or,
// with --batch frame, one batch per worker, with all workers in the same stage.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "core/worker_pool.h"
#include "render/frame.h"
#include "render/plan.h"
#include "render/tile_tracer.h"

namespace whit {

// The packed pixels of each tile of the window, in Morton order: any 4, 8 or 16 that follow each
// other make up 2x2, 4x2 or 4x4 pixels, the most coherent packet there is. Tiles that the window
// cuts lose their outer pixels and close the gaps.
PixelLists makeTiles(const Crop& window, int side);

using Tracers = std::vector<std::unique_ptr<TileTracer>>;

class Scheduler {
 public:
  explicit Scheduler(int threads) : pool_(threads), threads_(threads) {}

  // Tiles and tracers for frames of `window`, unless they are there already. The plan must
  // outlive them.
  void layOut(const Plan& plan, const RenderOptions& options, const Crop& window);
  // For another plan: the next layOut() makes tracers anew.
  void forgetTracers() { tracers_.clear(); }

  const Crop& window() const { return window_; }
  // Every pixel of the window that was laid out.
  const PixelLists& tiles() const { return tiles_; }

  // Workers take one list after the other; with --batch frame each takes its share of all at once.
  FrameStats trace(const Frame& frame, const PixelLists& lists);
  // task(first row, last row) of the window for each worker; the time is updateImage's.
  FrameStats forRows(const std::function<void(int, int)>& task);

  WorkerPool& pool() { return pool_; }
  int threads() const { return threads_; }
  const Tracers& tracers() const { return tracers_; }
  std::size_t bytes() const;

 private:
  FrameStats traceTiles(const Frame& frame, const PixelLists& lists);
  FrameStats traceBatches(const Frame& frame, const PixelLists& lists);
  FrameStats forWorkers(const std::function<void(std::size_t worker, FrameStats& stats)>& task);

  WorkerPool pool_;
  int threads_;
  Crop window_;
  bool inBatches_ = false;
  PixelLists tiles_;
  Tracers tracers_;           // a tracer for each worker; empty after another plan
  std::size_t capacity_ = 0;  // rays, of each
};

}  // namespace whit
