// Depth of field by a thin lens: packets and the reference against the circle of confusion.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "pi.h"
#include "reference/small_scenes.h"
#include "render/pipeline_laws.h"
#include "sampling/sample_pattern.h"

namespace whit::test::depth_of_field {
namespace {

constexpr int kSide = 64;           // of the picture, in pixels
constexpr double kHalfEmitter = 3;  // half the side of the emitter's sharp image, in pixels
constexpr double kFov = 40, kHeight = 3;

// A square that emits lies at `distance` from a camera that is focused at `focus`.
struct Focusing {
  double focus, distance;
  bool parallel = false;
  double aperture = 1.5;
  bool told = false;  // the camera states its focus, and its target lies elsewhere

  // The width of a pixel at distance 1, or anywhere with parallel rays.
  double pixel() const { return (parallel ? kHeight : 2 * std::tan(kFov * kPi / 360)) / kSide; }
  double pixelAt(double d) const { return pixel() * (parallel ? 1 : d); }

  // The diameter of the circle of confusion, in pixels. A ray through the lens at l and through q
  // in the plane of focus, at distance F, is at l + (q - l) d / F in the plane at distance d. The
  // rays that meet a point p there have q = p F / d + l (1 - F / d): l in a disk of radius A makes
  // q a disk of diameter 2 A |d - F| / d. Parallel central rays start at q itself, which makes it
  // 2 A |d - F| / F.
  double diameter() const {
    const double off = 2 * aperture * std::fabs(distance - focus);
    if (parallel) return off / focus / pixel();
    return off / distance / pixelAt(focus);
  }
};

void PrintTo(const Focusing& f, std::ostream* out) {
  *out << "focus " << f.focus << ", distance " << f.distance << (f.parallel ? ", parallel" : "");
}

constexpr std::array<double, 2> kCenter{34.6, 35.4};  // of the emitter's image, in pixels

// Builds the scene `scale` times as large.
Scene sceneOf(const Focusing& setup, double scale = 1) {
  SceneBuilder builder;
  Camera camera;
  camera.eye = Vec3f(Vec3d{0.5, 1, 2} * scale);
  camera.at = Vec3f(Vec3d{0.5, 1, 2 - (setup.told ? 30 : setup.focus)} * scale);
  if (setup.told) camera.focus = static_cast<float>(setup.focus * scale);
  camera.fov = static_cast<float>(kFov);
  if (setup.parallel) camera.orthographicHeight = static_cast<float>(kHeight * scale);
  camera.aperture = static_cast<float>(setup.aperture * scale);
  builder.description.cameras = {camera};

  const double pixel = setup.pixelAt(setup.distance), half = kHalfEmitter * pixel;
  const double x = 0.5 + (kCenter[0] - kSide / 2) * pixel, y = 1 - (kCenter[1] - kSide / 2) * pixel;
  const auto corner = [&](double right, double up) {
    return Vec3f(Vec3d{x + right, y + up, 2 - setup.distance} * scale);
  };

  builder.add(quad(corner(-half, -half), corner(half, -half), corner(half, half),
                   corner(-half, half), builder.add(emittingMaterial(1))));
  return builder.build();
}

RenderOptions optionsOf(int spp, Mode mode = Mode::packets) {
  RenderOptions o;
  o.mode = mode;
  o.size = ImageSize{kSide, kSide};
  o.threads = 2;
  o.spp = spp;
  return o;
}

// Sums up the light of a picture: all of it, in cells of the middle of the disk, and how far it
// reaches.
struct Spread {
  static constexpr int kSectors = 6, kRings = 2;
  double flux = 0, x = 0, y = 0, farthest = 0;
  std::array<double, kSectors * kRings> light{}, pixels{};

  Spread(const Image& image, double inner) {
    forEachPixel(image, [&](int px, int py) {
      const double value{image.at(px, py).x};
      const double dx = px + 0.5 - kCenter[0], dy = py + 0.5 - kCenter[1];
      const double r = std::hypot(dx, dy);
      flux += value;
      x += value * dx;
      y += value * dy;
      if (value > 0) farthest = std::max(farthest, r);

      if (r >= inner) return;
      const double turn = std::atan2(dy, dx) / (2 * kPi) + 0.5;
      const auto sector = std::min(static_cast<int>(turn * kSectors), kSectors - 1);
      const auto ring = static_cast<int>(r * r / (inner * inner) * kRings);
      const auto cell = static_cast<std::size_t>(ring * kSectors + sector);
      light[cell] += value;
      pixels[cell] += 1;
    });
    x /= flux;
    y /= flux;
  }
};

constexpr double kEmitterArea = 4 * kHalfEmitter * kHalfEmitter;

// The emitter's image and the pixels' own size blur the edge of the disk by so much.
constexpr double kEdge = (kHalfEmitter + 0.5) * std::numbers::sqrt2;

class CircleOfConfusion : public testing::TestWithParam<std::tuple<Focusing, Mode>> {};

TEST_P(CircleOfConfusion, GetsTheLightEvenly) {
  const auto& [setup, mode] = GetParam();
  const double radius = setup.diameter() / 2, inner = radius - kEdge;
  ASSERT_GT(inner, 8);
  const Spread spread(render(sceneOf(setup), optionsOf(256, mode)).image, inner);

  EXPECT_NEAR(spread.flux, kEmitterArea, 0.01 * kEmitterArea);
  EXPECT_NEAR(spread.x, 0, 0.1);
  EXPECT_NEAR(spread.y, 0, 0.1);
  EXPECT_LE(spread.farthest, radius + kEdge);
  EXPECT_GE(spread.farthest, radius + kHalfEmitter / 2);

  // Away from its edge, the disk has the same light everywhere.
  const double even = kEmitterArea / (kPi * radius * radius);
  for (std::size_t cell = 0; cell < spread.light.size(); ++cell) {
    EXPECT_NEAR(spread.light[cell] / spread.pixels[cell], even, 0.06 * even) << cell;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Lenses, CircleOfConfusion,
    testing::Combine(testing::Values(Focusing{4, 8}, Focusing{4, 2.5, false, 1.5, true},
                                     Focusing{4, 6.5, true}, Focusing{4, 2, true, 1.3, true}),
                     testing::Values(Mode::packets, Mode::reference)));

TEST(DepthOfField, IsSharpInThePlaneOfFocus) {
  for (const bool parallel : {false, true}) {
    for (const Mode mode : {Mode::packets, Mode::reference}) {
      const Scene scene = sceneOf({4, 4, parallel});
      RenderOptions o = optionsOf(16, mode);
      const Image lens = render(scene, o).image;
      EXPECT_LE(Spread(lens, 1).farthest, kEdge);

      o.disable = {Effect::depthOfField};
      const Image pinhole = render(scene, o).image;
      for (std::size_t i = 0; i < lens.pixels.size(); ++i) {
        // A ray at the emitter's edge may miss it by rounding.
        ASSERT_NEAR(lens.pixels[i].x, pinhole.pixels[i].x, 1.01 / 16) << i;
      }
    }
  }
}

TEST(DepthOfField, PinholesKeepEveryBit) {
  for (const bool parallel : {false, true}) {
    const Scene lens = sceneOf({4, 8, parallel}), pinhole = sceneOf({4, 8, parallel, 0});
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
    const Focusing setup{4, 8, parallel};
    EXPECT_EQ(firstDifference(render(sceneOf(setup, 1.0 / 64), optionsOf(4)),
                              render(sceneOf(setup), optionsOf(4))),
              "");
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

  expectStagesAgreeOnEveryTarget(sceneOf({4, 8, true}), optionsOf(2));
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

// The sample whose channels are kept is not the first one, so its ray passes beside the center of
// the lens.
TEST(DepthOfField, ChannelsAreThoseOfTheRayThroughTheLens) {
  RenderOptions o = optionsOf(9);
  ASSERT_NE(nearestToCenter(samplePattern(o.spp)), 0u);
  o.channels = parseChannels("depth,position,rays");
  const Scene scene = sceneOf({4, 8});

  const auto [packets, reference] = renderBoth(scene, o);
  int apart = 0, aside = 0;
  for (std::size_t i = 0; i < packets.image.pixels.size(); ++i) {
    const float z = packets.channels.floats(Channel::depth)[2 * i];
    apart += std::isinf(z) != std::isinf(reference.channels.floats(Channel::depth)[2 * i]);
    if (std::isinf(z)) continue;

    EXPECT_NEAR(z, 8, 1e-5);
    EXPECT_NEAR(packets.channels.floats(Channel::position)[3 * i + 2], -6, 1e-5);

    const double x = static_cast<double>(i % kSide) + 0.5, y = static_cast<double>(i / kSide) + 0.5;
    aside += std::hypot(x - kCenter[0], y - kCenter[1]) > kEdge;
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
  builder.add(box({-10, -10, -1}, {0, 10, 10}, builder.add(m)));

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
