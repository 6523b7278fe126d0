// Images of one material that differ in size or sampler: what is made of them shows each as it is
// alone. glTF 2.0, sections 3.8.4 and 3.9.2.
#include <array>

#include "decoded_texel.h"
#include "gltf_pictures.h"

namespace whit {
namespace {

constexpr char kRoughly[] =
    "textures of one material have different samplers; that of the first is used for all";
constexpr char kByTexel[] = "\"magFilter\":9728", kTiled[] = "\"wrapS\":10497",
               kClamped[] = "\"wrapS\":33071", kMirrored[] = "\"wrapS\":33648";

// Metal, in the blue channel, takes the diffuse color. Base color is red beside green.
class GltfSizes : public GltfMaterials {
 protected:
  using Pixels = std::vector<std::vector<int>>;

  void SetUp() override {
    GltfMaterials::SetUp();
    save("base.tga", tga(2, 1, {{255, 0, 0}, {0, 255, 0}}));
  }

  static Pixels gray(std::size_t count) { return Pixels(count, {0, 128, 0}); }

  // Two textures, each with a sampler of its own.
  void useTwo(const std::string& second, const std::string& baseSampler,
              const std::string& metalSampler) {
    images_ =
        R"(,"images":[{"uri":"base.tga"},{"uri":")" + second +
        R"("}],"textures":[{"source":0,"sampler":0},{"source":1,"sampler":1}],"samplers":[{)" +
        baseSampler + "},{" + metalSampler + "}]";
  }

  static std::string mixed(const std::string& metallic = "1") {
    return "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0},\"metallicFactor\":" +
           metallic + ",\"metallicRoughnessTexture\":{\"index\":1}}}";
  }

  Texture diffuseOf(const std::string& material) {
    const SceneDescription d = loadText(sceneText({{0, material, 1}}));
    return d.textures.at(static_cast<std::size_t>(d.materials[0].diffuseMap));
  }

  // Expects one row of texels whose shares of red are given, times what is no metal.
  static void expectRow(const Texture& made, const std::vector<float>& reds,
                        const std::vector<float>& rest) {
    ASSERT_EQ(made.width, static_cast<int>(reds.size()));
    ASSERT_EQ(made.height, 1);
    for (std::size_t i = 0; i < reds.size(); ++i) {
      SCOPED_TRACE(i);
      expectColor(decodeColorTexel(made.texels[i]), Rgb{reds[i], 1 - reds[i], 0} * rest[i]);
    }
  }
};

// Each of the two texels becomes three, whose centers lie 1/3 of a texel apart.
TEST_F(GltfSizes, ASmallerBaseColorIsInterpolatedWithItsWrapMode) {
  Pixels metal = gray(6);
  metal[3][2] = 255;
  save("metal.tga", tga(6, 1, metal));
  const std::vector<float> rest{1, 1, 1, 0, 1, 1};
  const float third = 1.0f / 3;

  useTwo("metal.tga", kTiled, kTiled);
  const Texture repeated = diffuseOf(mixed());
  useTwo("metal.tga", kClamped, kClamped);
  const Texture clamped = diffuseOf(mixed());
  useTwo("metal.tga", kMirrored, kMirrored);
  const Texture mirrored = diffuseOf(mixed());

  expectRow(repeated, {2 * third, 1, 2 * third, third, 0, third}, rest);
  expectRow(clamped, {1, 1, 2 * third, third, 0, 0}, rest);
  expectRow(mirrored, {1, 1, 2 * third, third, 0, 0}, rest);
  EXPECT_EQ(kinds(), "");
}

TEST_F(GltfSizes, ASmallerMetalnessIsInterpolated) {
  save("base.tga", tga(6, 1, Pixels(6, {255, 0, 0})));
  save("metal.tga", tga(2, 1, {{0, 128, 0}, {0, 128, 255}}));
  useTwo("metal.tga", kClamped, kClamped);
  const float third = 1.0f / 3;

  const Texture made = diffuseOf(mixed());

  expectRow(made, std::vector<float>(6, 1), {1, 1, 2 * third, third, 0, 0});
}

// Edges of both lie between texels of 6 columns.
TEST_F(GltfSizes, TexelsThatAreNotInterpolatedKeepTheirSizes) {
  save("metal.tga", tga(3, 1, {{0, 128, 0}, {0, 128, 255}, {0, 128, 0}}));
  useTwo("metal.tga", kByTexel, kByTexel);

  const Texture made = diffuseOf(mixed());

  expectRow(made, {1, 1, 1, 0, 0, 0}, {1, 1, 0, 0, 1, 1});
  EXPECT_TRUE(made.nearest);
  EXPECT_EQ(kinds(), "");
}

TEST_F(GltfSizes, TexelsThatCannotKeepTheirSizesAreCounted) {
  save("base.tga", tga(254, 1, Pixels(254, {255, 0, 0})));
  Pixels metal = gray(255);
  metal[7][2] = 255;
  save("metal.tga", tga(255, 1, metal));
  useTwo("metal.tga", kByTexel, kByTexel);

  const Texture made = diffuseOf(mixed());

  EXPECT_EQ(made.width, 255);
  EXPECT_EQ(warned(kRoughly), 1u);
}

TEST_F(GltfSizes, SamplersThatDifferAreCounted) {
  save("metal.tga", tga(2, 1, {{0, 128, 0}, {0, 128, 255}}));

  for (const auto& [first, second] : {std::array{kTiled, kClamped}, std::array{kMirrored, kTiled},
                                      std::array{kByTexel, kTiled}}) {
    const std::uint64_t before = warned(kRoughly);
    useTwo("metal.tga", first, second);
    diffuseOf(mixed());
    EXPECT_EQ(warned(kRoughly), before + 1) << first << ' ' << second;
  }
}

// A metalness that is the same everywhere, or that a factor of 0 takes away, leaves the base color
// as a file without the image has it.
TEST_F(GltfSizes, AnEvenMetalnessChangesNoTexel) {
  save("even.tga", tga(5, 3, Pixels(15, {7, 128, 51})));
  Pixels uneven = gray(15);
  uneven[4][2] = 255;
  save("uneven.tga", tga(5, 3, uneven));
  const auto pictureOfFile = [&](const std::string& image, const std::string& material) {
    useTwo(image, kTiled, kClamped);
    return picture({{0, material, 1}}, 16);
  };
  const auto bare = [](const std::string& metallic) {
    return "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0},\"roughnessFactor\":" +
           std::to_string(128 / 255.0) + ",\"metallicFactor\":" + metallic + "}}";
  };

  const auto even = pictureOfFile("even.tga", mixed());
  const auto without = pictureOfFile("even.tga", bare("0.2"));
  const auto dielectric = pictureOfFile("uneven.tga", mixed("0"));
  const auto plain = pictureOfFile("uneven.tga", bare("0"));

  for (std::size_t i = 0; i < even.size(); ++i) {
    SCOPED_TRACE(i);
    expectColor(even[i], without[i]);
    expectColor(dielectric[i], plain[i]);
  }
  EXPECT_EQ(kinds(), "");
}

// The metalness, 0 in its only texel, says nothing of the size. By the factor alone the material
// would be metal.
TEST_F(GltfSizes, AColorOfTheReflectionKeepsItsTexels) {
  save("metal.tga", tga(1, 1, gray(1)));
  useTwo("metal.tga", kTiled, kTiled);
  const std::string material =
      "{\"pbrMetallicRoughness\":{\"metallicRoughnessTexture\":{\"index\":1}},\"extensions\":{"
      "\"KHR_materials_specular\":{\"specularColorTexture\":{\"index\":0}}}}";

  const SceneDescription d = loadText(sceneText({{0, material, 1}}));

  const Texture& made = d.textures.at(static_cast<std::size_t>(d.materials[0].specularMap));
  ASSERT_EQ(made.texels.size(), 2u);
  const Rgb all = d.materials[0].specular;
  expectColor(all * decodeColorTexel(made.texels[0]), {0.04f, 0, 0});
  expectColor(all * decodeColorTexel(made.texels[1]), {0, 0.04f, 0});
}

}  // namespace
}  // namespace whit
