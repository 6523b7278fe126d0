// Emission maps of radiance and of color: the vector pipeline against the reference.
#include <gtest/gtest.h>

#include "render/row_of_tiles.h"

namespace whit::test {
namespace {

// Maps of both kinds are side by side, by either set of coordinates, with and without instances.
Scene glowingTiles() {
  SceneBuilder builder;
  const std::int32_t color = addColors(builder);
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
    return tile(builder.add(m));
  });
}

TEST(RadianceMaps, KeepTheLawsOfMaps) { expectTheLawsOfMaps(glowingTiles()); }

TEST(RadianceMaps, AreLeftOutWithTheirEffect) {
  expectTheReferenceWithout(glowingTiles(), {Effect::emissionMaps, Effect::textures});
}

}  // namespace
}  // namespace whit::test
