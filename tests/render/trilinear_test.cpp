// Mip levels in the vector pipeline: agreement with the reference, and laws of pictures.
#include <gtest/gtest.h>

#include <tuple>

#include "render/row_of_tiles.h"
#include "render/scaled_scene.h"

namespace whit::test {
namespace {

RenderOptions filteredBy(TextureFilter filter) {
  RenderOptions o = smallOptions();
  o.shading.textureFilter = filter;
  return o;
}

const RenderOptions kBilinear = filteredBy(TextureFilter::bilinear),
                    kTrilinear = filteredBy(TextureFilter::trilinear);

Texture noise(TexelFormat format, int width, int height) {
  Numbers numbers(5);
  std::vector<std::uint32_t> texels;
  for (int i = 0; i < width * height; ++i) {
    // Normals lean a little this way and that.
    const auto lean = [&] { return static_cast<float>(numbers.in(0.4, 0.6)); };
    texels.push_back(format == TexelFormat::data
                         ? encodeDataTexel(lean(), lean(), 1, 1)
                         : static_cast<std::uint32_t>(numbers.in(0, 0x1p30)));
  }
  Texture t = makeTexture(format, width, height, texels);
  t.wrapV = Wrap::mirror;
  return t;
}

// The scene has a floor, walls as instances, a mirror and a glass pane, with every kind of map, to
// the horizon.
SceneDescription textured() {
  SceneBuilder builder;
  Material m = diffuseMaterial(0.6f);
  m.specular = m.emission = Rgb(0.3f);
  m.diffuseMap = builder.add(noise(TexelFormat::color, 33, 64));
  m.specularMap = builder.add(noise(TexelFormat::color, 16, 16));
  m.emissionMap = builder.add(noise(TexelFormat::color, 8, 1));

  Material bumpy = diffuseMaterial(0.8f);
  bumpy.normalMap = builder.add(noise(TexelFormat::data, 16, 50));
  bumpy.mirror = bumpy.mirrorGrazing = Rgb(0.3f);
  const std::uint32_t matt = builder.add(m), waves = builder.add(bumpy);
  Mesh floor = floorAt(0, 60, matt);
  for (Vec2f& uv : floor.uvs) uv = {uv.x * 40, uv.y * 40};
  builder.add(floor);
  builder.add(quad({-6, 0, -8}, {-1, 0, -9}, {-1, 4, -9}, {-6, 4, -8}, waves));
  builder.add(box({1, 1, -3}, {2.5f, 2, -2.5f}), glassMaterial(1.5f));

  Object sign;
  sign.meshes = {quad({0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, matt)};
  const Affine far = Affine::translation({3, 0, -20}) * Affine::scaling({3, 5, 1});
  builder.place(std::move(sign), {Affine::translation({-3, 0, -4}), far});

  builder.description.lights.push_back(lightAt({2, 8, 3}, 300));
  builder.sky(0.2f);
  builder.lookFrom({0, 2, 4}, {0, 1, -4});
  return builder.describe();
}

TEST(Trilinear, AgreesWithTheReferenceOnEveryTarget) {
  expectTheReferenceOnEveryTarget(repaired(textured()), kTrilinear);
}

TEST(Trilinear, KeepsItsBitsWhateverTheQueues) {
  expectBitsWhateverTheQueues(repaired(textured()), kTrilinear);
}

TEST(Trilinear, H61a_keepsItsBitsAtAnyPowerOfTwo) {
  expectBitsAtAnyScale(textured(), {-20, 3, 20}, kTrilinear);
}

TEST(Trilinear, CostsColumnsAndTexelsOnlyWhereItIsAskedFor) {
  const Scene scene = repaired(textured()), plain = load("matte");
  const auto parts = [](const Scene& s, const RenderOptions& o) {
    Renderer renderer(s, o);
    const ShadingTables& tables = renderer.tables();
    return std::tuple(renderer.plan().features.has(Feature::cones), tables.copiedTexels,
                      tables.mipLevels.size());
  };

  // Each level takes strips of 8 columns that hold 7 of the width + 1 footprints, in height + 2
  // rows. The full textures have 33x64, 16x16, 8x1 and 16x50 texels, and the others are their
  // halves.
  constexpr std::size_t kRow = 8;
  constexpr std::size_t kFull = kRow * (5 * 66 + 3 * 18 + 2 * 3 + 3 * 52);
  constexpr std::size_t kLevels =
      kRow * ((3 * 34 + 2 * 18 + 10 + 6 + 4 + 3) + (2 * 10 + 6 + 4 + 3) + (3 + 3 + 3) +
              (2 * 27 + 14 + 8 + 5 + 3));

  EXPECT_EQ(parts(scene, kBilinear), std::tuple(false, kFull, std::size_t{0}));
  EXPECT_EQ(parts(scene, kTrilinear), std::tuple(true, kFull + kLevels, 4u * kMipStride));
  EXPECT_FALSE(plain.effects.has(Effect::textures));
  EXPECT_EQ(parts(plain, kTrilinear), std::tuple(false, std::size_t{0}, std::size_t{0}));
}

TEST(Trilinear, CanBeAskedForBetweenFrames) {
  const Scene scene = repaired(textured());
  const Picture sharp = render(scene, kBilinear);
  const Picture soft = render(scene, kTrilinear);
  EXPECT_NE(firstDifference(sharp, soft), "");

  Renderer renderer(scene, kBilinear);
  for (const bool mips : {false, true, false, true}) {
    const RenderOptions& o = mips ? kTrilinear : kBilinear;
    ASSERT_TRUE(renderer.canSetOptions(o));
    renderer.setOptions(o);
    EXPECT_EQ(firstDifference(render(renderer), mips ? soft : sharp), "") << mips;
  }
}

}  // namespace
}  // namespace whit::test
