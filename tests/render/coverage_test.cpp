// Surfaces that cover a part of what is behind them, and thin sheets: the reference against sums of
// what is seen without them, and the vector pipeline against the reference.
#include <gtest/gtest.h>

#include <cmath>

#include "inspect/reference_frame.h"
#include "pi.h"
#include "render/row_of_tiles.h"
#include "rounding.h"

namespace whit::test {
namespace {

Material inPart(Material m, float coverage) {
  m.coverage = coverage;
  return m;
}

// A square of the plane y = `height`, as wide as the scene.
Mesh levelAt(float height, std::uint32_t material) {
  return quad({-9, height, 9}, {9, height, 9}, {9, height, -9}, {-9, height, -9}, material);
}

std::int32_t addCoverageMap(SceneBuilder& builder, const std::vector<float>& values) {
  std::vector<std::uint32_t> texels;
  for (const float v : values) texels.push_back(encodeDataTexel(v, 0.9f, 0.1f, 1));
  return builder.add(
      makeTexture(TexelFormat::data, static_cast<int>(values.size()), 1, std::move(texels)));
}

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

// Returns the radiance of a sheet of allAtOnce() over a floor, under a light without shadows.
RgbD sheetOverAFloor(float coverage, const Vec3d& direction) {
  SceneBuilder builder;
  Material sheet = inPart(allAtOnce(), coverage);
  sheet.castsShadow = false;

  builder.add(levelAt(0, builder.add(sheet)));
  builder.add(levelAt(-1, builder.add(diffuseMaterial(0.7f))));
  builder.sky(0.4f);
  builder.description.ambient = {Rgb(0.25f), Rgb(0.25f)};
  builder.description.lights = {lightAt({1, 3, 1}, 30)};
  return radianceAlong(builder.build(), -direction * 2.0, direction);
}

TEST(Coverage, IsAShareOfAllThatASurfaceSends) {
  for (const double degrees : {0.0, 40.0, 80.0}) {
    const Vec3d down = steep(degrees);
    const RgbD whole = sheetOverAFloor(1, down), none = sheetOverAFloor(0, down);
    EXPECT_GT(std::fabs(whole.x - none.x), 0.05);
    for (const double c : {0.25, 0.5, 0.9}) {
      const RgbD seen = sheetOverAFloor(static_cast<float>(c), down),
                 wanted = whole * c + none * (1 - c);
      EXPECT_NEAR(seen.x, wanted.x, 1e-6) << degrees << " " << c;
      EXPECT_NEAR(seen.z, wanted.z, 1e-6) << degrees << " " << c;
    }
  }
}

TEST(Coverage, CountsTexelByTexel) {
  SceneBuilder builder;
  Material sheet = inPart(emittingMaterial(1), 0.5f);
  sheet.coverageMap = addCoverageMap(builder, {0, 0.2f, 0.6f, 1});
  builder.add(quad({0, 0, 0}, {4, 0, 0}, {4, 0, -1}, {0, 0, -1}, builder.add(sheet)));
  builder.add(levelAt(-1, builder.add(emittingMaterial(3))));
  const Scene scene = builder.build();
  reference::Settings settings = uncut();
  settings.options.shading.textureFilter = TextureFilter::nearest;
  const double values[] = {0, 0.2, 0.6, 1};

  for (int i = 0; i < 4; ++i) {
    const double seen = radianceAlong(scene, {i + 0.5, 2, -0.5}, {0, -1, 0}, settings).x;
    const double c = values[i] * 0.5;
    EXPECT_NEAR(seen, c + 3 * (1 - c), 1e-6) << i;
  }
}

// The sheets are seen from the front and from behind, where a sheet that bounded a medium would be
// taken for the end of a medium that never began.
TEST(Coverage, LetsThroughSheetAfterSheetFromEitherSide) {
  for (const int sheets : {1, 2, 7}) {
    SceneBuilder builder;
    const auto sheet = builder.add(inPart(emittingMaterial(1), 0.25f));
    for (int i = 0; i < sheets; ++i) builder.add(levelAt(static_cast<float>(-i), sheet));
    builder.sky(5);
    const Scene scene = builder.build();

    const double through = std::pow(0.75, sheets), wanted = 1 - through + 5 * through;
    const reference::Settings settings = uncut(9);

    EXPECT_NEAR(radianceAlong(scene, {0, 1, 0}, steep(30), settings).x, wanted, 1e-6) << sheets;
    EXPECT_NEAR(radianceAlong(scene, {0, -8, 0}, -steep(30), settings).x, wanted, 1e-6) << sheets;
  }
}

TEST(Coverage, OfASheetInWaterBendsNothing) {
  const auto picture = [](bool withSheet) {
    SceneBuilder builder;
    builder.add(box({-4, -4, -4}, {4, 4, 4}, builder.add(glassMaterial(1.33f))));
    if (withSheet) {
      builder.add(quad({-3, -3, -1}, {3, -3, -1}, {3, 3, -1}, {-3, 3, -1},
                       builder.add(inPart(emittingMaterial(0), 0.5f))));
    }

    Object lamp;
    lamp.meshes = {
        box({-0.4f, -0.4f, -2.4f}, {0.4f, 0.4f, -1.6f}, builder.add(emittingMaterial(1)))};
    builder.place(std::move(lamp), {Affine(), Affine::translation({1, 1, 0})});
    builder.description.cameras = {{.eye = {0.1f, 0.2f, 3}, .at = {0, 0, 0}}};
    RenderOptions o = smallOptions();
    o.size = kSmallSize;
    o.depth = 2;
    return render(builder.build(), o).image;
  };

  // Half of the lamp's light passes the sheet, if no ray is bent on its way.
  const Image clear = picture(false), veiled = picture(true);
  std::size_t seen = 0, different = 0;
  for (std::size_t i = 0; i < clear.pixels.size(); ++i) {
    if (clear.pixels[i].x != 1) continue;
    ++seen;
    different += std::fabs(veiled.pixels[i].x - 0.5f) > 1e-6f;
  }

  EXPECT_GT(seen, 100u);
  EXPECT_LE(different, kPixelsAtEdges);
}

// The glass reflects where the sheet is clear, and reflects all light past its critical angle.
TEST(Coverage, OfASheetOnGlassLeavesItsReflection) {
  for (const bool within : {false, true}) {
    SceneBuilder builder;
    builder.add(box({-2, -1, -2}, {2, 0, 2}, builder.add(glassMaterial(1.5f))));
    builder.add(quad({-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1},
                     builder.add(inPart(blackMaterial(), 0.25f))));

    builder.sky(2);
    const float height = within ? -0.5f : 0.5f;
    builder.description.cameras = {{.eye = {0.1f, height, 1.2f}, .at = {0.05f, 0, 0}, .fov = 20}};
    const Scene scene = builder.build();
    const RenderOptions o = smallOptions();
    const auto [packets, reference] = renderBoth(scene, o);
    const int x = packets.image.width / 2, y = packets.image.height / 2;
    const Rgb pixel = packets.image.at(x, y), wanted = reference.image.at(x, y);

    EXPECT_GT(wanted.x, 0.1f) << within;
    EXPECT_NEAR(pixel.x, wanted.x, 1e-5f) << within;
  }
}

TEST(Coverage, LiesOnWhatIsOpaqueWithoutALeak) {
  SceneBuilder builder;
  builder.add(levelAt(0, builder.add(emittingMaterial(1))));
  builder.add(levelAt(-1, builder.add(emittingMaterial(9))));
  builder.add(quad({-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1},
                   builder.add(inPart(emittingMaterial(0), 0.5f))));

  const Scene scene = builder.build();
  for (const double x : {-0.7, 0.3, 0.9, 2.0}) {
    EXPECT_EQ(radianceAlong(scene, {x, 2, 0.4}, {0, -1, 0}).x, 1) << x;
  }
}

// The sheet covers by its own map, and by its map where another map has cut holes besides.
TEST(Coverage, CastsShadowsWhereItIsHalfOrMore) {
  for (const float factor : {1.0f, 0.9f}) {
    for (const bool cut : {false, true}) {
      SceneBuilder builder;
      Material sheet = inPart(blackMaterial(), factor);
      sheet.coverageMap = addCoverageMap(builder, {0.1f, 0.45f, 0.6f, 1});
      sheet.passClearTexels();
      if (cut) sheet.alphaMap = addCoverageMap(builder, {1, 1, 0.8f, 0.4f});
      if (cut) sheet.alphaCutoff = 0.5f;

      builder.add(quad({0, 1, 0}, {4, 1, 0}, {4, 1, -1}, {0, 1, -1}, builder.add(sheet)));
      builder.add(levelAt(0, builder.add(diffuseMaterial(0.5f))));
      builder.description.lights = {sun({0, -1, 0}, 2)};
      builder.description.cameras = {
          {.eye = {2, 0.5f, -0.5f}, .at = {2, 0, -0.5f}, .up = {0, 0, -1}}};
      builder.description.cameras[0].orthographicHeight = 1;
      const Scene scene = builder.build();

      RenderOptions o = smallOptions();
      o.size = ImageSize{4, 1};
      const Image image = render(scene, o).image;

      // Texels of a coverage of 0.5 or more cast shadows; the other map cuts the last one.
      const bool lit[] = {true, true, false, cut};
      for (int i = 0; i < 4; ++i) {
        const double seen = radianceAlong(scene, {i + 0.5, 0.5, -0.5}, {0, -1, 0}).x;
        const double wanted = lit[i] ? 1 / kPi : 0;
        EXPECT_NEAR(seen, wanted, 1e-6) << i << " " << factor << cut;
        EXPECT_NEAR(double{image.at(i, 0).x}, wanted, 1e-6) << i << " " << factor << cut;
      }
    }
  }
}

TEST(Coverage, ClearTexelsAreNoBounce) {
  SceneBuilder builder;
  Material sheet = emittingMaterial(1);
  sheet.coverageMap = addCoverageMap(builder, {0});
  sheet.passClearTexels();
  builder.add(levelAt(0, builder.add(sheet)));
  builder.sky(0.5f);
  reference::RayCounts counts;
  EXPECT_EQ(radianceAlong(builder.build(), {0, 1, 0}, {0, -1, 0}, uncut(), &counts).x, 0.5);
  EXPECT_EQ(counts[RayKind::refraction], 0u);
}

// A thin sheet of any index bounds no medium, so light passes straight.
TEST(ThinSheet, TintsWhatGoesStraightOn) {
  SceneBuilder builder;
  Material sheet = blackMaterial();
  sheet.transmission = {0.5f, 0.25f, 1};
  sheet.thin = true;
  sheet.ior = 1.7f;
  sheet.mirror = sheet.mirrorGrazing = Rgb(0.25f);
  builder.add(levelAt(0, builder.add(sheet)));
  builder.sky(0.4f);

  const Scene scene = builder.build();
  for (const double height : {1.0, -1.0}) {
    const RgbD seen = radianceAlong(scene, {0, height, 0}, steep(60) * height);
    EXPECT_NEAR(seen.x, 0.4 * (0.25 + 0.5 * 0.75), 1e-6);
    EXPECT_NEAR(seen.y, 0.4 * (0.25 + 0.25 * 0.75), 1e-6);
    EXPECT_NEAR(seen.z, 0.4 * (0.25 + 0.75), 1e-6);
  }
}

// Pairs of tiles, one over the other, cover by maps and numbers, mirror and shine. One is thin.
Scene tilesInPart() {
  SceneBuilder builder;
  const std::int32_t few = addCoverageMap(builder, {0, 0.3f, 1, 0.6f});
  std::vector<float> many;
  for (int i = 0; i < 37; ++i) many.push_back(static_cast<float>(i) / 36);
  const std::int32_t slope = addCoverageMap(builder, many);

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

RenderOptions sampledOptions() {
  RenderOptions o = smallOptions();
  o.glossy = 2;
  return o;
}

TEST(Coverage, KeepsTheLawsOfMaps) { expectTheLawsOfMaps(tilesInPart(), sampledOptions()); }

TEST(Coverage, HasAStepWhereTheSceneHasSome) {
  expectStep("lookUpCoverage", tilesInPart(), sampledOptions(),
             {Effect::coverage, Effect::transmission});
}

}  // namespace
}  // namespace whit::test
