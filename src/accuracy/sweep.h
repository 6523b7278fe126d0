// The sweep of a scene, which measures one choice of options after the other, and the pictures that
// points are measured against: those of the scalar reference, each rendered once, and the picture
// with all transport.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/measurement.h"
#include "bake/scene.h"
#include "core/image.h"
#include "core/options.h"
#include "core/progress.h"

namespace whit::accuracy {

struct ReferencePicture {
  Image image;
  double renderMs = 0;  // the time that rendering took
  double rays = 0;      // number of rays
};

// The picture with all light that whit can transport. Packets render it in several passes of
// independent noise. The reference in double would take a hundred times as long, so that its noise
// would be far above the rounding errors that it avoids.
struct TransportPicture : TransportFacts {
  Image image;
};

// The number of passes of the picture with all transport; even, so that both halves are alike.
inline constexpr int kTransportPasses = 8;

// The mean of independent pictures of one view, which differ in their noise, and its error.
class PassMean {
 public:
  void add(const Image& pass) { passes_.push_back(pass); }

  // Needs one pass or more.
  Image mean() const { return picture(0, 1); }
  // The mean of the passes with even or odd numbers, to tell how visible noise is. Needs two passes
  // or more.
  Image half(bool odd) const { return picture(odd ? 1 : 0, 2); }
  // The standard error of the mean in linear radiance: the root mean square over pixels and
  // channels. Needs two passes or more.
  double standardError() const;
  // The mean over pixels and channels.
  double meanRadiance() const;

 private:
  // The means of every step-th pass, from `first` on.
  std::vector<RgbD> means(std::size_t first, std::size_t step) const;
  Image picture(std::size_t first, std::size_t step) const;

  std::vector<Image> passes_;
};

// The mean of kTransportPasses passes with these options, which must have Mode::packets; each has
// options.spp samples.
TransportPicture renderTransport(const Scene& scene, const Camera& camera,
                                 const RenderOptions& options, Progress* progress);

// Keeps the pictures of one scene and camera by their options.
class ReferenceCache {
 public:
  ReferenceCache(const Scene& scene, const Camera& camera) : scene_(scene), camera_(camera) {}

  // `options` must have Mode::reference.
  const ReferencePicture& get(const RenderOptions& options, Progress* progress);

 private:
  const Scene& scene_;
  Camera camera_;
  std::map<std::string, ReferencePicture> pictures_;
};

// The points that a sweep measures, and what it leaves out.
struct PointList {
  std::vector<Point> points;  // the baseline first; all with different options
  std::vector<IdleKnob> idle;
};

// `base` with one knob changed at a time, and the presets of --quality. Knobs that change nothing
// in a scene with these effects are left out.
PointList makePoints(const RenderOptions& base, EffectSet effects, const std::vector<Knob>& knobs);

// The knobs that lead from one sample to all transport: numbers of samples of a pixel, a lobe or a
// light, and light that the model leaves out.
std::vector<Knob> knobsTowardsTransport();
// Adds combinations of the presets' samples a pixel with each value of the knobs of transport,
// alone and with as many samples of lobes and lights. Leaves out points that `list` has already.
void addTransportPoints(const RenderOptions& base, EffectSet effects,
                        const std::vector<Knob>& knobs, PointList& list);

// Most limits count rays, so that the reference does not depend on the speed of the machine.
struct Limits {
  int samples, leastSamples;
  double referenceRays;  // for the reference
  double transportRays;  // for the picture with all transport
  double scalarRays;     // for a point that the scalar reference renders
  double longFrameRays;  // a frame of the baseline with more rays is long
  double timingSeconds;  // for all points of a scene
  double seconds;        // no point is begun later, apart from the time for timing
};
inline constexpr Limits kQuick{64, 2, 30e6, 400e6, 20e6, 2.5e6, 20, 30};
inline constexpr Limits kFull{256, 8, 400e6, 4e9, 100e6, 1e300, 600, 1e300};

struct Scope {
  Limits limits;
  double frameRays = 0;      // rays of a frame of the baseline
  double raysPerSample = 0;  // rays of a sample of the exact picture
  bool chosenKnobs = false;  // the user named the knobs, and all of them are measured
  int baselineSpp = 1;
  double transportPaths = 0;  // paths of a pixel in the picture with all transport, or 0 without it

  // Samples a pixel of the reference.
  int samples() const {
    int samples = limits.samples;
    while (samples > limits.leastSamples && samples * raysPerSample > limits.referenceRays) {
      samples /= 2;
    }
    return samples;
  }

  // Samples a pixel in each pass of the picture with all transport. `rays` is the number of rays of
  // one sample of the whole picture.
  int transportSamples(double rays) const {
    int count = samples();
    while (count > 1 && kTransportPasses * count * rays > limits.transportRays) count /= 2;
    return count;
  }
  bool longFrames() const { return frameRays > limits.longFrameRays; }

  // The reason why the point is left out; empty if it is measured.
  std::string leavesOut(const Point& point) const {
    if (point.kind == PointKind::baseline) return {};

    if (point.options.mode == Mode::reference &&
        point.options.spp * raysPerSample > limits.scalarRays) {
      return "the scalar reference would take too long here";
    }
    if (point.options.spp > std::max(samples() / 2, baselineSpp)) {
      return "more than half of the reference's samples";
    }
    if (transportPaths > 0 && whit::accuracy::transportPaths(point.options) > transportPaths / 2) {
      return "more than half of the paths that the picture with all transport has";
    }

    return {};
  }

  // True if no point is begun any more after `seconds`; the sweep gives the reason below.
  bool isOver(double seconds) const { return !chosenKnobs && seconds > limits.seconds; }
  static constexpr const char* kOverBecause =
      "the minute of a quick sweep was over: --full, or --knobs with one of them, measures it";

  // True if packets are compared with the scalar reference of the same options, path by path.
  bool comparesPaths(const Point& point) const {
    if (point.options.mode == Mode::reference) return false;
    if (point.kind == PointKind::baseline) return true;
    return point.cause == Cause::arithmetic && (chosenKnobs || !longFrames());
  }
};

struct SweepSettings {
  Truth truth = Truth::model;
  bool full = false;
  // Empty for all knobs, or for knobsTowardsTransport() in a quick sweep with Truth::transport.
  std::vector<std::string> knobs;
  std::uint32_t seed = 1;               // gives the order of the points
  std::optional<double> timingSeconds;  // for all points of a scene; see Limits for the default
};

// `base` is the baseline. kQuick and kFull limit the samples of the reference and of the picture
// with all transport.
SceneSweep sweepScene(const Scene& scene, const RenderOptions& base, const SweepSettings& settings,
                      Progress* progress);

}  // namespace whit::accuracy
