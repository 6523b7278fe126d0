#include "cli/app/frame_summary.h"

#include <algorithm>

#include "render/shadow_cache_schedule.h"

namespace whit::cli {

RunSummary summarize(const Scene& scene, const RenderOptions& options, const Renderer& renderer,
                     const Film& film, double loadMs) {
  RunSummary run;
  run.scene = scene.name;
  run.width = film.image.width;
  run.height = film.image.height;
  run.options = options;
  run.machine = renderer.machine();
  run.effects = renderer.plan().effects;
  run.triangles = scene.instancedTriangles;
  run.spheres = scene.instancedSpheres;
  run.loadMs = loadMs;
  run.buildMs = renderer.buildMs();
  return run;
}

std::vector<double> frameTimes(const RunSummary& run) {
  std::vector<double> times;
  for (const FrameStats& frame : run.frames) times.push_back(frame.frameMs);
  return times;
}

const FrameStats& medianFrame(const RunSummary& run) {
  const double median = quantile(frameTimes(run), 0.5);
  return *std::ranges::find(run.frames, median, &FrameStats::frameMs);
}

double writtenPerSecond(const RunSummary& run) {
  return run.tracedAndWrittenMs > 0
             ? 1e3 * static_cast<double>(run.writingMs.size()) / run.tracedAndWrittenMs
             : 0;
}

double outsideEmbreeMs(const RunSummary& run) {
  const FrameStats& frame = medianFrame(run);
  return frame.frameMs - frame.embreeMs();
}

RunRatio ratioOf(const RunSummary& a, const RunSummary& b) {
  std::vector<double> frames, outside;
  for (std::size_t i = 0; i < std::min(a.frames.size(), b.frames.size()); ++i) {
    const FrameStats &x = a.frames[i], &y = b.frames[i];
    const double restX = x.frameMs - x.embreeMs(), restY = y.frameMs - y.embreeMs();
    if (y.frameMs > 0) frames.push_back(x.frameMs / y.frameMs);
    if (restY > 0) outside.push_back(restX / restY);
  }
  return {quantile(frames, 0.5), quantile(outside, 0.5)};
}

double lanesFilled(const RayTally& tally) {
  return tally.lanes == 0 ? 0 : static_cast<double>(tally.rays) / static_cast<double>(tally.lanes);
}

double mraysPerSecond(std::uint64_t rays, double ms) {
  return ms > 0 ? static_cast<double>(rays) / ms / 1e3 : 0;
}

std::vector<EffectRow> effectRows(const Scene& scene, const RenderOptions& options) {
  std::vector<EffectRow> rows;
  for (int i = 0; i < kEffectCount; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const EffectReason& reason = scene.reasons[index];
    const auto effect = static_cast<Effect>(i);
    const bool disabled = options.disable.has(effect);
    rows.push_back({std::string(kEffectNames[index].name), reason.on && !disabled,
                    reason.on && disabled ? "disabled by --disable" : reason.because});
  }
  for (const AskedFor& a : effectsAskedFor(options)) {
    EffectRow& row = rows[static_cast<std::size_t>(a.effect)];
    if (a.asked || !row.on) continue;
    row.on = false;
    row.because += ", " + std::string(a.otherwise);
  }
  return rows;
}

std::string surfacesText(std::uint64_t triangles, std::uint64_t spheres) {
  const auto counted = [](std::uint64_t count, const char* what) {
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
  };
  if (spheres == 0) return counted(triangles, "triangle");
  if (triangles == 0) return counted(spheres, "sphere");
  return counted(triangles, "triangle") + ", " + counted(spheres, "sphere");
}

std::uint64_t bytesPerSphere(const Scene& scene, const Renderer& renderer) {
  const std::uint64_t spheres = scene.triangles.size() - scene.firstSphere;
  return spheres == 0 ? 0 : sizeof(TriangleRecord) + renderer.accel().sphereBytes() / spheres;
}

std::uint64_t memoryLeft(const Scene& scene, const Renderer& renderer, std::uint64_t most) {
  const std::uint64_t taken = scene.memoryBytes() + renderer.memoryBytes();
  return most > taken ? most - taken : 0;
}

ShadowCacheOutlook shadowCacheOutlook(const Scene& scene, const RenderOptions& options) {
  if (options.shadowCache == ShadowCacheMode::off) return {0, 0, 0, "it is off by --shadow-cache"};
  const std::size_t lights = lightsWithShadowCache(makePlan(scene, options, true)).size();
  if (lights == 0) return {0, 0, 0, "there is no light whose shadows it could hold"};
  const std::size_t parts = ShadowParts::of(scene).count();
  if (parts == 0) return {0, 0, 0, "the world has no triangles, too many, or too distant ones"};
  return {lights, parts, samplesThatPay(scene), ""};
}

double memoryMb(const Scene& scene, const Renderer& renderer) {
  return static_cast<double>(scene.memoryBytes() + renderer.memoryBytes()) / 1e6;
}

}  // namespace whit::cli
