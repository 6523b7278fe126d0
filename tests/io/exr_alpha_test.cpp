// Images of OpenEXR with alpha, whose colors are premultiplied by it.
#include <bit>

#include "gltf_pictures.h"

namespace whit {
namespace {

// Half covered by the color (1, 0.5, 0.2).
const Rgb kPremultiplied{0.5f, 0.25f, 0.1f};
constexpr float kAlpha = 0.5f;

class ExrAlpha : public GltfMaterials {
 protected:
  ExrAlpha() {
    Image image(1, 1);
    image.pixels = {kPremultiplied};
    writeExr(root_ + "half.exr", image, {}, ExrStorage::zip, 1,
             {{"A", false, {std::bit_cast<std::uint32_t>(kAlpha)}}});
  }
};

// Before black a surface shows its color times its coverage, which is what the file holds.
TEST_F(ExrAlpha, CountsOnceInScenes) {
  const Scene scene = bake(loadMembers(
      "'size': [1, 1], 'cameras': {'above': {'eye': [0, 3, 0], 'at': [0, 0, 0], 'up': [0, 0, -1], "
      "'orthographicHeight': 1}}, 'textures': {'half': {'image': 'half.exr'}}, 'materials': "
      "{'lamp': {'diffuse': 0, 'emission': 1, 'emissionMap': 'half', 'coverageMap': 'half'}}, "
      "'scene': [{'shape': 'quad', 'width': 2, 'depth': 2, 'material': 'lamp'}]"));

  for (const bool reference : {false, true}) {
    expectColor(pixelsOf(scene, reference)[0], kPremultiplied);
  }
}

TEST_F(ExrAlpha, CountsOnceInModels) {
  useImages({"half.exr"});
  const std::string pane =
      "{'alphaMode':'BLEND','pbrMetallicRoughness':{'baseColorTexture':{'index':0}},'extensions':{"
      "'KHR_materials_unlit':{}}}";
  expectColor(picture(pane)[0], kPremultiplied);
}

// A sky is light, which premultiplied colors are.
TEST_F(ExrAlpha, DoesNotCountInSkies) {
  options_.sky = "";  // the scene's own
  const SceneDescription scene = loadMembers("'sky': {'image': 'half.exr'}");
  const EnvironmentImage& sky = scene.sky.image;
  EXPECT_EQ(Rgb(sky.r.at(0), sky.g.at(0), sky.b.at(0)), kPremultiplied);
}

}  // namespace
}  // namespace whit
