// Procedural textures: exact squares, seams, normals, masks.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "decoded_texel.h"
#include "make/patterns/noise.h"
#include "shapes/generated.h"

namespace whit::test {
namespace {

constexpr double kStep8 = 1.0 / 255;

Vec3d data(const Texture& texture, int column, int row) {
  const std::uint32_t t = texture.texels[cellAt(column, row, texture.width)];
  const auto channel = [&](int shift) { return (t >> shift & 255u) * kStep8; };
  return {channel(0), channel(8), channel(16)};
}

Rgb color(const Texture& texture, int column, int row) {
  return decodeColorTexel(texture.texels[cellAt(column, row, texture.width)]);
}

TEST(EveryPattern, IsCompleteNotFlatAndTheSameEachTime) {
  for (const auto& [name, generator] : patternGenerators()) {
    SCOPED_TRACE(name);
    const Texture a = paint(name, "'size': 64");
    EXPECT_EQ(a.width, 64);
    EXPECT_EQ(a.height, 64);
    EXPECT_EQ(a.texels.size(), 64u * 64u);
    EXPECT_EQ(a.texels, paint(name, "'size': 64").texels);
    EXPECT_EQ(a.wrapU, Wrap::repeat);

    const bool isData = name.ends_with("Normals") || name.ends_with("Mask");
    EXPECT_EQ(a.format, isData ? TexelFormat::data : TexelFormat::color);
    EXPECT_NE(std::ranges::adjacent_find(a.texels, std::not_equal_to()), a.texels.end());
  }
}

TEST(EveryNormalMap, HoldsUnitVectorsOnTheOutside) {
  for (const char* name : {"bricksNormals", "tilesNormals", "plasterNormals", "roofNormals"}) {
    SCOPED_TRACE(name);
    const Texture texture = paint(name, "'size': 128");
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
}

TEST(Patterns, CheckerStartsWithItsFirstColorAtTheLowerLeft) {
  const Texture texture =
      paint("checker", "'size': 8, 'columns': 2, 'color': [1, 0, 0], 'color2': [0, 0, 1]");
  EXPECT_EQ(color(texture, 0, 7), Rgb(1, 0, 0));
  EXPECT_EQ(color(texture, 7, 7), Rgb(0, 0, 1));
  EXPECT_EQ(color(texture, 0, 0), Rgb(0, 0, 1));
  EXPECT_EQ(color(texture, 7, 0), Rgb(1, 0, 0));
}

TEST(Patterns, NormalsOfAnUpwardJointLeanAwayFromIt) {
  // There is one tile: near its left joint the surface rises to the right, so the normal leans
  // left.
  const Texture texture = paint("tilesNormals",
                                "'size': 128, 'columns': 1, 'rows': 1, 'joint': 0.02, 'bevel': "
                                "0.2, 'rough': 0, 'depth': 0.05");

  EXPECT_LT(data(texture, 12, 64).x, 0.5 - 4 * kStep8);
  EXPECT_GT(data(texture, 127 - 12, 64).x, 0.5 + 4 * kStep8);
  EXPECT_GT(data(texture, 64, 12).y, 0.5 + 4 * kStep8) << "row 12 is near the top: leans up";
  EXPECT_LT(data(texture, 64, 127 - 12).y, 0.5 - 4 * kStep8);
  EXPECT_NEAR(data(texture, 64, 64).x, 0.5, kStep8);
}

TEST(Patterns, LeafMaskCutsTheCornersAndKeepsTheMiddle) {
  const Texture texture = paint("leafMask", "'size': 64");
  for (const int row : {0, 63}) {
    for (const int column : {0, 63}) EXPECT_EQ(data(texture, column, row).x, 0);
  }
  EXPECT_EQ(data(texture, 32, 32).x, 1);
}

TEST(Noise, RepeatsAfterItsPeriodAndVanishesOnTheLattice) {
  const auto noise = [](double x, double y) { return procedural::fractalNoise(3, x, y, 5, 8); };
  for (int k = 0; k < 50; ++k) {
    const double x = 0.37 * k, y = 0.61 * k;

    // x + 8 is rounded differently from x: by 2^-49 times a slope of about two an octave.
    EXPECT_NEAR(noise(x, y), noise(x + 8, y), 1e-12);
    EXPECT_NEAR(noise(x, y), noise(x, y - 8), 1e-12);

    // There is no seam where the period ends; slopes stay below ten per cell of an octave.
    EXPECT_NEAR(noise(8 - 1e-9, y), noise(1e-9, y), 1e-6);
    EXPECT_NEAR(noise(x, 8 - 1e-9), noise(x, 1e-9), 1e-6);

    EXPECT_EQ(procedural::gradientNoise(3, k, 2 * k), 0);
    EXPECT_LE(std::fabs(procedural::fractalNoise(3, x, y, 5)), 1.1);
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
