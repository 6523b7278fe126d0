// The sweep of a scene, which measures one choice of options after the other.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/measurement.h"
#include "bake/scene.h"

namespace whit::accuracy {

// A scene with exact spheres, or with triangles in their place: --sphere-segments changes how a
// scene is loaded, and not how it is rendered.
class SceneVariants {
 public:
  // Loads the scene with `sphereSegments`; 0 stands for exact spheres.
  using Load = std::function<Scene(int sphereSegments)>;

  // `given` was loaded with `segments`, and must outlive the variants.
  SceneVariants(const Scene& given, int segments, Load load)
      : given_(given), segmentsGiven_(segments), load_(std::move(load)) {}

  // Loads a variant at its first use.
  const Scene& with(int sphereSegments);
  const Scene& given() const { return given_; }

  // The reason why the variant would need too much memory; empty if it does not.
  std::string leavesOut(int sphereSegments);

 private:
  const Scene& given_;
  int segmentsGiven_;
  Load load_;
  std::map<int, Scene> others_;
};

// The points that a sweep measures, and what it leaves out.
struct PointList {
  std::vector<Point> points;  // the baseline first; all with different options
  std::vector<IdleKnob> idle;
};

// `base` with one knob changed at a time, the presets of --quality, and up to `jointLimit`
// combinations of the knobs' crossed values, chosen at random with `seed`. Knobs that change
// nothing in a scene with these effects are left out.
PointList makePoints(const RenderOptions& base, EffectSet effects, const std::vector<Knob>& knobs,
                     std::size_t jointLimit, std::uint32_t seed);

// The knobs that lead from a draft to all transport: numbers of samples of a pixel, a lobe or a
// light, and light that the model leaves out.
std::vector<Knob> knobsTowardsTransport();
// Adds combinations of the presets' samples a pixel with each value of the knobs of transport,
// alone and with as many samples of lobes and lights. Leaves out points that `list` has already.
void addTransportPoints(const RenderOptions& base, EffectSet effects,
                        const std::vector<Knob>& knobs, PointList& list);

struct SweepSettings {
  Truth truth = Truth::model;
  bool full = false;
  // Empty for all knobs, or for knobsTowardsTransport() in a quick sweep with Truth::transport.
  std::vector<std::string> knobs;
  std::uint32_t seed = 1;               // gives the order of the points
  std::optional<double> timingSeconds;  // for all points of a scene; see Limits for the default
  std::string cacheFolder;
  std::string program;  // identifies the code that renders
};

// `base` is the baseline, and scenes.given() has its --sphere-segments. kQuick and kFull limit the
// samples of the reference and of the picture with all transport. Throws Error(io) when the cache
// cannot be written.
SceneSweep sweepScene(SceneVariants& scenes, const RenderOptions& base,
                      const SweepSettings& settings, Progress* progress);

}  // namespace whit::accuracy
