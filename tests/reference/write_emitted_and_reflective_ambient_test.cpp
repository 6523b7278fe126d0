// Emission, ambient light and the sky.
#include "reference/write_emitted_and_reflective_ambient.h"

#include <gtest/gtest.h>

#include <cmath>

#include "reference/small_chunk.h"
#include "reference/small_scenes.h"

namespace whit::reference {
namespace {

using test::SceneBuilder;

TEST(Ambient, FollowsTheNormal) {
  Scene scene;
  scene.materials.resize(1);
  scene.ambient = {Rgb(3.0f), Rgb(1.0f)};
  Surfel s;
  s.diffuse = {1, 0.5, 0};

  const EffectSet direct = EffectSet::all().without(Effect::indirect);
  s.shadingNormal = {0, 1, 0};
  EXPECT_EQ(emittedAndAmbient(scene, direct, s), RgbD(3, 1.5, 0));
  s.shadingNormal = {0, -1, 0};
  EXPECT_EQ(emittedAndAmbient(scene, direct, s), RgbD(1, 0.5, 0));
  s.shadingNormal = {1, 0, 0};
  EXPECT_EQ(emittedAndAmbient(scene, direct, s), RgbD(2, 1, 0));
  EXPECT_EQ(emittedAndAmbient(scene, EffectSet::all().without(Effect::ambient), s), RgbD());
}

TEST(Emission, AddsToTheRest) {
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].emission = {1, 2, 3};
  Surfel s;
  EXPECT_EQ(emittedAndAmbient(scene, EffectSet::all(), s), RgbD(1, 2, 3));
  EXPECT_EQ(emittedAndAmbient(scene, EffectSet::all().without(Effect::emission), s), RgbD());
}

TEST(Sky, NeedsItsEffects) {
  SceneBuilder builder;
  builder.sky(2);
  const Scene plain = builder.build();
  EXPECT_EQ(skyAlong(plain, EffectSet::all(), {0, 1, 0}), RgbD(2.0));
  EXPECT_EQ(skyAlong(plain, EffectSet::all().without(Effect::skyImage), {0, 1, 0}), RgbD(2.0));
  EXPECT_EQ(skyAlong(plain, EffectSet::all().without(Effect::sky), {0, 1, 0}), RgbD());

  SceneBuilder withImage;
  withImage.description.sky.kind = Sky::Kind::image;
  withImage.description.sky.image = {1, 1, {1}, {2}, {3}};
  const Scene image = withImage.build();
  EXPECT_EQ(skyAlong(image, EffectSet::all(), {0, 1, 0}), RgbD(1, 2, 3));
  EXPECT_EQ(skyAlong(image, EffectSet::all().without(Effect::skyImage), {0, 1, 0}), RgbD());
}

// White light from all sides: a lobe takes from the diffuse color what it reflects, so that no
// surface is brighter than the light; metals reflect their lobe's albedo.
TEST(BlurredSky, IsReflectedByRoughSurfaces) {
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].specular = Rgb(1.0f);
  scene.ambient = {Rgb(1.0f), Rgb(1.0f)};
  scene.sky.kind = Sky::Kind::color;
  scene.sky.zenith = Rgb(1.0f);
  scene.blurredSky = blurredSky(scene.sky);
  const EffectSet effects =
      EffectSet::all().without(Effect::indirect).without(Effect::glossyReflection);

  Surfel s;
  s.shadingNormal = {0, 1, 0};
  s.view = normalized(Vec3d(1, 1, 0));
  s.alpha = 0.25;
  s.specular = {1, 0.5, 0.04};
  const RgbD albedo = lobeAlbedo(s.specular, 1, std::sqrt(0.5), 0.5);

  findLayers(scene, effects, {}, {}, {}, s);
  const RgbD metal = emittedAndAmbient(scene, effects, s);
  EXPECT_NEAR(metal.x, albedo.x, 1e-6);
  EXPECT_NEAR(metal.z, albedo.z, 1e-6);

  s.diffuse = RgbD(1.0);
  findLayers(scene, effects, {}, {}, {}, s);
  EXPECT_NEAR(s.diffuse.x, 1 - albedo.x, 1e-12);
  EXPECT_NEAR(emittedAndAmbient(scene, effects, s).y, 1, 1e-6);
  EXPECT_EQ(emittedAndAmbient(scene, effects.without(Effect::blurredSky), s), s.diffuse);

  scene.ambient.reflection = 0.5f;
  EXPECT_NEAR(emittedAndAmbient(scene, effects, s).x, 1 - albedo.x / 2, 1e-6);
  scene.ambient.reflection = 1;

  scene.materials[0].mirror = scene.materials[0].mirrorGrazing = Rgb(0.25f);
  EXPECT_NEAR(emittedAndAmbient(scene, effects, s).x, s.diffuse.x + 0.75 * albedo.x, 1e-6)
      << "under the mirror";
  scene.materials[0].glossyReflection = false;
  EXPECT_EQ(emittedAndAmbient(scene, effects, s), s.diffuse) << "the mirror shows the scene";
}

TEST(AmbientReference, TellsSkySurfelsAndHiddenOnesApart) {
  SceneBuilder builder;
  builder.sky(2);
  Material glowing = test::blackMaterial();
  glowing.emission = {1, 2, 3};
  const auto material = builder.add(glowing);
  builder.add(test::floorAt(0, 1, material));
  const Scene scene = builder.build();
  test::SmallChunk small(scene, FeatureSet::all().without(Feature::emissionFactors));
  test::setRay(small.chunk.rays, 0, {0, 1, 0}, {0, -1, 0});

  const auto blue = [&](std::uint32_t found, std::uint32_t flags) {
    small.chunk.surfels.material[0] = found;
    small.chunk.surfels.flags[0] = flags;
    return writeEmittedAndReflectiveAmbient(small.world, small.chunk, 0).rgb.z;
  };

  EXPECT_EQ(blue(kMiss, 0), 2);
  EXPECT_EQ(blue(scene.triangles[0].material, kEntering), 3);
  EXPECT_EQ(blue(scene.triangles[0].material, kEntering | kHidden), 0);
}

}  // namespace
}  // namespace whit::reference
