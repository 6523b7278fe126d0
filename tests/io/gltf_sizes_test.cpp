// Images of one material that differ in size or sampler: what is made of them shows each as it is
// alone. glTF 2.0, sections 3.8.4 and 3.9.2.
#include "gltf_pictures.h"

namespace whit {
namespace {

constexpr char kRoughly[] =
    "textures of one material have different samplers; that of the first is used for all";
constexpr char kByTexel[] = "'magFilter':9728", kTiled[] = "'wrapS':10497",
               kClamped[] = "'wrapS':33071", kMirrored[] = "'wrapS':33648";

// Metal, in the blue channel, takes the diffuse color. Base color is red beside green.
class GltfSizes : public GltfMaterials {
 protected:
  static Texels plastic(std::size_t count) { return Texels(count, "008000"); }

  // A row of no metal, but for one texel.
  static Texels metalAt(std::size_t i, std::size_t count) {
    Texels texels = plastic(count);
    texels[i] = "0080ff";
    return texels;
  }

  static std::string mixed(const std::string& metallic = "1") {
    return "{'pbrMetallicRoughness':{'baseColorTexture':{'index':0},'metallicFactor':" + metallic +
           ",'metallicRoughnessTexture':{'index':1}}}";
  }

  // Returns the texture that is made of the two with this sampler, and its colors.
  std::pair<Texture, Colors> made(const Texels& base, const Texels& metal,
                                  const std::string& sampler) {
    useRows({base, metal}, sampler);
    const SceneDescription d = loadMaterial(mixed());
    const std::int32_t map = d.materials[0].diffuseMap;
    return {textureOf(d, map), colorsOf(d, map)};
  }

  // Expects one row of texels whose shares of red are given, times what is no metal.
  static void expectRow(const Colors& colors, const std::vector<float>& reds,
                        const std::vector<float>& rest) {
    Colors wanted;
    for (std::size_t i = 0; i < reds.size(); ++i) {
      wanted.push_back(Rgb{reds[i], 1 - reds[i], 0} * rest[i]);
    }
    EXPECT_EQ(colors.size(), wanted.size());
    expectColors(colors, wanted);
  }

  const Texels base_{"ff0000", "00ff00"};
};

// Each of the two texels becomes three, whose centers lie 1/3 of a texel apart.
TEST_F(GltfSizes, TheSmallerOneIsInterpolatedWithItsWrapMode) {
  const float third = 1.0f / 3;
  const std::vector<float> clamped{1, 1, 2 * third, third, 0, 0};
  const std::pair<const char*, std::vector<float>> cases[] = {
      {kTiled, {2 * third, 1, 2 * third, third, 0, third}},
      {kClamped, clamped},
      {kMirrored, clamped}};
  for (const auto& [sampler, reds] : cases) {
    SCOPED_TRACE(sampler);
    expectRow(made(base_, metalAt(3, 6), sampler).second, reds, {1, 1, 1, 0, 1, 1});
  }
  expectNoWarnings();

  expectRow(made(Texels(6, "ff0000"), metalAt(1, 2), kClamped).second, {1, 1, 1, 1, 1, 1}, clamped);
}

// Edges of both lie between texels of 6 columns.
TEST_F(GltfSizes, TexelsThatAreNotInterpolatedKeepTheirSizes) {
  const auto [texture, colors] = made(base_, metalAt(1, 3), kByTexel);
  expectRow(colors, {1, 1, 1, 0, 0, 0}, {1, 1, 0, 0, 1, 1});
  EXPECT_TRUE(texture.nearest);
  expectNoWarnings();
}

TEST_F(GltfSizes, TexelsThatCannotKeepTheirSizesAreCounted) {
  EXPECT_EQ(made(Texels(254, "ff0000"), metalAt(7, 255), kByTexel).first.width, 255);
  expectWarned(kRoughly);
}

TEST_F(GltfSizes, SamplersThatDifferAreCounted) {
  saveImage("base.tga", base_);
  saveImage("metal.tga", metalAt(1, 2));
  for (const auto& [first, second] :
       {std::pair{kTiled, kClamped}, std::pair{kMirrored, kTiled}, std::pair{kByTexel, kTiled}}) {
    SCOPED_TRACE(first);
    useImages({"base.tga", "metal.tga"}, {first, second});
    expectWarnings(kRoughly, {{mixed(), 1}});
  }
}

// A metalness that is the same everywhere, or that a factor of 0 takes away, leaves the base color
// as a file without the image has it.
TEST_F(GltfSizes, AnEvenMetalnessChangesNoTexel) {
  saveImage("base.tga", base_);
  saveImage("even.tga", Texels(15, "078033"), 3);
  saveImage("uneven.tga", metalAt(4, 15), 3);
  const auto pictureOfFile = [&](const std::string& image, const std::string& material) {
    useImages({"base.tga", image}, {kTiled, kClamped});
    return picture(material, 16);
  };
  const auto bare = [](const std::string& metallic) {
    return joined("{'pbrMetallicRoughness':{'baseColorTexture':{'index':0},'roughnessFactor':",
                  128 / 255.0, ",'metallicFactor':", metallic, "}}");
  };

  expectColors(pictureOfFile("even.tga", mixed()), pictureOfFile("even.tga", bare("0.2")));
  expectColors(pictureOfFile("uneven.tga", mixed("0")), pictureOfFile("uneven.tga", bare("0")));
  expectNoWarnings();
}

// The metalness, 0 in its only texel, says nothing of the size. By the factor alone the material
// would be metal.
TEST_F(GltfSizes, AColorOfTheReflectionKeepsItsTexels) {
  useRows({base_, plastic(1)}, kTiled);
  const SceneDescription d = loadMaterial(
      "{'pbrMetallicRoughness':{'metallicRoughnessTexture':{'index':1}},"
      "'extensions':{'KHR_materials_specular':{'specularColorTexture':{'index':0}}}}");

  const Material& m = d.materials[0];
  const Colors colors = colorsOf(d, m.specularMap);
  ASSERT_EQ(colors.size(), 2u);
  expectColors({colors[0] * m.specular, colors[1] * m.specular}, {{0.04f, 0, 0}, {0, 0.04f, 0}});
}

}  // namespace
}  // namespace whit
