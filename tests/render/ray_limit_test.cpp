// --max-rays in the vector pipeline: which pixels it limits, and that its random choices are those
// of the reference whatever the queues.
#include <gtest/gtest.h>

#include <cmath>

#include "reference/sample_mean.h"
#include "render/pipeline_laws.h"

namespace whit::test {
namespace {

// Glass, mirrors and samples of lobes give many pixels trees of more rays than the limit.
RenderOptions branching() {
  RenderOptions o = smallOptions();
  o.size = ImageSize{48, 30};
  o.indirect = 2;
  o.glossy = 2;
  o.maxRays = 24;
  return o;
}

TEST(RayLimit, HasTheSameBitsWhateverTheQueues) {
  RenderOptions o = branching();
  o.spp = 2;
  expectBitsWhateverTheQueues(load("glass"), o);
}

TEST(RayLimit, AgreesWithTheReference) { expectSampledPictureAgrees(load("glass"), branching()); }

TEST(RayLimit, ChangesThePixelsThatItCountsAndNoOthers) {
  const Scene scene = load("glass");
  RenderOptions o = branching();
  const Picture limited = render(scene, o);
  o.maxRays = 0;
  const Picture whole = render(scene, o);
  o.maxRays = 1000000;
  const Picture large = render(scene, o);

  EXPECT_EQ(whole.stats.limitedPixels, 0u);
  EXPECT_EQ(large.stats.limitedPixels, 0u);
  EXPECT_EQ(firstDifference(large.image, whole.image), "");
  EXPECT_GT(limited.stats.limitedPixels, 100u);
  EXPECT_LT(limited.stats.limitedPixels, limited.image.pixels.size());

  std::uint64_t different = 0;
  for (std::size_t i = 0; i < whole.image.pixels.size(); ++i) {
    different += !(limited.image.pixels[i] == whole.image.pixels[i]);
  }

  EXPECT_LE(different, limited.stats.limitedPixels);
  EXPECT_GT(different, limited.stats.limitedPixels / 2);
}

// The limits are small and differ much, so that a wrong weight of any kind of ray would show.
TEST(RayLimit, KeepsTheMeanOfPictures) {
  const Scene scene = load("glass");
  RenderOptions o = branching();
  o.spp = 64;
  o.size = ImageSize{24, 15};
  o.maxRays = 0;
  const Image whole = render(scene, o).image;
  for (const int maxRays : {8, 40}) {
    o.maxRays = maxRays;
    const Image limited = render(scene, o).image;

    SampleMean change;
    for (std::size_t i = 0; i < whole.pixels.size(); ++i) {
      const RgbD a(limited.pixels[i]), b(whole.pixels[i]);
      change.add(a.x + a.y + a.z - b.x - b.y - b.z);
    }

    // The standard error of the mean bounds its change.
    EXPECT_LE(std::fabs(change.value()), 4.5 * change.error()) << maxRays;
    EXPECT_GT(change.error(), 0) << maxRays;
  }
}

// The channel `rays` counts the rays of the tree that the picture shows.
TEST(RayLimit, BoundsTheCountedRays) {
  const Scene scene = load("glass");
  RenderOptions o = branching();
  o.spp = 3;
  o.channels = parseChannels("rays,error");

  const auto film = [&](int maxRays) {
    o.maxRays = maxRays;
    return render(scene, o);
  };

  Film limited = film(24), whole = film(0);
  std::uint32_t most = 0;
  for (const std::uint32_t rays : limited.channels.numbers(Channel::rays)) {
    most = std::max(most, rays);
  }

  std::uint32_t mostOfWhole = 0;
  for (const std::uint32_t rays : whole.channels.numbers(Channel::rays)) {
    mostOfWhole = std::max(mostOfWhole, rays);
  }

  // Each ray has a shadow ray to each light.
  EXPECT_LE(most, 25 * (1 + scene.lights.size()));
  EXPECT_GT(mostOfWhole, most);
}

}  // namespace
}  // namespace whit::test
