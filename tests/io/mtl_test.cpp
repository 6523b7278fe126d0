// What MTL statements mean.
#include "gltf_pictures.h"
#include "noun_members.h"

namespace whit {
namespace {

const std::string kBlender =
    "# Blender 3.4.1 MTL File: 'None'\n# www.blender.org\n\nnewmtl m\nNs 250\n";
constexpr char kSheet[] =
    "{'coverage': 0.25, 'transmission': 0, 'castsShadow': false, 'diffuse': 0.5}";

class Mtl : public SceneFileTest {
 protected:
  // Loads one triangle with the material m of this library.
  SceneDescription loadLibrary(const std::string& library) {
    save("m.mtl", library);
    return loadObj(
        "mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
        "f 1/1 2/2 3/3\n");
  }

  SceneDescription loadWith(const std::string& statements) {
    return loadLibrary("newmtl m\n" + statements);
  }

  Material materialOf(const std::string& statements) { return loadWith(statements).materials[0]; }
};

TEST_F(Mtl, MembersByStatements) {
  const std::pair<std::string, std::string> cases[] = {
      // One number stands for all three.
      {"Kd 0.1 0.2 0.3\nKs 0.4\nKe 1 2 3\n",
       "{'diffuse': [0.1,0.2,0.3], 'specular': 0.032, 'emission': [1,2,3], 'mirror': 0, "
       "'transmission': 0, 'castsShadow': true}"},
      {"", "{'diffuse': 0.8}"},
      {"\tkd 0.5 0.5 0.5  \nillum 2", "{'diffuse': 0.5}"},

      // alpha = sqrt(2 / (Ns + 2)) = 1/2 for Ns = 6, roughness its square root.
      {"Ns 6\n", "{'roughness': 0.70710678}"},
      {"Ns 0\n", "{'roughness': 1}"},
      {"Ns 6\nPr 0.25\n", "{'roughness': 0.25}"},
      {"Pr 0\n", "{'roughness': 0}"},

      // Below illum 3 a highlight is no mirror, however strong it is.
      {"Kd 0.5 0.5 0.5\nKs 1 1 1\nNs 10\nillum 2\n", "{'specular': 0.08, 'mirror': 0}"},
      {"Kd 1 1 1\nNs 900\n", "{'mirror': 0}"},
      {"Ks 0.9 0.9 0.9\nPr 0.6\nillum 3\n", "{'specular': 0.9, 'mirror': 0}"},
      {"Ks 0.9 0.9 0.9\nPr 0\nillum 3\n", "{'mirror': 0.9}"},

      // Half a metal is halfway from 0.04 to the color.
      {"Kd 0.8 0.4 0.2\nPm 1\n", "{'diffuse': 0, 'specular': [0.8,0.4,0.2]}"},
      {"Kd 0.8 0.4 0.2\nPm 0.5\n", "{'diffuse': [0.4,0.2,0.1], 'specular': [0.42,0.22,0.12]}"},

      // What is dissolved without refraction is seen through straight on.
      {"Kd 0.5 0.5 0.5\nNi 1.5\nd 0.25\n", kSheet},
      {"Kd 0.5 0.5 0.5\nNi 1.5\nd -halo 0.25\n", kSheet},
      {"Kd 0.5 0.5 0.5\nNi 1.5\nTr 0.75\n", kSheet},
      {"Kd 0.5 0.5 0.5\nNi 1.5\nd 0.25\nTr 0.1\n", kSheet},

      // Blender writes 1000 (1 - roughness)^2, and Ks 0.5 where its specular level is 0.5: F0 is
      // 0.04 as in the glTF file of the same material.
      {kBlender + "Ka 1 1 1\nKd 0.8 0.4 0.2\nKs 0.5 0.5 0.5\nKe 0 0 0\nNi 1.45\nd 1\nillum 2\n",
       "{'specular': 0.04, 'roughness': 0.5, 'diffuse': [0.8,0.4,0.2], 'mirror': 0}"},
      {kBlender + "Ka 1 1 1\nKd 0.8 0.4 0.2\nKs 0.5 0.5 0.5\nillum 3\n",
       "{'specular': [0.8,0.4,0.2], 'diffuse': 0, 'mirror': 0}"},
      {kBlender + "Kd 1 1 1\nKs 0.5 0.5 0.5\nNi 1.45\nd 0.25\nillum 9\n",
       "{'coverage': 0.25, 'transmission': 0}"},
  };
  for (const auto& [statements, members] : cases) {
    SCOPED_TRACE(statements);
    const bool isLibrary = statements.starts_with('#');
    const SceneDescription scene = isLibrary ? loadLibrary(statements) : loadWith(statements);
    EXPECT_EQ(scene.materials.at(0).name, "m");
    expectMembers(scene.materials[0], members);
  }
}

TEST_F(Mtl, IlluminationModels) {
  const auto lit = [&](const std::string& illum) {
    return materialOf("Kd 0.5 0.5 0.5\nKs 0.25 0.25 0.25\nTf 0.9 0.8 0.7\nNi 1.33\nillum " + illum +
                      "\n");
  };
  EXPECT_FALSE(lit("0").hasGlossy());
  EXPECT_FALSE(lit("1").hasGlossy());
  EXPECT_TRUE(lit("2").hasGlossy());
  EXPECT_FALSE(lit("2").hasTransmission());  // Tf is for glass

  for (const char* illum : {"3", "8"}) {
    expectMembers(lit(illum), "{'mirror': 0.25, 'mirrorGrazing': 0.25}");
    EXPECT_FALSE(lit(illum).hasGlossyReflection());
  }

  EXPECT_TRUE(lit("2").hasGlossyReflection());
  EXPECT_FALSE(lit("4").hasGlossyReflection());
  EXPECT_EQ(lit("5").mirrorGrazing, Rgb(1.0f));

  for (const char* illum : {"4\nd 0.25", "6\nd 0.25", "7\nd 0.25", "9\nd 0.25"}) {
    expectMembers(lit(illum),
                  "{'transmission': [0.9,0.8,0.7], 'ior': 1.33, 'mirror': 0, 'castsShadow': false, "
                  "'diffuse': 0.125}");
  }

  // Without Tf and Ni.
  expectMembers(materialOf("d 0.25\nillum 4\n"), "{'transmission': 0.75, 'ior': 1.5}");
}

TEST_F(Mtl, ValuesOutOfRangeAreClampedAndCounted) {
  EXPECT_EQ(materialOf("Kd 2 -1 0.5\n").diffuse, Rgb(1, 0, 0.5f));
  expectWarned("material color clamped to [0, 1]");
  EXPECT_EQ(materialOf("illum 4\nTf 1\nNi 0\n").ior, 1);
  expectWarned("index of refraction clamped to [1, 10]");
}

// A line that cannot be read is reported and left out; the other lines count.
TEST_F(Mtl, DamagedLinesAreLeftOut) {
  const std::string kind = "line of a material library that cannot be read left out";
  const std::pair<std::string, const char*> lines[] = {
      {"Kd red\n", "2: expected numbers after \"Kd\""},
      {"Kd spectral file.rfl 1\n", "2: expected numbers after \"Kd\""},
      {"Kd 1 1 x\n", "2: expected numbers after \"Kd\""},
      {"\n\nNs\n", "4: expected a number after \"Ns\""},
      {"Ns nan\n", "2: expected a number after \"Ns\""},
      {"map_Kd\n", "2: expected the name of a file after \"map_Kd\""},
      {"newmtl \n", "2: expected a name after \"newmtl\""}};

  for (const auto& [line, place] : lines) {
    SCOPED_TRACE(line);
    const SceneDescription scene = loadLibrary("newmtl n\n" + line + "newmtl m\nKe 2 2 2\n");
    EXPECT_EQ(scene.materials[0].emission, Rgb(2.0f));

    // With strict warnings it is an error.
    EXPECT_EQ(errorIfStrict(root_ + "m.obj"),
              joined("3 m.mtl:", place, ": ", kind, " (refused by --strict)"));
  }
  expectWarned(kind, std::size(lines));
}

// The texture has one texel. Its coordinates become u' = 0.25 + 2 u and v' = -0.5 + 3 v.
TEST_F(Mtl, OffsetAndScaleOfMaps) {
  saveImage("c.tga", {"ff0000"});
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
  expectNoWarnings();
}

// Maps of roughness are resampled for the coordinates of the color, if their offset is a number.
TEST_F(Mtl, OffsetsThatAreNotFiniteAreNotResampled) {
  saveImage("c.tga", {"ff0000", "00ff00"});
  for (const std::string offset : {"inf", "-inf", "nan", "0 nan"}) {
    EXPECT_FALSE(loadWith("map_Kd c.tga\nmap_Pr -o " + offset + " c.tga\n").materials.empty())
        << offset;
  }
}

// The material is metal on the left and plastic on the right, rough above and smooth below. The
// emission map is a factor of Ke, and stands alone where Ke is 0.
TEST_F(Mtl, MapsOfMetalnessRoughnessAndEmission) {
  saveImage("metal.tga", {"ff", "00"});
  saveImage("rough.tga", {"ff", "80"}, 2);
  saveImage("glow.tga", {"ff0000"});

  const SceneDescription scene = loadWith(
      "Kd 0.5 0.5 0.5\nKs 0.5 0.5 0.5\nmap_Pm metal.tga\nmap_Pr rough.tga\nKe 0 0 0\n"
      "map_Ke glow.tga\n");
  const Material& m = scene.materials[0];

  constexpr float kTexel = 2e-3f;  // 10 bits of a square root
  const Colors diffuse = colorsOf(scene, m.diffuseMap), specular = colorsOf(scene, m.specularMap);
  EXPECT_NEAR(diffuse[0].x * m.diffuse.x, 0, kTexel);
  EXPECT_NEAR(diffuse[1].x * m.diffuse.x, 0.5f, kTexel);
  EXPECT_NEAR(specular[0].x * m.specular.x, 0.5f, kTexel);
  EXPECT_NEAR(specular[1].x * m.specular.x, 0.04f, kTexel);

  EXPECT_EQ(m.roughness, 1);
  EXPECT_EQ(textureOf(scene, m.roughnessMap).texels[1] >> 8 & 0xffu, 128u);

  EXPECT_EQ(m.emission, Rgb(1.0f));
  EXPECT_EQ(colorsOf(scene, m.emissionMap)[0], Rgb(1, 0, 0));
  EXPECT_EQ(materialOf("Ke 3 2 1\nmap_Ke glow.tga\n").emission, Rgb(3, 2, 1));
}

// Other programs write names without regard to capitals, and with folders of another machine.
TEST_F(Mtl, NamesOfOtherSystems) {
  saveImage("Textures/Wood.tga", {"ff0000"});
  saveImage("Beside.TGA", {"ff0000"});

  for (const std::string name :
       {"textures\\wood.TGA", "C:\\Users\\me\\beside.tga", "../../beside.tga",
        "file:///C:/maps/Beside.TGA", "/home/me/BESIDE.tga"}) {
    EXPECT_NE(materialOf("map_Kd " + name + "\n").diffuseMap, kNoTexture) << name;
  }

  const std::string kind = "file taken whose name or folder differs from the one in the model";
  expectWarned(kind, 5);
  EXPECT_TRUE(
      hasText(warnings_.entries().at(kind).first, ": Textures/Wood.tga for textures/wood.TGA"));
}

// A file that the model may not name leaves the one beside the model.
TEST_F(Mtl, NamesThatLeaveTheFolder) {
  saveImage("../c.tga", {"ff0000"});
  saveImage("c.tga", {"00ff00"});
  for (const std::string& name : {std::string("../c.tga"), folder_ + "/c.tga"}) {
    const SceneDescription scene = loadWith("map_Kd " + name + "\n");
    ASSERT_NE(scene.materials[0].diffuseMap, kNoTexture) << name;
    EXPECT_EQ(colorsOf(scene, scene.materials[0].diffuseMap)[0], Rgb(0, 1, 0));
  }
}

TEST_F(Mtl, MapsByTheirKeys) {
  saveImage("c.tga", {"ff0000"});
  saveImage("n.tga", {"8080ff"});
  saveImage("d.tga", {"40"});

  const SceneDescription scene =
      loadWith("map_Kd c.tga\nKs 1 1 1\nmap_Ks c.tga\nnorm n.tga\nmap_d -clamp on d.tga\n");
  const Material& m = scene.materials[0];

  EXPECT_EQ(m.diffuse, Rgb(1.0f));  // without Kd the map is the color
  EXPECT_EQ(textureOf(scene, m.diffuseMap).format, TexelFormat::color);
  EXPECT_EQ(colorsOf(scene, m.diffuseMap)[0], Rgb(1, 0, 0));

  // The map of reflectances has F0: 0.08 times Ks times the texel.
  const Rgb f0 = colorsOf(scene, m.specularMap)[0] * m.specular;
  EXPECT_NEAR(f0.x, 0.08f, 1e-3f);
  EXPECT_EQ(f0.y, 0);

  EXPECT_EQ(textureOf(scene, m.normalMap).format, TexelFormat::data);
  EXPECT_EQ(textureOf(scene, m.normalMap).texels[0] & 0xffffffu, 0xff8080u);
  EXPECT_EQ(dataOf(scene, m.alphaMap)[0], 64);
  EXPECT_EQ(textureOf(scene, m.alphaMap).wrapU, Wrap::clamp);
  EXPECT_EQ(scene.textures.size(), 4u);

  // Maps of reflectances multiply.
  EXPECT_EQ(materialOf("Ks 0 0 0\nmap_Ks c.tga\n").specularMap, kNoTexture);
  EXPECT_NE(materialOf("map_Ks c.tga\n").specularMap, kNoTexture);
}

TEST_F(Mtl, NamesWithBlanksBackslashesAndOptions) {
  saveImage("a folder/c 1.tga", {"ff0000"});
  for (const std::string line :
       {"map_Kd a folder\\c 1.tga\r", "map_Kd -clamp off a folder/c 1.tga \t",
        "map_Kd -imfchan r a folder/c 1.tga", "map_Kd -bm 2 a folder/c 1.tga",
        "map_Kd -t 1 a folder/c 1.tga", "map_Kd -blendu on a folder/c 1.tga",
        "map_kd -mm 0 1 a folder/c 1.tga"}) {
    EXPECT_EQ(loadWith(line + "\n").textures.size(), 1u) << line;
  }

  for (const std::string option : {"-imfchan", "-t", "-mm"}) {
    expectWarned("texture option that is not supported: " + option);
  }
}

TEST_F(Mtl, MissingFilesAreLeftOut) {
  loadObj("mtllib ../../m.mtl\nusemtl m\n" + kTriangleObj);
  expectWarned("material library missing");

  for (const std::string name :
       {"none.png", "../../c.tga", "model://robot/c.png", "http://host/c.png"}) {
    EXPECT_EQ(materialOf("map_Kd " + name + "\n").diffuseMap, kNoTexture);
  }
  expectWarned("texture left out", 4);
}

// MeshLab writes the opacity as Tr, where others write 1 - d. A Tr of 1 of others would make the
// material invisible.
TEST_F(Mtl, TransparencyOfMeshLabIsOpacity) {
  const auto coverage = [&](const std::string& library) {
    return loadLibrary(library).materials[0].coverage;
  };

  const std::string head =
      "#\n# Wavefront material file\n# Converted by Meshlab Group\n#\nnewmtl m\n";
  EXPECT_EQ(coverage(head + "Tr 1\nillum 2\n"), 1);
  EXPECT_EQ(coverage(head + "Tr 0.75\n"), 0.75f);
  EXPECT_EQ(coverage(head + "Kd 1 1 1\n"), 1);
  expectNoWarnings();

  // The comment counts at the beginning of the file only.
  EXPECT_EQ(coverage("newmtl m\nTr 0.75\n# Converted by Meshlab Group\n"), 0.25f);
  EXPECT_EQ(coverage("newmtl m\nTr 1\n"), 1);
  expectWarned("material that Tr 1 makes invisible taken as opaque");

  EXPECT_EQ(materialOf("Tr 1\nillum 4\n").transmission, Rgb(1.0f));
  EXPECT_EQ(materialOf("d 0\n").coverage, 0);
  expectWarned("material that Tr 1 makes invisible taken as opaque");
}

TEST_F(Mtl, AlphaOfTheColorCuts) {
  saveImage("cut.tga", {"ff0000ff", "ff00000a"});
  saveImage("solid.tga", {"ff0000ff", "ff0000ff"});
  saveImage("mask.tga", {"07", "09"});
  const auto alphaOf = [&](const std::string& statements) {
    const SceneDescription scene = loadWith(statements);
    return dataOf(scene, scene.materials[0].alphaMap).at(1);
  };

  EXPECT_EQ(alphaOf("map_Kd cut.tga\n"), 10);
  EXPECT_EQ(materialOf("map_Kd solid.tga\n").alphaMap, kNoTexture);
  EXPECT_EQ(alphaOf("map_Kd cut.tga\nmap_d mask.tga\n"), 9);
  EXPECT_EQ(alphaOf("map_Kd cut.tga\nmap_d cut.tga\n"), 10);
}

// "The map_d value is multiplied by the d value". Masks stay masks though their edges are soft.
TEST_F(Mtl, GrayMasksAreCoverage) {
  saveImage("gray.tga", {"64", "c8"});
  const SceneDescription gray = loadWith("d 0.5\nmap_d gray.tga\n");
  const Material& m = gray.materials[0];
  EXPECT_EQ(m.coverage, 0.5f);
  EXPECT_TRUE(m.thin);
  EXPECT_EQ(m.coverageMap, m.alphaMap);
  EXPECT_EQ(m.alphaCutoff, kClearCoverage);
  EXPECT_EQ(dataOf(gray, m.coverageMap)[0], 100);

  saveImage("color.tga", {"ff000064"});
  const SceneDescription color = loadWith("map_Kd color.tga\n");
  ASSERT_NE(color.materials[0].coverageMap, kNoTexture);
  EXPECT_EQ(dataOf(color, color.materials[0].coverageMap)[0], 100);

  saveImage("soft.tga", {"00", "64", "c8", "ff"});
  const Material soft = materialOf("map_d soft.tga\n");
  EXPECT_NE(soft.alphaMap, kNoTexture);
  EXPECT_EQ(soft.coverageMap, kNoTexture);
  EXPECT_EQ(soft.alphaCutoff, 0.5f);
}

// A square that glows with 1 before black is seen as its coverage.
TEST_F(GltfMaterials, GrayMasksOfMtlLetTheRestThrough) {
  saveImage("gray.tga", {"64"});
  constexpr int kSide = 9, kMiddle = kSide * kSide / 2;
  for (const float dissolve : {1.0f, 0.5f}) {
    save("m.mtl", joined("newmtl m\nKd 0 0 0\nKe 1 1 1\nmap_d gray.tga\nd ", dissolve, "\n"));
    const SceneDescription scene = loadObj(
        "mtllib m.mtl\nusemtl m\nvt 0 0\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
        "f 1/1 2/1 3/1 4/1\n");
    expectColor(pictureOf(scene, kSide)[kMiddle], Rgb(dissolve * 100 / 255));
  }
}

TEST_F(Mtl, BumpMapsOfHeightsBecomeNormals) {
  // The heights rise by 64 codes a texel to the right. The texture is 4 texels wide.
  saveImage("h.tga", {"00", "40", "80", "c0"});
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
  saveImage("n.tga", {"6496fa"});
  saveImage("g.tga", {"646862"});
  const SceneDescription normals = loadWith("bump n.tga\n"), flat = loadWith("map_bump g.tga\n");
  EXPECT_EQ(textureOf(normals, normals.materials[0].normalMap).texels[0] & 0xffffffu, 0xfa9664u);
  EXPECT_EQ(textureOf(flat, flat.materials[0].normalMap).texels[0] >> 16 & 0xffu, 255u);
}

}  // namespace
}  // namespace whit
