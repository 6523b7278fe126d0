// The scalar reference: Whitted's recursion in double precision, one ray at a time. No SIMD, no
// queues, no tiles. It shares no formula with the kernels. Both modes share the tables of `bake`,
// the random numbers of `sampling` and three rules of `surfaces`: which of several coincident
// surfaces is hit, the media that a ray starts in, and the channels roughness, metallic and motion
// (tests/README.md, "What both modes share").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <vector>

#include "bake/mip_maps.h"
#include "bake/scene.h"
#include "core/channels.h"
#include "core/image.h"
#include "core/index.h"
#include "core/options.h"
#include "core/progress.h"
#include "reference/path_observer.h"
#include "sampling/adaptive_pixels.h"
#include "stages/lobes.h"
#include "stages/ray_kinds.h"
#include "surfaces/channel_values.h"
#include "surfaces/choose_surface.h"

namespace whit::reference {

struct Settings {
  RenderOptions options;
  EffectSet effects = EffectSet::all();  // effects that the scene has and that are not disabled
  int threads = 1;                       // used in place of the options' number
  const EarlierView* earlier = nullptr;  // where the channel "motion" begins
};

// Counters of the rays traced, by their kind.
class RayCounts {
 public:
  // Sums over the samples of RadianceColumns::ended and RadianceColumns::clear.
  double ended = 0;
  RgbD clear;

  std::uint64_t& operator[](RayKind kind) { return entryOf(counts_, kind); }
  std::uint64_t operator[](RayKind kind) const { return entryOf(counts_, kind); }

  // Samples that were traced again as narrower trees, and pixels that have such samples.
  std::uint64_t limitedSamples = 0, limitedPixels = 0;

  std::uint64_t all() const {
    return std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0});
  }

  RayCounts& operator+=(const RayCounts& b) {
    for (const auto k : indices(kRayKindCount)) counts_[k] += b.counts_[k];
    ended += b.ended;
    clear += b.clear;
    limitedSamples += b.limitedSamples;
    limitedPixels += b.limitedPixels;
    return *this;
  }

 private:
  std::array<std::uint64_t, kRayKindCount> counts_{};
};

struct Impulses;
struct SampledLobe;
struct Surfel;
struct Crossing;

// The impulses that a sample has followed, and whether it is traced again as a narrower tree
// (sampling/ray_limit.h).
struct SampleTree {
  std::uint64_t followed = 0;
  bool narrows = false;
};

// The path that a ray ends: the path's number, and the place of the pixel's sample in the pattern.
// The tree is set if the number of its rays is bounded; `width` is that of the ray.
struct Path {
  std::uint32_t number = 0, sample = 0;
  bool straight = true;  // the path has gone on along its camera ray
  SampleTree* tree = nullptr;
  std::uint64_t width = 1;
  double share = 1;      // 1 over the product of the numbers of samples of lobes on the way
  RgbD weight{1, 1, 1};  // weight of the background where it ends
};

// Selects the impulses of a surface that are followed: all, or the chosen one, which then counts
// for all. `next` is the number of the next impulse.
struct Choice {
  std::uint64_t width = 1;  // number of rays that are followed
  bool all = true;
  std::size_t chosen = 0, next = 0;
  double weights = 0;  // sum of the largest channels of all weights
};

// Computes the radiance along a ray, recursing for impulses (Whitted 1980). `throughput`, which the
// cutoff needs, is the factor of the result on its way to the eye; `path` draws the samples of
// lobes.
class Tracer {
 public:
  Tracer(const Scene& scene, const Intersector& intersector, const Settings& settings,
         const PathObserver& observer = kUnobserved);

  RgbD traceImpulse(const Ray& ray, int depth, double throughput, std::uint32_t media,
                    RayCounts& counts, Path path = {}) const;

  // Returns the mean over the sample pattern of the pixel.
  RgbD pixel(const CameraFrame& camera, int x, int y, RayCounts& counts) const;

  // Returns the standard error of pixel(), as the root mean square of those of the three colors and
  // as if samples were independent; infinity for one sample.
  double standardError(const CameraFrame& camera, int x, int y, RayCounts& counts) const;

  // Return the radiance along the ray through the pixel's center alone, and the surface that it
  // hits.
  RgbD center(const CameraFrame& camera, int x, int y, RayCounts& counts) const;
  PixelSurface surfaceAtCenter(const CameraFrame& camera, int x, int y) const;

  // Returns the radiance through any place in the pixel, from its top left; lobes are sampled as
  // for this sample.
  RgbD sampled(const CameraFrame& camera, int x, int y, const Vec2f& at, std::size_t sample,
               RayCounts& counts) const;

  bool samplesAdaptively() const { return whit::samplesAdaptively(options_, scene_.effects); }

  // Returns the channels of the first hit of the ray of sampled().
  ChannelValues channels(const CameraFrame& camera, int x, int y, const Vec2f& at,
                         std::size_t sample) const;

 private:
  std::optional<ChosenSurface> nearest(Ray ray, int depth) const;
  Surfel surfelAt(const Ray& ray, const ChosenSurface& chosen, const TriangleHit& hit) const;
  RgbD radianceFromLights(const Surfel& surfel, int depth, double throughput, RayCounts& counts,
                          Path path) const;
  RgbD radianceFromAmbient(const Surfel& surfel, int depth, RayCounts& counts, Path path) const;
  template <typename Use>
  void forEachSample(const SampledLobe& sampled, const Surfel& surfel, int depth,
                     std::uint32_t media, const Path& path, const Use& use) const;
  RgbD radianceByLobe(const SampledLobe& sampled, const Surfel& surfel, int depth,
                      double throughput, std::uint32_t media, RayCounts& counts, Path path,
                      Choice& choice) const;
  RgbD follow(const Impulse& impulse, RayKind kind, int depth, double throughput, RayCounts& counts,
              Path path, int shares, Choice& choice) const;
  Choice chooseImpulses(const Impulses& impulses, const Surfel& surfel, const Crossing& crossing,
                        int depth, double throughput, std::uint32_t media, Path path) const;

  const Scene& scene_;
  const Intersector& intersector_;
  const PathObserver& observer_;
  RenderOptions options_;
  EffectSet effects_;
  const EarlierView* earlier_;
  std::vector<Vec2f> samples_;
  std::optional<MipMaps> maps_;  // empty unless lookups are trilinear
};

// Renders all pixels of image.window; settings.threads threads share the rows.
RayCounts render(const Scene& scene, const Intersector& intersector, const Camera& camera,
                 const Settings& settings, Image& image, Progress* progress = nullptr);

// Stores the channels of image.window, the way kernels keep them (core/channels.h): the first hits
// of the rays through the sample nearest to the center of each pixel, or through the center itself
// with adaptive sampling.
void keepChannels(const Scene& scene, const Intersector& intersector, const Camera& camera,
                  const Settings& settings, const Image& image, ChannelLayers& layers,
                  Progress* progress = nullptr);

}  // namespace whit::reference
