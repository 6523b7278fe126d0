// Textures of KHR_materials_specular, _transmission and _clearcoat, and of smooth metals.
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

  const float f0 = 0.04f * 0.4f, left = white * (1 - f0 * kRoughestAlbedo);
  expectColor(p[1], Rgb{0.8f, 0.4f, 0.2f} * left + Rgb(f0 * lobe));
}

// A white wall behind the eye.
const Square kWhiteWall{6,
                        "{\"emissiveFactor\":[1,1,1],\"doubleSided\":true,"
                        "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0,0,0,1]}}",
                        20};

// Strength 1 beside 0.4; white beside a blue of 1.
TEST_F(GltfMaterials, MirrorsFollowSpecularTextures) {
  candela_ = 0;
  save("strength.tga", tga(2, 1, {{0, 0, 0, 255}, {0, 0, 0, 102}}));
  save("color.tga", tga(2, 1, {{255, 255, 255}, {0, 0, 255}}));
  useImages({"strength.tga", "color.tga"});

  const auto p =
      picture({{0,
                lobeOnly("\"specularColorFactor\":[5,5,5],\"specularTexture\":{\"index\":0},"
                         "\"specularColorTexture\":{\"index\":1}",
                         ",\"roughnessFactor\":0"),
                1},
               kWhiteWall},
              2);

  // 5 * 0.04, and next to nothing of Schlick's term.
  expectColor(p[0], Rgb(0.2f));
  expectColor(p[1], Rgb{0, 0, 0.2f} * 0.4f);
}

// The picture of a smooth metal, as that of a rough one in its lobe.
TEST_F(GltfMaterials, SmoothMetalsReflectByTexturesAndVertexColors) {
  candela_ = 0;
  save("t.tga", tga(2, 1, {{255, 0, 0}, {0, 255, 0}}));
  useImages({"t.tga"});
  const std::string metal = "{\"pbrMetallicRoughness\":{\"roughnessFactor\":0";

  auto p = picture({{0, metal + ",\"baseColorTexture\":{\"index\":0}}}", 1}, kWhiteWall}, 2);
  expectColor(p[0], {1, 0, 0});
  expectColor(p[1], {0, 1, 0});

  // A clearcoat reflects 0.04 by half, and leaves the rest to the metal.
  p = picture({{0,
                metal + ",\"baseColorTexture\":{\"index\":0}},\"extensions\":{"
                        "\"KHR_materials_clearcoat\":{\"clearcoatFactor\":0.5}}}",
                1},
               kWhiteWall},
              2);
  expectColor(p[0], {1, 0.02f, 0.02f});
  expectColor(p[1], {0.02f, 1, 0.02f});

  colors_ = {1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0};
  p = picture({{0, metal + "}}", 1}, kWhiteWall}, 2);
  expectColor(p[0], {0.75f, 0, 0.25f});
  expectColor(p[1], {0.25f, 0, 0.75f});
}

// A label on glass: what the left half lets pass, and what the right half reflects of the lamp.
TEST_F(GltfMaterials, TransmissionTexelByTexel) {
  candela_ = 0;
  save("clear.tga", tga(2, 1, {{255, 0, 0}, {51, 0, 0}}));
  save("color.tga", tga(2, 1, {{255, 0, 0}, {0, 255, 0}}));
  useImages({"clear.tga", "color.tga"});

  const auto show = [&](const std::string& pbr) {
    const std::string pane =
        "{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":1" + pbr +
        "},\"extensions\":{\"KHR_materials_specular\":{\"specularFactor\":0},"
        "\"KHR_materials_transmission\":{\"transmissionFactor\":0.5,"
        "\"transmissionTexture\":{\"index\":0}}}}";
    SceneDescription d = loadText(sceneText({{0, pane, 1}, {-1, glowing("[1,1,1]"), 4}}));
    d.ambient.up = d.ambient.down = Rgb(0.25f);
    return pictureOf(std::move(d), 2);
  };

  auto p = show("");
  expectColor(p[0], Rgb(0.5f + 0.5f * 0.25f));
  expectColor(p[1], Rgb(0.1f + 0.9f * 0.25f));

  p = show(",\"baseColorTexture\":{\"index\":1}");
  expectColor(p[0], {0.5f + 0.5f * 0.25f, 0, 0});
  expectColor(p[1], {0, 0.1f + 0.9f * 0.25f, 0});

  EXPECT_EQ(warned("transmission by a texture taken by its mean"), 0u);
}

TEST_F(GltfMaterials, ClearcoatsTakeTheMeanOfTheirTextures) {
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
  EXPECT_EQ(kinds(), "");

  expectColor(coat("1", "").mirrorGrazing, Rgb(0.3f), 1e-6);
  coat("0", rough + ",\"clearcoatRoughnessTexture\":{\"index\":1}");
  EXPECT_EQ(warned("clearcoat by a texture taken by its mean"), 1u);
  EXPECT_EQ(warned("roughness of a clearcoat by a texture taken by its mean"), 1u);
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
