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

TEST_F(GltfMaterials, VertexColorsOfHalfAMetalAreCounted) {
  const std::string what =
      "vertex colors of a partly metallic material: they multiply all of its reflection or none";
  const auto warnings = [&](const char* metallic) {
    const std::string metal = "{\"pbrMetallicRoughness\":{\"metallicFactor\":";
    loadText(sceneText({{0, metal + metallic + "}}", 1}}));
    return warned(what);
  };

  // White changes nothing.
  colors_.assign(12, 1);
  EXPECT_EQ(warnings("0.5"), 0u);

  colors_ = {1, 0, 0, 0, 1, 0, 1, 0.5f, 1, 0, 0, 1};
  EXPECT_EQ(warnings("0"), 0u);
  EXPECT_EQ(warnings("1"), 0u);
  EXPECT_EQ(warnings("0.5"), 1u);
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

// Shows four columns, whose middles lie at the centers of texels: the alpha of the texture is 1, 1,
// 0.4, 1, and that of the vertices 1/8, 3/8, 5/8, 7/8.
class GltfAlphas : public GltfMaterials {
 protected:
  void SetUp() override {
    GltfMaterials::SetUp();
    alphas_ = {0, 1, 1, 0};
    save("t.tga", tga(4, 1,
                      {{255, 255, 255, 255},
                       {255, 255, 255, 255},
                       {255, 255, 255, 102},
                       {255, 255, 255, 255}}));
    useImages({"t.tga"});
  }

  // A black surface whose alpha is that of the texture times `factor`.
  static std::string material(const std::string& mode, const std::string& factor) {
    return matte("\"baseColorFactor\":[0,0,0," + factor + "],\"baseColorTexture\":{\"index\":0}",
                 "\"doubleSided\":true,\"alphaMode\":" + mode);
  }

  static constexpr float kByTextureAndVertices[] = {0.125f, 0.375f, 0.4f * 0.625f, 0.875f};
};

TEST_F(GltfAlphas, OfTextureVerticesAndFactorAreMultiplied) {
  candela_ = 0;
  const std::string blend = material("\"BLEND\",\"emissiveFactor\":[1,1,1]", "0.5");
  const auto p = picture({{0, blend, 1}}, 4);
  for (std::size_t i = 0; i < 4; ++i) expectColor(p[4 + i], Rgb(0.5f * kByTextureAndVertices[i]));
  EXPECT_EQ(kinds(), "");
}

// The texture alone would be cut nowhere, and the vertices alone in the first column.
TEST_F(GltfAlphas, CutWhereTheirProductIsBelowTheCutoff) {
  candela_ = 0;
  const std::string mask = material("\"MASK\",\"alphaCutoff\":0.3,\"emissiveFactor\":[1,1,1]", "1");
  const auto p = picture({{0, mask, 1}}, 4);
  const float seen[] = {0, 1, 0, 1};
  for (std::size_t i = 0; i < 4; ++i) expectColor(p[4 + i], Rgb(seen[i]));
  EXPECT_EQ(kinds(), "");
}

// A texture without alpha counts as opaque.
TEST_F(GltfAlphas, OfVerticesCountBesideAnOpaqueTexture) {
  candela_ = 0;
  save("t.tga", tga(1, 1, {{255, 255, 255}}));
  const std::string blend = material("\"BLEND\",\"emissiveFactor\":[1,1,1]", "1");
  const auto p = picture({{0, blend, 1}}, 4);
  const float columns[] = {0.125f, 0.375f, 0.625f, 0.875f};
  for (std::size_t i = 0; i < 4; ++i) expectColor(p[4 + i], Rgb(columns[i]));
}

// Light goes the way that it is seen, through a black sheet that fills the picture: it is kept off
// where the sheet covers half and more. The floor is seen through what the sheet leaves.
TEST_F(GltfAlphas, DecideTogetherWhereShadowsAreCast) {
  const auto p = picture({{0, matte(""), 1}, {1, material("\"BLEND\"", "1"), 2.0 / 3}}, 4);
  for (std::size_t i = 0; i < 4; ++i) {
    const float covered = kByTextureAndVertices[i];
    const double x = (static_cast<double>(i) - 1.5) / 2;
    const float floor = covered < 0.5f ? static_cast<float>(lit(x, 0.25)) : 0;
    expectColor(p[4 + i], Rgb((1 - covered) * floor));
  }
}

// The mesh has no place for alpha where its maps have two sets of coordinates.
TEST_F(GltfAlphas, OfVerticesAreCountedBesideTwoSetsOfCoordinates) {
  loadText(sceneText({{0,
                       material("\"BLEND\",\"emissiveFactor\":[1,1,1],\"emissiveTexture\":"
                                "{\"index\":0,\"texCoord\":1}",
                                "1"),
                       1}}));
  EXPECT_EQ(
      warned("alpha of vertex colors left out, because textures have two sets of coordinates"), 1u);
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
