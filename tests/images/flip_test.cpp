// LDR-FLIP against values worked out from the paper's formulas in double, by routes that share no
// code with the implementation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/display.h"
#include "flat_image.h"
#include "inspect/metrics.h"
#include "pi.h"

namespace whit {
namespace {

std::vector<float> flipMap(const Image& a, const Image& b) {
  return flipOfCodes(toDisplay(a, 0, ToneCurve::none), toDisplay(b, 0, ToneCurve::none));
}

Rgb ofCodes(int r, int g, int b) {
  const auto linear = [](int c) { return static_cast<float>(srgbToLinear(c / 255.0)); };
  return {linear(r), linear(g), linear(b)};
}

// XYZ of a linear color relative to white, from the sRGB primaries as IEC 61966-2-1 rounds them.
// The paper's fractions differ from these in the fifth digit.
Vec3d relativeXyz(const Vec3d& c) {
  const auto share = [&](const Vec3d& row) { return dot(row, c) / dot(row, Vec3d(1.0)); };
  return {share({0.4124, 0.3576, 0.1805}), share({0.2126, 0.7152, 0.0722}),
          share({0.0193, 0.1192, 0.9505})};
}

// The differences that L*a*b* and the opponent colors are made of.
Vec3d opponentOf(const Vec3d& xyz) {
  return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}

// Hunt-adjusted L*a*b* of a linear color.
Vec3d huntLab(const Vec3d& c) {
  const auto f = [](double t) {
    return t > 216.0 / 24389 ? std::cbrt(t) : (841.0 / 108) * t + 4.0 / 29;
  };
  const Vec3d xyz = relativeXyz(c), lab = opponentOf({f(xyz.x), f(xyz.y), f(xyz.z)});

  // Hunt's effect scales the chroma by a hundredth of the lightness.
  return lab * Vec3d{1, lab.x / 100, lab.x / 100};
}

double distance(const Vec3d& p, const Vec3d& q) {
  const Vec3d d = huntLab(p) - huntLab(q);
  return std::abs(d.x) + std::hypot(d.y, d.z);
}

// FLIP of two flat images: there are no features, and filtering leaves flat colors as they are.
double flipOfColors(const Vec3d& p, const Vec3d& q) {
  const double largest = std::pow(distance({0, 1, 0}, {0, 0, 1}), 0.7);
  const double e = std::pow(distance(p, q), 0.7);
  return e < 0.4 * largest ? e / (0.4 * largest) * 0.95
                           : 0.95 + (e - 0.4 * largest) / (0.6 * largest) * 0.05;
}

// The matrices differ in their fifth digit, and rounding leaves feature differences around 1e-7,
// whose square root the exponent loses.
constexpr double kTolerance = 5e-4;

void expectFlat(const Rgb& a, const Rgb& b) {
  const double expected = flipOfColors(Vec3d(a), Vec3d(b));
  for (const float value : flipMap(flat(23, 17, a), flat(23, 17, b))) {
    EXPECT_NEAR(double{value}, expected, kTolerance);
  }
}

// Black against white is 100 in L* alone. Green against blue is the largest difference of all; by
// hand, L*a*b* (87.737, -86.185, 83.181) and (32.297, 79.188, -107.860), so adjusted (87.737,
// -75.616, 72.981) and (32.297, 25.575, -34.835): 55.440 + hypot(101.191, 107.816) = 203.30.
// 100^0.7 = 25.119, 203.30^0.7 = 41.270; the knee is at 16.508: 0.95 + 0.05 * 8.611 / 24.762.
TEST(Flip, BlackAgainstWhiteByHand) {
  const double expected = 0.95 + 0.05 * 8.611 / 24.762;
  EXPECT_NEAR(flipOfColors({0, 0, 0}, {1, 1, 1}), expected, 1e-4);

  for (const int side : {1, 16}) {
    const Image black = flat(side, side, Rgb(0)), white = flat(side, side, Rgb(1));
    for (const float value : flipMap(black, white)) {
      EXPECT_NEAR(double{value}, expected, kTolerance);
    }
    EXPECT_NEAR(compareImages(white, black).flipMean, expected, kTolerance);
  }
}

TEST(Flip, FlatColors) {
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
  Vec3d filtered(int x, int y) const {
    const double b[4] = {0.0047, 0.0053, 0.04, 0.025}, a[4] = {1, 1, 34.1, 13.5};
    Vec3d sum, mass;
    for (int dy = -10; dy <= 10; ++dy) {
      for (int dx = -10; dx <= 10; ++dx) {
        const double d2 = (dx * dx + dy * dy) / (67.0 * 67.0);
        const auto g = [&](int k) {
          return a[k] * std::sqrt(kPi / b[k]) * std::exp(-kPi * kPi * d2 / b[k]);
        };
        // The third channel is filtered with the sum of two Gaussians.
        const Vec3d weight{g(0), g(1), g(2) + g(3)};
        sum += weight * opponent(x + dx, y + dy);
        mass += weight;
      }
    }

    return rgbOfOpponent({sum.x / mass.x, sum.y / mass.y, sum.z / mass.z});
  }

  // Magnitude of the edge detector, or of the point detector.
  double feature(int x, int y, bool isPoint) const {
    const double deviation = 0.5 * 0.082 * 67;
    const auto weight = [&](int along, int across) {
      const double g = std::exp(-(along * along + across * across) / (2 * deviation * deviation));
      return isPoint ? (along * along / (deviation * deviation) - 1) * g : -along * g;
    };

    // Positive and negative weights are normalized separately.
    double positive = 0, negative = 0;
    for (int u = -9; u <= 9; ++u) {
      for (int v = -9; v <= 9; ++v) {
        positive += std::max(weight(u, v), 0.0);
        negative += std::max(-weight(u, v), 0.0);
      }
    }

    double across = 0, down = 0;
    for (int dy = -9; dy <= 9; ++dy) {
      for (int dx = -9; dx <= 9; ++dx) {
        // Features are found in the luminance, which is the first opponent channel mapped to [0,
        // 1].
        const double luminance = (opponent(x + dx, y + dy).x + 16) / 116;
        const double wx = weight(dx, dy), wy = weight(dy, dx);
        across += luminance * wx / (wx > 0 ? positive : negative);
        down += luminance * wy / (wy > 0 ? positive : negative);
      }
    }

    return std::hypot(across, down);
  }

 private:
  Vec3d opponent(int x, int y) const {
    return opponentOf(relativeXyz(
        Vec3d(image_.at(std::clamp(x, 0, image_.width - 1), std::clamp(y, 0, image_.height - 1)))));
  }
  static Vec3d rgbOfOpponent(const Vec3d& o) {
    const double Y = (o.x + 16) / 116;
    const Vec3d xyz{0.9505 * (Y + o.y / 500), Y, 1.089 * (Y - o.z / 200)};
    const Vec3d rgb{dot({3.2406, -1.5372, -0.4986}, xyz), dot({-0.9689, 1.8758, 0.0415}, xyz),
                    dot({0.0557, -0.2040, 1.0570}, xyz)};
    return min(max(rgb, Vec3d()), Vec3d(1.0));
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
      double feature = 0;
      for (const bool isPoint : {false, true}) {
        feature =
            std::max(feature, std::abs(forA.feature(x, y, isPoint) - forB.feature(x, y, isPoint)));
      }
      const double expected = std::pow(color, 1 - std::sqrt(feature / std::sqrt(2.0)));
      EXPECT_NEAR(double{map[cellAt(x, y, 40)]}, expected, 2e-3) << x << ", " << y;
      largest = std::max(largest, expected);
    }
  EXPECT_GT(largest, 0.5);  // the case has something to compare
}

TEST(Flip, IsSymmetric) {
  Image a = flat(20, 10, Rgb(0.2f)), b = a;
  b.at(7, 3) = Rgb(0.9f, 0.1f, 0.4f);
  EXPECT_EQ(flipMap(a, b), flipMap(b, a));
}

}  // namespace
}  // namespace whit
