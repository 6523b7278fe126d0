// Emission maps from images that hold radiance: what is above 1 stays above 1.
#include "gltf_pictures.h"

namespace whit {
namespace {

// Largest error of a channel, relative to the largest channel of its texel: TexelFormat::radiance
// keeps 9 bits a channel and a shared exponent. Conversions add a few roundings.
constexpr float kOfTheLargest = 1.0f / 512 + 1e-6f;

const Colors kTexels{{8, 6.5f, 0.3f}, {60000, 41234, 999}};

// Expects these colors at the beginning of a picture.
void expectTexels(const Colors& pixels, const Colors& wanted) {
  ASSERT_GE(pixels.size(), wanted.size());
  for (const auto i : indices(wanted)) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(pixels[i][c], wanted[i][c], maxComponent(wanted[i]) * kOfTheLargest)
          << "pixel " << i << " channel " << c;
    }
  }
}

class EmissionRange : public GltfMaterials {
 protected:
  void saveExr(const Colors& texels) const {
    Image image(static_cast<int>(texels.size()), 1);
    image.pixels = texels;
    writeExr(root_ + "glow.exr", image, {});
  }

  // Returns pixels that each see the middle of one texel, traced in packets or by the reference.
  Colors pixels(bool reference) {
    return pixelsOf(
        bake(loadMembers(
            "'size': [2, 1], 'cameras': {'above': {'eye': [0, 3, 0], 'at': [0, 0, 0], 'up': [0, 0, "
            "-1], 'orthographicHeight': 1}}, 'textures': {'glow': {'image': 'glow.exr', 'wrap': "
            "'clamp'}}, 'materials': {'lamp': {'diffuse': 0, 'emission': [1, 1, 1], 'emissionMap': "
            "'glow'}}, 'scene': [{'shape': 'quad', 'width': 2, 'depth': 1, 'material': 'lamp'}]")),
        reference);
  }
};

TEST_F(EmissionRange, OfExrFilesIsKept) {
  saveExr(kTexels);
  for (const bool reference : {true, false}) expectTexels(pixels(reference), kTexels);
  expectNoWarnings();
}

// Reflectances are at most 1.
TEST_F(EmissionRange, OfReflectancesIsCutAndCounted) {
  saveExr(kTexels);
  const Scene scene = bake(loadMembers(
      "'textures': {'bright': {'image': 'glow.exr'}}, 'materials': {'m': {'diffuseMap': "
      "'bright'}}, 'scene': [{'shape': 'quad', 'width': 2, 'depth': 1, 'material': 'm'}]"));

  EXPECT_EQ(scene.textures[0].format, TexelFormat::color);
  expectWarned("color texel above 1 clamped", 2);
}

// Two pixels in RGBE: 128 / 256 * 2^(132 - 128) = 8, and 192 / 256 * 2^(138 - 128) = 768.
TEST_F(EmissionRange, OfGltfModelsIsKept) {
  save("glow.hdr",
       "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x40\x20\x84\xc0\xc0\x60\x8a");
  useImages({"glow.hdr"});
  for (const std::string& material :
       {matte("'baseColorFactor':[0,0,0,1]",
              "'emissiveFactor':[1,1,1],'emissiveTexture':{'index':0}"),
        std::string("{'pbrMetallicRoughness':{'baseColorTexture':{'index':0}},"
                    "'extensions':{'KHR_materials_unlit':{}}}")}) {
    expectTexels(picture(material, 2), {{8, 4, 2}, {768, 768, 384}});
  }
}

// An image whose codes cannot exceed 1 is decoded once for both maps.
TEST_F(EmissionRange, ImagesOfCodesAreSharedWithOtherMaps) {
  saveImage("t.tga", {"c86432"});
  const SceneDescription scene = loadMembers(
      "'textures': {'t': {'image': 't.tga'}}, 'materials': {'m': {'diffuseMap': 't', 'emission': "
      "1, 'emissionMap': 't'}}, 'scene': [{'shape': 'quad', 'material': 'm'}]");

  ASSERT_EQ(scene.textures.size(), 1u);
  EXPECT_EQ(scene.textures[0].format, TexelFormat::color);
}

}  // namespace
}  // namespace whit
