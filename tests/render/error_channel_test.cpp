// The channel `error`. Its first component is the standard error: tested against a closed form
// where every sample is black or of one color, and against the true error where light is sampled.
// Its second component is the share of the paths that --depth and --cutoff end: tested against a
// closed form between mirrors, and as a bound of what these options leave out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reference/small_scenes.h"
#include "shipped_scene.h"

namespace whit::test {
namespace {

RenderOptions withErrors(Mode mode = Mode::packets) {
  RenderOptions o = smallOptions();
  o.mode = mode;
  o.channels = parseChannels("error");
  return o;
}

double meanOf(const Rgb& p) { return (double{p.x} + double{p.y} + double{p.z}) / 3; }

// A tilted square emits before a black background.
Scene tiltedSquare() {
  SceneBuilder builder;
  Material emitting = blackMaterial();
  emitting.emission = {0.3f, 0.6f, 0.9f};
  builder.add(quad({-2, -1.7f, 0}, {1.7f, -2, 0}, {2, 1.7f, 0}, {-1.7f, 2, 0}, 0), emitting);
  builder.lookFrom({0, 0, 5}).fov = 60;
  return builder.build();
}

class ErrorChannel : public testing::TestWithParam<Mode> {};

// The share p of samples that hit the square gives the error of a pixel,
// r sqrt(p (1 - p) / (n - 1)) for the root mean square r of its three colors. The
// squares of errors are averaged within kPoolReach.
TEST_P(ErrorChannel, IsThatOfABinomialAtAnEdge) {
  const double radiance = std::sqrt((0.3 * 0.3 + 0.6 * 0.6 + 0.9 * 0.9) / 3);
  RenderOptions o = withErrors(GetParam());
  o.spp = 16;
  o.channels = o.channels.with(Channel::alpha);
  const Film film = render(tiltedSquare(), o);
  const auto errors = film.channels.floats(Channel::error),
             hits = film.channels.floats(Channel::alpha);

  double largest = 0;
  forEachPixel(film.image, [&](int x, int y) {
    double squares = 0, count = 0;
    for (int j = y - kPoolReach; j <= y + kPoolReach; ++j) {
      for (int i = x - kPoolReach; i <= x + kPoolReach; ++i) {
        if (!film.image.window.contains(i, j)) continue;
        const double p{hits[film.image.index(i, j)]};
        squares += radiance * radiance * p * (1 - p) / (o.spp - 1);
        ++count;
      }
    }

    const double expected = std::sqrt(squares / count);
    // Double sums numbers in float, so equal samples leave the root of their rounding.
    EXPECT_NEAR(errors[2 * film.image.index(x, y)], expected, 1e-6) << x << "," << y;
    largest = std::max(largest, expected);
  });
  EXPECT_GT(largest, 0.03);
}

TEST_P(ErrorChannel, IsInfiniteForOneSample) {
  const Film film = render(tiltedSquare(), withErrors(GetParam()));
  const auto errors = film.channels.floats(Channel::error);
  for (std::size_t i = 0; i < errors.size(); i += 2) EXPECT_EQ(errors[i], kInfinity);
}

// Two mirrors face each other, with the camera between them.
Scene hallScene() {
  Material mirror = blackMaterial();
  mirror.mirror = mirror.mirrorGrazing = {0.2f, 0.5f, 0.3f};
  SceneBuilder builder;
  const std::uint32_t material = builder.add(mirror);
  constexpr float kFar = 1000;  // no ray of the tests gets past the edges
  builder.add(floorAt(-1, kFar, material));
  builder.add(ceilingAt(4, kFar, material));
  builder.lookFrom({0, 2, 0}).up = {0, 0, -1};
  return builder.build();
}

// After k mirrors of the largest reflectance 0.5 the share is 0.5^k.
TEST_P(ErrorChannel, HasTheShareOfThePathsThatEndBetweenMirrors) {
  struct Case {
    int depth;
    float cutoff;
    double share;
  };
  for (const Case& c : {Case{0, 1e-3f, 0.5}, {3, 1e-3f, 1.0 / 16}, {64, 0.1f, 1.0 / 16}}) {
    RenderOptions o = withErrors(GetParam());
    o.depth = c.depth;
    o.cutoff = c.cutoff;
    o.spp = 2;

    const Film film = render(hallScene(), o);
    const auto errors = film.channels.floats(Channel::error);
    for (std::size_t i = 1; i < errors.size(); i += 2) EXPECT_EQ(double{errors[i]}, c.share);
  }
}

// All light of this frame is the sky's, so no path brings more than the sky's brightest color,
// which is that of its horizon.
TEST_P(ErrorChannel, BoundsWhatDepthAndCutoffLeaveOut) {
  constexpr double kBrightest = 0.86, kRounding = 1e-5;
  const Scene scene = load("glass");
  RenderOptions o = withErrors(GetParam());
  o.size = ImageSize{53, 33};
  o.disable = {Effect::lights, Effect::ambient, Effect::emission};
  o.depth = 3;
  o.cutoff = 0.02f;
  const Film film = render(scene, o);

  o.depth = 32;
  o.cutoff = 1e-4f;
  const Film exact = render(scene, o);
  double largest = 0;
  for (const auto i : indices(film.image.pixels)) {
    const Rgb missing = exact.image.pixels[i] - film.image.pixels[i];
    const auto boundOf = [&](const Film& f) {
      return kBrightest * double{f.channels.floats(Channel::error)[2 * i + 1]} + kRounding;
    };

    EXPECT_LE(double{maxComponent(missing)}, boundOf(film));
    EXPECT_GE(double{std::min({missing.x, missing.y, missing.z})}, -boundOf(exact));
    largest = std::max(largest, double{maxComponent(missing)} / boundOf(film));
  }
  EXPECT_GT(largest, 0.3);
}

INSTANTIATE_TEST_SUITE_P(Modes, ErrorChannel, testing::Values(Mode::packets, Mode::reference));

struct SampledScene {
  const char* scene;
  int indirect, ambientSamples;
};

// The scenes have soft shadows, glossy reflections, and indirect light or ambient occlusion.
TEST(ErrorChannelCoverage, HoldsTheTrueErrorOfNineTenthsOfThePixels) {
  constexpr double kDeviations = 1.96;  // 95 % of a normal distribution
  constexpr double kLeastCovered = 0.9;
  for (const SampledScene& sampled :
       {SampledScene{"cornell", 1, 0}, {"cornell", 0, 1}, {"glossy", 0, 0}, {"whitted", 0, 0}}) {
    RenderOptions o = withErrors();
    o.size = ImageSize{64, 48};
    o.lightSamples = 2;
    o.glossy = 1;
    o.indirect = sampled.indirect;
    o.ambientSamples = sampled.ambientSamples;
    const Scene scene = load(sampled.scene);

    // The truth has a quarter of the error of 16 samples, which adds 3 % to the difference of the
    // two.
    RenderOptions many = o;
    many.spp = 256;
    o.spp = 16;
    const Image truth = render(scene, many).image;
    const Film film = render(scene, o);

    // Pixels that have no error and claim none say nothing about those that do.
    double covered = 0, noisy = 0, uncertain = 0;
    for (const auto i : indices(truth.pixels)) {
      const double apart = std::abs(meanOf(film.image.pixels[i]) - meanOf(truth.pixels[i]));
      const double error = double{film.channels.floats(Channel::error)[2 * i]};
      const double rounding = 1e-6 * meanOf(truth.pixels[i]);
      const bool isNoisy = error > 1e-3 * meanOf(truth.pixels[i]);
      noisy += isNoisy;
      if (!isNoisy && apart <= rounding) continue;
      ++uncertain;
      covered += apart <= kDeviations * error + rounding;
    }

    const auto pixels = static_cast<double>(truth.pixels.size());
    EXPECT_GE(covered / uncertain, kLeastCovered) << sampled.scene << sampled.indirect;
    EXPECT_GT(noisy / pixels, 0.1) << sampled.scene << ": hardly anything is sampled";
  }
}

}  // namespace
}  // namespace whit::test
