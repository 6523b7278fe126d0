// Textures with holes keep their color and their area in mip levels, whichever format names them.

#include "bake/mip_maps.h"
#include "gltf_pictures.h"

namespace whit {
namespace {

constexpr int kSide = 32;
constexpr std::uint32_t kGreen = 1023;  // codes of the leaf's green; all other texels are black
constexpr int kLeafWidth = 8, kLeafHeight = 16;

// The share of the leaf that is covered: bilinear lookups show some of the leaf up to half a texel
// beyond its edges.
constexpr double kShare =
    static_cast<double>(kLeafWidth * kLeafHeight) / ((kLeafWidth + 1) * (kLeafHeight + 1));

class MaskedLevels : public GltfMaterials {
 protected:
  MaskedLevels() {
    Texels leaf, color, mask;
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const bool isLeaf = x < kLeafWidth && y < kLeafHeight;
        leaf.push_back(isLeaf ? "00ff00ff" : "00000000");
        color.push_back(isLeaf ? "00ff00" : "000000");
        mask.push_back(isLeaf ? "ff" : "00");
      }
    }

    saveImage("leaf.tga", leaf, kSide);
    saveImage("color.tga", color, kSide);
    saveImage("mask.tga", mask, kSide);
  }

  void expectGreenLevels(const SceneDescription& description, bool isCovered) {
    const Scene scene = bake(description);
    const MipMaps maps(scene);

    int leaves = 0;
    for (const Material& m : scene.materials) {
      if (m.diffuseMap == kNoTexture) continue;
      ++leaves;

      const ShownMap color = shownMap(m, &Material::diffuseMap);
      ASSERT_EQ(maps.levels(color), 6);
      // The color of the leaf is spread over the transparent texels, so that no level has a dark
      // border.
      for (int level = 1; level < 6; ++level) {
        for (const std::uint32_t texel : maps.level(color, level).texels) {
          EXPECT_EQ(texel >> 10 & 1023u, kGreen) << "level " << level;
        }
      }

      EXPECT_EQ(m.coverageMap != kNoTexture, isCovered);
      if (!isCovered) continue;
      const std::uint32_t mean =
          maps.level(shownMap(m, &Material::coverageMap), 5).texels[0] & 255u;
      EXPECT_NEAR(mean / 255.0, kShare, 2.0 / 255);
    }

    EXPECT_EQ(leaves, 1);
  }

  SceneDescription gltf(const std::string& mode) {
    useImages({"leaf.tga"});
    return loadMaterial(matte("'baseColorTexture':{'index':0}", "'alphaMode':'" + mode + "'"));
  }

  SceneDescription obj(const std::string& maps) {
    save("m.mtl", "newmtl m\n" + maps);
    return loadObj(
        "mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
        "f 1/1 2/2 3/3\n");
  }

  SceneDescription sceneFile(const std::string& mask) {
    return loadMembers(
        "'textures': {'c': {'image': 'color.tga'}, 'm': {'image': 'mask.tga'}},'materials': {'m': "
        "{'diffuseMap': 'c', '" +
        mask + "': 'm'}}, 'scene': [{'shape': 'quad', 'material': 'm'}]");
  }
};

TEST_F(MaskedLevels, OfEveryFormat) {
  expectGreenLevels(gltf("MASK"), false);
  expectGreenLevels(gltf("BLEND"), true);
  expectGreenLevels(obj("map_Kd color.tga\nmap_d mask.tga\n"), false);
  expectGreenLevels(obj("map_Kd leaf.tga\n"), false);
  expectGreenLevels(sceneFile("alphaMap"), false);
  expectGreenLevels(sceneFile("coverageMap"), true);
}

}  // namespace
}  // namespace whit
