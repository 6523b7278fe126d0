// Values of glTF files that are repaired and counted, and files that show nothing.
#include "gltf_files.h"
#include "scene/description.h"

namespace whit {
namespace {

using GltfMended = GltfTest;

TEST_F(GltfMended, ValuesOutOfRangeAreMended) {
  const SceneDescription scene = loadText(
      "{\"asset\":{\"version\":\"2.0\"},\"materials\":["
      "{\"emissiveFactor\":[1,1,1],\"extensions\":{\"KHR_materials_emissive_strength\":"
      "{\"emissiveStrength\":-2}}},{\"emissiveFactor\":[-1,0,0]},"
      "{\"extensions\":{\"KHR_materials_volume\":{\"attenuationDistance\":-3}}},"
      "{\"alphaMode\":\"blend\"}]}");

  EXPECT_EQ(warned("unknown alpha mode taken as OPAQUE"), 1u);
  for (const Material& material : scene.materials) {
    EXPECT_EQ(material.emission, Rgb(0.0f));
    EXPECT_EQ(material.absorption, Rgb(0.0f));
  }
}

TEST_F(GltfMended, NothingToDrawIsSaidWithItsReason) {
  loadText("{\"asset\":{\"version\":\"2.0\"}}");
  EXPECT_EQ(warned("model with nothing to draw: no meshes"), 1u);

  GltfBuilder b;
  const std::string mesh = triangle(b), points = triangle(b, ",\"mode\":0");
  loadText(replaced(b.json(oneMesh(mesh)), "{\"mesh\":0}", "{}"));
  EXPECT_EQ(warned("model with nothing to draw: no node shows a mesh"), 1u);
  loadShown(b, points);
  EXPECT_EQ(warned("model with nothing to draw: its meshes have no triangles"), 1u);
}

TEST_F(GltfMended, CamerasOfOneNameCanBeToldApart) {
  const SceneDescription scene = loadText(
      "{\"asset\":{\"version\":\"2.0\"},\"cameras\":[{\"type\":\"perspective\",\"perspective\":"
      "{\"yfov\":1,\"znear\":1}}],\"nodes\":[{\"camera\":0,\"name\":\"eye\"},{\"camera\":0},"
      "{\"camera\":0,\"name\":\"eye\"},{\"camera\":0}]}");

  std::vector<std::string> names;
  for (const Camera& camera : scene.cameras) names.push_back(camera.name);
  EXPECT_EQ(names, (std::vector<std::string>{"eye", "camera", "eye#2", "camera#2"}));
}

}  // namespace
}  // namespace whit
