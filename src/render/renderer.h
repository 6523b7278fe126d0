// Renders frames of one scene with the vector pipeline: eight stages over tiles, or over the whole
// frame (--batch frame).
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/options.h"
#include "core/progress.h"
#include "render/frame_stats.h"
#include "render/plan.h"
#include "scene/scene.h"

namespace whit {

// Where a frame goes. `image` is linear radiance; `display`, when wanted, its 8-bit form.
struct Film {
  Image image;
  bool wantDisplay = true;
  DisplayImage display;  // of the window only
};

// What the pipeline runs on, after "auto" has been resolved.
struct Machine {
  std::string simd;    // kernel target: avx3, avx2, sse4, sse2, neon, scalar
  std::string embree;  // version and ISA, "3.13.5 avx2"
  int packet = 8;
  int threads = 1;
};

struct FloorResult {
  double floorMs = 0;  // Embree alone, the same rays in full packets
  double frameMs = 0;  // whole frames, rendered in turn with the replays
  std::uint64_t rays = 0;
};

class Renderer {
 public:
  // Builds the acceleration structure and the shading tables. `scene` must outlive the renderer.
  // Throws Error(usage) for a SIMD target or packet width that this machine does not have.
  Renderer(const Scene& scene, const RenderOptions& options, Progress* progress = nullptr);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // film.image must have its size and window set. Allocates on the first call and when sizes
  // change.
  FrameStats render(const Camera& camera, Film& film);

  // For frames to come: all that changes neither the acceleration structure nor the workers is
  // taken from `options` (see canSetOptions), the others stay. Plans anew where needed. Throws
  // Error(usage) when alpha masks or instances would come or go, which are built in. Not while
  // rendering.
  void setOptions(const RenderOptions& options);
  // Whether setOptions() is enough for frames with these options. Otherwise they need a renderer of
  // their own: what differs is part of the acceleration structure or of the workers.
  bool canSetOptions(const RenderOptions& options) const;

  // For frames to come, after materials or lights of the scene were changed (editShading). Plans
  // anew where effects have come or gone; keeps the acceleration structure. Not while rendering.
  void shadingChanged();

  // The same image by the scalar reference, its candidates from this renderer's Embree scene.
  FrameStats renderReference(const Camera& camera, Film& film, Progress* progress = nullptr);

  // Captures the rays of one frame, then in turn renders a frame and replays its rays through
  // Embree alone, `frames` times each, and returns the medians.
  FloorResult measureFloor(const Camera& camera, Film& film, int frames);

  const Plan& plan() const;
  const Machine& machine() const;
  double buildMs() const;             // acceleration structure and tables
  std::uint64_t memoryBytes() const;  // tables, queues, acceleration structure

  struct Parts;
  Parts& parts() { return *parts_; }  // for the folder's own comparisons

 private:
  std::unique_ptr<Parts> parts_;
};

// The camera that the options ask for: --camera, then --eye, --at, --up, --fov on top of it.
// Throws Error(usage) naming the nearest camera.
Camera chooseCamera(const Scene& scene, const RenderOptions& options);
// Where the scene's camera path is at `seconds`, with --eye, --at, --up, --fov on top. Throws
// Error(usage) when the scene has no path.
Camera cameraOnPath(const Scene& scene, const RenderOptions& options, double seconds);
// An empty film of the size and crop that the options ask for. Throws Error(usage) for a crop
// outside the image, Error(limit) when it and what writes it would take more than `maxBytes`.
Film makeFilm(const Scene& scene, const RenderOptions& options,
              std::uint64_t maxBytes = std::numeric_limits<std::uint64_t>::max());
// Throws Error(badScene) for a frame with pixels that are not finite when the options are strict.
void refuseNonFinite(const Scene& scene, const RenderOptions& options, const FrameStats& frame);

// One row of `whit compare --stages`: the worst difference between a vector stage's output and its
// scalar twin on the same input, in ulps of the column's magnitude.
struct StageDifference {
  Stage stage;
  std::string column;
  std::uint64_t slots = 0;
  double worstUlp = 0, limitUlp = 0;
  int pixelX = 0, pixelY = 0, depth = 0;
};
std::vector<StageDifference> compareStages(Renderer& renderer, const Camera& camera,
                                           const Film& film);

}  // namespace whit
