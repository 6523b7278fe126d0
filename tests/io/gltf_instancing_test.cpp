// EXT_mesh_gpu_instancing: copies of a mesh by attributes of its node.
#include <cmath>

#include "gltf_files.h"
#include "scene/description.h"

namespace whit {
namespace {

class GltfInstancing : public GltfTest {
 protected:
  // Returns a file whose node is moved by (0, 0, 5) and shows a triangle as copies with these
  // attributes.
  static std::string textOf(GltfBuilder& b, const std::string& attributes) {
    return b.json(
        "\"extensionsRequired\":[\"EXT_mesh_gpu_instancing\"],\"meshes\":[{"
        "\"primitives\":[" +
        triangle(b) +
        "]}],\"nodes\":[{\"mesh\":0,"
        "\"translation\":[0,0,5],\"extensions\":{\"EXT_mesh_gpu_instancing\":{"
        "\"attributes\":{" +
        attributes + "}}}}]");
  }
};

TEST_F(GltfInstancing, CopiesStandWhereTheAttributesSay) {
  GltfBuilder b;
  const std::string translation = b.positions({1, 2, 3, -1, 0, 0});
  const float half = std::sqrt(0.5f);  // a quarter turn about z
  const std::string rotation =
      b.accessor(b.view(bytesOf<float>({0, 0, half, half, 0, 0, 0, 1})), 5126, "VEC4", 2);
  const std::string scale = b.positions({2, 2, 2, 1, 1, 1});

  const SceneDescription scene = loadText(textOf(
      b, "\"TRANSLATION\":" + translation + ",\"ROTATION\":" + rotation + ",\"SCALE\":" + scale));

  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.objects.size(), 1u);

  // Scale, rotation, translation of the copy and translation of the node apply in this order.
  expectNear(cornerOf(scene, 0, 0, 0), {1, 2, 8});
  expectNear(cornerOf(scene, 0, 0, 1), {1, 4, 8});
  expectNear(cornerOf(scene, 1, 0, 1), {0, 0, 5});
  EXPECT_EQ(kinds(), "");
}

TEST_F(GltfInstancing, AttributesMustFitTogether) {
  GltfBuilder b;
  const std::string two = b.positions({1, 2, 3, -1, 0, 0});
  const std::string one = b.positions({1, 1, 1});
  EXPECT_EQ(errorOfText(textOf(b, "\"TRANSLATION\":" + two + ",\"SCALE\":" + one)),
            "3 m.gltf#/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes: expected attributes "
            "of equal lengths, found 1 beside 2");

  // A scale of 0 makes a copy flat.
  GltfBuilder flat;
  const std::string zero = flat.positions({1, 0, 1, 1, 1, 1});
  EXPECT_EQ(triangleCount(loadText(textOf(flat, "\"SCALE\":" + zero))), 1u);
  EXPECT_EQ(warned("copy of a mesh that is flattened left out"), 1u);
}

}  // namespace
}  // namespace whit
