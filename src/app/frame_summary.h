// The summary of a run: a scene, its settings, and what its frames cost. The common source of
// tables and JSON.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/options.h"
#include "core/quantile.h"
#include "farm/farm.h"
#include "render/renderer.h"

namespace whit::cli {

struct RunSummary {
  std::string scene;
  int width = 0, height = 0;
  RenderOptions options;
  Machine machine;
  EffectSet effects;
  std::uint64_t triangles = 0, spheres = 0;  // as seen, instances multiplied out
  double loadMs = 0, buildMs = 0;
  std::vector<FrameStats> frames;  // counted ones; none: all images were there
  std::vector<double> floorMs;     // empty without --floor
  std::string imageHash;           // of the last frame: accuracy::digestOf(image)
  std::vector<FarmFrame> shares;   // how the frames were shared; empty for one process
};

RunSummary summarize(const Scene& scene, const RenderOptions& options, const Renderer& renderer,
                     const Film& film, double loadMs);

using whit::quantile;

// The frame of median duration (the lower of the two middle ones): its stages add up.
const FrameStats& medianFrame(const RunSummary& run);
std::size_t medianFrameIndex(const RunSummary& run);
std::vector<double> frameTimes(const RunSummary& run);

// The median frame's time that is not spent inside Embree's calls.
double outsideEmbreeMs(const RunSummary& run);

// `a` over `b`, of two runs whose frames took turns: the median over the turns, in which whatever
// else the machine did to both of a turn's frames cancels. 0 for none.
struct RunRatio {
  double frame = 0, outsideEmbree = 0;
};
RunRatio ratioOf(const RunSummary& a, const RunSummary& b);

// Live lanes over lanes sent to Embree; 0 where nothing was sent.
double lanesFilled(const RayTally& tally);
double mraysPerSecond(std::uint64_t rays, double ms);

std::vector<std::string> effectNames(EffectSet effects);

struct EffectRow {
  std::string name;
  bool on = false;
  std::string because;
};
// Every effect, in the order of core/effects.h; "disabled by --disable" overrides the scene's
// reason.
std::vector<EffectRow> effectRows(const Scene& scene, const RenderOptions& options);

// "2 triangles", "3 spheres" or both.
std::string surfacesText(std::uint64_t triangles, std::uint64_t spheres);

// What one exact sphere takes beside its part of the BVH; 0 where there are none.
std::uint64_t bytesPerSphere(const Scene& scene, const Renderer& renderer);

// Scene, tables, queues and acceleration structure, in 10^6 bytes.
double memoryMb(const Scene& scene, const Renderer& renderer);

}  // namespace whit::cli
