// Laws that hold for every scene and effect.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "inspect/metrics.h"
#include "inspect/reference_frame.h"
#include "inspect/stage_comparison.h"
#include "render/every_target.h"
#include "render/shipped_scene.h"

namespace whit::test {

// Expects every stage to be as near to its scalar reference as its limit requires, on every SIMD
// target of the machine, but for rows for which isExempt(row) holds.
template <typename IsExempt>
void expectStagesAgreeOnEveryTarget(const Scene& scene, RenderOptions options,
                                    const IsExempt& isExempt) {
  forEachTarget([&](const std::string& target) {
    options.simd = target;
    Renderer renderer(scene, options);
    const Film film = makeFilm(scene, options);

    for (const StageDifference& row : compareStages(renderer, chooseCamera(scene, options), film)) {
      EXPECT_GT(row.slots, 0u);
      if (isExempt(row)) continue;
      EXPECT_LE(row.worstUlp, row.limitUlp)
          << entryOf(kStageNames, row.stage) << " " << row.column << " at " << row.pixelX << ","
          << row.pixelY << " depth " << row.depth;
    }
  });
}
inline void expectStagesAgreeOnEveryTarget(const Scene& scene, const RenderOptions& options) {
  expectStagesAgreeOnEveryTarget(scene, options, [](const StageDifference&) { return false; });
}

inline ImageDifference differenceOf(const BothModes& both) {
  return compareImages(both.packets.image, both.reference.image);
}

// Returns the difference between packets and the reference.
inline ImageDifference differenceFromReference(const Scene& scene, const RenderOptions& options) {
  return differenceOf(renderBoth(scene, options));
}

// Expects packets to agree with the reference where rays are sampled. Half a per cent of the pixels
// may differ: each is the mean of dozens of paths, any of which may hit an edge.
inline void expectSampledPictureAgrees(const BothModes& both) {
  const ImageDifference d = differenceOf(both);
  EXPECT_LE(d.pixelsGe2CodesPct, 0.5);
  EXPECT_LE(d.flipMean, 0.01);
  EXPECT_EQ(d.nonFinite, 0u);
}
inline void expectSampledPictureAgrees(const Scene& scene, const RenderOptions& options) {
  expectSampledPictureAgrees(renderBoth(scene, options));
}

// Ways to divide the work.
struct Division {
  const char* name;
  std::function<void(RenderOptions&)> set;
};

inline std::vector<Division> usualDivisions() {
  return {
      {"1 thread", [](RenderOptions& o) { o.threads = 1; }},
      {"3 threads", [](RenderOptions& o) { o.threads = 3; }},
      {"tiles of 8", [](RenderOptions& o) { o.tile = 8; }},
      {"tiles of 11", [](RenderOptions& o) { o.tile = 11; }},
      {"queues of 48", [](RenderOptions& o) { o.queue = 48; }},
      {"whole frames", [](RenderOptions& o) { o.batch = Batch::frame; }},
      {"packets of 4", [](RenderOptions& o) { o.packet = 4; }},
      {"every effect", [](RenderOptions& o) { o.effects = EffectChoice::all; }},
  };
}

// Expects the same bits however the work is divided.
inline void expectBitsWhateverTheQueues(const Scene& scene, const RenderOptions& options,
                                        const std::vector<Division>& divisions = usualDivisions()) {
  const Picture expected = render(scene, options);
  for (const Division& division : divisions) {
    RenderOptions o = options;
    division.set(o);
    EXPECT_EQ(firstDifference(render(scene, o), expected), "") << division.name;
  }
}

// Expects stages and pictures of the reference, and the same bits however the work is divided.
inline void expectThePipelineLaws(const Scene& scene, const RenderOptions& options) {
  expectStagesAgreeOnEveryTarget(scene, options);
  expectSampledPictureAgrees(scene, options);
  expectBitsWhateverTheQueues(scene, options);
}

// Expects that a part of the picture and of its channels has the bits of the whole.
inline void expectBitsOfTheWhole(const Scene& scene, RenderOptions options, const Crop& crop) {
  const Picture whole = render(scene, options);
  options.crop = crop;
  const Picture part = render(scene, options);
  EXPECT_EQ(part.image.window, crop);

  forEachPixel(part.image, [&](int x, int y) {
    EXPECT_EQ(part.image.at(x, y), whole.image.at(x, y)) << x << "," << y;
    options.channels.forEach([&](Channel c) {
      const auto bytesAt = [&](const Film& film) {
        const std::size_t size = infoOf(c).components * sizeof(float);
        return bytesOf(film.channels, c).subspan(size * film.image.index(x, y), size);
      };
      EXPECT_TRUE(std::ranges::equal(bytesAt(part), bytesAt(whole))) << infoOf(c).name << x << y;
    });
  });
}

}  // namespace whit::test
