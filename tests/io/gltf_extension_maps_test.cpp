// Textures of KHR_materials_specular, _transmission and _clearcoat.
#include "core/display.h"
#include "gltf_pictures.h"

namespace whit {
namespace {

// Black with a lobe of alpha 1, which off the middle is f0 / (4 pi cos).
std::string lobeOnly(const std::string& specular, const std::string& pbr = "") {
  return "{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"baseColorFactor\":[0,0,0,1]" + pbr +
         "},\"extensions\":{\"KHR_materials_specular\":{" + specular + "}}}";
}
float lobeAt(double x, double y) { return static_cast<float>(9 / (4 * (x * x + y * y + 9))); }

// Strength 1 beside 102 / 255 = 0.4; of colors red and a gray of 0.5029.
TEST_F(GltfMaterials, SpecularTexelByTexel) {
  save("strength.tga", tga(2, 1, {{0, 0, 0, 255}, {0, 0, 0, 102}}));
  save("color.tga", tga(2, 1, {{255, 0, 0}, {188, 188, 188}}));
  useImages({"strength.tga", "color.tga"});
  const auto gray = static_cast<float>(srgbToLinear(188 / 255.0));
  const float lobe = lobeAt(0.5, 0.5);
  const auto show = [&](const std::string& specular) {
    return picture({{0, lobeOnly(specular), 1}}, 2);
  };
  const std::string strength = "\"specularFactor\":0.5,\"specularTexture\":{\"index\":0}";
  const std::string color =
      "\"specularColorFactor\":[10,5,10],\"specularColorTexture\":{\"index\":1}";
  auto p = show(strength);
  expectColor(p[0], Rgb(0.04f * 0.5f * lobe));
  expectColor(p[1], Rgb(0.04f * 0.2f * lobe));
  p = show(color);
  expectColor(p[0], Rgb{0.4f, 0, 0} * lobe);
  expectColor(p[1], Rgb{0.4f, 0.2f, 0.4f} * (gray * lobe));
  p = show(strength + "," + color);
  expectColor(p[0], Rgb{0.4f, 0, 0} * (0.5f * lobe));
  expectColor(p[1], Rgb{0.4f, 0.2f, 0.4f} * (gray * 0.2f * lobe));
  // Color is bounded by 1 before the strength counts.
  p = show(strength +
           ",\"specularColorFactor\":[100,100,100],\"specularColorTexture\":"
           "{\"index\":1}");
  expectColor(p[0], Rgb{0.5f, 0, 0} * lobe);
  expectColor(p[1], Rgb(0.2f * lobe));
  EXPECT_EQ(kinds(), "");
}

// A metal has its base color, whatever the specular texture; half a metal half of it.
TEST_F(GltfMaterials, SpecularTexturesOfWhatIsPartlyMetal) {
  save("metal.tga", tga(2, 1, {{0, 255, 255}, {0, 255, 0}}));
  save("strength.tga", tga(1, 1, {{0, 0, 0, 102}}));
  useImages({"metal.tga", "strength.tga"});
  const auto p = picture({{0,
                           "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.8,0.4,0.2,1],"
                           "\"metallicRoughnessTexture\":{\"index\":0}},\"extensions\":"
                           "{\"KHR_materials_specular\":{\"specularTexture\":{\"index\":1}}}}",
                           1}},
                         2);
  const float lobe = lobeAt(0.5, 0.5), white = static_cast<float>(lit(0.5, 0.5));
  expectColor(p[0], Rgb{0.8f, 0.4f, 0.2f} * lobe);
  expectColor(p[1], Rgb{0.8f, 0.4f, 0.2f} * white + Rgb(0.04f * 0.4f * lobe));
}

TEST_F(GltfMaterials, ClearcoatAndTransmissionTakeTheMeanOfTheirTextures) {
  save("even.tga", tga(2, 1, {{102, 51, 0}, {102, 51, 0}}));
  save("uneven.tga", tga(2, 1, {{102, 0, 0}, {204, 102, 0}}));
  useImages({"even.tga", "uneven.tga"});
  const auto materialOf = [&](const std::string& extension) {
    return loadText(sceneText({{0,
                                "{\"pbrMetallicRoughness\":{\"metallicFactor\":0,"
                                "\"roughnessFactor\":1},\"extensions\":{" +
                                    extension + "}}",
                                1}}))
        .materials[0];
  };
  const auto coat = [&](const std::string& index, const std::string& roughness) {
    return materialOf(
        "\"KHR_materials_clearcoat\":{\"clearcoatFactor\":0.5,\"clearcoatTexture\":"
        "{\"index\":" +
        index + "}" + roughness + "}");
  };
  const Material even = coat("0", "");
  expectColor(even.mirror, Rgb(0.04f * 0.2f), 1e-6);
  expectColor(even.mirrorGrazing, Rgb(0.2f), 1e-6);
  // 0.2 is smooth; 1 without the texture is not.
  const std::string rough = ",\"clearcoatRoughnessFactor\":1";
  EXPECT_FALSE(coat("0", rough).hasMirror());
  EXPECT_TRUE(coat("0", rough + ",\"clearcoatRoughnessTexture\":{\"index\":0}").hasMirror());
  const auto clear = [&](const std::string& index) {
    return materialOf(
        "\"KHR_materials_transmission\":{\"transmissionFactor\":0.5,"
        "\"transmissionTexture\":{\"index\":" +
        index + "}}");
  };
  expectColor(clear("0").transmission, Rgb(0.2f), 1e-6);
  EXPECT_EQ(kinds(), "");

  expectColor(coat("1", "").mirrorGrazing, Rgb(0.3f), 1e-6);
  expectColor(clear("1").transmission, Rgb(0.3f), 1e-6);
  coat("0", rough + ",\"clearcoatRoughnessTexture\":{\"index\":1}");
  EXPECT_EQ(warned("clearcoat by a texture taken by its mean"), 1u);
  EXPECT_EQ(warned("roughness of a clearcoat by a texture taken by its mean"), 1u);
  EXPECT_EQ(warned("transmission by a texture taken by its mean"), 1u);
}

TEST_F(GltfMaterials, SpecularTexturesWithOtherCoordinatesAreCounted) {
  save("strength.tga", tga(1, 1, {{0, 0, 0, 102}}));
  useImages({"strength.tga"});
  secondUvs_ = {1, 1, 0, 1, 0, 0, 1, 0};
  loadText(sceneText({{0,
                       lobeOnly("\"specularTexture\":{\"index\":0,\"texCoord\":1}",
                                ",\"baseColorTexture\":{\"index\":0}"),
                       1}}));
  EXPECT_EQ(
      warned("texture looked up with the coordinates of its material's first in place of its own"),
      1u);
}

}  // namespace
}  // namespace whit
