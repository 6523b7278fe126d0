#include "io/image/texture_from_image.h"
#include "image_samples.h"

namespace whit {
namespace {

// Return images of one row.
RawImage codes(int channels, const Bytes& values) {
  RawImage raw;
  raw.channels = channels;
  raw.width = static_cast<int>(values.size()) / channels;
  raw.height = 1;
  raw.codes = values;
  return raw;
}

RawImage floats(int channels, const std::vector<float>& values) {
  RawImage raw = codes(channels, Bytes(values.size()));
  raw.codes = {};
  raw.linear = true;
  raw.values = values;
  return raw;
}

// The table gives just what encoding each color by itself would.
TEST(TextureFromImage, ColorCodesAreEncodedAsTheirLinearLight) {
  for (int code = 0; code < 256; ++code) {
    const RawImage raw = codes(3, {byteOf(code), byteOf(255 - code), 7});
    EXPECT_EQ(makeTexture("t", raw, TexelFormat::color).texels,
              std::vector{encodeColorTexel(linearPixel(raw, 0))});
  }
}

TEST(TextureFromImage, DataCodesAreKept) {
  const auto texel = [](const Bytes& values) {
    return makeTexture("t", codes(static_cast<int>(values.size()), values), TexelFormat::data)
        .texels.at(0);
  };
  EXPECT_EQ(texel({1, 2, 3, 4}), 0x04030201u);
  EXPECT_EQ(texel({1, 2, 3}), 0xff030201u);
  EXPECT_EQ(texel({1, 2}), 0x02010101u);
  EXPECT_EQ(texel({9}), 0xff090909u);
}

TEST(TextureFromImage, LinearValuesAreEncoded) {
  EXPECT_EQ(makeTexture("t", floats(3, {0.25f, 1, 7}), TexelFormat::color).texels[0],
            encodeColorTexel({0.25f, 1, 1}));
  EXPECT_EQ(makeTexture("t", floats(1, {1}), TexelFormat::data).texels[0], 0xffffffffu);
}

// Only emission that goes beyond 1 is stored in another format than other colors.
TEST(TextureFromImage, EmissionAboveOneKeepsItsRange) {
  Warnings warnings;
  const Texture bright = makeEmissionTexture("t", floats(3, {8, 0.5f, 3, 0, 0.25f, 1}), warnings);
  EXPECT_EQ(bright.format, TexelFormat::radiance);
  EXPECT_EQ(decodeRadianceTexel(bright.texels.at(0)), (Rgb{8, 0.5f, 3}));
  EXPECT_EQ(decodeRadianceTexel(bright.texels.at(1)), (Rgb{0, 0.25f, 1}));

  // Emission of at most 1 is stored as a color.
  const RawImage dim = floats(3, {0.25f, 1, 0.1f}), coded = codes(3, {255, 128, 0});
  for (const RawImage* raw : {&dim, &coded}) {
    const Texture color = makeEmissionTexture("t", *raw, warnings);
    EXPECT_EQ(color.format, TexelFormat::color);
    EXPECT_EQ(color.texels, makeTexture("t", *raw, TexelFormat::color).texels);
  }

  // A large alpha does not make the emission bright.
  EXPECT_EQ(makeEmissionTexture("t", floats(4, {1, 1, 1, 7}), warnings).format, TexelFormat::color);
  EXPECT_TRUE(warnings.entries().empty());
}

TEST(TextureFromImage, EmissionBeyondTheLargestIsClampedAndCounted) {
  Warnings warnings;
  const Texture t = makeEmissionTexture("sun", floats(1, {1e6f, 2, 65409}), warnings);
  EXPECT_EQ(decodeRadianceTexel(t.texels.at(0)), Rgb(kLargestRadianceTexel));
  EXPECT_EQ(warnings.entries().at("emission texel above 65408 clamped").count, 2u);
}

TEST(TextureFromImage, KeepsNameSizeAndOrder) {
  RawImage raw = codes(1, {1, 2, 3, 4, 5, 6});
  raw.width = 2;
  raw.height = 3;

  const Texture texture = makeTexture("wood", raw, TexelFormat::data);
  EXPECT_EQ(texture.name, "wood");
  EXPECT_EQ(texture.format, TexelFormat::data);
  EXPECT_EQ(texture.width, 2);
  EXPECT_EQ(texture.height, 3);
  for (const auto i : indices(6)) EXPECT_EQ(texture.texels[i] & 255, i + 1);
}

TEST(EnvironmentFromImage, HasLinearPlanes) {
  const EnvironmentImage linear = makeEnvironment(floats(3, {1, 20, 300, 4, 5, 6}));
  EXPECT_EQ(linear.width, 2);
  EXPECT_EQ(linear.height, 1);
  EXPECT_EQ(linear.r, (std::vector<float>{1, 4}));
  EXPECT_EQ(linear.g, (std::vector<float>{20, 5}));
  EXPECT_EQ(linear.b, (std::vector<float>{300, 6}));

  const EnvironmentImage gray = makeEnvironment(floats(1, {0.5f}));
  EXPECT_EQ(gray.b, (std::vector<float>{0.5f}));

  const EnvironmentImage encoded = makeEnvironment(codes(4, {255, 10, 0, 77}));
  EXPECT_EQ(encoded.r[0], 1);
  EXPECT_FLOAT_EQ(encoded.g[0], static_cast<float>(10 / 255.0 / 12.92));
  EXPECT_EQ(encoded.b[0], 0);
}

}  // namespace
}  // namespace whit
