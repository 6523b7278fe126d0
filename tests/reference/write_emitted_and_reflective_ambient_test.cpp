// Emission, ambient light and the sky.
#include "reference/write_emitted_and_reflective_ambient.h"

#include <gtest/gtest.h>

#include <cmath>

#include "reference/small_scenes.h"

namespace whit::reference {
namespace {

using namespace test;

// Returns a scene of one material, without geometry.
Scene lit(const Ambient& ambient) {
  Scene scene;
  scene.materials.resize(1);
  scene.ambient = ambient;
  return scene;
}

TEST(Ambient, FollowsTheNormal) {
  const Scene scene = lit({Rgb(3.0f), Rgb(1.0f)});
  Surfel s;
  s.diffuse = {1, 0.5, 0};

  for (const auto& [normal, ambient] :
       {std::pair{Vec3d(0, 1, 0), 3.0}, {Vec3d(0, -1, 0), 1.0}, {Vec3d(1, 0, 0), 2.0}}) {
    s.shadingNormal = normal;
    EXPECT_EQ(emittedAndAmbient(scene, allBut(Effect::indirect), s), s.diffuse * ambient);
  }
  EXPECT_EQ(emittedAndAmbient(scene, allBut(Effect::ambient), s), RgbD());
}

TEST(Emission, AddsToTheRest) {
  Scene scene = lit({Rgb(1.0f), Rgb(1.0f)});
  scene.materials[0].emission = {1, 2, 3};
  Surfel s;
  s.diffuse = RgbD(0.5);
  EXPECT_EQ(emittedAndAmbient(scene, allBut(Effect::indirect), s), RgbD(1.5, 2.5, 3.5));
  s.diffuse = {};
  EXPECT_EQ(emittedAndAmbient(scene, allBut(Effect::emission), s), RgbD());
}

TEST(Sky, NeedsItsEffects) {
  SceneBuilder color, image;
  color.sky(2);
  image.description.sky.kind = Sky::Kind::image;
  image.description.sky.image = {1, 1, {1}, {2}, {3}};
  const Scene plain = color.build(), pictured = image.build();

  const Vec3d up{0, 1, 0};
  EXPECT_EQ(skyAlong(plain, allBut(Effect::skyImage), up), RgbD(2.0));
  EXPECT_EQ(skyAlong(plain, allBut(Effect::sky), up), RgbD());
  EXPECT_EQ(skyAlong(pictured, EffectSet::all(), up), RgbD(1, 2, 3));
  EXPECT_EQ(skyAlong(pictured, allBut(Effect::skyImage), up), RgbD());
}

// White light from all sides: a lobe takes from the diffuse color what it reflects, so that no
// surface is brighter than the light. That metals reflect their lobe's albedo is tested by
// Layers.BlurredSkyHasTheAlbedoOfTheLobe.
TEST(BlurredSky, IsReflectedByRoughSurfaces) {
  Scene scene = lit({Rgb(1.0f), Rgb(1.0f)});
  scene.materials[0].specular = Rgb(1.0f);
  scene.sky.kind = Sky::Kind::color;
  scene.sky.zenith = Rgb(1.0f);
  scene.blurredSky = blurredSky(scene.sky);
  const EffectSet effects = allBut(Effect::indirect).without(Effect::glossyReflection);

  Surfel s;
  s.shadingNormal = {0, 1, 0};
  s.view = normalized(Vec3d(1, 1, 0));
  s.alpha = 0.25;
  s.specular = {1, 0.5, 0.04};
  const RgbD albedo = lobeAlbedo(s.specular, 1, std::sqrt(0.5), 0.5);

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

}  // namespace
}  // namespace whit::reference
