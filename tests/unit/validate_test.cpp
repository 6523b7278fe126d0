// What finalize() refuses, and what it repairs.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "unit/scene_builder.h"

namespace whit {
namespace {

using test::expectError;
using test::finalized;
using test::sceneOf;
using test::square;

constexpr float kInf = std::numeric_limits<float>::infinity();

struct Refusal {
  const char* name;
  std::function<void(SceneDescription&)> spoil;
  std::vector<std::string> parts;
};

void addLight(SceneDescription& d, const Light& light) { d.lights.push_back(light); }

const std::vector<Refusal>& refusals() {
  static const std::vector<Refusal> all{
      {"size", [](auto& d) { d.width = 0; }, {"test: image size", "65536"}},
      {"light position",
       [](auto& d) {
         addLight(d, {"key", {0, std::nanf(""), 0}});
       },
       {"test: light 'key'", "finite position"}},
      {"unnamed light",
       [](auto& d) {
         addLight(d, {"", {0, kInf, 0}});
       },
       {"light 0", "finite position"}},
      {"light intensity",
       [](auto& d) {
         addLight(d, {"key", {}, {1, -1, 1}});
       },
       {"light 'key'", "intensity"}},
      {"light radius",
       [](auto& d) {
         addLight(d, {"key", {}, {1, 1, 1}, 0});
       },
       {"radius"}},
      {"light radius too small to square",
       [](auto& d) {
         addLight(d, {"key", {}, {1, 1, 1}, 1e-20f});
       },
       {"radius"}},
      {"spot light to nowhere",
       [](auto& d) {
         addLight(d, {"key", {}, {1, 1, 1}, 1, Light::Kind::spot, {0, 0, 0}});
       },
       {"light 'key'", "direction"}},
      {"directional light from everywhere",
       [](auto& d) {
         addLight(d, {"key", {}, {1, 1, 1}, 1, Light::Kind::directional, {0, kInf, 0}});
       },
       {"light 'key'", "direction"}},
      {"cone inside out",
       [](auto& d) {
         addLight(d, {"key", {}, {1, 1, 1}, 1, Light::Kind::spot, {0, 1, 0}, 45, 30});
       },
       {"light 'key'", "inner < outer"}},
      {"cone beyond a right angle",
       [](auto& d) {
         addLight(d, {"key", {}, {1, 1, 1}, 1, Light::Kind::spot, {0, 1, 0}, 45, 91});
       },
       {"light 'key'", "from 0.5 to 90"}},
      {"camera",
       [](auto& d) {
         d.cameras.resize(2);
         d.cameras[1].name = "top";
         d.cameras[1].at.y = kInf;
       },
       {"camera 'top'", "finite"}},
      {"keyframes out of order",
       [](auto& d) {
         d.cameraPath = {{2, {}}, {2, {}}};
       },
       {"keyframe 1", "after"}},
      {"material map out of range",
       [](auto& d) { d.materials[0].diffuseMap = 0; },
       {"material 'gray'", "diffuseMap is texture 0"}},
      {"negative map",
       [](auto& d) { d.materials[0].alphaMap = -7; },
       {"material 'gray'", "alphaMap is texture -7"}},
      {"color map of data",
       [](auto& d) {
         d.textures.push_back(test::whiteTexture(TexelFormat::data));
         d.materials[0].specularMap = 0;
       },
       {"specularMap", "color"}},
      {"texture without texels",
       [](auto& d) {
         d.textures.push_back(test::whiteTexture(TexelFormat::data));
         d.textures[0].width = 1 << 30;
         d.textures[0].height = 1 << 30;
       },
       {"texture 'white'", "width * height"}},
      {"ior of a dielectric",
       [](auto& d) {
         d.materials[0].transmission = Rgb(1.0f);
         d.materials[0].ior = 0;
       },
       {"material 'gray'", "ior"}},
      {"sky", [](auto& d) { d.sky.zenith.x = kInf; }, {"test: sky", "finite"}},
      {"sky image",
       [](auto& d) {
         d.sky.kind = Sky::Kind::image;
         d.sky.image.width = d.sky.image.height = 2;
         d.sky.image.r.resize(4);
       },
       {"sky image", "three planes"}},
      {"ambient", [](auto& d) { d.ambient.up.x = -1; }, {"ambient"}},
      {"too few normals",
       [](auto& d) { d.objects[0].meshes[0].normals.resize(3); },
       {"mesh 'square'", "expected 4 normals, found 3"}},
      {"too few places in an order",
       [](auto& d) { d.objects[0].meshes[0].order = {0}; },
       {"mesh 'square'", "expected 2 places, found 1"}},
      {"too many uvs",
       [](auto& d) { d.objects[0].meshes[0].uvs.resize(5); },
       {"expected 4 uvs, found 5"}},
      {"no material",
       [](auto& d) { d.objects[0].meshes[0].materials.clear(); },
       {"expected 2 materials, found 0"}},
      {"spheres without a material",
       [](auto& d) {
         Mesh& mesh = d.objects[0].meshes[0];
         mesh = {};
         mesh.name = "balls";
         mesh.spheres = {Affine()};
       },
       {"mesh 'balls'", "expected 1 materials, found 0"}},
      {"unknown material",
       [](auto& d) {
         d.objects[0].meshes[0].materials = {0, 1};
       },
       {"mesh 'square'", "material 1, expected below 1"}},
      {"unknown object",
       [](auto& d) {
         d.instances.push_back({1, {}});
       },
       {"instance 1", "object 1, expected below 1"}},
      {"singular transform",
       [](auto& d) {
         d.instances[0].toWorld = Affine::scaling({1, 0, 1});
       },
       {"instance 'object'", "flattens"}},
      {"nearly singular transform",
       [](auto& d) {
         d.instances[0].toWorld.x = {1, 1, 0};
         d.instances[0].toWorld.y = {1, 1 + 1e-15, 0};
         d.instances[0].toWorld.z = {0, 0, 1};
       },
       {"flattens"}},
      {"infinite transform",
       [](auto& d) { d.instances[0].toWorld.p.x = kInf; },
       {"instance 'object'", "finite"}},
      {"enormous transform",
       [](auto& d) { d.instances[0].toWorld = Affine::scaling(Vec3d(1e19)); },
       {"1.844e18"}},
  };
  return all;
}

TEST(Validate, RefusesNamingTheThingAtFault) {
  EXPECT_NO_THROW(finalized(sceneOf(square())));
  for (const Refusal& r : refusals()) {
    SCOPED_TRACE(r.name);
    SceneDescription d = sceneOf(square());
    r.spoil(d);
    expectError(ExitStatus::badScene, r.parts, [&] { finalized(std::move(d)); });
  }
}

TEST(Validate, TinyTransformsAreNotSingular) {
  SceneDescription d = sceneOf(square());
  d.instances[0].toWorld = Affine::scaling(Vec3d(1e-12));
  EXPECT_EQ(finalized(std::move(d)).triangles.size(), 2u);
}

TEST(Validate, RepairsMaterialsToTheNearestSensibleValue) {
  SceneDescription d = sceneOf(square());
  d.materials[0].diffuse = {-1, std::nanf(""), 0.5f};
  d.materials[0].roughness = 3;
  Warnings warnings;
  const Scene scene = Scene::finalize(std::move(d), warnings);
  EXPECT_EQ(scene.materials[0].diffuse, (Rgb{0, 0, 0.5f}));
  EXPECT_EQ(scene.materials[0].roughness, 1);
  const auto entries = warnings.entries();
  ASSERT_TRUE(entries.contains("material value out of range repaired"));
  EXPECT_EQ(entries.at("material value out of range repaired").count, 2u);
  EXPECT_EQ(entries.at("material value out of range repaired").first, "test: material 'gray'");
}

// H57: one bad texel must not reach the picture.
TEST(Validate, RepairsSkyTexels) {
  SceneDescription d = sceneOf(square());
  d.sky.kind = Sky::Kind::image;
  d.sky.image = {2, 1, {1, std::nanf("")}, {1, -1}, {kInf, 1}};
  Warnings warnings;
  const Scene scene = Scene::finalize(std::move(d), warnings);
  EXPECT_EQ(scene.sky.image.r, (std::vector<float>{1, 0}));
  EXPECT_EQ(scene.sky.image.g, (std::vector<float>{1, 0}));
  EXPECT_EQ(scene.sky.image.b, (std::vector<float>{0, 1}));
  EXPECT_EQ(warnings.entries().at("negative or non-finite sky texel set to 0").count, 3u);
}

TEST(Validate, StrictRefusesWhatWouldBeMended) {
  SceneDescription d = sceneOf(square());
  d.materials[0].roughness = -1;
  Warnings strict(true);
  expectError(ExitStatus::badScene, {"material 'gray'", "--strict"},
              [&] { Scene::finalize(std::move(d), strict); });
}

}  // namespace
}  // namespace whit
