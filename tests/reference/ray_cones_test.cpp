// Ray cones, and the mip levels that they determine.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reference/generate_rays.h"
#include "reference/small_scenes.h"
#include "rounding.h"
#include "surfaces/texture_sampling.h"

namespace whit::reference {
namespace {

using namespace test;

// Rays that are reflected or refracted start off the surface, by less than 1e-3 of the distances
// here. This changes the level by as much.
constexpr double kOffset = 2e-3;
constexpr int kTexels = 64;  // along a side

Texture noise() {
  Numbers numbers(11);
  std::vector<std::uint32_t> texels;
  for (int i = 0; i < kTexels * kTexels; ++i) {
    texels.push_back(static_cast<std::uint32_t>(numbers.in(0, 0x1p30)));
  }
  return makeTexture(TexelFormat::color, kTexels, kTexels, texels);
}

// Returns a glowing floor with one texel a unit.
Mesh glowingFloor(SceneBuilder& builder, Texture texture) {
  Material m = emittingMaterial(1);
  m.emissionMap = builder.add(std::move(texture));
  return floorAt(0, kTexels / 2.0f, builder.add(m));
}

Scene floorOf(Texture texture) {
  SceneBuilder builder;
  builder.add(glowingFloor(builder, std::move(texture)));
  return builder.build();
}

// Returns a ray straight down; its cone has the width of a texel at a distance of 64.
Ray rayFrom(double height, const RayCone& cone = {0, 1.0 / kTexels}, double x = 3.3) {
  return {{x, height, 2.1}, {0, -1, 0}, cone};
}

RgbD seen(const Scene& scene, const Ray& ray, int depth = 8) {
  Settings settings = uncut(depth);
  settings.options.shading.textureFilter = TextureFilter::trilinear;
  const BruteForce bruteForce(scene);
  RayCounts counts;
  return Tracer(scene, bruteForce, settings).traceImpulse(ray, 0, 1, 0, counts);
}

// Returns the color of the floor below those rays, or elsewhere.
RgbD floorColor(const Scene& scene, double level, double x = 3.3, double z = 2.1) {
  const double half = kTexels / 2.0;
  return sampleTexture(MipMaps(scene), {0}, (x + half) / kTexels, (half - z) / kTexels, level);
}

TEST(MipLevel, GrowsByOneAsTheSidesDouble) {
  EXPECT_EQ(mipLevel(0), 0);
  EXPECT_EQ(mipLevel(0.7), 0);
  EXPECT_EQ(mipLevel(1), 0);
  EXPECT_EQ(mipLevel(4), 1);
  EXPECT_EQ(mipLevel(64), 3);
  EXPECT_NEAR(mipLevel(9), std::log2(3), kRounding);
}

TEST(MipLevel, H70_ofSenselessFootprintsIsALevel) {
  EXPECT_EQ(mipLevel(std::nan("")), 0);
  EXPECT_EQ(mipLevel(-kInfinity), 0);
  EXPECT_EQ(mipLevel(kInfinity), kMipLevels - 1);

  const Scene scene = floorOf(noise());
  for (const auto& [width, level] : {std::pair{0.0, 0},
                                     {-1e300, kMipLevels - 1},
                                     {kInfinity, kMipLevels - 1},
                                     {std::nan(""), 0}}) {
    expectNear(seen(scene, rayFrom(5, {width, 0})), floorColor(scene, level));
  }
}

TEST(Trilinear, H70_aWholeLevelIsThatLevelBitForBit) {
  const Scene scene = floorOf(noise());
  const MipMaps maps(scene);
  Numbers numbers(3);
  for (int i = 0; i < 200; ++i) {
    const double u = numbers.in(-2, 2), v = numbers.in(-2, 2);
    const int level = i % kMipLevels;
    EXPECT_EQ(sampleTexture(maps, {0}, u, v, level), sampleTexture(maps.level({0}, level), u, v));
  }
}

TEST(Trilinear, MixesDataBetweenLevels) {
  const std::vector<Texture> textures{
      makeTexture(TexelFormat::data, 2, 1, {0x00c86450u, 0x00000000u})};
  const MipMaps maps(textures, {{0}});

  // At the first texel's center the value is (80, 100, 200), and half of it in the next level.
  expectNear(sampleTexture(maps, {0}, 0.25, 0.5, 0.5) * 255, {60, 75, 150}, 1e-10);
}

TEST(RayCone, OfAPixelIsAsWideAsThePixel) {
  Camera camera;
  camera.fov = 90;

  const Ray ray = generateRay(makeCameraFrame(camera, 300, 200), 17, 33);
  EXPECT_EQ(ray.cone.width, 0);
  EXPECT_NEAR(ray.cone.spread, 2.0 / 200, kRounding);
  EXPECT_NEAR(ray.cone.widthAt(7), 0.07, kRounding);

  camera.orthographicHeight = 5;
  const Ray parallel = generateRay(makeCameraFrame(camera, 300, 200), 17, 33);
  EXPECT_NEAR(parallel.cone.width, 5.0 / 200, kRounding);
  EXPECT_EQ(parallel.cone.spread, 0);
}

TEST(RayCone, LevelsFollowFromTheDistance) {
  const Scene scene = floorOf(noise());
  for (const double distance : {10.0, 64.0, 128.0, 192.0, 256.0, 1024.0, 1e6}) {
    const double wanted = std::clamp(std::log2(distance / 64), 0.0, 6.0);
    const RgbD color = floorColor(scene, wanted);
    expectNear(seen(scene, rayFrom(distance)), color, 1e-9);

    // Up to distance 64 the floor is as sharp as by lookups of level 0.
    const RgbD full = floorColor(scene, 0);
    EXPECT_EQ(distance <= 64, maxComponent(abs(full - color)) < 1e-3) << distance;
  }
}

TEST(RayCone, OfParallelRaysKeepsItsWidth) {
  const Scene scene = floorOf(noise());
  for (const double distance : {1.0, 1000.0}) {
    expectNear(seen(scene, rayFrom(distance, {4, 0})), floorColor(scene, 2));
  }
}

// At 60 degrees to the normal the cone's section is twice as long.
TEST(RayCone, GrowsOnSurfacesSeenAtAnAngle) {
  const Scene scene = floorOf(noise());
  const Vec3d direction = steep(60);
  expectNear(seen(scene, {Vec3d{3.3, 0, 2.1} - direction * 256, direction, {0, 1.0 / 64}}),
             floorColor(scene, 3), 1e-9);
}

TEST(RayCone, GoesOnBehindAMirror) {
  SceneBuilder builder;
  builder.add(glowingFloor(builder, noise()));
  builder.add(ceilingAt(100, kTexels / 2.0f), mirrorMaterial(0.5f));
  const Scene scene = builder.build();
  expectNear(seen(scene, {{3.3, 72, 2.1}, {0, 1, 0}, {0, 1.0 / 64}}), floorColor(scene, 1) * 0.5,
             kOffset);  // 28 + 100 units of way
}

TEST(RayCone, GoesOnInsideGlassAndBehindIt) {
  SceneBuilder builder;
  builder.add(glowingFloor(builder, noise()));
  addSlab(builder, 90, 30, glassMaterial(1.5f), kTexels / 2.0f);
  const Scene scene = builder.build();

  // Each of two surfaces reflects 4 %. Light that is reflected between them would need more depth.
  expectNear(seen(scene, rayFrom(128), 2), floorColor(scene, 1) * (0.96 * 0.96), kOffset);
}

// An instance of twice the size has texels of two units, and one level less.
TEST(RayCone, CountsTexelsOfInstancesInTheWorld) {
  SceneBuilder builder;
  builder.place({"floor", {glowingFloor(builder, noise())}},
                {Affine::scaling(Vec3d(2)), Affine::translation({1000, 0, 0})});
  const Scene scene = builder.build();
  ASSERT_EQ(scene.instances.size(), 2u);

  expectNear(seen(scene, rayFrom(256)), floorColor(scene, 1, 1.65, 1.05), 1e-9);
  expectNear(seen(scene, rayFrom(256, {0, 1.0 / kTexels}, 1003.3)), floorColor(scene, 2), 1e-9);
}

}  // namespace
}  // namespace whit::reference
