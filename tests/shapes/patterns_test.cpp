// Procedural textures: exact squares, seams, normals, masks.
#include <gtest/gtest.h>

#include "decoded_texel.h"
#include "make/patterns/noise.h"
#include "shapes/map_parameters.h"

namespace whit::test {
namespace {

constexpr double kStep8 = 1.0 / 255;

Vec3d data(const Texture& texture, int column, int row) {
  const std::uint32_t t = texture.texels[static_cast<std::size_t>(row * texture.width + column)];
  return Vec3d{static_cast<double>(t & 255u), static_cast<double>(t >> 8 & 255u),
               static_cast<double>(t >> 16 & 255u)} *
         kStep8;
}

Rgb color(const Texture& texture, int column, int row) {
  return decodeColorTexel(texture.texels[static_cast<std::size_t>(row * texture.width + column)]);
}

std::vector<std::string> patternNames() {
  std::vector<std::string> names;
  for (const auto& [name, generator] : patternGenerators()) names.push_back(name);
  return names;
}

class EveryPattern : public testing::TestWithParam<std::string> {};

TEST_P(EveryPattern, IsCompleteAndTheSameEachTime) {
  const Texture a = paint(GetParam(), {{"size", 64.0}}), b = paint(GetParam(), {{"size", 64.0}});

  EXPECT_EQ(a.width, 64);
  EXPECT_EQ(a.height, 64);
  EXPECT_EQ(a.texels.size(), 64u * 64u);
  EXPECT_EQ(a.texels, b.texels);
  EXPECT_EQ(a.wrapU, Wrap::repeat);

  const bool isData = GetParam().ends_with("Normals") || GetParam().ends_with("Mask");
  EXPECT_EQ(a.format, isData ? TexelFormat::data : TexelFormat::color);
}

TEST_P(EveryPattern, IsNotOneFlatColor) {
  const Texture texture = paint(GetParam(), {{"size", 64.0}});
  EXPECT_NE(std::count(texture.texels.begin(), texture.texels.end(), texture.texels[0]),
            static_cast<std::ptrdiff_t>(texture.texels.size()));
}

INSTANTIATE_TEST_SUITE_P(Patterns, EveryPattern, testing::ValuesIn(patternNames()),
                         [](const auto& info) { return info.param; });

class EveryNormalMap : public testing::TestWithParam<std::string> {};

TEST_P(EveryNormalMap, HoldsUnitVectorsOnTheOutside) {
  const Texture texture = paint(GetParam(), {{"size", 128.0}});
  Vec3d mean;

  for (int row = 0; row < 128; ++row) {
    for (int column = 0; column < 128; ++column) {
      const Vec3d n = data(texture, column, row) * 2.0 - Vec3d(1.0);
      ASSERT_GT(n.z, 0);
      // Each channel is rounded by half a code, and doubled.
      ASSERT_NEAR(length(n), 1, std::sqrt(3.0) * kStep8);
      mean += n / (128.0 * 128.0);
    }
  }

  // A repeating surface is level on the whole. Steep sides weigh less once they are normalized,
  // which matters where one side is steeper than the other (overlapping pans of a roof).
  EXPECT_NEAR(mean.x, 0, 0.05);
  EXPECT_NEAR(mean.y, 0, 0.10);
}

INSTANTIATE_TEST_SUITE_P(Patterns, EveryNormalMap,
                         testing::Values("bricksNormals", "tilesNormals", "plasterNormals",
                                         "roofNormals"),
                         [](const auto& info) { return info.param; });

TEST(Patterns, CheckerStartsWithItsFirstColorAtTheLowerLeft) {
  const Texture texture = paint(
      "checker",
      {{"size", 8.0}, {"columns", 2.0}, {"color", Vec3d{1, 0, 0}}, {"color2", Vec3d{0, 0, 1}}});
  EXPECT_EQ(color(texture, 0, 7), Rgb(1, 0, 0));
  EXPECT_EQ(color(texture, 7, 7), Rgb(0, 0, 1));
  EXPECT_EQ(color(texture, 0, 0), Rgb(0, 0, 1));
  EXPECT_EQ(color(texture, 7, 0), Rgb(1, 0, 0));
}

TEST(Patterns, NormalsOfAnUpwardJointLeanAwayFromIt) {
  // There is one tile: near its left joint the surface rises to the right, so the normal leans
  // left.
  const Texture texture = paint("tilesNormals", {{"size", 128.0},
                                                 {"columns", 1.0},
                                                 {"rows", 1.0},
                                                 {"joint", 0.02},
                                                 {"bevel", 0.2},
                                                 {"rough", 0.0},
                                                 {"depth", 0.05}});

  const double level = 0.5 + kStep8;
  EXPECT_LT(data(texture, 12, 64).x, 0.5 - 4 * kStep8);
  EXPECT_GT(data(texture, 127 - 12, 64).x, 0.5 + 4 * kStep8);
  EXPECT_GT(data(texture, 64, 12).y, 0.5 + 4 * kStep8) << "row 12 is near the top: leans up";
  EXPECT_LT(data(texture, 64, 127 - 12).y, 0.5 - 4 * kStep8);
  EXPECT_NEAR(data(texture, 64, 64).x, 0.5, level - 0.5);
}

TEST(Patterns, LeafMaskCutsTheCornersAndKeepsTheMiddle) {
  const Texture texture = paint("leafMask", {{"size", 64.0}});
  for (const int row : {0, 63}) {
    EXPECT_EQ(data(texture, 0, row).x, 0);
    EXPECT_EQ(data(texture, 63, row).x, 0);
  }
  EXPECT_EQ(data(texture, 32, 32).x, 1);
}

TEST(Noise, RepeatsAfterItsPeriodAndVanishesOnTheLattice) {
  using procedural::fractalNoise;
  for (int k = 0; k < 50; ++k) {
    const double x = 0.37 * k, y = 0.61 * k;

    // x + 8 is rounded differently from x: by 2^-49 times a slope of about two an octave.
    EXPECT_NEAR(fractalNoise(3, x, y, 5, 8), fractalNoise(3, x + 8, y, 5, 8), 1e-12);
    EXPECT_NEAR(fractalNoise(3, x, y, 5, 8), fractalNoise(3, x, y - 8, 5, 8), 1e-12);

    // There is no seam where the period ends; slopes stay below ten per cell of an octave.
    EXPECT_NEAR(fractalNoise(3, 8 - 1e-9, y, 5, 8), fractalNoise(3, 1e-9, y, 5, 8), 1e-6);
    EXPECT_NEAR(fractalNoise(3, x, 8 - 1e-9, 5, 8), fractalNoise(3, x, 1e-9, 5, 8), 1e-6);

    EXPECT_EQ(procedural::gradientNoise(3, k, 2 * k), 0);
    EXPECT_LE(std::fabs(fractalNoise(3, x, y, 5)), 1.1);
  }
}

TEST(Noise, HashesSpreadEvenly) {
  constexpr int kBins = 16, kDraws = 16000;
  std::array<int, kBins> counts{};
  for (int k = 0; k < kDraws; ++k) {
    const double x = procedural::unitHash(7, k % 127, k / 127);
    ASSERT_GE(x, 0);
    ASSERT_LT(x, 1);
    ++counts[static_cast<std::size_t>(x * kBins)];
  }

  // 37.7 is the 99.9th percentile of chi-squared with 15 degrees of freedom. Hashes are fixed, so
  // the test either always passes or never.
  double chi = 0;
  for (const int c : counts) chi += (c - 1000.0) * (c - 1000.0) / 1000.0;
  EXPECT_LT(chi, 37.7);
}

}  // namespace
}  // namespace whit::test
