// Texels in tiles: each is where the kernels look for it.
#include "render/texture_tables.h"

#include <gtest/gtest.h>

#include <numeric>
#include <utility>
#include <vector>

#include "reference/small_scenes.h"
#include "render/build_tables.h"

namespace whit::test {
namespace {

Texture numbered(int width, int height) {
  std::vector<std::uint32_t> texels(static_cast<std::size_t>(width * height));
  std::iota(texels.begin(), texels.end(), 1u);
  return makeTexture(TexelFormat::colour, width, height, texels);
}

TEST(TextureTables, TexelsAreInTilesOfFourByFour) {
  SceneBuilder builder;
  Material floor = diffuseMaterial(0.5f);
  // Rows and columns left over, less than a tile, and a single texel.
  for (const auto& [width, height] : {std::pair{9, 6}, {3, 2}, {1, 1}, {8, 4}}) {
    floor.diffuseMap = builder.add(numbered(width, height));
    builder.add(floorAt(0, 1, builder.add(floor)));
  }
  const Scene scene = builder.build();
  const ShadingTables tables = buildTables(scene, EffectSet::all(), {});
  ASSERT_EQ(tables.textures.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const TextureRecord& record = tables.textures[i];
    const Texture& texture = scene.textures[i];
    EXPECT_EQ(record.firstTexel % 16, 0u) << "a cache line begins here";
    const int tilesInARow = (record.width + 3) / 4;
    for (int y = 0; y < record.height; ++y) {
      for (int x = 0; x < record.width; ++x) {
        const int tile = y / 4 * tilesInARow + x / 4, within = y % 4 * 4 + x % 4;
        EXPECT_EQ(tables.texels[record.firstTexel + static_cast<std::size_t>(tile * 16 + within)],
                  texture.texels[static_cast<std::size_t>(y * record.width + x)])
            << "texture " << i << ", texel " << x << "," << y;
      }
    }
  }
}

}  // namespace
}  // namespace whit::test
