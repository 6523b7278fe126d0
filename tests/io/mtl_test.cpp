// What MTL statements mean.
#include <cmath>

#include "decoded_texel.h"
#include "scene/texture.h"
#include "scene_files.h"

namespace whit {
namespace {

class Mtl : public SceneFileTest {
 protected:
  // The scene of one triangle with the material of these statements.
  SceneDescription loadWith(const std::string& statements) {
    save("m.mtl", "newmtl m\n" + statements);
    return loadObj("mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  }
  Material materialOf(const std::string& statements) { return loadWith(statements).materials[0]; }
  const Texture& textureOf(const SceneDescription& scene, std::int32_t map) {
    return scene.textures.at(static_cast<std::size_t>(map));
  }
};

constexpr float kRounding = 1e-6f;  // a few float operations on numbers below 2

TEST_F(Mtl, ColorsAndDefaults) {
  const Material m = materialOf("Kd 0.1 0.2 0.3\nKs 0.4\nKe 1 2 3\n");
  EXPECT_EQ(m.name, "m");
  EXPECT_EQ(m.diffuse, Rgb(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(m.specular, Rgb(0.4f));  // one number stands for all three
  EXPECT_EQ(m.emission, Rgb(1, 2, 3));
  EXPECT_FALSE(m.hasMirror());
  EXPECT_FALSE(m.hasTransmission());
  EXPECT_TRUE(m.castsShadow);
  EXPECT_EQ(materialOf("").diffuse, Rgb(0.8f));
  EXPECT_EQ(materialOf("\tkd 0.5 0.5 0.5  \nillum 2").diffuse, Rgb(0.5f));
}

TEST_F(Mtl, ExponentToRoughness) {
  // alpha = sqrt(2 / (Ns + 2)) = 1/2 for Ns = 6, roughness its square root.
  EXPECT_NEAR(materialOf("Ns 6\n").roughness, std::sqrt(0.5f), kRounding);
  EXPECT_NEAR(materialOf("Ns 0\n").roughness, 1, kRounding);
  EXPECT_EQ(materialOf("Ns 6\nPr 0.25\n").roughness, 0.25f);
  EXPECT_EQ(materialOf("Pr 0\n").roughness, 0);
}

TEST_F(Mtl, Metalness) {
  const Material metal = materialOf("Kd 0.8 0.4 0.2\nPm 1\n");
  EXPECT_EQ(metal.diffuse, Rgb(0.0f));
  EXPECT_EQ(metal.specular, Rgb(0.8f, 0.4f, 0.2f));
  const Material half = materialOf("Kd 0.8 0.4 0.2\nPm 0.5\n");
  EXPECT_NEAR(half.diffuse.x, 0.4f, kRounding);
  EXPECT_NEAR(half.specular.x, 0.42f, kRounding);  // halfway from 0.04 to 0.8
}

TEST_F(Mtl, IlluminationModels) {
  const std::string colors = "Kd 0.5 0.5 0.5\nKs 0.25 0.25 0.25\nTf 0.9 0.8 0.7\nNi 1.33\n";
  EXPECT_FALSE(materialOf(colors + "illum 0\n").hasGlossy());
  EXPECT_FALSE(materialOf(colors + "illum 1\n").hasGlossy());
  EXPECT_TRUE(materialOf(colors + "illum 2\n").hasGlossy());
  EXPECT_FALSE(materialOf(colors + "illum 2\n").hasTransmission());  // Tf is for glass
  for (const char* illum : {"3", "8"}) {
    const Material m = materialOf(colors + "illum " + illum + "\n");
    EXPECT_EQ(m.mirror, Rgb(0.25f));
    EXPECT_EQ(m.mirrorGrazing, Rgb(0.25f));
    EXPECT_FALSE(m.hasGlossyReflection());
  }
  EXPECT_TRUE(materialOf(colors + "illum 2\n").hasGlossyReflection());
  EXPECT_FALSE(materialOf(colors + "illum 4\n").hasGlossyReflection());
  EXPECT_EQ(materialOf(colors + "illum 5\n").mirrorGrazing, Rgb(1.0f));
  for (const char* illum : {"4", "6", "7", "9"}) {
    const Material m = materialOf(colors + "d 0.25\nillum " + illum + "\n");
    EXPECT_EQ(m.transmission, Rgb(0.9f, 0.8f, 0.7f));
    EXPECT_EQ(m.ior, 1.33f);
    EXPECT_FALSE(m.hasMirror());
    EXPECT_FALSE(m.castsShadow);
    EXPECT_EQ(m.diffuse, Rgb(0.125f));
  }
  EXPECT_EQ(materialOf("d 0.25\nillum 4\n").transmission, Rgb(0.75f));
}

TEST_F(Mtl, DissolveWithoutRefraction) {
  for (const char* statement : {"d 0.25\n", "d -halo 0.25\n", "Tr 0.75\n", "d 0.25\nTr 0.1\n"}) {
    const Material m = materialOf(std::string("Kd 0.5 0.5 0.5\nNi 1.5\n") + statement);
    EXPECT_EQ(m.coverage, 0.25f) << statement;
    EXPECT_FALSE(m.hasTransmission()) << statement;
    EXPECT_FALSE(m.castsShadow) << statement;
    EXPECT_EQ(m.diffuse, Rgb(0.5f)) << statement;
  }
}

TEST_F(Mtl, ValuesOutOfRangeAreClampedAndCounted) {
  EXPECT_EQ(materialOf("Kd 2 -1 0.5\n").diffuse, Rgb(1, 0, 0.5f));
  EXPECT_EQ(warned("material color clamped to [0, 1]"), 1u);
  EXPECT_EQ(materialOf("illum 4\nTf 1\nNi 0\n").ior, 1);
  EXPECT_EQ(warned("index of refraction clamped to [1, 10]"), 1u);
}

TEST_F(Mtl, ErrorsHaveTheirLine) {
  const auto error = [&](const std::string& statements) {
    return errorOf([&] { materialOf(statements); });
  };
  EXPECT_EQ(error("Kd red\n"), "3 m.mtl:2: expected numbers after \"Kd\"");
  EXPECT_EQ(error("Kd spectral file.rfl 1\n"), "3 m.mtl:2: expected numbers after \"Kd\"");
  EXPECT_EQ(error("Kd 1 1 x\n"), "3 m.mtl:2: expected numbers after \"Kd\"");
  EXPECT_EQ(error("\n\nNs\n"), "3 m.mtl:4: expected a number after \"Ns\"");
  EXPECT_EQ(error("Ns nan\n"), "3 m.mtl:2: expected a number after \"Ns\"");
  EXPECT_EQ(error("map_Kd\n"), "3 m.mtl:2: expected the name of a file after \"map_Kd\"");
  EXPECT_EQ(error("newmtl \n"), "3 m.mtl:2: expected a name after \"newmtl\"");
}

TEST_F(Mtl, MapsByTheirKeys) {
  save("c.tga", tga(1, 1, {{255, 0, 0}}));
  save("n.tga", tga(1, 1, {{128, 128, 255}}));
  save("d.tga", tga(1, 1, {{64}}));
  const SceneDescription scene =
      loadWith("map_Kd c.tga\nKs 1 1 1\nmap_Ks c.tga\nnorm n.tga\nmap_d -clamp on d.tga\n");
  const Material& m = scene.materials[0];
  EXPECT_EQ(m.diffuse, Rgb(1.0f));  // without Kd the map is the color
  EXPECT_EQ(textureOf(scene, m.diffuseMap).format, TexelFormat::color);
  EXPECT_EQ(decodeColorTexel(textureOf(scene, m.diffuseMap).texels[0]), Rgb(1, 0, 0));
  EXPECT_EQ(m.specularMap, m.diffuseMap);
  EXPECT_EQ(textureOf(scene, m.normalMap).format, TexelFormat::data);
  EXPECT_EQ(textureOf(scene, m.normalMap).texels[0] & 0xffffffu, 0xff8080u);
  EXPECT_EQ(textureOf(scene, m.alphaMap).texels[0] & 0xffu, 64u);
  EXPECT_EQ(textureOf(scene, m.alphaMap).wrapU, Wrap::clamp);
  EXPECT_EQ(scene.textures.size(), 3u);
}

TEST_F(Mtl, SpecularMapsMultiply) {
  save("c.tga", tga(1, 1, {{255, 0, 0}}));
  EXPECT_EQ(materialOf("Ks 0 0 0\nmap_Ks c.tga\n").specularMap, kNoTexture);
  EXPECT_EQ(materialOf("map_Ks c.tga\n").specular, Rgb(1.0f));
}

TEST_F(Mtl, NamesWithBlanksBackslashesAndOptions) {
  save("a folder/c 1.tga", tga(1, 1, {{255, 0, 0}}));
  for (const char* line : {"map_Kd a folder\\c 1.tga\r", "map_Kd -clamp off a folder/c 1.tga \t",
                           "map_Kd -s 2 2 a folder/c 1.tga", "map_Kd -o 1 -bm 2 a folder/c 1.tga",
                           "map_kd -mm 0 1 a folder/c 1.tga"}) {
    const SceneDescription scene = loadWith(std::string(line) + "\n");
    EXPECT_EQ(scene.textures.size(), 1u) << line;
  }
  EXPECT_EQ(warned("texture option that is not supported"), 3u);
}

TEST_F(Mtl, MissingTexturesAreLeftOut) {
  EXPECT_EQ(materialOf("map_Kd none.png\n").diffuseMap, kNoTexture);
  EXPECT_EQ(warned("texture left out"), 1u);
  for (const char* name : {"../../c.tga", "model://robot/c.png", "http://host/c.png"}) {
    EXPECT_EQ(materialOf(std::string("map_Kd ") + name + "\n").diffuseMap, kNoTexture);
  }
  EXPECT_EQ(warned("texture left out"), 4u);
}

// Elsewhere Tr is 1 - d. A Tr of 1 would leave nothing to be seen.
TEST_F(Mtl, TransparencyOfMeshLabIsOpacity) {
  const std::string head = "#\n# Wavefront material file\n# Converted by Meshlab Group\n#\n";
  const auto coverage = [&](const std::string& text) {
    save("m.mtl", text);
    return loadObj("mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        .materials[0]
        .coverage;
  };
  EXPECT_EQ(coverage(head + "newmtl m\nTr 1\nillum 2\n"), 1);
  EXPECT_EQ(coverage(head + "newmtl m\nTr 0.75\n"), 0.75f);
  EXPECT_EQ(coverage(head + "newmtl m\nKd 1 1 1\n"), 1);
  EXPECT_EQ(kinds(), "");
  EXPECT_EQ(coverage("newmtl m\nTr 0.75\n# Converted by Meshlab Group\n"), 0.25f);
  EXPECT_EQ(coverage("newmtl m\nTr 1\n"), 1);
  EXPECT_EQ(warned("material that Tr 1 makes invisible taken as opaque"), 1u);
  EXPECT_EQ(materialOf("Tr 1\nillum 4\n").transmission, Rgb(1.0f));
  EXPECT_EQ(materialOf("d 0\n").coverage, 0);
  EXPECT_EQ(warned("material that Tr 1 makes invisible taken as opaque"), 1u);
}

TEST_F(Mtl, LibrariesThatMayNotBeReadAreMissing) {
  loadObj("mtllib ../../m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(warned("material library missing"), 1u);
}

TEST_F(Mtl, AlphaOfTheColorCuts) {
  save("cut.tga", tga(2, 1, {{255, 0, 0, 255}, {255, 0, 0, 10}}));
  save("solid.tga", tga(2, 1, {{255, 0, 0, 255}, {255, 0, 0, 255}}));
  save("mask.tga", tga(2, 1, {{7}, {9}}));
  const SceneDescription cut = loadWith("map_Kd cut.tga\n");
  EXPECT_EQ(textureOf(cut, cut.materials[0].alphaMap).texels[1] & 0xffu, 10u);
  EXPECT_EQ(materialOf("map_Kd solid.tga\n").alphaMap, kNoTexture);
  const SceneDescription masked = loadWith("map_Kd cut.tga\nmap_d mask.tga\n");
  EXPECT_EQ(textureOf(masked, masked.materials[0].alphaMap).texels[1] & 0xffu, 9u);
  const SceneDescription same = loadWith("map_Kd cut.tga\nmap_d cut.tga\n");
  EXPECT_EQ(textureOf(same, same.materials[0].alphaMap).texels[1] & 0xffu, 10u);
}

TEST_F(Mtl, BumpMapsOfHeightsBecomeNormals) {
  // Rises to the right by 64 codes a texel, in the middle; 4 texels wide.
  const std::vector<std::vector<int>> ramp{{0}, {64}, {128}, {192}};
  save("h.tga", tga(4, 1, ramp));
  const SceneDescription scene = loadWith("map_Bump -bm 8 h.tga\n");
  const std::uint32_t texel = textureOf(scene, scene.materials[0].normalMap).texels[1];
  // Slope: 64/255 a texel, 4 texels a tile, height 8/64 of the tile.
  const double slope = 64.0 / 255 * 4 * 8 / 64, size = std::sqrt(1 + slope * slope);
  constexpr double kHalfCode = 0.5001;
  EXPECT_NEAR(texel & 0xffu, 255 * (0.5 - 0.5 * slope / size), kHalfCode);
  EXPECT_NEAR(texel >> 8 & 0xffu, 127.5, kHalfCode);
  EXPECT_NEAR(texel >> 16 & 0xffu, 255 * (0.5 + 0.5 / size), kHalfCode);
}

TEST_F(Mtl, BumpMapsOfNormalsAndGrayPicturesAreToldApart) {
  save("n.tga", tga(1, 1, {{100, 150, 250}}));
  save("g.tga", tga(1, 1, {{100, 104, 98}}));
  const SceneDescription normals = loadWith("bump n.tga\n");
  EXPECT_EQ(textureOf(normals, normals.materials[0].normalMap).texels[0] & 0xffffffu, 0xfa9664u);
  const SceneDescription flat = loadWith("map_bump g.tga\n");
  EXPECT_EQ(textureOf(flat, flat.materials[0].normalMap).texels[0] >> 16 & 0xffu, 255u);
}

}  // namespace
}  // namespace whit
