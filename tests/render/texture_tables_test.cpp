// Texels in strips: each footprint is where the kernels read it.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "accel/ray_queries.h"
#include "core/error.h"
#include "reference/small_scenes.h"
#include "render/build_tables.h"
#include "render/pipeline_laws.h"

namespace whit::test {
namespace {

Texture numbered(int width, int height) {
  std::vector<std::uint32_t> texels(width * height);
  std::iota(texels.begin(), texels.end(), 1u);
  return makeTexture(TexelFormat::color, width, height, texels);
}

// Returns the index of the texel in the place of one beyond the border. Mirrored coordinates are
// folded before they become indices, and never wrap.
int wrappedTexel(int i, int size, Wrap wrap) {
  if (wrap == Wrap::repeat) return (i % size + size) % size;
  return std::clamp(i, 0, size - 1);
}

TEST(TextureTables, EveryFootprintIsWholeInOneStrip) {
  SceneBuilder builder;
  Material floor = diffuseMaterial(0.5f);

  // The widths leave columns over, make whole strips, make less than one strip, or are a single
  // texel.
  const std::vector<std::pair<int, int>> sizes{{9, 6}, {7, 2}, {1, 1}, {22, 4}, {2, 11}};

  for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp}) {
    for (const auto& [width, height] : sizes) {
      floor.diffuseMap = builder.add(numbered(width, height));
      builder.description.textures.back().wrapU = wrap;
      builder.add(floorAt(0, 1), floor);
    }
  }

  const Scene scene = builder.build();
  const ShadingTables tables = buildTables(scene, EffectSet::all(), {});
  ASSERT_EQ(tables.textures.size(), 3 * sizes.size());

  for (const auto i : indices(tables.textures)) {
    const TextureRecord& record = tables.textures[i];
    const Texture& texture = scene.textures[i];
    const Texture rows = numbered(record.width, record.height);
    EXPECT_EQ(record.firstTexel % 8, 0u) << "no row crosses a cache line";

    // Footprint (x, y) has its upper texels at (x - 1, y - 1) and (x, y - 1), so the first and the
    // last are half beyond the border. A strip holds seven footprints in eight columns.
    for (int y = 0; y <= record.height; ++y) {
      for (int x = 0; x <= record.width; ++x) {
        const int first = (x / 7 * (record.height + 2) + y) * 8 + x % 7;
        for (const auto& [stepX, stepY] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
          const int column = wrappedTexel(x - 1 + stepX, record.width, texture.wrapU);
          const int row = wrappedTexel(y - 1 + stepY, record.height, texture.wrapV);
          const int place = first + stepY * 8 + stepX;
          EXPECT_EQ(tables.texels[record.firstTexel + place], rows.texel(column, row))
              << "texture " << i << ", footprint " << x << "," << y << " step " << stepX << stepY;
        }
      }
    }
  }
}

Texture lateTexture(int& made) {
  Texture texture = makeTexture(TexelFormat::data, 1, 2, {0, 0xffffffffu});
  texture.shared =
      std::make_shared<SharedTexels>([&made, texels = std::exchange(texture.texels, {})] {
        ++made;
        return texels;
      });
  return texture;
}

// A floor with these maps, which is masked.
Scene maskedFloor(const std::vector<Texture>& maps) {
  SceneBuilder builder;
  for (const Texture& map : maps) builder.add(map);
  Material floor = diffuseMaterial(0.5f);
  floor.diffuseMap = 0;
  floor.alphaMap = static_cast<std::int32_t>(maps.size()) - 1;
  floor.alphaCutoff = 0.5f;
  builder.add(floorAt(0, 1), floor);
  return builder.build();
}

std::uint32_t firstTexel(const ShadingTables& tables) {
  return tables.texels[tables.textures.at(0).firstTexel];
}

TEST(TextureTables, LateTexelsAreMadeForWhatLooksThemUp) {
  int colors = 0, masks = 0;
  const Scene scene = maskedFloor({lateTexture(colors), lateTexture(masks)});
  buildTables(scene, allBut(Effect::textures), {});
  EXPECT_EQ(colors + masks, 0);

  const std::uint64_t before = scene.memoryBytes();
  const RayQueries queries(scene, 1, nullptr);
  EXPECT_EQ(colors, 0);
  EXPECT_EQ(masks, 1);
  EXPECT_EQ(scene.memoryBytes(), before + 2 * sizeof(std::uint32_t)) << "the texels of the mask";

  EXPECT_EQ(firstTexel(buildTables(scene, EffectSet::all(), {})), 0xffffffffu)
      << "a row beyond the top";
  EXPECT_EQ(colors, 1);
  EXPECT_EQ(masks, 1) << "masks are kept";
}

TEST(TextureTables, TexelsThatAMaskKeepsAreNotMadeAgain) {
  int made = 0;
  const Scene scene = maskedFloor({lateTexture(made)});
  const RayQueries queries(scene, 1, nullptr);
  EXPECT_EQ(firstTexel(buildTables(scene, EffectSet::all(), {})), 0xffffffffu);
  EXPECT_EQ(made, 1);
}

// A floor has one row of texels that grow brighter from left to right.
Scene paintedOver(int width) {
  SceneBuilder builder;
  Material floor = diffuseMaterial(0.5f);
  std::vector<std::uint32_t> texels(width);
  for (const auto i : indices(texels)) {
    texels[i] = static_cast<std::uint32_t>(i * 1024 / texels.size());
  }

  floor.diffuseMap = builder.add(makeTexture(TexelFormat::color, width, 1, texels));
  builder.add(floorAt(0, 1), floor);
  return builder.build();
}

// The kernels compute strips in float, which is coarsest at the right end of the widest texture.
TEST(TextureTables, TheWidestTextureIsReadAsByTheReference) {
  expectStagesAgreeOnEveryTarget(paintedOver(kTextureSideLimit), smallOptions());
}

TEST(TextureTables, AWiderOneIsRefused) {
  EXPECT_THROW(buildTables(paintedOver(kTextureSideLimit + 1), EffectSet::all(), {}), Error);
}

}  // namespace
}  // namespace whit::test
