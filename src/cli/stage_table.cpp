#include "cli/stage_table.h"

#include "core/formatted.h"

namespace whit::cli {

namespace {

void appendSettings(std::string& text, const RunSummary& run) {
  const bool packets = run.options.mode == Mode::packets;
  text += formatted("%s  %dx%d  %s  %d thread%s  ", run.scene.c_str(), run.width, run.height,
                    surfacesText(run.triangles, run.spheres).c_str(), run.machine.threads,
                    run.machine.threads == 1 ? "" : "s");
  if (!run.shares.empty()) text += formatted("on each of %d ranks  ", run.shares[0].ranks);
  if (packets) {
    text +=
        formatted("packets of %d, %s, %s at a time\n", run.machine.packet, run.machine.simd.c_str(),
                  run.options.batch == Batch::tile ? "a tile" : "the frame");
  } else {
    text += "scalar reference\n";
  }
}

void appendFrames(std::string& text, const RunSummary& run) {
  const std::vector<double> times = frameTimes(run);
  const double median = quantile(times, 0.5);
  text += formatted("  frame %.2f ms (%.1f a second)", median, median > 0 ? 1e3 / median : 0);
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
  for (std::size_t i = 0; i < kStageCount; ++i) {
    const double ms = frame.stageMs(static_cast<Stage>(i));
    sum += ms;
    text += formatted("  %-34s%10.3f%8.1f\n", kStageNames[i].data(), ms, 100 * ms / whole);
  }
  text += formatted("  %-34s%10.3f%8.1f\n", "between the stages, waiting", frame.frameMs - sum,
                    100 * (frame.frameMs - sum) / whole);
  text += formatted("  %-34s%10.3f%8.1f\n", "of all this inside Embree", frame.embreeMs(),
                    100 * frame.embreeMs() / whole);
}

void appendRays(std::string& text, const FrameStats& frame) {
  text += formatted("  %-14s%12s%10s%16s\n", "rays", "traced", "Mray/s", "lanes filled %");
  for (std::size_t i = 0; i < kRayKindCount; ++i) {
    const RayTally& tally = frame.meter.tally[i];
    text += formatted("  %-14s%12llu%10.2f", kRayKindNames[i].data(),
                      static_cast<unsigned long long>(tally.rays),
                      mraysPerSecond(tally.rays, frame.frameMs));
    if (tally.lanes > 0) {
      text += formatted("%16.1f\n", 100 * lanesFilled(tally));
    } else {
      text += formatted("%16s\n", "-");
    }
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
  appendRays(text, frame);
  if (!run.floorMs.empty()) {
    const double floor = quantile(run.floorMs, 0.5);
    text += formatted("  floor %.2f ms (Embree alone, the same rays); frame over floor %.2f\n",
                      floor, floor > 0 ? frame.frameMs / floor : 0);
  }
  if (frame.nonFinitePixels > 0) {
    text += formatted("  %llu pixels are not finite\n",
                      static_cast<unsigned long long>(frame.nonFinitePixels));
  }
  return text;
}

std::string effectsRatioText(const RunSummary& scenes, const RunSummary& all) {
  const RunRatio ratio = ratioOf(all, scenes);
  std::string text;
  text += formatted("%s, every effect over the scene's, medians of %zu turns\n",
                    scenes.scene.c_str(), scenes.frames.size());
  text += formatted("  %-34s%10.3f  (%.2f over %.2f ms)\n", "whole frame", ratio.frame,
                    medianFrame(all).frameMs, medianFrame(scenes).frameMs);
  text += formatted("  %-34s%10.3f  (%.2f over %.2f ms)\n", "outside Embree", ratio.outsideEmbree,
                    outsideEmbreeMs(all), outsideEmbreeMs(scenes));
  return text;
}

}  // namespace whit::cli
