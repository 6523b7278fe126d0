// --max-rays in the vector pipeline: which pixels it limits, and that its random choices are those
// of the reference, whose mean is tested there, whatever the queues.
#include <gtest/gtest.h>

#include <algorithm>

#include "render/pipeline_laws.h"

namespace whit::test {
namespace {

// Glass, mirrors and samples of lobes give many pixels trees of more rays than the limit.
RenderOptions branching() {
  RenderOptions o = smallOptions({48, 30});
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
  const auto picture = [&](int maxRays) {
    RenderOptions o = branching();
    o.maxRays = maxRays;
    return render(scene, o);
  };
  const Picture limited = picture(24), whole = picture(0), large = picture(1000000);

  EXPECT_EQ(whole.stats.limitedPixels, 0u);
  EXPECT_EQ(large.stats.limitedPixels, 0u);
  EXPECT_EQ(firstDifference(large, whole), "");
  EXPECT_GT(limited.stats.limitedPixels, 100u);
  EXPECT_LT(limited.stats.limitedPixels, limited.image.pixels.size());

  const std::size_t different =
      pixelsApart(limited.image, whole.image, std::numeric_limits<float>::denorm_min());

  EXPECT_LE(different, limited.stats.limitedPixels);
  EXPECT_GT(different, limited.stats.limitedPixels / 2);
}

// The channel `rays` counts the rays of the tree that the picture shows.
TEST(RayLimit, BoundsTheCountedRays) {
  const Scene scene = load("glass");
  RenderOptions o = branching();
  o.spp = 3;
  o.channels = parseChannels("rays,error");
  const auto mostRays = [&](int maxRays) {
    o.maxRays = maxRays;
    Film film = render(scene, o);
    return std::ranges::max(film.channels.numbers(Channel::rays));
  };

  // Each ray has a shadow ray to each light.
  const std::uint32_t most = mostRays(24);
  EXPECT_LE(most, 25 * (1 + scene.lights.size()));
  EXPECT_GT(mostRays(0), most);
}

}  // namespace
}  // namespace whit::test
