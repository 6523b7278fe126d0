// Emission maps of radiance and of color: the vector pipeline against the reference.
#include <gtest/gtest.h>

#include "render/row_of_tiles.h"

namespace whit::test {
namespace {

// Maps of both kinds are side by side, by either set of coordinates, with and without instances.
Scene glowingTiles() {
  SceneBuilder builder;
  const std::int32_t color = builder.add(makeTexture(
      TexelFormat::color, 2, 2, {1023u, 700u << 10 | 300u, 341u | 341u << 10 | 341u << 20, 900u}));
  const std::int32_t bright = builder.add(
      makeTexture(TexelFormat::radiance, 2, 2,
                  {encodeRadianceTexel({20, 3, 0.5f}), encodeRadianceTexel({1e-4f, 0, 2e-5f}),
                   encodeRadianceTexel({0, 7, 0}), encodeRadianceTexel({1, 1, 1.5f})}));

  return rowOfTiles(builder, [&](int i) {
    Material m = diffuseMaterial(0.5f);
    if (i < 5) m.emission = {0.5f, 0.25f, 1};
    m.emissionMap = i % 2 ? color : bright;
    if (i == 3) m.diffuseMap = color;
    m.emissionBySecondUvs = i == 4;
    Mesh mesh = quad({0, 0, 0}, {1, 0, 0}, {1, 0, -1}, {0, 0, -1}, builder.add(m));
    mesh.secondUvs = {{0, 1}, {0, 0}, {1, 0}, {1, 1}};
    return mesh;
  });
}

TEST(RadianceMaps, AgreeWithTheReferenceOnEveryTarget) {
  const Scene scene = glowingTiles();
  for (const TextureFilter filter :
       {TextureFilter::nearest, TextureFilter::bilinear, TextureFilter::trilinear}) {
    RenderOptions o = smallOptions();
    o.shading.textureFilter = filter;
    expectTheReferenceOnEveryTarget(scene, o);
  }
}

TEST(RadianceMaps, HaveTheSameBitsWhateverTheQueues) {
  expectBitsWhateverTheQueues(glowingTiles(), smallOptions());
}

TEST(RadianceMaps, AreLeftOutWithTheirEffect) {
  for (const Effect effect : {Effect::emissionMaps, Effect::textures}) {
    RenderOptions o = smallOptions();
    o.disable = EffectSet().with(effect);
    const auto name = kEffectNames[static_cast<std::size_t>(effect)].name;
    expectThePictureOfTheReference(glowingTiles(), o, std::string(name));
  }
}

}  // namespace
}  // namespace whit::test
