// Which effects a scene calls for, and why.
#include <gtest/gtest.h>

#include <functional>

#include "unit/scene_builder.h"

namespace whit {
namespace {

using namespace test;

const EffectReason& reason(const Scene& scene, Effect e) { return entryOf(scene.reasons, e); }

std::int32_t addTexture(SceneDescription& d, TexelFormat format) {
  d.textures.push_back(whiteTexture(format));
  return static_cast<std::int32_t>(d.textures.size() - 1);
}

Light& addLight(SceneDescription& d, const Rgb& intensity = {1, 1, 1}) {
  return d.lights.emplace_back(Light{"lamp", {0, 0, 1}, intensity});
}

// A square that reflects lights alone.
SceneDescription plainScene() {
  SceneDescription d = sceneOf(square());
  d.materials[0].diffuseReflection = false;
  return d;
}

void useSky(SceneDescription& d, Sky::Kind kind) {
  d.sky.kind = kind;
  d.sky.zenith = {0, 0, 1};
  d.sky.image = {2, 1, {0, 0}, {0, 0}, {0, 1}};
}

struct Rule {
  Effect effect;
  std::function<void(SceneDescription&, Material&)> add;
  std::string because;
  std::vector<Effect> also = {};  // what comes with it
};

const std::vector<Rule> kRules{
    {Effect::textures, [](auto& d, auto& m) { m.diffuseMap = addTexture(d, TexelFormat::color); },
     "1 material with a color texture, 2 triangles use it"},
    {Effect::normalMaps, [](auto& d, auto& m) { m.normalMap = addTexture(d, TexelFormat::data); },
     "1 material with a normal map, 2 triangles use it"},
    {Effect::alphaMasks, [](auto& d, auto& m) { m.alphaMap = addTexture(d, TexelFormat::data); },
     "1 material with an alpha mask, 2 triangles use it"},
    {Effect::coverage,
     [](auto&, auto& m) { m.coverage = 0.5f; },
     "1 material whose coverage is not 1, 2 triangles use it",
     {Effect::transmission}},
    {Effect::smoothNormals,
     [](auto& d, auto&) {
       d.objects[0].meshes[0].normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 1e-3f, 1}};
     },
     "some vertex normals differ from their triangle's"},
    {Effect::glossy,
     [](auto&, auto& m) {
       m.specular = Rgb(0.04f);
       m.glossyReflection = false;
     },
     "1 material with a glossy lobe, 2 triangles use it"},
    {Effect::glossyReflection,
     [](auto&, auto& m) { m.specular = Rgb(0.04f); },
     "1 material whose glossy lobe reflects the scene, 2 triangles use it",
     {Effect::glossy}},
    {Effect::blurredSky,
     [](auto& d, auto& m) {
       m.specular = Rgb(0.04f);
       useSky(d, Sky::Kind::color);
     },
     "a glossy lobe reflects the sky",
     {Effect::glossy, Effect::glossyReflection, Effect::sky}},
    {Effect::indirect, [](auto&, auto& m) { m.diffuseReflection = true; },
     "1 material whose diffuse color reflects the scene, 2 triangles use it"},
    {Effect::emission,
     [](auto&, auto& m) {
       m.emission = {0, 0, 1};
     },
     "1 material with emission, 2 triangles use it"},
    {Effect::emissionMaps,
     [](auto& d, auto& m) {
       m.emission = {0, 0, 1};
       m.emissionMap = addTexture(d, TexelFormat::color);
     },
     "1 material with a texture of emission, 2 triangles use it",
     {Effect::emission, Effect::textures}},
    {Effect::vertexColors,
     [](auto& d, auto&) {
       d.objects[0].meshes[0].colors = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 0.5f, 1}};
     },
     "some vertices are not white"},
    {Effect::spheres,
     [](auto& d, auto&) {
       d.objects[0].meshes[0].spheres = {Affine(), Affine::translation({3, 0, 0})};
     },
     "2 spheres"},
    {Effect::sky, [](auto& d, auto&) { useSky(d, Sky::Kind::color); }, "the sky is not black"},
    {Effect::skyImage,
     [](auto& d, auto&) { useSky(d, Sky::Kind::image); },
     "the sky is an image",
     {Effect::sky}},
    {Effect::ambient,
     [](auto& d, auto&) {
       d.ambient.down = {0, 1, 0};
     },
     "the ambient light is not black"},
    {Effect::ambientOcclusion,
     [](auto& d, auto&) {
       d.ambient.up = {0, 1, 0};
       d.ambient.occlusion = 1;
     },
     "the ambient light has a radius of occlusion",
     {Effect::ambient}},
    {Effect::lights,
     [](auto& d, auto& m) {
       addLight(d);
       addLight(d);
       addLight(d, {});
       m.castsShadow = false;
     },
     "2 lights"},
    {Effect::spotLights,
     [](auto& d, auto& m) {
       addLight(d).kind = Light::Kind::spot;
       m.castsShadow = false;
     },
     "1 spot light",
     {Effect::lights}},
    {Effect::directionalLights,
     [](auto& d, auto& m) {
       addLight(d).kind = Light::Kind::directional;
       m.castsShadow = false;
     },
     "1 directional light",
     {Effect::lights}},
    {Effect::shadows,
     [](auto& d, auto&) { addLight(d).radius = kPointRadius; },
     "1 light, 2 triangles cast shadows",
     {Effect::lights}},
    {Effect::softShadows,
     [](auto& d, auto&) { addLight(d); },
     "1 light with a radius",
     {Effect::lights, Effect::shadows}},
    {Effect::mirror, [](auto&, auto& m) { m.mirrorGrazing = Rgb(1.0f); },
     "1 material with a mirror, a smooth lobe or a reflecting dielectric, 2 triangles use it"},
    {Effect::transmission,
     [](auto&, auto& m) {
       m.transmission = Rgb(1.0f);
       m.ior = 1;
     },
     "1 material that light passes, 2 triangles use it"},
    {Effect::absorption,
     [](auto&, auto& m) {
       m.transmission = Rgb(1.0f);
       m.absorption = {0, 1, 0};
     },
     "1 material with absorption, 2 triangles use it",
     {Effect::transmission, Effect::mirror}},
    {Effect::instances,
     [](auto& d, auto&) {
       d.instances.push_back({0, Affine::translation({3, 0, 0})});
     },
     "2 instances of 1 object"},
    {Effect::depthOfField,
     [](auto& d, auto&) {
       d.cameras.resize(3);
       d.cameras[1].aperture = 0.5f;
     },
     "1 camera with an aperture"},
    {Effect::fog,
     [](auto& d, auto&) {
       d.fog.density = {0, 0.1f, 0};
     },
     "the fog has a density"},
};

TEST(SceneEffects, APlainSceneCallsForNothingAndSaysWhy) {
  const Scene scene = finalized(plainScene());
  EXPECT_EQ(scene.effects, EffectSet());
  for (const EffectReason& r : scene.reasons) {
    EXPECT_FALSE(r.on);
    EXPECT_FALSE(r.because.empty());
  }
  EXPECT_EQ(reason(scene, Effect::transmission).because,
            "no mesh uses a material that light passes");
  EXPECT_EQ(reason(scene, Effect::shadows).because, "the scene has no light");
  EXPECT_EQ(reason(scene, Effect::skyImage).because, "the sky is black");
  EXPECT_EQ(reason(scene, Effect::depthOfField).because, "no camera has an aperture");
}

TEST(SceneEffects, EachIsTurnedOnByWhatCallsForItAndNothingElse) {
  EXPECT_EQ(kRules.size(), static_cast<std::size_t>(kEffectCount));
  for (const Rule& rule : kRules) {
    SCOPED_TRACE(nameOf(rule.effect));
    SceneDescription d = plainScene();
    rule.add(d, d.materials[0]);
    const Scene scene = finalized(d);
    EffectSet expected = EffectSet().with(rule.effect);
    for (const Effect effect : rule.also) expected = expected.with(effect);
    EXPECT_EQ(scene.effects.bits(), expected.bits());
    EXPECT_TRUE(reason(scene, rule.effect).on);
    EXPECT_EQ(reason(scene, rule.effect).because, rule.because);
  }
}

// What a scene has but does not show calls for nothing.
TEST(SceneEffects, MapsOfRoughnessAreTexturesWhereThereIsALobe) {
  for (const float specular : {0.0f, 0.04f}) {
    SceneDescription d = plainScene();
    d.materials[0].specular = Rgb(specular);
    d.materials[0].roughnessMap = addTexture(d, TexelFormat::data);
    EXPECT_EQ(finalized(d).effects.has(Effect::textures), specular > 0);
  }
}

TEST(SceneEffects, ACameraPathMayHaveAnAperture) {
  SceneDescription d = plainScene();
  d.cameraPath.resize(1);
  d.cameraPath[0].camera.aperture = 0.5f;
  const Scene scene = finalized(d);
  // The scene has no camera but the first one of the path.
  EXPECT_EQ(reason(scene, Effect::depthOfField).because, "the camera path has an aperture");
  EXPECT_EQ(scene.effects, EffectSet().with(Effect::depthOfField));
}

TEST(SceneEffects, UnusedMaterialsDoNotCount) {
  SceneDescription d = plainScene();
  d.ambient.occlusion = 1;  // of what is black

  for (int i = 1; i <= 2; ++i) d.materials.emplace_back().mirror = Rgb(1.0f);
  d.materials.emplace_back().transmission = Rgb(1.0f);
  d.objects.push_back({"never placed", {square()}});
  d.objects[1].meshes[0].materials = {1};

  // Material 2 only colors a triangle that is dropped.
  Mesh& mesh = d.objects[0].meshes[0];
  mesh.triangles.push_back({0, 0, 1});
  mesh.materials = {0, 0, 2};

  const Scene scene = finalized(d);
  EXPECT_EQ(scene.effects, EffectSet());
  EXPECT_EQ(scene.media.size(), 1u);
}

TEST(SceneEffects, CountsMaterialsAndTriangles) {
  SceneDescription d = plainScene();
  d.materials.resize(3);
  d.materials[1].mirror = d.materials[2].mirror = Rgb(0.5f);
  d.objects[0].meshes[0].materials = {1, 2};
  EXPECT_EQ(
      reason(finalized(d), Effect::mirror).because,
      "2 materials with a mirror, a smooth lobe or a reflecting dielectric, 2 triangles use them");
}

TEST(SceneEffects, WhatIsMultipliedByNothingDoesNotCount) {
  SceneDescription d = plainScene();
  d.materials[0].diffuse = {};
  d.materials[0].diffuseMap = d.materials[0].specularMap = addTexture(d, TexelFormat::color);
  d.materials[0].alphaMap = addTexture(d, TexelFormat::data);
  d.materials[0].alphaCutoff = 0;
  d.materials[0].absorption = Rgb(1.0f);  // of what nothing enters
  useSky(d, Sky::Kind::image);
  d.sky.scale = 0;
  addLight(d, {});
  EXPECT_EQ(finalized(d).effects, EffectSet());

  d.sky.scale = 1;
  d.sky.image.b = {0, 0};
  const Scene scene = finalized(d);
  EXPECT_EQ(scene.effects, EffectSet());
  EXPECT_EQ(reason(scene, Effect::lights).because, "every light is black");
}

TEST(SceneEffects, DielectricsReflectUnlessAllIndicesAreOne) {
  SceneDescription d = plainScene();
  d.materials.resize(2);
  for (Material& m : d.materials) m.transmission = Rgb(1.0f), m.ior = 1;
  d.materials[1].absorption = Rgb(1.0f);
  d.objects[0].meshes[0].materials = {0, 1};
  EXPECT_FALSE(finalized(d).effects.has(Effect::mirror));
  d.materials[1].ior = 1.0001f;
  EXPECT_TRUE(finalized(d).effects.has(Effect::mirror));
}

}  // namespace
}  // namespace whit
