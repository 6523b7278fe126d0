// Mip levels are means of the texels that they cover.
#include "bake/mip_maps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "verify/scene_builder.h"

namespace whit::test {
namespace {

using Texels = std::vector<std::uint32_t>;

using verify::makeTexture;

std::uint32_t gray(std::uint32_t code) { return code | code << 10 | code << 20; }

Texture noise(TexelFormat format, int width, int height) {
  verify::Numbers numbers(7);
  Texels texels;
  for (int i = 0; i < width * height; ++i) {
    texels.push_back(static_cast<std::uint32_t>(numbers.in(0, 0x1p30)));
  }
  return makeTexture(format, width, height, texels);
}

TEST(Halved, RadianceIsTheMeanOfRadiance) {
  const Texture half =
      halved(makeTexture(TexelFormat::radiance, 2, 2,
                         {encodeRadianceTexel({1000, 4, 0}), encodeRadianceTexel({8, 4, 0}),
                          encodeRadianceTexel({0, 4, 0}), encodeRadianceTexel({0, 4, 0})}));
  EXPECT_EQ(half.format, TexelFormat::radiance);
  ASSERT_EQ(half.texels.size(), 1u);
  EXPECT_EQ(decodeRadianceTexel(half.texels[0]), (Rgb{252, 4, 0}));
}

// Even sides are halved in whole numbers. A code is the nearest to the mean of four, and of two
// that are as near the even one.
TEST(Halved, MeansOfFourAreTheNearestCodes) {
  const auto mean = [](const Texture& t, int column, int row, int shift, bool isData) {
    double sum = 0;
    for (const int i : {0, 1, 2, 3}) {
      const std::uint32_t code = t.texel(2 * column + i % 2, 2 * row + i / 2) >> shift;
      sum += isData ? code & 255u : std::pow(code & 1023u, 2);
    }
    return std::nearbyint(isData ? sum / 4 : std::sqrt(sum / 4));
  };

  for (const bool isData : {false, true}) {
    const Texture t = noise(isData ? TexelFormat::data : TexelFormat::color, 256, 256);
    const Texture half = halved(t);
    for (int row = 0; row < half.height; ++row) {
      for (int column = 0; column < half.width; ++column) {
        for (int shift = 0; shift < 30; shift += isData ? 8 : 10) {
          const std::uint32_t code = half.texel(column, row) >> shift & (isData ? 255u : 1023u);
          ASSERT_EQ(code, mean(t, column, row, shift, isData)) << column << "," << row;
        }
      }
    }
  }
}

// Each of 2 texels covers 2.5 of 5.
TEST(Halved, OddSizesCutThroughTexels) {
  const Texture half = halved(makeTexture(TexelFormat::data, 5, 1, {100, 50, 20, 70, 90}));
  EXPECT_EQ(half.width, 2);
  EXPECT_EQ(half.height, 1);
  EXPECT_EQ(half.texels, (Texels{64, 68}));  // 160 / 2.5, 170 / 2.5
}

TEST(Halved, EqualTexelsStayWhatTheyAre) {
  for (const auto& [width, height] : {std::pair(8, 8), {7, 3}, {1, 6}, {5, 1}}) {
    for (const std::uint32_t texel : {0u, gray(1), gray(511), gray(1023), 0x2a5c3f17u}) {
      for (const TexelFormat format : {TexelFormat::color, TexelFormat::data}) {
        const Texels texels(width * height, texel);
        for (const std::uint32_t got : halved(makeTexture(format, width, height, texels)).texels) {
          EXPECT_EQ(got, texel);
        }
      }
    }
  }
}

TEST(MipMaps, ReachDownToOneTexel) {
  const std::vector<Texture> textures{noise(TexelFormat::color, 8, 3),
                                      noise(TexelFormat::data, 4, 4)};

  const MipMaps maps(textures, {{0}});
  // Levels beyond the last one are the last one; unused textures have one level.
  ASSERT_EQ(maps.levels({0}), 4);
  const int sizes[][2] = {{8, 3}, {4, 1}, {2, 1}, {1, 1}, {1, 1}, {1, 1}};
  for (int level = 0; level < 6; ++level) {
    EXPECT_EQ(maps.level({0}, level).width, sizes[level][0]) << level;
    EXPECT_EQ(maps.level({0}, level).height, sizes[level][1]) << level;
  }

  EXPECT_EQ(&maps.level({0}, 0), textures.data());
  EXPECT_EQ(maps.levels({1}), 1);
  EXPECT_EQ(&maps.level({1}, 3), &textures[1]);
}

TEST(MipMaps, OfASceneAreThoseThatMaterialsShow) {
  verify::SceneBuilder builder;
  Material m = verify::diffuseMaterial(1);
  for (std::int32_t* map :
       {&m.diffuseMap, &m.alphaMap, &m.normalMap, &m.emissionMap, &m.specularMap}) {
    const bool data = map == &m.alphaMap || map == &m.normalMap;
    *map = builder.add(noise(data ? TexelFormat::data : TexelFormat::color, 2, 2));
  }

  m.emission = m.specular = Rgb(0.5f);
  builder.add(verify::floorAt(0, 1), m);
  const Scene scene = builder.build();
  const MipMaps maps(scene);

  for (const auto map : {&Material::diffuseMap, &Material::normalMap, &Material::emissionMap,
                         &Material::specularMap}) {
    EXPECT_EQ(maps.levels(shownMap(m, map)), 2);
  }
  EXPECT_EQ(maps.levels({m.alphaMap}), 1) << "alpha masks are looked up in full";
}

// A leaf of two columns beside two empty ones. Bilinear lookups reach half a texel beyond the leaf
// on either side, where the mean coverage is a quarter of the leaf's. The leaf covers 2 x 200 of
// the 3 texels that are not empty.
TEST(MipMaps, CoverageIsTheMeanOfWhatIsLeft) {
  Texels masks;
  for (int i = 0; i < 16; ++i) masks.push_back(i % 4 < 2 ? 200 : 0);
  const std::vector<Texture> textures{makeTexture(TexelFormat::data, 4, 4, masks)};
  const ShownMap coverage{0, 0, 1.0f / 1024};
  const MipMaps maps(textures, {coverage});
  EXPECT_EQ(maps.level(coverage, 2).texels[0] & 255u, 133u);
}

}  // namespace
}  // namespace whit::test
