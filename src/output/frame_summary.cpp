#include "output/frame_summary.h"

#include <unistd.h>

#include <algorithm>

#include "core/index.h"
#include "core/text.h"

namespace whit {

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

  run.processors = static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
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

std::string loadText(const RunSummary& run) {
  // Frames of one picture do the same work, so on an idle machine their times differ by little.
  constexpr double kLargestSpread = 1.5;
  const std::vector<double> times = frameTimes(run);
  const double least = quantile(times, 1e-9);
  const double spread = least > 0 ? quantile(times, 0.95) / least : 1;
  const double others = quantile(run.otherTasks, 0.5);

  const bool crowded = others > 0 && others + run.machine.threads > run.processors;
  if (!crowded && spread <= kLargestSpread) return "";

  return formatted(
      "  machine busy or throttled: %.0f other tasks for %d processors, 95 %% of the frames within "
      "%.2f times the least%s\n",
      others, run.processors, spread, run.floorMs.empty() ? "" : "; frame over floor is too high");
}

double writtenPerSecond(const RunSummary& run) {
  return run.tracedAndWrittenMs > 0
             ? 1e3 * static_cast<double>(run.writingMs.size()) / run.tracedAndWrittenMs
             : 0;
}

double outsideEmbreeMs(const FrameStats& frame) { return frame.frameMs - frame.embreeMs(); }

RunRatio ratioOf(const RunSummary& a, const RunSummary& b) {
  std::vector<double> frames, outside;
  for (const auto i : indices(std::min(a.frames.size(), b.frames.size()))) {
    const FrameStats &x = a.frames[i], &y = b.frames[i];
    const double restX = outsideEmbreeMs(x), restY = outsideEmbreeMs(y);
    if (y.frameMs > 0) frames.push_back(x.frameMs / y.frameMs);
    if (restY > 0) outside.push_back(restX / restY);
  }
  return {quantile(frames, 0.5), quantile(outside, 0.5)};
}

double lanesFilled(const RayTally& tally) {
  return tally.lanes == 0 ? 0 : static_cast<double>(tally.rays) / static_cast<double>(tally.lanes);
}

std::vector<double> eventsPerRay(const RunSummary& run) {
  std::uint64_t rays = 0;
  for (const FrameStats& frame : run.frames) rays += frame.allRays();

  std::vector<double> perRay = run.events;
  for (double& count : perRay) count /= static_cast<double>(rays);
  return perRay;
}

double mraysPerSecond(std::uint64_t rays, double ms) {
  return ms > 0 ? static_cast<double>(rays) / ms / 1e3 : 0;
}

std::string surfacesText(std::uint64_t triangles, std::uint64_t spheres) {
  if (spheres == 0) return counted(triangles, "triangle");
  if (triangles == 0) return counted(spheres, "sphere");
  return counted(triangles, "triangle") + ", " + counted(spheres, "sphere");
}

double memoryMb(const Scene& scene, const Renderer& renderer) {
  return static_cast<double>(scene.memoryBytes() + renderer.memoryBytes()) / 1e6;
}

namespace {

void appendSettings(std::string& text, const RunSummary& run) {
  const bool packets = run.options.mode == Mode::packets;
  const std::string name = run.name.empty() ? "" : ", " + run.name;
  text += formatted("%s%s  %dx%d  %s  %s  ", run.scene.c_str(), name.c_str(), run.width, run.height,
                    surfacesText(run.triangles, run.spheres).c_str(),
                    counted(run.machine.threads, "thread").c_str());
  if (packets) {
    text +=
        formatted("packets of %d, %s, %s at a time\n", run.machine.packet, run.machine.simd.c_str(),
                  run.options.batch == Batch::tile ? "a tile" : "the frame");
  } else {
    text += "scalar reference\n";
  }
}

// Chooses the unit in which the number is not 0.0.
std::string rateText(double perSecond) {
  if (perSecond >= 1) return formatted("%.1f a second", perSecond);
  if (perSecond * 60 >= 1) return formatted("%.1f a minute", perSecond * 60);
  return formatted("%.1f an hour", perSecond * 3600);
}

void appendFrames(std::string& text, const RunSummary& run) {
  const std::vector<double> times = frameTimes(run);
  const double median = quantile(times, 0.5);
  std::string rates = rateText(median > 0 ? 1e3 / median : 0);
  if (run.writingMs.size() > 1) {
    rates += " traced, " + rateText(writtenPerSecond(run)) + " traced and written";
  }

  text += formatted("  frame %.2f ms (%s)", median, rates.c_str());
  if (times.size() > 1) {
    text += formatted(", least %.2f, 95 %% within %.2f, of %zu frames", quantile(times, 1e-9),
                      quantile(times, 0.95), times.size());
  }
  text += formatted("; load %.0f ms, build %.0f ms\n", run.loadMs, run.buildMs);
}

void appendStages(std::string& text, const FrameStats& frame) {
  const double whole = frame.frameMs > 0 ? frame.frameMs : 1;
  text += formatted("  %-34s%10s%8s\n", "stage", "ms", "%");

  double sum = 0;
  for (const auto i : indices(kStageCount)) {
    const double ms = frame.stageMs(static_cast<Stage>(i));
    sum += ms;
    text += formatted("  %-34s%10.3f%8.1f\n", kStageNames[i].data(), ms, 100 * ms / whole);
  }

  // The rest of the frame is spent between the stages, where threads wait for each other.
  text += formatted("  %-34s%10.3f%8.1f\n", "between the stages, waiting", frame.frameMs - sum,
                    100 * (frame.frameMs - sum) / whole);
  text += formatted("  %-34s%10.3f%8.1f\n", "of all this inside Embree", frame.embreeMs(),
                    100 * frame.embreeMs() / whole);
}

void appendRays(std::string& text, const FrameStats& frame, EffectSet effects) {
  text += formatted("  %-14s%12s%10s%16s\n", "rays", "traced", "Mray/s", "lanes filled %");
  for (const auto i : indices(kRayKindCount)) {
    if (!kRayKinds[i].calledForBy(effects)) continue;
    const RayTally& tally = frame.meter.tally[i];
    text += formatted("  %-14s%12llu%10.2f", kRayKinds[i].name.data(),
                      static_cast<unsigned long long>(tally.rays),
                      mraysPerSecond(tally.rays, frame.frameMs));
    const std::string filled = formatted("%.1f", 100 * lanesFilled(tally));
    text += formatted("%16s\n", tally.lanes > 0 ? filled.c_str() : "-");
  }

  text +=
      formatted("  %-14s%12llu%10.2f\n", "all", static_cast<unsigned long long>(frame.allRays()),
                mraysPerSecond(frame.allRays(), frame.frameMs));
}

}  // namespace

std::string stageTable(const RunSummary& run) {
  std::string text;
  appendSettings(text, run);
  appendFrames(text, run);

  const FrameStats& frame = medianFrame(run);
  // The reference has no stages to take apart.
  if (run.options.mode == Mode::packets) appendStages(text, frame);

  if (!run.updateMs.empty()) {
    text +=
        formatted("  %-34s%10.3f\n", "updateScene, before the frame", quantile(run.updateMs, 0.5));
  }
  if (!run.writingMs.empty()) {
    text += formatted("  %-34s%10.3f%8s  %.3f waited for\n", "writing the image",
                      quantile(run.writingMs, 0.5), "", quantile(run.waitedMs, 0.5));
  }

  appendRays(text, frame, run.effects);
  if (!run.floorMs.empty()) {
    const double floor = quantile(run.floorMs, 0.5);
    text += formatted("  floor %.2f ms (Embree alone, the same rays); frame over floor %.2f\n",
                      floor, floor > 0 ? frame.frameMs / floor : 0);
  }

  const std::vector<double> perRay = eventsPerRay(run);
  for (const auto i : indices(perRay)) {
    text += formatted("  %s a ray %.4g\n", kProcessorEvents[i].name.data(), perRay[i]);
  }
  if (!run.noEvents.empty()) {
    text += "  instructions, cycles and cache misses a ray are not counted: " + run.noEvents + "\n";
  }

  return run.otherTasks.empty() ? text : text + loadText(run);
}

std::vector<std::string> pictureWarnings(const RunSummary& run) {
  unsigned long long limited = 0, notFinite = 0;
  for (const FrameStats& frame : run.frames) {
    limited += frame.limitedPixels;
    notFinite += frame.nonFinitePixels;
  }

  std::vector<std::string> warnings;
  if (limited > 0) {
    warnings.push_back(
        formatted("%llu %s samples of more than %d rays, which were traced with fewer (--max-rays)",
                  limited, limited == 1 ? "pixel has" : "pixels have", run.options.maxRays));
  }
  if (notFinite > 0)
    warnings.push_back(
        formatted("%llu %s not finite", notFinite, notFinite == 1 ? "pixel is" : "pixels are"));
  return warnings;
}

std::string ratioText(const RunSummary& first, const RunSummary& second) {
  const RunRatio ratio = ratioOf(second, first);
  const auto row = [](const char* what, double of, double a, double b) {
    return formatted("  %-34s%10.3f  (%.2f over %.2f ms)\n", what, of, a, b);
  };

  std::string text = formatted("%s, %s over %s, medians of %zu turns\n", first.scene.c_str(),
                               second.name.c_str(), first.name.c_str(), first.frames.size());
  text += row("whole frame", ratio.frame, medianFrame(second).frameMs, medianFrame(first).frameMs);
  return text + row("outside Embree", ratio.outsideEmbree, outsideEmbreeMs(medianFrame(second)),
                    outsideEmbreeMs(medianFrame(first)));
}

}  // namespace whit
