// A scene edited in place makes the pictures of a scene that was read like that, bit for bit.
#include <gtest/gtest.h>

#include <functional>

#include "bake/edit_scene.h"
#include "core/error.h"
#include "make/studio_sky.h"
#include "shipped_scene.h"
#include "unit/scene_builder.h"

namespace whit::test {
namespace {

using Edit = std::function<void(std::vector<Material>&, std::vector<Light>&)>;

// Renders, edits, and renders again with the same renderer.
void expectAsIfRead(const std::string& name, const Edit& edit) {
  RenderOptions options = smallOptions({53, 37});
  SceneDescription description = described(name);
  Scene edited = load(name);
  edit(description.materials, description.lights);
  const Scene read = repaired(std::move(description));

  Renderer renderer(edited, options);
  const Picture before = render(renderer);

  std::vector<Material> materials = edited.materials;
  std::vector<Light> lights = edited.lights;
  edit(materials, lights);
  editShading(edited, materials, lights);
  renderer.shadingChanged();
  const Picture after = render(renderer);

  EXPECT_NE(firstDifference(before, after), "") << "the edit changes nothing";
  EXPECT_EQ(firstDifference(render(read, options), after), "");
  EXPECT_EQ(edited.effects, read.effects);
  for (const auto i : indices(kEffectCount)) {
    EXPECT_EQ(edited.reasons[i].because, read.reasons[i].because);
  }
}

TEST(EditShading, ColorsAndLights) {
  expectAsIfRead("whitted", [](auto& materials, auto&) {
    for (Material& m : materials) m.diffuse = {0.1f, 0.7f, 0.3f};
  });
  expectAsIfRead("whitted", [](auto&, auto& lights) {
    lights[0].position.x += 1.5f;
    lights[0].intensity *= 0.25f;
  });
}

TEST(EditShading, EffectsComeAndGo) {
  expectAsIfRead("whitted", [](auto& materials, auto&) {
    for (Material& m : materials) m.mirror = m.mirrorGrazing = m.transmission = {0, 0, 0};
  });
  expectAsIfRead("whitted", [](auto& materials, auto&) {  // mirrors stay
    for (Material& m : materials) m.transmission = {0, 0, 0};
  });
  expectAsIfRead("matte", [](auto&, auto& lights) {
    for (Light& light : lights) light.intensity = {0, 0, 0};
  });
  expectAsIfRead("matte", [](auto& materials, auto&) {
    for (Material& m : materials) {
      m.mirror = m.mirrorGrazing = {0.5f, 0.5f, 0.4f};
      m.specular = {0.2f, 0.2f, 0.2f};
      m.emission = {0.01f, 0, 0};
    }
  });
}

TEST(EditShading, Dielectrics) {
  expectAsIfRead("whitted", [](auto& materials, auto&) {
    for (Material& m : materials) {
      if (!m.hasTransmission()) continue;
      m.ior += 0.2f;
      m.absorption = {0.5f, 0.1f, 0};
    }
  });
}

TEST(EditShading, MapsAndShadowsStay) {
  Scene scene = load("whitted");
  const Material first = scene.materials[0];
  std::vector<Material> materials = scene.materials;
  materials[0].castsShadow = !first.castsShadow;
  materials[0].diffuseMap = 77;
  materials[0].alphaCutoff = 0.9f;

  editShading(scene, materials, scene.lights);
  EXPECT_EQ(scene.materials[0].castsShadow, first.castsShadow);
  EXPECT_EQ(scene.materials[0].diffuseMap, first.diffuseMap);
  EXPECT_EQ(scene.materials[0].alphaCutoff, first.alphaCutoff);
}

// The same renderer shows the new sky as if the scene had been read like that, and then the first
// sky again.
TEST(EditShading, SkiesAreExchanged) {
  const RenderOptions options = smallOptions();
  for (const Sky& other : {studioSky(), Sky()}) {
    SceneDescription description = described("whitted");
    description.sky = other;
    description.ambient = ambientFromSky(other, 0.5);
    const Scene read = repaired(std::move(description));

    Scene edited = load("whitted");
    Renderer renderer(edited, options);
    const Picture before = render(renderer);

    const Ambient ambient = edited.ambient;
    Sky sky = other;
    editSky(edited, sky, ambientFromSky(other, 0.5));
    renderer.shadingChanged();
    EXPECT_EQ(firstDifference(render(read, options), render(renderer)), "");
    EXPECT_EQ(edited.effects, read.effects);

    editSky(edited, sky, ambient);
    renderer.shadingChanged();
    EXPECT_EQ(firstDifference(before, render(renderer)), "");
  }
}

TEST(EditShading, SkiesThatCannotBeAreRefused) {
  Scene scene = load("whitted");
  const Rgb zenith = scene.sky.zenith;
  Sky sky = studioSky();
  sky.scale = std::nanf("");
  EXPECT_THROW(editSky(scene, sky, Ambient()), Error);
  EXPECT_EQ(scene.sky.zenith, zenith);
  EXPECT_EQ(sky.name, kStudio);
}

TEST(EditShading, WhatCannotBeIsRefused) {
  Scene scene = load("whitted");
  const auto expectRefused = [&](ExitStatus status, const Edit& edit) {
    std::vector<Material> materials = scene.materials;
    std::vector<Light> lights = scene.lights;
    edit(materials, lights);
    expectError(status, {}, [&] { editShading(scene, materials, lights); });
  };

  const Vec3f position = scene.lights[0].position;
  expectRefused(ExitStatus::badScene,
                [](auto&, auto& lights) { lights[0].position.y = std::nanf(""); });
  EXPECT_EQ(scene.lights[0].position, position);
  expectRefused(ExitStatus::usage, [](auto& materials, auto&) { materials.pop_back(); });
  expectRefused(ExitStatus::badScene, [](auto& materials, auto&) { materials[0].roughness = 2; });
}

}  // namespace
}  // namespace whit::test
