// The sky along a direction, blurred by a lobe, and as ambient light. oracle/ has gradients and
// turned images as well.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "pi.h"
#include "scene/light.h"

namespace whit {
namespace {

// Returns the direction at `azimuth` turns from -z towards +x and `polar` half-turns from the
// zenith.
Vec3d direction(double azimuth, double polar) {
  const double a = 2 * kPi * azimuth, p = kPi * polar;
  return {std::sin(p) * std::sin(a), std::cos(p), -std::sin(p) * std::cos(a)};
}

template <typename Value>
Sky imageSky(int width, int height, const Value& value) {
  Sky sky;
  sky.kind = Sky::Kind::image;
  sky.image.width = width;
  sky.image.height = height;

  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float v = static_cast<float>(value(x, y));
      sky.image.r.push_back(v);
      sky.image.g.push_back(2 * v);
      sky.image.b.push_back(3 * v);
    }
  }
  return sky;
}

Sky gradientSky() {
  Sky sky;
  sky.kind = Sky::Kind::gradient;
  sky.zenith = {0, 0, 8};
  sky.horizon = {4, 4, 4};
  sky.ground = {2, 0, 0};
  sky.scale = 0.5f;
  return sky;
}

TEST(SkyRadiance, NoneAndColor) {
  Sky sky;
  sky.zenith = {1, 2, 3};
  EXPECT_EQ(skyRadiance(sky, {0, 1, 0}), RgbD{});
  EXPECT_EQ(ambientFromSky(sky, 1).up, Rgb{});
  sky.kind = Sky::Kind::color;
  sky.scale = 2;
  EXPECT_EQ(skyRadiance(sky, {0, 1, 0}), (RgbD{2, 4, 6}));
  EXPECT_EQ(skyRadiance(sky, {0, -1, 0}), (RgbD{2, 4, 6}));
}

TEST(SkyRadiance, GradientIsLinearInTheSineOfTheElevation) {
  const Sky sky = gradientSky();
  EXPECT_EQ(skyRadiance(sky, {0, 1, 0}), (RgbD{0, 0, 4}));
  EXPECT_EQ(skyRadiance(sky, {0, 0, 1}), (RgbD{2, 2, 2}));
  EXPECT_EQ(skyRadiance(sky, {0, -1, 0}), (RgbD{1, 0, 0}));
  EXPECT_EQ(skyRadiance(sky, {0.8, 0.25, 0}), (RgbD{1.5, 1.5, 2.5}));
  EXPECT_EQ(skyRadiance(sky, {0.8, -0.5, 0}), (RgbD{1.5, 1, 1}));
}

struct Seen {
  Vec3d direction;
  double radiance;
};

void expectSeen(const Sky& sky, const std::vector<Seen>& rows) {
  for (const auto& [d, radiance] : rows) {
    EXPECT_NEAR(skyRadiance(sky, d).x, radiance, 1e-12) << d.x << " " << d.y << " " << d.z;
  }
}

TEST(SkyRadiance, ColumnsBeginAtMinusZAndRunTowardsPlusX) {
  // Cardinal directions lie between two columns and show their mean, also across the seam at -z.
  // The last two are a quarter of a column before and behind the seam, between columns 3 and 0.
  expectSeen(imageSky(4, 1, [](int x, int) { return x; }), {{{0, 0, -1}, 1.5},
                                                            {{1, 0, 0}, 0.5},
                                                            {{0, 0, 1}, 1.5},
                                                            {{-1, 0, 0}, 2.5},
                                                            {direction(0.0625, 0.5), 0.75},
                                                            {direction(-0.0625, 0.5), 2.25}});
}

TEST(SkyRadiance, PolesAreClamped) {
  expectSeen(imageSky(4, 2, [](int, int y) { return y == 0 ? 5 : 7; }),
             {{{0, 1, 0}, 5},
              {{0, -1, 0}, 7},
              {direction(0.3, 0.1), 5},
              {direction(0.3, 0.5), 6},
              {direction(0.3, 0.95), 7}});
}

TEST(SkyRadiance, OneTexelAndExactSeamStayInRange) {
  const Sky sky = imageSky(1, 1, [](int, int) { return 3; });
  for (const double tiny : {0.0, -0.0, 1e-300, -1e-300, -1e-17}) {
    EXPECT_EQ(skyRadiance(sky, {tiny, 0, -1}).x, 3);
    EXPECT_EQ(skyRadiance(sky, {tiny, 1, tiny}).x, 3);
  }
}

TEST(AmbientFromSky, ConstantSkyGivesItself) {
  Sky color;
  color.kind = Sky::Kind::color;
  color.zenith = {1, 2, 4};
  color.scale = 0.5f;

  const Ambient a = ambientFromSky(color, 3);
  EXPECT_EQ(a.up, (Rgb{1.5f, 3, 6}));
  EXPECT_EQ(a.down, a.up);

  // The weights of a hemisphere's rows sum to 1, also where the horizon cuts a row.
  for (const int height : {1, 2, 3, 8, 33}) {
    const Ambient b = ambientFromSky(imageSky(5, height, [](int, int) { return 1; }), 1);
    EXPECT_NEAR(b.up.x, 1, 1e-6) << height;
    EXPECT_NEAR(b.down.z, 3, 3e-6) << height;
  }
}

TEST(AmbientFromSky, HemispheresAreKeptApart) {
  const Ambient a = ambientFromSky(imageSky(4, 4, [](int, int y) { return y < 2 ? 1 : 0; }), 2);
  EXPECT_NEAR(a.up.x, 2, 1e-6);
  EXPECT_EQ(a.down, Rgb{});

  // One of eight columns is bright.
  const Ambient b = ambientFromSky(imageSky(8, 2, [](int x, int) { return x == 3; }), 1);
  EXPECT_NEAR(b.up.x, 0.125, 1e-7);

  // The row at the zenith is bright, down to 45 degrees: sin^2(45 degrees).
  const Ambient c = ambientFromSky(imageSky(4, 4, [](int, int y) { return y == 0; }), 1);
  EXPECT_NEAR(c.up.x, 0.5, 1e-6);
}

TEST(AmbientFromSky, ImageOfAGradientApproachesTheGradient) {
  const Sky sky = imageSky(4, 128, [](int, int y) { return 1 + std::cos(kPi * (y + 0.5) / 128); });
  const Ambient a = ambientFromSky(sky, 1);

  // Texels have the value at their centers, so that the error is quadratic in the row's height.
  EXPECT_NEAR(a.up.x, 1 + 2.0 / 3, 1e-4);
  EXPECT_NEAR(a.down.x, 1 - 2.0 / 3, 1e-4);
}

// GGX of roughness 1 is constant over the half vectors, which leaves the mean weighted by the
// cosine, and ambient light has it in closed form. The sums' texels are 6 degrees wide, hence 0.01.
TEST(BlurredSky, OfRoughnessOneIsTheCosineWeightedMean) {
  const Sky sky = gradientSky();
  const Ambient mean = ambientFromSky(sky, 1);
  const EnvironmentImage blurred = blurredSky(sky);

  const RgbD up = blurredRadiance(sky, blurred, {0, 1, 0}, 1);
  const RgbD down = blurredRadiance(sky, blurred, {0, -1, 0}, 1);

  EXPECT_NEAR(up.z, double{mean.up.z}, 0.01 * mean.up.z);
  EXPECT_NEAR(up.x, double{mean.up.x}, 0.01 * mean.up.x);
  EXPECT_NEAR(down.x, double{mean.down.x}, 0.01 * mean.down.x);
}

// Returns the mean of a cosine under a lobe around its axis, weighted by D(h) cos(theta) of GGX
// with the half vector at theta / 2, in closed form: with c = cos(theta), D(h) is proportional to 1
// / (a - b c)^2.
double meanCosine(double roughness) {
  const double squared = std::pow(roughness, 4);
  if (squared == 1) return 2.0 / 3;
  const double a = (1 + squared) / 2, b = (1 - squared) / 2, ratio = std::log(a / squared);
  const double weights = a / squared - 1 - ratio;
  return (a * a / squared - a - 2 * a * ratio + a - squared) / (weights * b);
}

// Radiance that is linear in the direction stays linear under every round lobe: its slope is
// multiplied by the mean cosine. The sums' texels are 6 degrees wide.
TEST(BlurredSky, ShrinksALinearSkyByTheLobesMeanCosine) {
  constexpr int kHeight = 128;
  constexpr double kError = 0.004;  // relative to the sky's mean

  const Vec3d slope{0.3, 0.5, -0.6};
  const Sky sky = imageSky(2 * kHeight, kHeight, [&](int x, int y) {
    return 1 + dot(slope, direction((x + 0.5) / (2 * kHeight), (y + 0.5) / kHeight));
  });

  const EnvironmentImage blurred = blurredSky(sky);
  for (const double roughness : {0.2, 0.4, 0.6, 0.8, 1.0}) {
    for (double azimuth = 0.02; azimuth < 1; azimuth += 0.07) {
      for (double polar = 0.05; polar < 1; polar += 0.06) {
        const Vec3d d = direction(azimuth, polar);
        const double expected = 1 + dot(slope, d) * meanCosine(roughness);

        const RgbD seen = blurredRadiance(sky, blurred, d, roughness);
        EXPECT_NEAR(seen.x, expected, kError) << roughness << " " << azimuth << " " << polar;
        EXPECT_NEAR(seen.z, 3 * seen.x, 1e-5);
      }
    }
  }
}

// A bright texel is the darker the further the lobe is turned away and, along the lobe, the rougher
// the lobe is. Rotation and scale are those of the sky.
TEST(BlurredSky, SpreadsWhatIsBright) {
  Sky sky = imageSky(64, 32, [](int x, int y) { return x == 16 && y == 16 ? 100.0 : 0.0; });
  sky.scale = 2;

  const EnvironmentImage blurred = blurredSky(sky);
  const auto seen = [&](double azimuth, double roughness) {
    return blurredRadiance(sky, blurred, direction(azimuth, 16.5 / 32), roughness).x;
  };

  const double at = 16.5 / 64;
  EXPECT_NEAR(seen(at, 0), 200, 1e-3);
  for (const double roughness : {0.2, 0.4, 0.6, 0.8}) {
    EXPECT_GT(seen(at, roughness), seen(at, roughness + 0.2));
    EXPECT_GT(seen(at, roughness), seen(at + 0.05, roughness));
    EXPECT_GT(seen(at, roughness), 0);
  }

  EXPECT_EQ(seen(at + 0.5, 1), 0) << "behind the horizon";
  sky.rotation = 90;
  EXPECT_NEAR(seen(at - 0.25, 0), 200, 1e-3);
}

}  // namespace
}  // namespace whit
