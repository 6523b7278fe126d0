// Laws that hold for every scene and effect.
#pragma once

#include <gtest/gtest.h>

#include "inspect/metrics.h"
#include "inspect/reference_frame.h"
#include "inspect/stage_comparison.h"
#include "render/shipped_scene.h"
#include "simd/kernels.h"

namespace whit::test {

// Expects every stage to be as near to its scalar reference as its limit requires, on every SIMD
// target of the machine. Leaves the default target chosen.
inline void expectStagesAgreeOnEveryTarget(const Scene& scene, RenderOptions options) {
  for (const std::string& target : simd::availableTargets()) {
    options.simd = target;
    Renderer renderer(scene, options);
    const Film film = makeFilm(scene, options);

    for (const StageDifference& row : compareStages(renderer, chooseCamera(scene, options), film)) {
      EXPECT_LE(row.worstUlp, row.limitUlp)
          << target << " " << kStageNames[static_cast<std::size_t>(row.stage)] << " " << row.column
          << " at " << row.pixelX << "," << row.pixelY << " depth " << row.depth;
      EXPECT_GT(row.slots, 0u);
    }
  }
  simd::chooseTarget("auto");
}

// Returns the difference between packets and the reference.
inline ImageDifference differenceFromReference(const Scene& scene, const RenderOptions& options) {
  Renderer renderer(scene, options);
  Film packets = makeFilm(scene, options), reference = makeFilm(scene, options);
  renderer.render(chooseCamera(scene, options), packets);
  renderReference(renderer, chooseCamera(scene, options), reference);
  return compareImages(packets.image, reference.image);
}

// Expects the picture to agree with the reference where rays are sampled. Half a per cent of the
// pixels may differ: each is the mean of dozens of paths, any of which may hit an edge.
inline void expectSampledPictureAgrees(const Scene& scene, const RenderOptions& options) {
  const ImageDifference d = differenceFromReference(scene, options);
  EXPECT_LE(d.pixelsGe2CodesPct, 0.5);
  EXPECT_LE(d.flipMean, 0.01);
  EXPECT_EQ(d.nonFinite, 0u);
}

// Expects the same bits however the work is divided.
inline void expectBitsWhateverTheQueues(const Scene& scene, const RenderOptions& options) {
  const Image expected = render(scene, options).image;
  const auto same = [&](const char* what, auto&& change) {
    RenderOptions o = options;
    change(o);
    EXPECT_EQ(firstDifference(render(scene, o).image, expected), "") << what;
  };

  same("1 thread", [](RenderOptions& o) { o.threads = 1; });
  same("3 threads", [](RenderOptions& o) { o.threads = 3; });
  same("tiles of 8", [](RenderOptions& o) { o.tile = 8; });
  same("tiles of 11", [](RenderOptions& o) { o.tile = 11; });
  same("queues of 48", [](RenderOptions& o) { o.queue = 48; });
  same("whole frames", [](RenderOptions& o) { o.batch = Batch::frame; });
  same("packets of 4", [](RenderOptions& o) { o.packet = 4; });
  same("every effect", [](RenderOptions& o) { o.effects = EffectChoice::all; });
}

}  // namespace whit::test
