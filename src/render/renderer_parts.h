// What a Renderer holds.
#pragma once

#include <optional>
#include <vector>

#include "core/worker_pool.h"
#include "reference/reference.h"
#include "render/renderer.h"
#include "render/tile_tracer.h"
#include "scene/sample_pattern.h"

namespace whit {

struct Renderer::Parts {
  Parts(const Scene& s, const RenderOptions& o) : scene(s), options(o) {}

  FrameJob makeJob(const Camera& camera, Film& film);
  reference::Settings referenceSettings() const;
  void layOut(const Film& film);  // tiles and tracers, when the window has changed
  void replan(const Plan& next);
  FrameStats renderTiles(FrameJob& job, std::vector<RayLog>* logs);
  FrameStats renderBatches(FrameJob& job);
  FrameStats renderFrame(FrameJob& job, std::vector<RayLog>* logs);
  // One worker, tile by tile, with an observer looking on.
  FrameStats renderObserved(FrameJob& job, StageObserver& observer);

  const Scene& scene;
  RenderOptions options;
  Plan plan;
  ShadingTables tables;
  std::optional<Accel> accel;
  std::optional<WorkerPool> pool;
  Machine machine;
  double buildMs = 0;

  Crop laidOut;  // window that the tiles below cover
  std::vector<std::vector<std::uint32_t>> tiles;
  std::vector<std::vector<std::uint32_t>> batches;  // --batch frame: one a worker
  std::vector<TileTracer> tracers;                  // one a worker; none after another plan
  std::size_t tracerCapacity = 0;                   // rays, of each
};

}  // namespace whit
