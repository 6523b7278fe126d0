// Depth of field by a thin lens. Its rays have a closed form (PrimaryRay.*), and the oracle has
// lenses of its own (Mixed.*).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pi.h"
#include "reference/small_scenes.h"
#include "render/pipeline_laws.h"
#include "render/scaled_scene.h"
#include "sampling/sample_pattern.h"

namespace whit::test::depth_of_field {
namespace {

constexpr int kSide = 64;           // of the picture, in pixels
constexpr double kHalfEmitter = 3;  // half the side of the emitter's sharp image, in pixels
constexpr double kFov = 40, kHeight = 3;

constexpr double kCenterX = 34.6, kCenterY = 35.4;  // of the emitter's image, in pixels

// A square that emits lies at `distance` from a camera that is focused at a distance of 4.
SceneDescription descriptionOf(double distance, bool parallel, float aperture = 1.5f) {
  SceneBuilder builder;
  Camera& camera = builder.lookFrom({0.5f, 1, 2}, {0.5f, 1, -2});
  camera.fov = static_cast<float>(kFov);
  if (parallel) camera.orthographicHeight = static_cast<float>(kHeight);
  camera.aperture = aperture;

  // The width of a pixel where the square lies.
  const double pixel = (parallel ? kHeight : 2 * std::tan(kFov * kPi / 360) * distance) / kSide;
  const double half = kHalfEmitter * pixel;
  const double x = 0.5 + (kCenterX - kSide / 2) * pixel, y = 1 - (kCenterY - kSide / 2) * pixel;
  const auto corner = [&](double right, double up) {
    return Vec3f(Vec3d{x + right, y + up, 2 - distance});
  };

  builder.add(
      quad(corner(-half, -half), corner(half, -half), corner(half, half), corner(-half, half)),
      emittingMaterial(1));
  return builder.describe();
}
Scene sceneOf(double distance, bool parallel, float aperture = 1.5f) {
  return repaired(descriptionOf(distance, parallel, aperture));
}

RenderOptions optionsOf(int spp, Mode mode = Mode::packets) {
  RenderOptions o;
  o.mode = mode;
  o.size = ImageSize{kSide, kSide};
  o.threads = 2;
  o.spp = spp;
  return o;
}

TEST(DepthOfField, IsSharpInThePlaneOfFocus) {
  for (const bool parallel : {false, true}) {
    for (const Mode mode : {Mode::packets, Mode::reference}) {
      const Scene scene = sceneOf(4, parallel);
      RenderOptions o = optionsOf(16, mode);
      const Image lens = render(scene, o).image;

      o.disable = {Effect::depthOfField};
      const Image pinhole = render(scene, o).image;
      for (const auto i : indices(lens.pixels)) {
        // A ray at the emitter's edge may miss it by rounding.
        ASSERT_NEAR(lens.pixels[i].x, pinhole.pixels[i].x, 1.01 / 16) << i;
      }
    }
  }
}

TEST(DepthOfField, PinholesKeepEveryBit) {
  for (const bool parallel : {false, true}) {
    const Scene lens = sceneOf(8, parallel), pinhole = sceneOf(8, parallel, 0);
    EXPECT_FALSE(pinhole.effects.has(Effect::depthOfField));

    for (const Mode mode : {Mode::packets, Mode::reference}) {
      RenderOptions o = optionsOf(4, mode);
      const Picture plain = render(pinhole, o);
      EXPECT_NE(firstDifference(render(lens, o), plain), "");

      // The scene has the effect as if another of its cameras needed it.
      Scene beside = pinhole;
      beside.effects = beside.effects.with(Effect::depthOfField);
      EXPECT_EQ(firstDifference(render(beside, o), plain), "");

      o.disable = {Effect::depthOfField};
      EXPECT_EQ(firstDifference(render(lens, o), plain), "");
    }

    // One sample goes through the center of the lens.
    EXPECT_EQ(firstDifference(render(lens, optionsOf(1)), render(pinhole, optionsOf(1))), "");
  }
}

TEST(DepthOfField, ScalesWithTheScene) {
  for (const bool parallel : {false, true}) {
    expectBitsAtAnyScale(descriptionOf(8, parallel), {-6}, optionsOf(4));
  }
}

RenderOptions lensOptions(int spp) {
  RenderOptions o = smallOptions();
  o.camera = "lens";
  o.spp = spp;
  return o;
}

TEST(DepthOfField, KeepsThePipelineLaws) {
  const Scene scene = load("effects");
  expectThePipelineLaws(scene, lensOptions(4));
  RenderOptions adaptive = lensOptions(8);
  adaptive.adaptive = true;
  expectSampledPictureAgrees(scene, adaptive);

  expectStagesAgreeOnEveryTarget(sceneOf(8, true), optionsOf(2));
}

// The first pass goes through the lens, too, and so finds regions that are blurred beside sharp
// edges.
TEST(DepthOfField, AdaptiveSamplingFindsTheBlur) {
  RenderOptions o = lensOptions(16);
  o.shading.textureFilter = TextureFilter::bilinear;  // pixels of one sample are not blurred
  const Image all = render(load("effects"), o).image;

  o.adaptive = true;
  const Image found = render(load("effects"), o).image;
  // It would be 0.0142 with a first pass through the center of the lens.
  EXPECT_LE(compareImages(found, all).flipMean, 0.0125);
}

// No pixel of the emitter's sharp image has its center farther from the middle than this.
constexpr double kFarthestSharp = (kHalfEmitter + 0.5) * std::numbers::sqrt2;

// The sample whose channels are kept is not the first one, so its ray passes beside the center of
// the lens.
TEST(DepthOfField, ChannelsAreThoseOfTheRayThroughTheLens) {
  RenderOptions o = optionsOf(9);
  ASSERT_NE(nearestToCenter(samplePattern(o.spp)), 0u);
  o.channels = parseChannels("depth,position,rays");

  const auto [packets, reference] = renderBoth(sceneOf(8, false), o);
  int apart = 0, aside = 0;
  for (const auto i : indices(packets.image.pixels)) {
    const float z = packets.channels.floats(Channel::depth)[2 * i];
    apart += std::isinf(z) != std::isinf(reference.channels.floats(Channel::depth)[2 * i]);
    if (std::isinf(z)) continue;

    EXPECT_NEAR(z, 8, 1e-5);
    EXPECT_NEAR(packets.channels.floats(Channel::position)[3 * i + 2], -6, 1e-5);

    const double x = static_cast<double>(i % kSide) + 0.5, y = static_cast<double>(i / kSide) + 0.5;
    aside += std::hypot(x - kCenterX, y - kCenterY) > kFarthestSharp;
  }

  EXPECT_LE(apart, 2);
  EXPECT_GT(aside, 5);
}

// A dielectric fills half of the space around the lens, x < 0. It does not refract but absorbs
// three quarters of the light on its way to the sky. Rays are nearly parallel.
Scene halfInMedium(float eye) {
  SceneBuilder builder;
  builder.sky(1);
  Material m = glassMaterial(1);
  m.absorption = Rgb(static_cast<float>(std::log(4.0)));
  builder.add(box({-10, -10, -1}, {0, 10, 10}), m);

  Camera& camera = builder.lookFrom({eye, 0, 0}, {eye, 0, -1});
  camera.fov = 0.02f;
  camera.aperture = 0.1f;
  camera.focus = 1e4f;
  return builder.build();
}

TEST(DepthOfField, RaysStartInTheMediumAroundTheirPointOfTheLens) {
  for (const double eye : {-0.08, -0.02, 0.05}) {
    // The share of the disk beyond the chord at x = 0 sees the sky undimmed.
    const double h = -eye / 0.1;
    const double outside = (std::acos(h) - h * std::sqrt(1 - h * h)) / kPi;
    const Scene scene = halfInMedium(static_cast<float>(eye));
    RenderOptions o = optionsOf(64);
    o.size = ImageSize{8, 8};

    const auto [packets, reference] = renderBoth(scene, o);
    for (const Image& image : {packets.image, reference.image}) {
      double mean = 0;
      for (const Rgb& pixel : image.pixels) mean += double{pixel.x} / 64;
      EXPECT_NEAR(mean, outside + (1 - outside) / 4, 0.005) << eye;
    }
    expectStagesAgreeOnEveryTarget(scene, o);
  }
}

}  // namespace
}  // namespace whit::test::depth_of_field
