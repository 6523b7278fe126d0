// Emission by textures, unlit materials, vertex colors, textures of KHR_materials_specular,
// _transmission and _clearcoat, of smooth metals, and what is counted because it is left out.
#include "gltf_pictures.h"

namespace whit {
namespace {

// The emission is the factor, times the texture in linear light. A lamp does not light an unlit
// material, which reflects nothing although a metal would.
TEST_F(GltfMaterials, EmissionByATexture) {
  useRows({{"ffbc00"}});
  expectShown({
      {"{'pbrMetallicRoughness':{'baseColorFactor':[0.5,0.25,1,1]},"
       "'extensions':{'KHR_materials_unlit':{}}}",
       {0.5f, 0.25f, 1}},
      {"{'pbrMetallicRoughness':{'baseColorFactor':[0.5,1,1,1],'roughnessFactor':0,"
       "'baseColorTexture':{'index':0}},'extensions':{'KHR_materials_unlit':{}}}",
       {0.5f, kCode188, 0}},
  });

  candela_ = 0;
  expectShown({
      {"{'emissiveFactor':[0.5,0.25,0],'extensions':{'KHR_materials_emissive_strength':{"
       "'emissiveStrength':8}}}",
       {4, 2, 0}},
      {matte("", "'emissiveFactor':[0.5,1,1],'emissiveTexture':{'index':0}"), {0.5f, kCode188, 0}},
  });
}

// Colors are interpolated between the corners. The pixel sees the middle of the first triangle's
// edge, where the color is half of each end's.
TEST_F(GltfMaterials, VertexColors) {
  colors_ = {1, 0, 0, 0, 1, 0, 1, 0.5f, 1, 0, 0, 1};
  expectShown({{matte("'baseColorFactor':[0.5,0.5,1,1]"), {0.5f, 0.125f, 0.5f}}});

  candela_ = 0;
  expectShown({
      {"{'pbrMetallicRoughness':{'baseColorFactor':[0.5,0.5,1,1]},"
       "'extensions':{'KHR_materials_unlit':{}}}",
       {0.5f, 0.125f, 0.5f}},
      {glowing("[1,1,1]"), Rgb(1.0f)},  // emission has no base color
  });
}

TEST_F(GltfMaterials, VertexColorsOfHalfAMetalAreCounted) {
  const char* const kind =
      "vertex colors of a partly metallic material: they multiply all of its reflection or none";
  const std::string half = "{'pbrMetallicRoughness':{'metallicFactor':0.5}}";

  colors_.assign(12, 1);  // white changes nothing
  expectWarnings(kind, {{half, 0}});

  colors_ = {1, 0, 0, 0, 1, 0, 1, 0.5f, 1, 0, 0, 1};
  expectWarnings(kind, {{matte(""), 0}, {"{}", 0}, {half, 1}});
}

// Shows four columns, whose middles lie at the centers of texels: the alpha of the texture is 1, 1,
// 0.4, 1, and that of the vertices 1/8, 3/8, 5/8, 7/8.
class GltfAlphas : public GltfMaterials {
 protected:
  GltfAlphas() {
    alphas_ = {0, 1, 1, 0};
    useRows({{"ffffffff", "ffffffff", "ffffff66", "ffffffff"}});
  }

  // A black surface whose alpha is that of its color, with the texture or without it.
  static std::string material(const std::string& mode, const std::string& factor = "1",
                              bool isTextured = true) {
    return matte("'baseColorFactor':[0,0,0," + factor + "]" +
                     (isTextured ? ",'baseColorTexture':{'index':0}" : ""),
                 "'doubleSided':true,'alphaMode':" + mode);
  }

  static void expectColumns(const Colors& picture, const std::vector<float>& grays) {
    for (std::size_t i = 0; i < 4; ++i) expectColor(picture[4 + i], Rgb(grays[i]));
  }

  // Expects what is seen of a surface that glows with 1: its alpha.
  void expectGlow(const std::string& material, const std::vector<float>& grays) {
    SCOPED_TRACE(material);
    candela_ = 0;
    expectColumns(picture(material, 4), grays);
    expectNoWarnings();
  }

  static constexpr char kBlend[] = "'BLEND','emissiveFactor':[1,1,1]";
};

// The texture alone would be cut nowhere, and the vertices alone in the first column.
TEST_F(GltfAlphas, OfTextureVerticesAndFactorAreMultiplied) {
  expectGlow(material(kBlend, "0.5", false), {0.0625f, 0.1875f, 0.3125f, 0.4375f});
  expectGlow(material("'MASK','alphaCutoff':0.75,'emissiveFactor':[1,1,1]", "1", false),
             {0, 0, 0, 1});
  expectGlow(material(kBlend, "0.5"), {0.0625f, 0.1875f, 0.125f, 0.4375f});
  expectGlow(material("'MASK','alphaCutoff':0.3,'emissiveFactor':[1,1,1]"), {0, 1, 0, 1});

  // A texture without alpha counts as opaque.
  useRows({{"ffffff"}});
  expectGlow(material(kBlend), {0.125f, 0.375f, 0.625f, 0.875f});

  // Opaque materials ignore the alpha of vertices.
  alphas_ = {0, 0, 0, 0};
  expectGlow(glowing("[1,1,1]"), {1, 1, 1, 1});
}

// Light goes the way that it is seen, through a black sheet that fills the picture: it is kept off
// where the sheet covers half and more. The floor is seen through what the sheet leaves.
TEST_F(GltfAlphas, DecideTogetherWhereShadowsAreCast) {
  expectColumns(picture({{matte("")}, {material("'BLEND'"), 1, 2.0 / 3}}, 4),
                {0.875f * lit(0.75, 0.25), 0.625f * lit(0.25, 0.25), 0.75f * lit(0.25, 0.25), 0});
}

// The mesh has no place for alpha where its maps have two sets of coordinates.
TEST_F(GltfAlphas, OfVerticesAreCountedBesideTwoSetsOfCoordinates) {
  loadMaterial(
      material("'BLEND','emissiveFactor':[1,1,1],'emissiveTexture':{'index':0,'texCoord':1}"));
  expectWarned("alpha of vertex colors left out, because textures have two sets of coordinates");
}

TEST_F(GltfMaterials, WhatCannotBeShownIsCounted) {
  useImages({"missing.png"});
  loadSquares({{"{'extensions':{'KHR_materials_clearcoat':{'clearcoatNormalTexture':{"
                "'index':0}},'KHR_materials_volume':{'thicknessTexture':{'index':0}}}}"},
               {matte("'baseColorTexture':{'index':0}"), 1}});

  expectWarned("normal map of a clearcoat left out");
  expectWarned("thickness of a volume by a texture left out: what the mesh encloses counts");
  expectWarned("texture left out");
}

// The roughness of a metal is that of no glass: it transmits nothing.
TEST_F(GltfMaterials, RoughnessFrostsGlass) {
  const auto isFrosted = [&](const std::string& roughness, const std::string& metal) {
    return loadMaterial("{'pbrMetallicRoughness':{'metallicFactor':" + metal +
                        ",'roughnessFactor':" + roughness +
                        "},'extensions':{'KHR_materials_transmission':{'transmissionFactor':1}}}")
        .materials.at(0)
        .isFrosted();
  };

  EXPECT_FALSE(isFrosted("0.03", "0"));
  EXPECT_TRUE(isFrosted("0.05", "0"));
  EXPECT_TRUE(isFrosted("0.5", "0.5"));
  EXPECT_FALSE(isFrosted("0.5", "1"));
}

// Strength 1 beside 102 / 255 = 0.4.
const Texels kStrength{"000000ff", "00000066"};

// Black with a lobe of alpha 1.
std::string lobeOnly(const std::string& specular, const std::string& pbr = "") {
  return "{'pbrMetallicRoughness':{'metallicFactor':0,'baseColorFactor':[0,0,0,1]" + pbr +
         "},'extensions':{'KHR_materials_specular':{" + specular + "}}}";
}

// Of colors red and a gray.
TEST_F(GltfMaterials, SpecularTexelByTexel) {
  useRows({kStrength, {"ff0000", "bcbcbc"}});
  const float lobe = lobeAt(0.5, 0.5);
  const std::string strength = "'specularFactor':0.5,'specularTexture':{'index':0}",
                    color = "'specularColorFactor':[10,5,10]",
                    large = "'specularColorFactor':[100,100,100]",
                    texture = ",'specularColorTexture':{'index':1}";
  const auto expectLobes = [&](const std::string& specular, const Rgb& left, const Rgb& right) {
    expectColors(picture(lobeOnly(specular), 2), {left * lobe, right * lobe});
  };

  const Rgb red{0.4f, 0, 0}, dull = Rgb{0.4f, 0.2f, 0.4f} * kCode188;
  expectLobes(strength, Rgb(0.04f * 0.5f), Rgb(0.04f * 0.2f));
  expectLobes(color + texture, red, dull);
  expectLobes(strength + "," + color + texture, red * 0.5f, dull * 0.2f);
  // Color is bounded by 1 before the strength counts.
  expectLobes(strength + "," + large + texture, {0.5f, 0, 0}, Rgb(0.2f));
  expectNoWarnings();
}

// A metal has its base color, whatever the specular texture; half a metal half of it.
TEST_F(GltfMaterials, SpecularTexturesOfWhatIsPartlyMetal) {
  useRows({{"00ffff", "00ff00"}, {"00000066"}});
  const Rgb color{0.8f, 0.4f, 0.2f};
  const float lobe = lobeAt(0.5, 0.5), f0 = 0.04f * 0.4f;
  expectColors(
      picture(
          "{'pbrMetallicRoughness':{'baseColorFactor':[0.8,0.4,0.2,1],'metallicRoughnessTexture':{'"
          "index':0}},'extensions':{'KHR_materials_specular':{'specularTexture':{'index':1}}}}",
          2),
      {color * lobe, color * (lit(0.5, 0.5) * (1 - f0 * kRoughestAlbedo)) + Rgb(f0 * lobe)});
}

// What mirrors before a white wall behind the eye.
class GltfMirrors : public GltfMaterials {
 protected:
  GltfMirrors() { candela_ = 0; }

  void expectMirrored(const std::string& material, const Rgb& left, const Rgb& right) {
    expectColors(picture({{material}, {glowing("[1,1,1]"), 6, 20}}, 2), {left, right});
  }
};

// White beside a blue of 1; next to nothing of Schlick's term.
TEST_F(GltfMirrors, FollowSpecularTextures) {
  useRows({kStrength, {"ffffff", "0000ff"}});
  expectMirrored(lobeOnly("'specularColorFactor':[5,5,5],'specularTexture':{'index':0},"
                          "'specularColorTexture':{'index':1}",
                          ",'roughnessFactor':0"),
                 Rgb(5 * 0.04f), Rgb{0, 0, 5 * 0.04f} * 0.4f);
}

// The picture of a smooth metal, as that of a rough one in its lobe.
TEST_F(GltfMirrors, OfMetalHaveTheColorsOfTexturesAndVertices) {
  useRows({{"ff0000", "00ff00"}});
  const std::string metal = "{'pbrMetallicRoughness':{'roughnessFactor':0",
                    textured = metal + ",'baseColorTexture':{'index':0}}";
  expectMirrored(textured + "}", {1, 0, 0}, {0, 1, 0});

  // A clearcoat reflects 0.04 by half, and leaves the rest to the metal.
  expectMirrored(textured + ",'extensions':{'KHR_materials_clearcoat':{'clearcoatFactor':0.5}}}",
                 {1, 0.02f, 0.02f}, {0.02f, 1, 0.02f});

  colors_ = {1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0};
  expectMirrored(metal + "}}", {0.75f, 0, 0.25f}, {0.25f, 0, 0.75f});
}

// A label on glass: what the left half lets pass, and what the right half reflects of the lamp.
TEST_F(GltfMaterials, TransmissionTexelByTexel) {
  candela_ = 0;
  useRows({{"ff0000", "330000"}, {"ff0000", "00ff00"}});

  const auto show = [&](const std::string& pbr) {
    const std::string pane =
        "{'pbrMetallicRoughness':{'metallicFactor':0,'roughnessFactor':1" + pbr +
        "},'extensions':{'KHR_materials_specular':{'specularFactor':0},'KHR_materials_transmission'"
        ":{'transmissionFactor':0.5,'transmissionTexture':{'index':0}}}}";
    SceneDescription d = loadSquares({{pane}, {glowing("[1,1,1]"), -1, 4}});
    d.ambient.up = d.ambient.down = Rgb(0.25f);
    return pictureOf(std::move(d), 2);
  };

  const float left = 0.5f + 0.5f * 0.25f, right = 0.1f + 0.9f * 0.25f;
  expectColors(show(""), {Rgb(left), Rgb(right)});
  expectColors(show(",'baseColorTexture':{'index':1}"), {{left, 0, 0}, {0, right, 0}});
  expectNoWarnings();
}

TEST_F(GltfMaterials, ClearcoatsTakeTheMeanOfTheirTextures) {
  useRows({{"663300", "663300"}, {"660000", "cc6600"}});
  const auto coat = [&](const std::string& index, const std::string& roughness = "") {
    return loadMaterial(
               "{'pbrMetallicRoughness':{'metallicFactor':0,'roughnessFactor':1},'extensions':{'"
               "KHR_materials_clearcoat':{'clearcoatFactor':0.5,'clearcoatTexture':{'index':" +
               index + "}" + roughness + "}}}")
        .materials[0];
  };

  const Material even = coat("0");
  expectColor(even.mirror, Rgb(0.04f * 0.2f), 1e-6);
  expectColor(even.mirrorGrazing, Rgb(0.2f), 1e-6);
  // 0.2 is smooth; 1 without the texture is not.
  const std::string rough = ",'clearcoatRoughnessFactor':1",
                    texture = rough + ",'clearcoatRoughnessTexture':{'index':";
  EXPECT_FALSE(coat("0", rough).hasMirror());
  EXPECT_TRUE(coat("0", texture + "0}").hasMirror());
  expectNoWarnings();

  expectColor(coat("1").mirrorGrazing, Rgb(0.3f), 1e-6);
  coat("0", texture + "1}");
  expectWarned("clearcoat by a texture taken by its mean");
  expectWarned("roughness of a clearcoat by a texture taken by its mean");
}

TEST_F(GltfMaterials, SpecularTexturesWithOtherCoordinatesAreCounted) {
  useRows({kStrength});
  secondUvs_ = {1, 1, 0, 1, 0, 0, 1, 0};
  loadMaterial(
      lobeOnly("'specularTexture':{'index':0,'texCoord':1}", ",'baseColorTexture':{'index':0}"));
  expectWarned(
      "texture looked up with the coordinates of its material's first in place of its own");
}

}  // namespace
}  // namespace whit
