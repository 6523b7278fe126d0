// Textures whose texels are not interpolated, whatever --texture-filter is for the others.
#include <gtest/gtest.h>

#include "render/row_of_tiles.h"

namespace whit::test {
namespace {

// Tiles have textures of nearest texels for color, roughness and mask, beside interpolated ones.
Scene pixelArt(bool everywhere) {
  SceneBuilder builder;
  std::array<std::int32_t, 2> color{}, data{}, mask{};
  for (const std::size_t i : {0, 1}) {
    const auto add = [&](Texture t) {
      t.nearest = everywhere || i == 0;
      t.wrapU = Wrap::mirror;
      return builder.add(t);
    };

    color[i] = add(makeTexture(TexelFormat::color, 3, 2,
                               {1023u, 0u, 700u << 10, 1023u << 20, 341u, 900u << 10}));
    data[i] = add(dataMap(3, {1, 0.3f, 0.6f, 0.2f, 0.9f, 0.5f}, true));
    mask[i] = add(dataMap(3, {1, 0, 1, 0, 1, 0}));
  }

  return rowOfTiles(builder, [&](int i) {
    const std::size_t at = i % 2;
    Material m = diffuseMaterial(0.8f);
    m.diffuseMap = color[at];
    if (i / 2 == 1) {
      m.specular = Rgb(0.6f);
      m.roughnessMap = data[at];
    }
    if (i / 2 == 2) m.alphaMap = mask[at];
    return tile(builder.add(m));
  });
}

TEST(NearestTextures, KeepTheLawsOfMaps) { expectTheLawsOfMaps(pixelArt(false)); }

TEST(NearestTextures, AreLookedUpAsWhereAllAre) {
  Scene scene = pixelArt(true);
  RenderOptions o = smallOptions();
  // --texture-filter does not apply to masks.
  o.disable = {Effect::alphaMasks};
  o.shading.textureFilter = TextureFilter::bilinear;
  const Image alone = render(scene, o).image;

  for (Texture& t : scene.textures) t.nearest = false;
  const Image interpolated = render(scene, o).image;
  o.shading.textureFilter = TextureFilter::nearest;
  const Image all = render(scene, o).image;

  EXPECT_EQ(alone.pixels, all.pixels);
  EXPECT_NE(alone.pixels, interpolated.pixels);
}

// A mask of 1 beside 0 has its edge halfway between the texels: at u = 1/2, where interpolated
// masks have it too, and at u = 0, where the texture repeats.
TEST(NearestTextures, CutTexelByTexel) {
  for (const float right : {0.0f, 0.45f}) {
    SceneBuilder builder;
    Material m = emittingMaterial(1);
    Texture t = dataMap(2, {1, right});
    t.nearest = true;
    m.alphaMap = builder.add(t);
    // Bilinear alpha is below the cutoff only beyond u = 0.55, or nowhere.
    m.alphaCutoff = 0.4f;
    builder.add(tile(builder.add(m)));
    const Scene scene = builder.build();

    for (int i = 0; i < 100; ++i) {
      const double u = (i + 0.5) / 100;
      const double seen = radianceBelow(scene, {u, 1, -0.5}).x;
      EXPECT_EQ(seen, u < 0.5 || right > 0.4f ? 1 : 0) << u;
    }
  }
}

}  // namespace
}  // namespace whit::test
