// What a Renderer holds.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/worker_pool.h"
#include "reference/reference.h"
#include "render/renderer.h"
#include "render/tile_tracer.h"
#include "render/tiles.h"

namespace whit {

// Room for the display codes of the film's window, when they are wanted.
void sizeDisplay(Film& film);

struct Renderer::Parts {
  Parts(const Scene& s, const RenderOptions& o) : scene(s), options(o) {}

  reference::Settings referenceSettings() const;
  bool adaptive() const { return options.adaptive && options.spp > 1; }
  // The pixels that a frame traces: the film's, and those next to them when they are compared.
  Crop tracedWindow(const Film& film) const;
  // A job over the tiles of `window`.
  FrameJob makeJob(const Camera& camera, Film& film, const Crop& window);
  // Rays that find nothing are retried only if the eye, too, is where the scene is closed: outside,
  // most of them find nothing for good.
  void lookFrom(const Vec3f& eye);
  void layOut(const Crop& window);  // tiles and tracers, when the window has changed
  // The lists one by one, each by the next worker that is free; their rays go to logs of their own
  // behind those that are there.
  FrameStats renderTiles(FrameJob& job, const PixelLists& lists, std::vector<RayLog>* logs);
  // A list a worker, all workers in the same stage.
  FrameStats renderBatches(FrameJob& job, const PixelLists& lists);
  FrameStats renderLists(FrameJob& job, const PixelLists& tileLists, const PixelLists& batchLists,
                         std::vector<RayLog>* logs);
  void replan(const Plan& next);
  FrameStats renderFrame(FrameJob& job, std::vector<RayLog>* logs);
  // The center of every pixel first; with --adaptive then more where that picture has edges.
  FrameStats renderInPasses(FrameJob& job, std::vector<RayLog>* logs);
  FrameStats renderCenters(FrameJob& job, std::vector<RayLog>* logs);
  // The probe samples of the pixels at edges, then all samples where those differ.
  FrameStats refine(FrameJob& job, std::vector<RayLog>* logs);
  FrameStats renderMarked(FrameJob& job, const Crop& window, const std::vector<std::uint8_t>& marks,
                          std::vector<RayLog>* logs);
  // Takes over what is not traced anew.
  void keepFirstSamples(Film& film, FrameStats& stats);
  // task(first row, last row) of the traced window for each worker; the time is updateImage's.
  void shareRows(FrameStats& stats, const std::function<void(int, int)>& task);
  PixelLists markedPixels(const Crop& window, const std::vector<std::uint8_t>& marks) const;
  // Tile by tile, as many workers as there are observers: each looks on at one. No more of them
  // than tracers.
  FrameStats renderObserved(const FrameJob& job, std::span<StageObserver* const> observers);
  FrameStats renderObserved(const FrameJob& job, StageObserver& observer) {
    StageObserver* const one[] = {&observer};
    return renderObserved(job, one);
  }

  const Scene& scene;
  RenderOptions options;
  Plan plan;
  ShadingTables tables;
  std::optional<Accel> accel;
  bool enclosed = false;  // the scene is closed around its cameras, and rays are to be retried
  std::optional<Vec3f> lookedFrom;  // where the last frame's eye was
  std::optional<WorkerPool> pool;
  Machine machine;
  double buildMs = 0;

  Crop laidOut;  // window that the tiles below cover
  PixelLists tiles;
  PixelLists batches;               // --batch frame: one a worker
  std::vector<TileTracer> tracers;  // one a worker; none after another plan
  std::size_t tracerCapacity = 0;   // rays, of each

  // Frames of several passes: the picture of the first, then of the probe samples as well; and a
  // mark a pixel, where those are traced and where all are.
  Film firstSamples;
  std::vector<PixelSurface> surfaces;
  std::vector<std::uint8_t> edges, contrasting;
  std::optional<ProbeSamples> probes;
};

}  // namespace whit
