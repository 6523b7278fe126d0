// Surfaces that cover a part of what is behind them, and thin sheets: the vector pipeline against
// the reference, which tests/oracle compares with sums of what is seen without them.
#include <gtest/gtest.h>

#include "render/row_of_tiles.h"

namespace whit::test {
namespace {

// The material is matte, glossy, emitting and mirroring at once.
Material allAtOnce() {
  Material m = diffuseMaterial(0.6f);
  m.specular = Rgb(0.9f, 0.5f, 0.2f);
  m.roughness = 0.4f;
  m.glossyReflection = false;
  m.emission = {0.1f, 0.2f, 0.3f};
  m.mirror = Rgb(0.3f);
  m.mirrorGrazing = Rgb(0.8f);
  return m;
}

// The reference alone counts rays here; it and the packets trace the same ones.
TEST(Coverage, ClearTexelsAreNoBounce) {
  SceneBuilder builder;
  Material sheet = emittingMaterial(1);
  sheet.coverageMap = builder.add(dataMap(1, {0}));
  sheet.passClearTexels();
  builder.add(floorAt(0, 9), sheet);
  builder.sky(0.5f);
  reference::RayCounts counts;
  EXPECT_EQ(radianceBelow(builder.build(), {0, 1, 0}, uncut(), &counts).x, 0.5);
  EXPECT_EQ(counts[RayKind::refraction], 0u);
}

// Pairs of tiles, one over the other, cover by maps and numbers, mirror and shine. One is thin.
Scene tilesInPart() {
  SceneBuilder builder;
  const std::int32_t few = builder.add(dataMap(4, {0, 0.3f, 1, 0.6f}));
  std::vector<float> many;
  for (int i = 0; i < 37; ++i) many.push_back(static_cast<float>(i) / 36);
  const std::int32_t slope = builder.add(dataMap(37, many));

  builder.sky(0.3f);
  return rowOfTiles(builder, [&](int i) {
    Material m = allAtOnce();
    m.glossyReflection = i % 2 == 0;
    m.coverage = i == 1 ? 1.0f : 0.8f;
    if (i != 2) m.coverageMap = i < 2 ? few : slope;
    if (i > 3) m.passClearTexels();
    if (i == 5) {
      m.transmission = Rgb(0.5f);
      m.thin = true;
    }

    const std::uint32_t material = builder.add(m);
    Mesh both = tile(material);
    both.secondUvs.clear();
    const Mesh upper = both;
    both.uvs.insert(both.uvs.end(), upper.uvs.begin(), upper.uvs.end());
    for (const Vec3f& p : upper.positions) both.positions.push_back({p.x, p.y - 0.5f, p.z});
    for (const auto& [p, q, r] : upper.triangles) both.triangles.push_back({p + 4, q + 4, r + 4});
    both.materials.assign(both.triangles.size(), material);
    return both;
  });
}

TEST(Coverage, KeepsTheLawsOfMaps) { expectTheLawsOfMaps(tilesInPart(), withSampledLobes()); }

}  // namespace
}  // namespace whit::test
