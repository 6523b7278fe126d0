// A frame: its film, its statistics, and what all workers that trace it share.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "bake/scene.h"
#include "core/channels.h"
#include "core/image.h"
#include "core/options.h"
#include "sampling/sample_pattern.h"
#include "scene/camera.h"
#include "simd/kernels.h"
#include "stages/chunk.h"
#include "stages/ray_kinds.h"
#include "stages/stage.h"

namespace whit {

// The film: where a frame goes, as linear radiance and as 8-bit codes.
struct Film {
  Image image;  // linear radiance; size and window are set by whoever wants the frame
  bool wantDisplay = true;
  DisplayImage display;    // 8-bit codes of the window, when they are wanted
  ChannelLayers channels;  // of the window, those of RenderOptions::channels
};

// Room for the display codes of the film's window, when they are wanted.
void sizeDisplay(Film& film);

// Times and counters of a frame, by stage, step and kind of ray. Times are summed over the workers;
// `stageMs` and `embreeMs` divide by their number, which gives the wall-clock share. All that
// happens below depth 0 counts as addImpulses.
struct FrameStats {
  double frameMs = 0;
  int workers = 1;
  std::array<double, kStageCount> stageWorkerMs{};
  TraceMeter meter;                                              // rays, and the time inside Embree
  std::array<std::uint64_t, kStageCount> stageCalls{};           // times that a stage has ended
  std::array<std::uint64_t, simd::kKernels.size()> stepCalls{};  // by Step::number
  std::uint64_t nonFinitePixels = 0;
  // Pixels of which a sample had more rays than --max-rays; with --adaptive once for each pass.
  std::uint64_t limitedPixels = 0;

  double stageMs(Stage s) const { return stageWorkerMs[static_cast<std::size_t>(s)] / workers; }
  double embreeMs() const { return meter.embreeMs / workers; }
  const RayTally& of(RayKind k) const { return meter.tally[static_cast<std::size_t>(k)]; }
  std::uint64_t callsOf(Stage s) const { return stageCalls[static_cast<std::size_t>(s)]; }
  std::uint64_t callsOf(const simd::Kernel& k) const { return stepCalls[simd::indexOf(k)]; }
  std::uint64_t allRays() const {
    std::uint64_t sum = 0;
    for (const RayTally& t : meter.tally) sum += t.rays;
    return sum;
  }
  void add(const FrameStats& worker);  // counters and times of one worker
};

// The camera of a scene with this origin, changed by the options of forEachCameraOption(). Throws
// Error(usage) for a field of view of a camera that has none.
Camera aimed(Camera camera, const Vec3d& origin, const RenderOptions& options);
// The camera that the options ask for: --camera, changed by the options of forEachCameraOption().
// Throws Error(usage) naming the nearest camera.
Camera chooseCamera(const Scene& scene, const RenderOptions& options);
// The scene's camera path at `seconds`, changed by the same options. Throws Error(usage) when the
// scene has no path.
Camera cameraOnPath(const Scene& scene, const RenderOptions& options, double seconds);
// An empty film of the size and crop that the options ask for. Throws Error(usage) for a crop
// outside the image, Error(limit) when it and what writes it would take more than `maxBytes`.
Film makeFilm(const Scene& scene, const RenderOptions& options,
              std::uint64_t maxBytes = std::numeric_limits<std::uint64_t>::max());
// The standard errors of the film's pixels, each the root of the mean square of those around it.
// By itself a pixel whose few samples all missed the light would claim to be exact.
void poolErrors(Film& film);
inline constexpr int kPoolReach = 2;  // pixels to each side, within the film's window
// Shows the background of the options where the film was asked for display codes.
void showBackground(const RenderOptions& options, Film& film);
// Throws Error(badScene) for a frame with pixels that are not finite when the options are strict.
void refuseNonFinite(const Scene& scene, const RenderOptions& options, const FrameStats& frame);

// Samples of the pattern, [first, end).
struct SampleRange {
  int first = 0, end = 0;
};

struct SampleSum {
  RgbD total;          // in the order of the pattern
  double squares = 0;  // of the samples' mean channel, linear radiance
  // The standard error of the mean of `samples` samples, as if they were independent; infinite for
  // one sample.
  double standardError(int samples) const;
};

// The sums of a window's pixels, for pictures that gain samples over time. They start empty.
class SampleSums {
 public:
  explicit SampleSums(const Crop& window)
      : sums_(static_cast<std::size_t>(window.x1 - window.x0) *
              static_cast<std::size_t>(window.y1 - window.y0)) {
    shape_.window = window;
  }

  SampleSum& at(int x, int y) { return sums_[shape_.index(x, y)]; }
  const Crop& window() const { return shape_.window; }

  // The standard error of the mean of `samples` samples a pixel, 2 or more: its mean over the
  // window, as a share of the window's mean radiance (of the mean channel). As if samples were
  // independent; spread evenly, as those of a pattern are, they are off by less. Not its root mean
  // square, which a few bright samples decide. 0 for black.
  double relativeError(int samples) const;

 private:
  Image shape_;  // without pixels
  std::vector<SampleSum> sums_;
};

// Called by the workers while they trace a frame, possibly several at a time.
struct FrameHooks {
  // Asked between tiles and between samples; null: never. True: the frame is given up, and its film
  // is useless.
  std::function<bool()> stop;
  // Called when the film holds the pixels of a tile; null: not wanted. Batches do not call it.
  std::function<void(std::span<const std::uint32_t> pixels)> finished;
};

// Sees each chunk of rays after each stage: comparison with the reference, debug views, ray logs.
class StageObserver {
 public:
  virtual ~StageObserver() = default;
  virtual void after(Stage stage, const Chunk& chunk) = 0;
};

// Follows, for observers, which pixel each ray of each queue belongs to.
class PixelTracker {
 public:
  // To be called with every stage that an observer sees.
  void follow(Stage stage, const Chunk& chunk) {
    if (stage == Stage::generateRays) {
      levels_.assign(1, {chunk.pixels.begin(), chunk.pixels.end()});
    } else if (stage == Stage::addImpulses) {
      const auto depth = static_cast<std::size_t>(chunk.depth);
      levels_.resize(depth + 2);
      std::vector<std::uint32_t>& next = levels_[depth + 1];
      next.clear();
      for (std::size_t i = 0; i < chunk.childCount; ++i) {
        next.push_back(levels_[depth][chunk.first + chunk.children.parent[i]]);
      }
    }
  }

  // The packed pixel that slot i of the chunk is traced for.
  std::uint32_t pixel(const Chunk& chunk, std::size_t i) const {
    return levels_[static_cast<std::size_t>(chunk.depth)][chunk.first + i];
  }

 private:
  std::vector<std::vector<std::uint32_t>> levels_;  // a queue a depth
};

// Packed pixels (core/image.h), which a worker takes a list at a time.
using PixelLists = std::vector<std::vector<std::uint32_t>>;

// Says which part of a picture is traced. The default is all samples of the film's pixels; with
// --adaptive only the samples that are needed are traced.
struct TraceRequest {
  const Camera& camera;
  Film& film;  // its image has its size and window
  // Pixels in place of the film's, in lists as render/scheduler.h makes them for tiles.
  const PixelLists* pixels = nullptr;
  // Samples in place of the options' pattern.
  const std::vector<Vec2f>* pattern = nullptr;
  // With `sums` some of the samples are traced and added to the sums, which have those before them
  // and whose window holds the film's. The film shows the mean of all so far: with the last sample
  // it is the picture, bit for bit.
  SampleRange part = {};
  SampleSums* sums = nullptr;
  // See Frame::observers. `uniform`: they see all samples of all pixels, whatever --adaptive says.
  std::span<StageObserver* const> observers = {};
  bool uniform = false;
  const FrameHooks* hooks = nullptr;
};

// Read-only while it is traced, but for the film, the probe samples and the sums, of which each
// pixel is written by one worker.
struct Frame {
  FrameConstants constants;
  std::vector<Vec2f> samples;   // of each pixel, in the order of the pattern
  std::size_t firstSample = 0;  // those before it were traced for the probes, or are in `sums`
  std::size_t endSample = 0;    // the first that is not traced
  Film* film = nullptr;
  // Adaptive sampling stores its first samples here, or takes their sum from here.
  ProbeSamples* probes = nullptr;
  // Accumulation takes the sums of the earlier samples from here and stores the new sums here.
  SampleSums* sums = nullptr;
  // Part of the frame's work: sees the chunks of all workers, at the same time.
  StageObserver* observer = nullptr;
  // If there are any, each sees the chunks of one worker, which traces tile by tile, and workers
  // without one rest. Their time is not the frame's. There must not be more of them than workers.
  std::span<StageObserver* const> observers;
  const FrameHooks* hooks = nullptr;
  bool stops() const { return hooks && hooks->stop && hooks->stop(); }
};

}  // namespace whit
