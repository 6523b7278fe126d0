// LDR-FLIP against values worked out from the paper's formulas in double, by routes that share no
// code with the implementation.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/display.h"
#include "flat_image.h"
#include "inspect/metrics.h"

namespace whit {
namespace {

std::vector<float> flipMap(const Image& a, const Image& b) {
  return flipOfCodes(toDisplay(a, 0, ToneCurve::none), toDisplay(b, 0, ToneCurve::none));
}

using Triple = std::array<double, 3>;

Rgb ofCodes(int r, int g, int b) {
  const auto linear = [](int c) { return static_cast<float>(srgbToLinear(c / 255.0)); };
  return {linear(r), linear(g), linear(b)};
}

// Hunt-adjusted L*a*b* of a linear color, from the sRGB primaries as IEC 61966-2-1 rounds them.
// The paper's fractions differ from these in the fifth digit.
Triple huntLab(const Triple& c) {
  const Triple rows[3] = {
      {0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}};
  Triple f;
  for (int i = 0; i < 3; ++i) {
    const Triple& m = rows[i];
    const double t =
        (m[0] * c[0] + m[1] * c[1] + m[2] * c[2]) / (m[0] + m[1] + m[2]);  // relative to white
    f[static_cast<std::size_t>(i)] =
        t > 216.0 / 24389 ? std::cbrt(t) : (841.0 / 108) * t + 4.0 / 29;
  }

  // Hunt's effect scales the chroma by a hundredth of the lightness.
  const double lightness = 116 * f[1] - 16;
  return {lightness, 5 * lightness * (f[0] - f[1]), 2 * lightness * (f[1] - f[2])};
}

double distance(const Triple& p, const Triple& q) {
  const Triple a = huntLab(p), b = huntLab(q);
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

// FLIP of two flat images: there are no features, and filtering leaves flat colors as they are.
double flipOfColors(const Triple& p, const Triple& q) {
  const double largest = std::pow(distance({0, 1, 0}, {0, 0, 1}), 0.7);
  const double e = std::pow(distance(p, q), 0.7);
  return e < 0.4 * largest ? e / (0.4 * largest) * 0.95
                           : 0.95 + (e - 0.4 * largest) / (0.6 * largest) * 0.05;
}

Triple asTriple(const Rgb& c) {
  return {static_cast<double>(c.x), static_cast<double>(c.y), static_cast<double>(c.z)};
}

// The matrices differ in their fifth digit, and rounding leaves feature differences around 1e-7,
// whose square root the exponent loses.
constexpr double kTolerance = 5e-4;

void expectFlat(const Rgb& a, const Rgb& b) {
  const double expected = flipOfColors(asTriple(a), asTriple(b));
  for (const float value : flipMap(flat(23, 17, a), flat(23, 17, b)))
    EXPECT_NEAR(static_cast<double>(value), expected, kTolerance);
}

TEST(Flip, EqualImagesGiveZero) {
  Image image(31, 23);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = ofCodes(static_cast<int>(i * 37 % 256), static_cast<int>(i % 256), 90);
  for (const float value : flipMap(image, image)) EXPECT_EQ(value, 0);
}

// Black against white is 100 in L* alone. Green against blue is the largest difference of all; by
// hand, L*a*b* (87.737, -86.185, 83.181) and (32.297, 79.188, -107.860), so adjusted (87.737,
// -75.616, 72.981) and (32.297, 25.575, -34.835): 55.440 + hypot(101.191, 107.816) = 203.30.
// 100^0.7 = 25.119, 203.30^0.7 = 41.270; the knee is at 16.508: 0.95 + 0.05 * 8.611 / 24.762.
TEST(Flip, BlackAgainstWhiteByHand) {
  const double expected = 0.95 + 0.05 * 8.611 / 24.762;
  EXPECT_NEAR(flipOfColors({0, 0, 0}, {1, 1, 1}), expected, 1e-4);

  const Image black = flat(16, 16, Rgb(0)), white = flat(16, 16, Rgb(1));
  for (const float value : flipMap(black, white))
    EXPECT_NEAR(static_cast<double>(value), expected, kTolerance);
  EXPECT_NEAR(compareImages(white, black).flipMean, expected, kTolerance);
}

TEST(Flip, FlatColors) {
  expectFlat(ofCodes(0, 255, 0), ofCodes(0, 0, 255));  // the largest difference, which gives 1
  expectFlat(ofCodes(200, 30, 40), ofCodes(190, 60, 50));
  expectFlat(ofCodes(128, 128, 128), ofCodes(129, 128, 128));
  expectFlat(ofCodes(3, 2, 1), ofCodes(5, 9, 4));  // the straight part of L*a*b*
  expectFlat(ofCodes(250, 240, 10), ofCodes(10, 20, 245));
}

// The largest difference gives 1 by definition, and nothing exceeds it.
TEST(Flip, GreenAgainstBlueIsOne) {
  const auto map = flipMap(flat(5, 5, {0, 1, 0}), flat(5, 5, {0, 0, 1}));
  for (const float value : map) {
    EXPECT_NEAR(value, 1, 1e-5);
    EXPECT_LE(value, 1 + 1e-6f);
  }
}

// FLIP by brute force: two-dimensional kernels in double, summed without separating them.
class BruteForce {
 public:
  explicit BruteForce(const Image& image) : image_(image) {}

  // The filtered color at a pixel, as linear RGB in [0, 1].
  Triple filtered(int x, int y) const {
    const double b[4] = {0.0047, 0.0053, 0.04, 0.025}, a[4] = {1, 1, 34.1, 13.5};
    double sum[3] = {0, 0, 0}, mass[3] = {0, 0, 0};
    for (int dy = -10; dy <= 10; ++dy)
      for (int dx = -10; dx <= 10; ++dx) {
        const double d2 = (dx * dx + dy * dy) / (67.0 * 67.0);
        double g[4];
        for (int k = 0; k < 4; ++k)
          g[k] = a[k] * std::sqrt(M_PI / b[k]) * std::exp(-M_PI * M_PI * d2 / b[k]);
        // The third channel is filtered with the sum of two Gaussians.
        const double weight[3] = {g[0], g[1], g[2] + g[3]};
        const Triple o = opponent(x + dx, y + dy);
        for (std::size_t c = 0; c < 3; ++c) {
          sum[c] += weight[c] * o[c];
          mass[c] += weight[c];
        }
      }

    return rgbOfOpponent({sum[0] / mass[0], sum[1] / mass[1], sum[2] / mass[2]});
  }

  // Magnitudes of the edge and the point detector.
  std::array<double, 2> features(int x, int y) const {
    const double deviation = 0.5 * 0.082 * 67;
    double positive[2] = {0, 0}, negative[2] = {0, 0};

    const auto weights = [&](int along, int across) {
      const double g = std::exp(-(along * along + across * across) / (2 * deviation * deviation));
      return std::array<double, 2>{-along * g, (along * along / (deviation * deviation) - 1) * g};
    };

    // Positive and negative weights are normalized separately.
    for (int u = -9; u <= 9; ++u)
      for (int v = -9; v <= 9; ++v)
        for (std::size_t k = 0; k < 2; ++k) {
          const double w = weights(u, v)[k];
          (w > 0 ? positive : negative)[k] += std::abs(w);
        }

    double response[2][2] = {{0, 0}, {0, 0}};
    for (int dy = -9; dy <= 9; ++dy)
      for (int dx = -9; dx <= 9; ++dx) {
        // Features are found in the luminance, which is the first opponent channel mapped to [0,
        // 1].
        const double luminance = (opponent(x + dx, y + dy)[0] + 16) / 116;
        for (std::size_t k = 0; k < 2; ++k) {
          const double wx = weights(dx, dy)[k], wy = weights(dy, dx)[k];
          response[k][0] += luminance * wx / (wx > 0 ? positive[k] : negative[k]);
          response[k][1] += luminance * wy / (wy > 0 ? positive[k] : negative[k]);
        }
      }

    return {std::hypot(response[0][0], response[0][1]), std::hypot(response[1][0], response[1][1])};
  }

 private:
  Triple opponent(int x, int y) const {
    const Rgb& p =
        image_.at(std::clamp(x, 0, image_.width - 1), std::clamp(y, 0, image_.height - 1));
    const double r = static_cast<double>(p.x), g = static_cast<double>(p.y),
                 b = static_cast<double>(p.z);
    const double X = (0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505;
    const double Y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    const double Z = (0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089;
    return {116 * Y - 16, 500 * (X - Y), 200 * (Y - Z)};
  }
  static Triple rgbOfOpponent(const Triple& o) {
    const double Y = (o[0] + 16) / 116;
    const double X = 0.9505 * (Y + o[1] / 500), Z = 1.089 * (Y - o[2] / 200);
    const Triple rgb = {3.2406 * X - 1.5372 * Y - 0.4986 * Z, -0.9689 * X + 1.8758 * Y + 0.0415 * Z,
                        0.0557 * X - 0.2040 * Y + 1.0570 * Z};
    return {std::clamp(rgb[0], 0.0, 1.0), std::clamp(rgb[1], 0.0, 1.0),
            std::clamp(rgb[2], 0.0, 1.0)};
  }

  const Image& image_;
};

// The tolerance is 2e-3 because, besides the matrices' differences, the textbook's inverse matrix
// is rounded to four digits.
TEST(Flip, FeaturesAndFiltersAgainstBruteForce) {
  Image a = flat(40, 30, ofCodes(90, 100, 110)), b = a;
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) {
      if (x > 12) a.at(x, y) = ofCodes(200, 120, 60);  // an edge, moved in b
      if (x > 14) b.at(x, y) = ofCodes(200, 120, 60);
      if (x > 30 && (x + y) % 3 == 0) b.at(x, y) = ofCodes(20, 30, 240);  // a texture
    }

  a.at(5, 20) = Rgb(1);  // a point

  const std::vector<float> map = flipMap(a, b);
  const BruteForce forA(a), forB(b);
  double largest = 0;
  for (int y = 0; y < 30; y += 1)
    for (int x = 0; x < 40; x += 3) {
      const double color = flipOfColors(forA.filtered(x, y), forB.filtered(x, y));
      const auto featuresA = forA.features(x, y), featuresB = forB.features(x, y);
      const double feature =
          std::max(std::abs(featuresA[0] - featuresB[0]), std::abs(featuresA[1] - featuresB[1]));
      const double expected = std::pow(color, 1 - std::sqrt(feature / std::sqrt(2.0)));
      EXPECT_NEAR(static_cast<double>(map[static_cast<std::size_t>(40 * y + x)]), expected, 2e-3)
          << x << ", " << y;
      largest = std::max(largest, expected);
    }
  EXPECT_GT(largest, 0.5);  // the case has something to compare
}

TEST(Flip, IsSymmetric) {
  Image a = flat(20, 10, Rgb(0.2f)), b = a;
  b.at(7, 3) = Rgb(0.9f, 0.1f, 0.4f);
  EXPECT_EQ(flipMap(a, b), flipMap(b, a));
}

TEST(Flip, SinglePixelsWork) {
  const float value = flipMap(flat(1, 1, Rgb(0)), flat(1, 1, Rgb(1)))[0];
  EXPECT_NEAR(static_cast<double>(value), flipOfColors({0, 0, 0}, {1, 1, 1}), kTolerance);
}

}  // namespace
}  // namespace whit
