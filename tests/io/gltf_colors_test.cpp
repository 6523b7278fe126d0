// Emission by textures, unlit materials, vertex colors, and what is counted because it is left
// out.
#include "core/display.h"
#include "gltf_pictures.h"

namespace whit {
namespace {

// The emission is the factor times the texture in linear light, where code 188 is 0.5029.
TEST_F(GltfMaterials, EmissionByATexture) {
  candela_ = 0;
  save("t.tga", tga(1, 1, {{255, 188, 0}}));
  useImages({"t.tga"});
  const auto half = static_cast<float>(srgbToLinear(188 / 255.0));
  expectColor(pixel(matte("", "\"emissiveFactor\":[0.5,1,1],\"emissiveTexture\":{\"index\":0}")),
              {0.5f, half, 0});
}

// An unlit material is not lit, and reflects nothing although a metal would.
TEST_F(GltfMaterials, UnlitTexture) {
  save("t.tga", tga(1, 1, {{255, 188, 0}}));
  useImages({"t.tga"});

  const auto half = static_cast<float>(srgbToLinear(188 / 255.0));
  expectColor(pixel("{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,1,1,1],"
                    "\"roughnessFactor\":0,\"baseColorTexture\":{\"index\":0}},"
                    "\"extensions\":{\"KHR_materials_unlit\":{}}}"),
              {0.5f, half, 0});
}

// Colors are interpolated between the corners. The pixel sees the middle of the first triangle's
// edge, where the color is half of each end's.
TEST_F(GltfMaterials, VertexColors) {
  colors_ = {1, 0, 0, 0, 1, 0, 1, 0.5f, 1, 0, 0, 1};
  expectColor(pixel(matte("\"baseColorFactor\":[0.5,0.5,1,1]")), {0.5f, 0.125f, 0.5f});

  candela_ = 0;
  expectColor(pixel("{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.5,1,1]},"
                    "\"extensions\":{\"KHR_materials_unlit\":{}}}"),
              {0.5f, 0.125f, 0.5f});
  expectColor(pixel(glowing("[1,1,1]")), Rgb(1.0f));  // emission has no base color
}

// The pixel of a surface that glows with 1 shows its alpha: the alpha of the corners, interpolated,
// times the factor's.
TEST_F(GltfMaterials, AlphaOfVertexColorsBlends) {
  candela_ = 0;
  alphas_ = {0, 1, 1, 0};
  const std::string blend =
      "\"doubleSided\":true,\"alphaMode\":\"BLEND\",\"emissiveFactor\":[1,1,1]";
  const auto p = picture({{0, matte("\"baseColorFactor\":[0,0,0,0.5]", blend), 1}}, 4);
  const float columns[] = {0.125f, 0.375f, 0.625f, 0.875f};
  for (std::size_t i = 0; i < 4; ++i) expectColor(p[4 + i], Rgb(0.5f * columns[i]));
}

TEST_F(GltfMaterials, AlphaOfVertexColorsCuts) {
  candela_ = 0;
  alphas_ = {0, 1, 1, 0};
  const std::string mask =
      "\"doubleSided\":true,\"alphaMode\":\"MASK\",\"alphaCutoff\":0.75,\"emissiveFactor\":[1,1,1]";
  const auto p = picture({{0, matte("\"baseColorFactor\":[0,0,0,1]", mask), 1}}, 4);
  for (std::size_t i = 0; i < 3; ++i) expectColor(p[4 + i], Rgb(0.0f));
  expectColor(p[7], Rgb(1.0f));
}

TEST_F(GltfMaterials, OpaqueMaterialsIgnoreAlphaOfVertexColors) {
  candela_ = 0;
  alphas_ = {0, 0, 0, 0};
  expectColor(pixel(glowing("[1,1,1]")), Rgb(1.0f));
}

TEST_F(GltfMaterials, WhatCannotBeShownIsCounted) {
  save("t.tga", tga(1, 1, {{255, 255, 255}}));
  useImages({"t.tga", "missing.png"}, "\"magFilter\":9728");
  const std::string slot = "\":{\"index\":0}";

  loadText(sceneText({{0,
                       "{\"extensions\":{\"KHR_materials_clearcoat\":{\"clearcoatNormalTexture" +
                           slot + "},\"KHR_materials_volume\":{\"thicknessTexture" + slot + "}}}",
                       1},
                      {1, matte("\"baseColorTexture\":{\"index\":1}"), 1}}));

  EXPECT_EQ(warned("normal map of a clearcoat left out"), 1u);
  EXPECT_EQ(warned("thickness of a volume by a texture left out: what the mesh encloses counts"),
            1u);
  EXPECT_EQ(warned("texture left out"), 1u);
}

// The roughness of a metal is that of no glass: it transmits nothing.
TEST_F(GltfMaterials, RoughnessFrostsGlass) {
  const auto isFrosted = [&](const std::string& roughness, const std::string& metal) {
    const SceneDescription d =
        loadText(sceneText({{0,
                             "{\"pbrMetallicRoughness\":{\"metallicFactor\":" + metal +
                                 ",\"roughnessFactor\":" + roughness +
                                 "},\"extensions\":{\"KHR_materials_transmission\":"
                                 "{\"transmissionFactor\":1}}}",
                             1}}));
    return d.materials.at(0).isFrosted();
  };

  EXPECT_FALSE(isFrosted("0.03", "0"));
  EXPECT_TRUE(isFrosted("0.05", "0"));
  EXPECT_TRUE(isFrosted("0.5", "0.5"));
  EXPECT_FALSE(isFrosted("0.5", "1"));
}

}  // namespace
}  // namespace whit
