// Renders frames of one scene with the vector pipeline: eight stages over tiles, or over the whole
// frame (--batch frame).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "accel/accel.h"
#include "bake/scene.h"
#include "core/options.h"
#include "core/progress.h"
#include "core/vec3.h"
#include "render/adaptive.h"
#include "render/frame.h"
#include "render/plan.h"
#include "render/scheduler.h"
#include "stages/lobes.h"
#include "surfaces/channel_values.h"

namespace whit {

// The machine that the pipeline runs on, after "auto" has been resolved.
struct Machine {
  std::string simd;    // kernel target: avx3, avx2, sse4, sse2, neon, scalar
  std::string embree;  // version and ISA, "3.13.5 avx2"
  int packet = 8;
  int threads = 1;
};

// Returns the plan of frames with these options, whose SIMD target becomes the chosen one. Throws
// Error(usage) as the renderer's constructor does.
Plan planOf(const Scene& scene, const RenderOptions& options);

// Functions that change a renderer or its scene take effect from the next frame on. They must not
// be called while a frame is rendered.
class Renderer {
 public:
  // Builds the acceleration structure and the shading tables. `scene` must outlive the renderer.
  // Throws Error(usage) for a SIMD target that this machine does not have.
  Renderer(const Scene& scene, const RenderOptions& options, Progress* progress = nullptr);
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // Allocates on the first call and when sizes change.
  FrameStats render(const TraceRequest& request);
  FrameStats render(const Camera& camera, Film& film) { return render({camera, film}); }

  // The samples that render() takes the mean of at the film's only pixel.
  std::vector<Vec2f> samplesOf(const Camera& camera, Film& film);

  // Takes all options that change neither the acceleration structure nor the workers (see
  // canSetOptions). Throws Error(usage) when alpha masks, spheres or instances would come or go,
  // which are built in.
  void setOptions(const RenderOptions& options);
  // True if setOptions() suffices for frames with these options. Otherwise they need another
  // renderer, because the acceleration structure or the workers differ.
  bool canSetOptions(const RenderOptions& options) const;

  // Pictures of different seeds have independent noise. The reference always uses seed 0.
  void setSeed(std::uint32_t seed) { seed_ = seed; }

  // The channel "motion" of the next frames counts from this view; without a view it is 0.
  void setEarlier(std::optional<EarlierView> view) { earlier_ = std::move(view); }
  const EarlierView* earlier() const { return earlier_ ? &*earlier_ : nullptr; }

  // Call after materials or lights of the scene were changed (editShading). Keeps the acceleration
  // structure.
  void shadingChanged();

  // Call after cameras of the scene were changed.
  void camerasChanged() { findSurroundings(); }

  // Call after moveScene(). Meshes that stand still keep their acceleration structure.
  void sceneMoved();

  const Scene& scene() const { return scene_; }
  const RenderOptions& options() const { return options_; }
  const Plan& plan() const { return plan_; }
  const ShadingTables& tables() const { return tables_; }
  const Accel& accel() const { return *accel_; }
  const Machine& machine() const { return machine_; }
  Scheduler& scheduler() { return scheduler_; }

  // Prepares for frames by this camera: decides whether rays that find nothing are retried, and
  // fits the earlier view to the film's size. Returns the camera and the media around it. (Outside
  // of a closed scene, where most such rays find nothing for good, retries would cost too much.)
  CameraFrame prepareView(const Camera& camera, const Film& film);
  FrameConstants constantsOf(const CameraFrame& camera) const;

  double buildMs() const { return buildMs_; }  // acceleration structure and tables
  std::uint64_t memoryBytes() const;           // tables, queues, acceleration structure

 private:
  bool adaptive() const { return samplesAdaptively(options_, scene_.effects); }
  Frame frameOf(const TraceRequest& request, bool adaptively);
  const std::vector<Vec2f>& pattern();
  void replan(Plan next);
  void findSurroundings();

  const Scene& scene_;
  RenderOptions options_;
  Plan plan_;
  ShadingTables tables_;
  std::optional<Accel> accel_;
  Machine machine_;
  Scheduler scheduler_;
  AdaptiveSampler adaptive_;
  std::vector<Vec2f> pattern_;  // pattern of options_.spp samples; empty until it is needed
  std::uint32_t seed_ = 0;
  Box dielectrics_;        // around the surfaces of all of them
  bool enclosed_ = false;  // the scene is closed around its cameras, and rays are to be retried
  std::optional<Vec3f> lookedFrom_;  // eye of the last frame
  std::optional<EarlierView> earlier_;
  double buildMs_ = 0;
};

// Returns the metadata of an image file: everything needed to make the image again: version, scene,
// and each option by its name with "auto" resolved. Never a date or a host: the same picture gives
// the same text.
std::vector<std::pair<std::string, std::string>> describeImage(const Scene& scene,
                                                               const Camera& camera,
                                                               const Renderer& renderer,
                                                               const Film& film,
                                                               const RenderOptions& options);

}  // namespace whit
