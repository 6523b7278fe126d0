// The effect of arithmetic alone: pixels whose rays hit the same surfaces, in packets of floats and
// in the reference's doubles.
#include <gtest/gtest.h>

#include <filesystem>

#include "inspect/metrics.h"
#include "inspect/path_divergence.h"
#include "io/files.h"
#include "render/shipped_scene.h"

namespace whit::test {
namespace {

// Pixels whose paths diverged are taken from the reference, at the default depth and cutoff.
int largestStepOfSamePaths(const std::string& name) {
  const Scene scene = load(name);
  RenderOptions o = smallOptions();
  o.depth = RenderOptions().depth;

  Renderer renderer(scene, o);
  const Film film = makeFilm(scene, o);
  PathComparison paths = comparePaths(renderer, chooseCamera(scene, o), film);
  for (std::size_t i = 0; i < paths.diverged.size(); ++i) {
    if (paths.diverged[i]) paths.packets.pixels[i] = paths.reference.pixels[i];
  }

  const ImageDifference d = compareImages(paths.packets, paths.reference);
  std::printf("%s: %llu of %zu pixels diverged, the others within %d codes, RMSE %.2e\n",
              name.c_str(), static_cast<unsigned long long>(paths.divergences),
              paths.diverged.size(), d.maxCode, d.rmse);

  // Most pixels must remain to compare: 6 % diverge where paths are caught in glass.
  EXPECT_LT(static_cast<double>(paths.divergences),
            0.1 * static_cast<double>(paths.diverged.size()));
  return d.maxCode;
}

class SamePath : public testing::TestWithParam<std::string> {};

TEST_P(SamePath, PixelsAreWithinOneCode) { EXPECT_LE(largestStepOfSamePaths(GetParam()), 1); }

INSTANTIATE_TEST_SUITE_P(Shipped, SamePath,
                         testing::Values("whitted", "mirrors", "matte", "landscape?triangles=20000",
                                         "atrium"));

TEST(SamePathOfLargeScenes, SponzaIsWithinOneCode) {
  if (!std::filesystem::exists(dataFolder() / "crytek_sponza/sponza.obj")) {
    GTEST_SKIP() << "NOT TESTED: no crytek_sponza in '" << dataFolder() << "'; set WHIT_DATA";
  }
  EXPECT_LE(largestStepOfSamePaths("sponza-mirror"), 1);
}

// Curved surfaces of nested glass magnify rounding errors with every bounce, as long as the path
// hits the same triangles.
TEST(SamePathInGlass, PixelsAreWithinTwoCodes) { EXPECT_LE(largestStepOfSamePaths("glass"), 2); }

}  // namespace
}  // namespace whit::test
