// The exposure that --exposure auto chooses for a view.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/display.h"
#include "core/option_table.h"
#include "inspect/auto_exposure.h"
#include "shipped_scene.h"

namespace whit {
namespace {

float exposureOf(const Scene& scene, const RenderOptions& options = {}) {
  Renderer renderer(scene, options);
  return exposureFor(renderer, chooseCamera(scene, options));
}

// An emitting plate fills the view.
Scene glowing(float radiance, float sky = 0, float side = 10) {
  verify::SceneBuilder builder;
  builder.add(verify::quad({-side, -side, 0}, {side, -side, 0}, {side, side, 0}, {-side, side, 0}),
              verify::emittingMaterial(radiance));
  builder.description.cameras.emplace_back();
  builder.sky(sky);
  return builder.build();
}

// The exposure makes the mean of the surfaces 0.3, in steps of 1/8 EV. A sky beside a dark surface
// lowers it, but not without end unless the sky fills the picture; then that must not burn out.
TEST(AutoExposure, TakesTheMeanOfTheSurfacesToTheMiddle) {
  struct Case {
    float radiance, sky, side;
    double exposure;
  };
  for (const Case& c : {Case{0.3f, 0, 10, 0},
                        {1.2f, 0, 10, -2},
                        {0.3f / 1024, 0, 10, 10},
                        {3.0e5f, 0, 10, std::log2(1.0e-6)},
                        {0, 0, 10, 0},
                        {5, 1, 1.0e-6f, 0},
                        {0.0375f, 0.0625f, 1, 3},
                        {0.0375f, 0.125f, 1, 2},
                        {0.0375f, 0.35f, 1, 1},
                        {0.0375f, 50, 1, std::log2(0.8 / 50)}}) {
    EXPECT_EQ(exposureOf(glowing(c.radiance, c.sky, c.side)), std::round(8 * c.exposure) / 8)
        << c.radiance << " before " << c.sky;
  }
}

TEST(AutoExposure, LevelsAreThoseBehindTheToneCurve) {
  RenderOptions options;
  options.toneCurve = ToneCurve::reinhard;
  EXPECT_EQ(exposureOf(glowing(0.3f / 0.7f), options), 0);  // x / (1 + x) = 0.3

  options.toneCurve = ToneCurve::filmic;
  const float ev = exposureOf(glowing(0.1f), options);
  EXPECT_NEAR(applyToneCurve(ToneCurve::filmic, 0.1 * std::exp2(double{ev})), 0.3, 0.02)
      << "steps of 1/8 EV";
}

// A closed box around the camera, before whose far wall there are 32 x 20 emitting fields. One in
// twenty glows `peak` times as bright as the rest, in one channel only.
Scene closedBox(float peak, bool isModel) {
  constexpr int kColumns = 32, kRows = 20;
  verify::SceneBuilder builder;
  builder.description.isModel = isModel;
  for (const float radiance : {0.2f, 0.4f}) builder.add(verify::emittingMaterial(radiance));
  Material bright = verify::emittingMaterial(0.2f);
  bright.emission.x *= peak;
  builder.add(bright);

  for (int i = 0; i < kColumns * kRows; ++i) {
    const auto x = static_cast<float>(i % kColumns - kColumns / 2);
    const auto y = static_cast<float>(i / kColumns - kRows / 2);
    const bool isBright = i * 7 % 20 == 0;
    builder.add(verify::quad({x, y, 0}, {x + 1, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0},
                             isBright ? 2u : static_cast<std::uint32_t>(i & 1)));
  }

  builder.add(verify::box({-16, -10, -1}, {16, 10, 50}, 0));
  builder.lookFrom({0, 0, 20});
  return builder.build();
}

// The share of the pixels that have a channel at 255.
double clippedShare(const Scene& scene, RenderOptions options) {
  options.exposure.automatic = true;
  options.size = ImageSize{240, 150};
  Renderer renderer(scene, options);
  chooseExposure(renderer, scene.cameras[0], options);

  const Film film = test::render(renderer);
  std::size_t clipped = 0;
  for (std::size_t i = 0; i < film.display.rgba.size(); i += 4) {
    const auto* const pixel = &film.display.rgba[i];
    clipped += std::max({pixel[0], pixel[1], pixel[2]}) == 255;
  }
  return static_cast<double>(clipped) / static_cast<double>(film.image.pixels.size());
}

TEST(AutoExposure, OfAModelClipsAtMostOneHalfPercent) {
  for (const Mode mode : {Mode::packets, Mode::reference}) {
    for (const ToneCurve curve : {ToneCurve::none, ToneCurve::filmic}) {
      RenderOptions options;
      options.mode = mode;
      options.toneCurve = curve;
      for (const float peak : {1.0f, 9.0f, 20.0f}) {
        EXPECT_LE(clippedShare(closedBox(peak, true), options), 0.005) << peak;
      }
      EXPECT_GT(clippedShare(closedBox(20, false), options), 0.005) << "of other scenes";
    }
  }
}

// The highlights of the pieces are many small ones: those that measured pixels happen to meet must
// not decide.
TEST(AutoExposure, OfAModelIsAboutTheSameInNeighboringViews) {
  constexpr float kMost = 0.5f;  // EV
  const auto exposureFrom = [](const char* azimuth, const char* zoom) {
    LoadOptions options;
    options.settings = {std::string("/azimuth=") + azimuth, std::string("/zoom=") + zoom};
    return exposureOf(test::repaired(test::described("chess.glb", options)));
  };

  const float middle = exposureFrom("30", "1.2");
  for (const char* azimuth : {"25", "35"}) {
    EXPECT_NEAR(exposureFrom(azimuth, "1.2"), middle, kMost) << azimuth;
  }
  for (const char* zoom : {"1.1", "1.3"})
    EXPECT_NEAR(exposureFrom("30", zoom), middle, kMost) << zoom;
}

TEST(AutoExposure, HighlightsDarkenAModelByThreeStopsAtMost) {
  EXPECT_EQ(exposureOf(closedBox(1.0e6f, true)), exposureOf(closedBox(1.0e6f, false)) - 3);
}

TEST(AutoExposure, IsTheSameHoweverThePictureIsComputed) {
  const Scene scene = test::load("glass");
  const float expected = exposureOf(scene);
  EXPECT_NE(expected, 0);

  for (const auto& [name, value] : {std::pair{"size", "33x21"},
                                    {"crop", "0,0,5,5"},
                                    {"threads", "1"},
                                    {"tile", "7"},
                                    {"packet", "1"},
                                    {"batch", "frame"},
                                    {"spp", "4"},
                                    {"depth", "0"},
                                    {"mode", "reference"},
                                    {"exposure", "3"},
                                    {"glossy", "4"},
                                    {"light-samples", "4"},
                                    {"effects", "all"}}) {
    RenderOptions options;
    setOption(options, name, value);
    EXPECT_EQ(exposureOf(scene, options), expected) << name;
  }
}

TEST(AutoExposure, IsSettledOnce) {
  const Scene scene = glowing(1.2f);
  RenderOptions options;
  setOption(options, "exposure", "auto");
  EXPECT_EQ(optionText(options, "exposure"), "auto");

  Renderer renderer(scene, options);
  chooseExposure(renderer, scene.cameras[0], options);
  EXPECT_EQ(optionText(options, "exposure"), "-2");
  EXPECT_EQ(renderer.options().exposure, options.exposure);

  // An exposure that is given stays.
  setOption(options, "exposure", "1.5");
  chooseExposure(renderer, scene.cameras[0], options);
  EXPECT_EQ(options.exposure.ev, 1.5f);
}

}  // namespace
}  // namespace whit
