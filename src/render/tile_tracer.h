// Runs the eight stages over batches of pixels: one worker's share of a frame.
//
// A batch's rays form the queue of depth 0. A queue is worked off in chunks of at most the
// capacity; the children of a chunk become the queue of the next depth, which is drained completely
// before the chunk is finished. So memory is bounded by capacity times depth, whatever the number
// of paths, and nothing recurses. A finished chunk hands its radiance, times weight, to its
// parents: each surfel sums local radiance, then its reflection, then its refraction, in this order
// whatever the capacity, tile or number of workers.
#pragma once

#include <barrier>
#include <span>
#include <vector>

#include "accel/accel.h"
#include "render/frame_stats.h"
#include "render/plan.h"
#include "render/renderer.h"
#include "sampling/pixel_edges.h"
#include "sampling/probe_samples.h"
#include "stages/columns.h"
#include "stages/shading_tables.h"

namespace whit {

// One chunk in the middle of a frame, for observers.
struct ChunkView {
  int depth = 0;
  std::size_t first = 0, n = 0;  // the chunk's place in its queue
  RayColumns rays;
  HitColumns hits;
  SurfelColumns surfels;
  RadianceColumns radiance;
  UnshadowedColumns unshadowed;
  ShadowColumns shadows;
  std::size_t shadowCount = 0;
  const Light* light = nullptr;  // from findRadianceAndShadowRays to addShading
  RayColumns children;
  // Children, in this order: mirrored and sampled reflections, refractions.
  std::size_t reflections = 0, refractions = 0;
  std::span<const std::uint32_t> pixels;  // of the queue of depth 0, packed
  Vec2f sample;
  std::uint32_t sampleNumber = 0;
};

class StageObserver {
 public:
  virtual ~StageObserver() = default;
  virtual void after(Stage stage, const ChunkView& chunk) = 0;
};

// What all workers of a frame share; read-only while it runs.
struct FrameJob {
  const Plan* plan = nullptr;
  const ShadingTables* tables = nullptr;
  const Accel* accel = nullptr;
  CameraFrame camera;
  float coneSpread = 0;  // pixelCone(camera)'s
  std::vector<Vec2f> samples;
  float cutoff = 0, exposureScale = 1;
  ToneCurve toneCurve = ToneCurve::none;
  FilmPrecision precision = FilmPrecision::single;
  SrgbEncoding srgb = SrgbEncoding::exact;
  Film* film = nullptr;
  // Of adaptive sampling: where the samples go, or when the first ones were traced before, whence
  // these come.
  ProbeSamples* probes = nullptr;
  std::size_t firstSample = 0;
  // When wanted: what the rays of depth 0 meet, as film->image.pixels.
  std::vector<PixelSurface>* surfaces = nullptr;
  std::barrier<>* stageBarrier = nullptr;  // --batch frame: everyone waits after each stage
  StageObserver* observer = nullptr;
};

// Of each set of columns, all depths together; 0 where the plan has no use for it.
struct BufferBytes {
  std::size_t rays = 0, radiance = 0, hits = 0, surfels = 0, unshadowed = 0, shadows = 0;
  std::size_t sum() const { return rays + radiance + hits + surfels + unshadowed + shadows; }
};

class TileTracer {
 public:
  TileTracer(const Plan& plan, std::size_t capacity);

  // Traces all samples of the pixels and writes them to the film. `log` may be null.
  void trace(const FrameJob& job, std::span<const std::uint32_t> pixels, FrameStats& stats,
             RayLog* log);
  BufferBytes bufferBytes() const;
  std::size_t bytes() const;

 private:
  struct Level {
    ColumnStore<RayColumns> rays;
    ColumnStore<RadianceColumns> radiance;
    std::size_t count = 0, reflections = 0;  // rays in the queue; the first of them are reflections
    std::size_t cursor = 0, chunk = 0;       // the chunk being worked on
  };
  struct Pass;  // one sample of one batch

  // The job's samples, averaged.
  void traceSamples(Pass& pass);
  void keepCodes(const Pass& pass);
  void traceSample(Pass& pass);
  void shadeChunk(Pass& pass, std::size_t depth);
  void findIntersections(Pass& pass, std::size_t depth, const RayColumns& rays);
  void recordSurfaces(const Pass& pass);
  void shadeLights(Pass& pass, std::size_t depth, const RayColumns& rays);
  void addImpulses(Pass& pass, std::size_t depth, const RayColumns& rays);
  void finishChunk(Pass& pass, std::size_t depth);
  void endStage(Pass& pass, Stage stage, std::size_t depth, const Light* light = nullptr);
  void updateImage(const FrameJob& job, std::span<const std::uint32_t> pixels, FrameStats& stats);
  void keepAs(FilmPrecision precision, std::size_t n);
  void reserveLevel(std::size_t depth, std::size_t rays);

  const Plan& plan_;
  std::size_t capacity_;
  std::vector<Level> levels_;
  ColumnStore<HitColumns> hits_;
  ColumnStore<SurfelColumns> surfels_;
  ColumnStore<UnshadowedColumns> unshadowed_;
  ColumnStore<ShadowColumns> shadows_;
  std::size_t shadowCount_ = 0;
  std::uint32_t materialFlags_ = 0;   // kMaterial flags of the chunk's surfels, all together
  std::vector<RgbD> sums_;            // a pixel each, when there are several samples
  std::vector<std::uint32_t> codes_;  // display codes
};

}  // namespace whit
