// --impulse-rate and --shadow-rate: every other pixel borrows from its neighbours.
#include <gtest/gtest.h>

#include "metrics/metrics.h"
#include "reference/reference.h"
#include "render/embree_intersector.h"
#include "render/shipped_scene.h"
#include "scene/light_shares.h"

namespace whit::test {
namespace {

RenderOptions atRates(Rate impulses, Rate shadows) {
  RenderOptions o = smallOptions();
  o.impulseRate = impulses;
  o.shadowRate = shadows;
  return o;
}
RenderOptions half() { return atRates(Rate::half, Rate::half); }

class HalfRate : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { scene_ = load(GetParam()); }
  Scene scene_;
};

// Pixels that lend, and those that have too few lenders on their surface, are as at full rate to
// the bit.
TEST_P(HalfRate, borrowsOnlyFromTheSameSurface) {
  const RenderOptions o = half();
  const Picture full = render(scene_, smallOptions());
  Renderer renderer(scene_, o);
  Film film = makeFilm(scene_, o);
  const Camera camera = chooseCamera(scene_, o);
  const FrameStats stats = renderer.render(camera, film);
  Accel accel(scene_, AccelOptions{});
  const EmbreeIntersector intersector(accel);
  const reference::Tracer tracer(scene_, intersector, reference::Settings{});
  const CameraFrame frame = makeCameraFrame(camera, film.image.width, film.image.height);
  const Crop& window = film.image.window;
  std::vector<PixelSurface> surfaces(film.image.pixels.size());
  for (int y = 0; y < window.y1; ++y) {
    for (int x = 0; x < window.x1; ++x) {
      surfaces[film.image.index(x, y)] = tracer.surfaceAtCentre(frame, x, y);
    }
  }
  const LightShares shares(window, surfaces);
  int borrowed = 0, alone = 0, wrong = 0;
  for (int y = 0; y < window.y1; ++y) {
    for (int x = 0; x < window.x1; ++x) {
      const std::size_t i = film.image.index(x, y);
      const bool same = film.image.pixels[i] == full.image.pixels[i];
      const bool lends = LightShares::lends(x, y);
      const int lenders = lends ? 0 : shares.lendersOf(x, y, surfaces[i]).count;
      if (lends || lenders < Lenders::kEnough) {
        ++alone;
        wrong += !same;
      } else {
        borrowed += !same;
      }
    }
  }
  std::printf("%s: %d pixels changed, %d must not, %d of these did\n", GetParam().c_str(), borrowed,
              alone, wrong);
  // Surfaces are compared in float by the pipeline, in double here: a decision within rounding.
  EXPECT_LE(wrong, 2);
  EXPECT_LE(stats.of(RayKind::shadow).rays, full.stats.of(RayKind::shadow).rays);
  if (full.stats.of(RayKind::reflection).rays > 0) {
    EXPECT_GT(borrowed, 0);
    EXPECT_LT(stats.of(RayKind::reflection).rays, full.stats.of(RayKind::reflection).rays);
  }
}

TEST_P(HalfRate, H60_anyTilesThreadsQueuesAndPacketsGiveTheSameBits) {
  const Picture expected = render(scene_, half());
  std::vector<RenderOptions> variants(5, half());
  variants[0].threads = 3;
  variants[1].tile = 5;
  variants[2].queue = 16;
  variants[2].tile = 64;
  variants[3].batch = Batch::frame;
  variants[4].packet = 4;
  for (const RenderOptions& o : variants) {
    EXPECT_EQ(firstDifference(render(scene_, o).image, expected.image), "") << &o - variants.data();
  }
}

TEST_P(HalfRate, H59_croppedPixelsHaveTheBitsOfTheWholeImage) {
  for (const bool adaptive : {false, true}) {
    RenderOptions o = half();
    o.adaptive = adaptive;
    o.spp = adaptive ? 5 : 1;
    const Image whole = render(scene_, o).image;
    o.crop = Crop{31, 20, 62, 45};
    const Image part = render(scene_, o).image;
    for (int y = o.crop->y0; y < o.crop->y1; ++y) {
      for (int x = o.crop->x0; x < o.crop->x1; ++x) {
        EXPECT_EQ(part.at(x, y), whole.at(x, y)) << x << "," << y;
      }
    }
  }
}

TEST_P(HalfRate, agreesWithTheReference) {
  const RenderOptions rates[] = {atRates(Rate::half, Rate::full), atRates(Rate::full, Rate::half),
                                 half()};
  for (const RenderOptions& o : rates) {
    Renderer renderer(scene_, o);
    Film packets = makeFilm(scene_, o), reference = makeFilm(scene_, o);
    const FrameStats a = renderer.render(chooseCamera(scene_, o), packets);
    const FrameStats b = renderer.renderReference(chooseCamera(scene_, o), reference);
    const ImageDifference d = compareImages(packets.image, reference.image);
    std::printf("%s: %.4f %% of pixels off by two codes or more (at most 0.2)\n",
                GetParam().c_str(), d.pixelsGe2CodesPct);
    // Twice the gate of full rates: a pixel beside one that is off may borrow from it.
    EXPECT_LE(d.pixelsGe2CodesPct, 0.2);
    for (std::size_t kind = 0; kind < kRayKindCount; ++kind) {
      const auto rays = static_cast<double>(b.tally[kind].rays);
      EXPECT_NEAR(static_cast<double>(a.tally[kind].rays), rays, 2e-3 * rays + 4);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, HalfRate,
                         testing::Values("whitted", "glass", "mirrors", "matte"));

// One after the other, a renderer gives what one made for the options gives.
TEST(HalfRateOptions, canBeSetBetweenFrames) {
  const Scene scene = load("whitted");
  RenderOptions adaptive = smallOptions();
  adaptive.adaptive = true;
  adaptive.spp = 5;
  Renderer renderer(scene, smallOptions());
  for (const RenderOptions& o : {adaptive, half(), smallOptions(), half(), adaptive}) {
    renderer.setOptions(o);
    Film film = makeFilm(scene, o);
    renderer.render(chooseCamera(scene, o), film);
    EXPECT_EQ(firstDifference(film.image, render(scene, o).image), "");
  }
}

}  // namespace
}  // namespace whit::test
