// What a model gets that comes without a scene file, and the sky that is asked for.
#include "io/load_scene.h"

#include <gtest/gtest.h>

#include "make/studio_sky.h"
#include "scene_files.h"

namespace whit {
namespace {

// Radiance files of one row: 1 everywhere, and 4.
const std::string kHdrHead = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
const std::string kOne = kHdrHead + std::string("\x80\x80\x80\x81\x80\x80\x80\x81", 8);
const std::string kFour = kHdrHead + std::string("\x80\x80\x80\x83\x80\x80\x80\x83", 8);

class SuppliedView : public SceneFileTest {
 protected:
  // A triangle with a light of its own above it.
  SceneDescription loadLit(double intensity) {
    const std::string json =
        R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_lights_punctual"],"scene":0,
        "scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0},{"translation":[0.3,0.3,2],
        "extensions":{"KHR_lights_punctual":{"light":0}}}],
        "extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":)" +
        std::to_string(intensity) +
        R"(}]}},"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
        R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
        "bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,
        "componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}]})";
    return load(save("lit.gltf", json));
  }
};

TEST_F(SuppliedView, AModelStandsInAStudio) {
  const SceneDescription scene = loadObj(kTriangleObj);
  EXPECT_TRUE(scene.isModel);
  EXPECT_EQ(skyName(scene.sky), "studio");
  EXPECT_EQ(scene.sky.scale, 1);
  const Ambient expected = ambientFromSky(studioSky(), kAmbientOfSky);
  EXPECT_EQ(scene.ambient.up, expected.up);
  EXPECT_EQ(scene.ambient.down, expected.down);
  EXPECT_EQ(scene.cameras.size(), 1u);
}

TEST_F(SuppliedView, TheStudioIsAsBrightAsItsLights) {
  const SceneDescription dim = loadLit(0.01), bright = loadLit(1000);
  EXPECT_EQ(dim.lights.size(), 1u);
  EXPECT_EQ(skyName(dim.sky), "studio");
  EXPECT_NEAR(bright.sky.scale / dim.sky.scale, 1e5f, 10);
  EXPECT_NEAR(bright.ambient.up.x / dim.ambient.up.x, 1e5f, 10);
}

TEST_F(SuppliedView, AnotherSkyOrNone) {
  options_.sky = "none";
  EXPECT_EQ(skyName(loadObj(kTriangleObj).sky), "none");
  EXPECT_EQ(loadObj(kTriangleObj).ambient.up, Rgb(0.25f));
  EXPECT_EQ(loadLit(5).ambient.up, Rgb(0.0f));
  options_.sky = save("one.hdr", kOne);
  const SceneDescription scene = loadObj(kTriangleObj);
  EXPECT_EQ(skyName(scene.sky), options_.sky);
  ASSERT_EQ(scene.sky.image.r.size(), 2u);
  EXPECT_EQ(scene.sky.image.r[0], 1);
  EXPECT_NEAR(scene.ambient.up.x, kAmbientOfSky, 1e-6);
}

TEST_F(SuppliedView, WhatIsSetStays) {
  options_.settings = {"/sky/color=0.5", "/ambient/color=0.125"};
  const SceneDescription scene = loadObj(kTriangleObj);
  EXPECT_EQ(skyName(scene.sky), "color");
  EXPECT_EQ(scene.ambient.down, Rgb(0.125f));
  options_.settings = {"/sky/color=0.5"};
  EXPECT_NEAR(loadObj(kTriangleObj).ambient.up.x, 0.5 * kAmbientOfSky, 1e-6);
}

TEST_F(SuppliedView, ASceneFileKeepsItsSkyUnlessAnotherIsAskedFor) {
  save("four.hdr", kFour);
  const std::string members = R"("sky": {"image": "four.hdr"}, "ambient": {"fromSky": 0.5},
      "scene": [{"shape": "quad"}])";
  const SceneDescription own = loadMembers(members);
  EXPECT_FALSE(own.isModel);
  EXPECT_EQ(skyName(own.sky), "four.hdr");
  EXPECT_NEAR(own.ambient.up.x, 2, 1e-5);
  EXPECT_EQ(skyName(loadMembers(R"("scene": [{"shape": "quad"}])").sky), "none");
  options_.sky = save("one.hdr", kOne);
  EXPECT_NEAR(loadMembers(members).ambient.up.x, 0.5, 1e-5);
  std::filesystem::remove(root_ + "four.hdr");
  EXPECT_EQ(loadMembers(members).sky.image.r.at(0), 1) << "its own is not read";
  options_.sky = "studio";
  EXPECT_EQ(loadMembers(members).sky.image.r, studioSky().image.r);
  options_.sky = "none";
  EXPECT_EQ(loadMembers(members).sky.kind, Sky::Kind::none);
  EXPECT_EQ(loadMembers(members).ambient.up, Rgb(0.0f));
}

TEST_F(SuppliedView, ASkyThatIsNotThere) {
  options_.sky = root_ + "no.hdr";
  EXPECT_EQ(errorOf([&] { loadObj(kTriangleObj); }).substr(0, 2), "4 ");
  options_.sky = save("text.hdr", "not an image");
  EXPECT_EQ(errorOf([&] { loadObj(kTriangleObj); }).substr(0, 2), "3 ");
}

}  // namespace
}  // namespace whit
