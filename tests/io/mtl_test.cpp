// What MTL statements mean.
#include <cmath>

#include "decoded_texel.h"
#include "gltf_pictures.h"
#include "scene/texture.h"
#include "scene_files.h"

namespace whit {
namespace {

class Mtl : public SceneFileTest {
 protected:
  // Loads one triangle with the material of these statements.
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
  EXPECT_EQ(m.specular, Rgb(0.4f) * 0.08f);  // one number stands for all three
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

// Blender writes 1000 (1 - roughness)^2, and Ks 0.5 where its specular level is 0.5: F0 is 0.04 as
// in the glTF file of the same material.
TEST_F(Mtl, MaterialsOfBlenderAreThoseOfItsGltf) {
  const auto blender = [&](const std::string& statements) {
    save("m.mtl", "# Blender 3.4.1 MTL File: 'None'\n# www.blender.org\n\nnewmtl m\n" + statements);
    return loadObj("mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").materials[0];
  };

  const Material plain = blender(
      "Ns 250\nKa 1 1 1\nKd 0.8 0.4 0.2\nKs 0.5 0.5 0.5\nKe 0 0 0\nNi 1.45\nd 1\nillum 2\n");
  EXPECT_NEAR(plain.specular.x, 0.04f, kRounding);
  EXPECT_NEAR(plain.roughness, 0.5f, kRounding);
  EXPECT_EQ(plain.diffuse, Rgb(0.8f, 0.4f, 0.2f));
  EXPECT_FALSE(plain.hasMirror());

  const Material metal = blender("Ns 250\nKa 1 1 1\nKd 0.8 0.4 0.2\nKs 0.5 0.5 0.5\nillum 3\n");
  EXPECT_EQ(metal.specular, Rgb(0.8f, 0.4f, 0.2f));
  EXPECT_EQ(metal.diffuse, Rgb(0.0f));
  EXPECT_FALSE(metal.hasMirror());

  const Material sheet = blender("Ns 250\nKd 1 1 1\nKs 0.5 0.5 0.5\nNi 1.45\nd 0.25\nillum 9\n");
  EXPECT_EQ(sheet.coverage, 0.25f);
  EXPECT_FALSE(sheet.hasTransmission());
}

// Below illum 3 a highlight is no mirror, however strong it is.
TEST_F(Mtl, HighlightsAreNoMirrors) {
  const Material m = materialOf("Kd 0.5 0.5 0.5\nKs 1 1 1\nNs 10\nillum 2\n");
  EXPECT_NEAR(m.specular.x, 0.08f, kRounding);
  EXPECT_FALSE(m.hasMirror());
  EXPECT_FALSE(materialOf("Kd 1 1 1\nNs 900\n").hasMirror());

  const Material rough = materialOf("Ks 0.9 0.9 0.9\nPr 0.6\nillum 3\n");
  EXPECT_FALSE(rough.hasMirror());
  EXPECT_NEAR(rough.specular.x, 0.9f, kRounding);
  EXPECT_EQ(materialOf("Ks 0.9 0.9 0.9\nPr 0\nillum 3\n").mirror, Rgb(0.9f));
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

// A line that cannot be read is reported and left out; the other lines count.
TEST_F(Mtl, DamagedLinesAreLeftOut) {
  const std::pair<const char*, const char*> lines[] = {
      {"Kd red\n", "2: expected numbers after \"Kd\""},
      {"Kd spectral file.rfl 1\n", "2: expected numbers after \"Kd\""},
      {"Kd 1 1 x\n", "2: expected numbers after \"Kd\""},
      {"\n\nNs\n", "4: expected a number after \"Ns\""},
      {"Ns nan\n", "2: expected a number after \"Ns\""},
      {"map_Kd\n", "2: expected the name of a file after \"map_Kd\""},
      {"newmtl \n", "2: expected a name after \"newmtl\""}};

  const std::string kind = "line of a material library that cannot be read left out";
  for (const auto& [line, place] : lines) {
    Warnings warnings;
    save("m.mtl", "newmtl m\n" + std::string(line) + "newmtl n\nKe 2 2 2\n");
    const SceneDescription scene = loadScene(
        save("m.obj", std::string("mtllib m.mtl\nusemtl n\n") + kTriangleObj), options_, warnings);

    EXPECT_EQ(scene.materials[0].emission, Rgb(2.0f)) << line;
    ASSERT_EQ(warnings.entries().count(kind), 1u) << line;
    const std::string where = warnings.entries().at(kind).first;
    EXPECT_EQ(where.substr(where.find("m.mtl:")), "m.mtl:" + std::string(place));
  }

  // With --strict the warning becomes an error.
  save("m.mtl", "newmtl m\nKd 0.5\nmap_Kd\n");
  const std::string file = save("m.obj", std::string("mtllib m.mtl\n") + kTriangleObj);
  EXPECT_EQ(errorIfStrict(file), "3 m.mtl:3: expected the name of a file after \"map_Kd\": " +
                                     kind + " (refused by --strict)");
}

// The texture has one texel. Its coordinates become u' = 0.25 + 2 u and v' = -0.5 + 3 v.
TEST_F(Mtl, OffsetAndScaleOfMaps) {
  save("c.tga", tga(1, 1, {{255, 0, 0}}));
  save("m.mtl",
       "newmtl moved\nmap_Kd -o 0.25 -0.5 0 -s 2 3 1 c.tga\nnewmtl plain\nmap_Kd c.tga\n"
       "newmtl two\nmap_Kd c.tga\nKe 1 1 1\nmap_Ke -s 4 4 c.tga\n");

  const SceneDescription scene = loadObj(
      "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.5 0.25\nvt 1 0\nvt 0 1\n"
      "usemtl moved\nf 1/1 2/2 3/3\nusemtl plain\nf 1/1 2/2 3/3\nusemtl two\nf 1/1 2/2 3/3\n");

  const Mesh& mesh = meshOf(scene);
  EXPECT_EQ(mesh.uvs[mesh.triangles[0][0]], (Vec2f{1.25f, 0.25f}));
  EXPECT_EQ(mesh.uvs[mesh.triangles[0][2]], (Vec2f{0.25f, 2.5f}));
  EXPECT_EQ(mesh.uvs[mesh.triangles[1][0]], (Vec2f{0.5f, 0.25f}));

  // The maps of one material may be transformed differently.
  EXPECT_EQ(mesh.uvs[mesh.triangles[2][0]], (Vec2f{0.5f, 0.25f}));
  EXPECT_EQ(mesh.secondUvs[mesh.triangles[2][0]], (Vec2f{2, 1}));
  EXPECT_TRUE(scene.materials[2].emissionBySecondUvs);
  EXPECT_EQ(kinds(), "");
}

// Maps of roughness are resampled for the coordinates of the color, if their offset is a number.
TEST_F(Mtl, OffsetsThatAreNotFiniteAreNotResampled) {
  save("c.tga", tga(2, 1, {{255, 0, 0}, {0, 255, 0}}));
  for (const char* offset : {"inf", "-inf", "nan", "0 nan"}) {
    save("m.mtl", std::string("newmtl m\nmap_Kd c.tga\nmap_Pr -o ") + offset + " c.tga\n");
    const SceneDescription scene = loadObj(
        "mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
        "f 1/1 2/2 3/3\n");
    EXPECT_FALSE(scene.materials.empty()) << offset;
  }
}

// The material is metal on the left and plastic on the right, rough above and smooth below. The
// emission map is a factor of Ke, and stands alone where Ke is 0.
TEST_F(Mtl, MapsOfMetalnessRoughnessAndEmission) {
  save("metal.tga", tga(2, 1, {{255}, {0}}));
  save("rough.tga", tga(1, 2, {{255}, {128}}));
  save("glow.tga", tga(1, 1, {{255, 0, 0}}));

  const SceneDescription scene = loadWith(
      "Kd 0.5 0.5 0.5\nKs 0.5 0.5 0.5\nmap_Pm metal.tga\nmap_Pr rough.tga\nKe 0 0 0\n"
      "map_Ke glow.tga\n");
  const Material& m = scene.materials[0];

  constexpr float kTexel = 2e-3f;  // 10 bits of a square root
  const Texture& diffuse = textureOf(scene, m.diffuseMap);
  const Texture& specular = textureOf(scene, m.specularMap);
  EXPECT_NEAR(decodeColorTexel(diffuse.texels[0]).x * m.diffuse.x, 0, kTexel);
  EXPECT_NEAR(decodeColorTexel(diffuse.texels[1]).x * m.diffuse.x, 0.5f, kTexel);
  EXPECT_NEAR(decodeColorTexel(specular.texels[0]).x * m.specular.x, 0.5f, kTexel);
  EXPECT_NEAR(decodeColorTexel(specular.texels[1]).x * m.specular.x, 0.04f, kTexel);

  EXPECT_EQ(m.roughness, 1);
  EXPECT_EQ(textureOf(scene, m.roughnessMap).texels[1] >> 8 & 0xffu, 128u);

  EXPECT_EQ(m.emission, Rgb(1.0f));
  EXPECT_EQ(decodeColorTexel(textureOf(scene, m.emissionMap).texels[0]), Rgb(1, 0, 0));
  EXPECT_EQ(materialOf("Ke 3 2 1\nmap_Ke glow.tga\n").emission, Rgb(3, 2, 1));
}

// Other programs write names without regard to capitals, and with folders of another machine.
TEST_F(Mtl, NamesOfOtherSystems) {
  save("Textures/Wood.tga", tga(1, 1, {{255, 0, 0}}));
  save("Beside.TGA", tga(1, 1, {{255, 0, 0}}));

  for (const char* name : {"textures\\wood.TGA", "C:\\Users\\me\\beside.tga", "../../beside.tga",
                           "file:///C:/maps/Beside.TGA", "/home/me/BESIDE.tga"}) {
    EXPECT_NE(materialOf(std::string("map_Kd ") + name + "\n").diffuseMap, kNoTexture) << name;
  }

  EXPECT_EQ(warned("file taken whose name or folder differs from the one in the model"), 5u);
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

  // The map of reflectances has F0: 0.08 times Ks times the texel.
  const Rgb f0 = decodeColorTexel(textureOf(scene, m.specularMap).texels[0]) * m.specular;
  EXPECT_NEAR(f0.x, 0.08f, 1e-3f);
  EXPECT_EQ(f0.y, 0);

  EXPECT_EQ(textureOf(scene, m.normalMap).format, TexelFormat::data);
  EXPECT_EQ(textureOf(scene, m.normalMap).texels[0] & 0xffffffu, 0xff8080u);
  EXPECT_EQ(textureOf(scene, m.alphaMap).texels[0] & 0xffu, 64u);
  EXPECT_EQ(textureOf(scene, m.alphaMap).wrapU, Wrap::clamp);
  EXPECT_EQ(scene.textures.size(), 4u);
}

TEST_F(Mtl, SpecularMapsMultiply) {
  save("c.tga", tga(1, 1, {{255, 0, 0}}));
  EXPECT_EQ(materialOf("Ks 0 0 0\nmap_Ks c.tga\n").specularMap, kNoTexture);
  EXPECT_NE(materialOf("map_Ks c.tga\n").specularMap, kNoTexture);
}

TEST_F(Mtl, NamesWithBlanksBackslashesAndOptions) {
  save("a folder/c 1.tga", tga(1, 1, {{255, 0, 0}}));
  for (const char* line : {"map_Kd a folder\\c 1.tga\r", "map_Kd -clamp off a folder/c 1.tga \t",
                           "map_Kd -imfchan r a folder/c 1.tga", "map_Kd -bm 2 a folder/c 1.tga",
                           "map_Kd -t 1 a folder/c 1.tga", "map_Kd -blendu on a folder/c 1.tga",
                           "map_kd -mm 0 1 a folder/c 1.tga"}) {
    const SceneDescription scene = loadWith(std::string(line) + "\n");
    EXPECT_EQ(scene.textures.size(), 1u) << line;
  }

  for (const char* option : {"-imfchan", "-t", "-mm"}) {
    EXPECT_EQ(warned(std::string("texture option that is not supported: ") + option), 1u) << option;
  }
}

TEST_F(Mtl, MissingTexturesAreLeftOut) {
  EXPECT_EQ(materialOf("map_Kd none.png\n").diffuseMap, kNoTexture);
  EXPECT_EQ(warned("texture left out"), 1u);
  for (const char* name : {"../../c.tga", "model://robot/c.png", "http://host/c.png"}) {
    EXPECT_EQ(materialOf(std::string("map_Kd ") + name + "\n").diffuseMap, kNoTexture);
  }
  EXPECT_EQ(warned("texture left out"), 4u);
}

// MeshLab writes the opacity as Tr, where others write 1 - d. A Tr of 1 of others would make the
// material invisible.
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

  // The comment counts at the beginning of the file only.
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

// "The map_d value is multiplied by the d value". Masks stay masks though their edges are soft.
TEST_F(Mtl, GrayMasksAreCoverage) {
  save("gray.tga", tga(2, 1, {{100}, {200}}));
  const SceneDescription gray = loadWith("d 0.5\nmap_d gray.tga\n");
  const Material& m = gray.materials[0];
  EXPECT_EQ(m.coverage, 0.5f);
  EXPECT_TRUE(m.thin);
  EXPECT_EQ(m.coverageMap, m.alphaMap);
  EXPECT_EQ(m.alphaCutoff, kClearCoverage);
  EXPECT_EQ(textureOf(gray, m.coverageMap).texels[0] & 0xffu, 100u);

  save("color.tga", tga(1, 1, {{255, 0, 0, 100}}));
  const SceneDescription color = loadWith("map_Kd color.tga\n");
  ASSERT_NE(color.materials[0].coverageMap, kNoTexture);
  EXPECT_EQ(textureOf(color, color.materials[0].coverageMap).texels[0] & 0xffu, 100u);

  save("soft.tga", tga(4, 1, {{0}, {100}, {200}, {255}}));
  const Material soft = materialOf("map_d soft.tga\n");
  EXPECT_NE(soft.alphaMap, kNoTexture);
  EXPECT_EQ(soft.coverageMap, kNoTexture);
  EXPECT_EQ(soft.alphaCutoff, 0.5f);
}

// A square that glows with 1 before black is seen as its coverage.
TEST_F(GltfMaterials, GrayMasksOfMtlLetTheRestThrough) {
  save("gray.tga", tga(1, 1, {{100}}));
  constexpr int kSide = 9, kMiddle = kSide * kSide / 2;
  const auto middle = [&](const std::string& dissolve) {
    save("m.mtl", "newmtl m\nKd 0 0 0\nKe 1 1 1\nmap_d gray.tga\n" + dissolve);
    const SceneDescription scene = loadObj(
        "mtllib m.mtl\nusemtl m\nvt 0 0\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
        "f 1/1 2/1 3/1 4/1\n");
    return pictureOf(scene, kSide)[kMiddle];
  };
  expectColor(middle(""), Rgb(100.0f / 255));
  expectColor(middle("d 0.5\n"), Rgb(50.0f / 255));
}

TEST_F(Mtl, BumpMapsOfHeightsBecomeNormals) {
  // The heights rise by 64 codes a texel to the right. The texture is 4 texels wide.
  const std::vector<std::vector<int>> ramp{{0}, {64}, {128}, {192}};
  save("h.tga", tga(4, 1, ramp));

  const SceneDescription scene = loadWith("map_Bump -bm 8 h.tga\n");
  const std::uint32_t texel = textureOf(scene, scene.materials[0].normalMap).texels[1];

  // The slope is 64/255 a texel, with 4 texels a tile and a scale of 8/64 of the tile.
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
