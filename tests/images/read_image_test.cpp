// Reading 8-bit and Radiance files: every sample's pixels are known from how its bytes were made.
#include "core/display.h"
#include "image_samples.h"
#include "io/files.h"
#include "io/image/image_layers.h"
#include "source_files.h"

namespace whit {
namespace {

using ReadImage = ImageTest;

const Bytes kSixPixels = {255, 0, 0, 0, 255, 0, 0, 0, 255, 10, 20, 30, 40, 50, 60, 70, 80, 90};

void expectSixPixels(const RawImage& image) {
  EXPECT_EQ(image.width, 3);
  EXPECT_EQ(image.height, 2);
  EXPECT_EQ(image.channels, 3);
  EXPECT_FALSE(image.linear);
  EXPECT_TRUE(image.values.empty());
  EXPECT_EQ(image.codes, kSixPixels);
}

TEST_F(ReadImage, EightBitsKeepTheirCodes) {
  Bytes rows = {0};
  append(rows, slice(kSixPixels, 0, 9));
  rows.push_back(0);
  append(rows, slice(kSixPixels, 9));

  expectSixPixels(read("a.TGA", tga(3, 2, kSixPixels)));
  expectSixPixels(read("a.bmp", bmp(3, 2, kSixPixels)));
  expectSixPixels(read("a.png", png(3, 2, 8, 2, rows)));
  expectSixPixels(read("a.jpg", bmp(3, 2, kSixPixels)));  // the content counts more than the name
}

TEST_F(ReadImage, PngOfEveryChannelCount) {
  EXPECT_EQ(read("1.png", png(1, 1, 8, 0, {0, 7})).codes, (Bytes{7}));
  EXPECT_EQ(read("2.png", png(1, 1, 8, 4, {0, 7, 8})).codes, (Bytes{7, 8}));
  EXPECT_EQ(read("4.png", png(1, 1, 8, 6, {0, 1, 2, 3, 4})).codes, (Bytes{1, 2, 3, 4}));
}

// A code of 8 bits is 257 of 16 bits: 0x0080 and 0x0081 lie on both sides of a half.
TEST_F(ReadImage, SixteenBitPngIsRounded) {
  const RawImage image =
      read("a.png", png(4, 1, 16, 0, {0, 0x12, 0xff, 0xff, 0xff, 0x00, 0x80, 0x00, 0x81}));
  EXPECT_EQ(image.channels, 1);
  EXPECT_EQ(image.codes, (Bytes{0x13, 0xff, 0x00, 0x01}));
}

TEST_F(ReadImage, JpegOfOneCoefficient) {
  const RawImage image = read("a.jpg", jpegGray200());
  EXPECT_EQ(image.channels, 1);
  EXPECT_EQ(image.codes, Bytes(64, 200));
}

// The inks are 200, 150, 100 and 128 of 255. With Adobe's mark the codes mean the light that the
// inks let through.
TEST_F(ReadImage, JpegOfInks) {
  const auto expectCodes = [&](const Bytes& file, int r, int g, int b) {
    const RawImage image = read("a.jpg", file);
    ASSERT_EQ(image.channels, 3);
    ASSERT_EQ(image.codes.size(), 192u);
    EXPECT_NEAR(image.codes[0], r, 1);
    EXPECT_NEAR(image.codes[190], g, 1);
    EXPECT_NEAR(image.codes[191], b, 1);
  };

  const auto file = [](const std::string& name) {
    return load(sourceFile("tests/fuzz/corpus/jpeg/" + name));
  };

  Bytes flat = file("inksFlat.jpg");
  expectCodes(flat, 100, 75, 50);
  expectCodes(file("ycck.jpg"), 100, 75, 50);
  ASSERT_EQ(flat.at(3), 0xee);  // APP14
  flat.erase(flat.begin() + 2, flat.begin() + 18);
  expectCodes(flat, 27, 52, 77);
}

// value = mantissa * 2^(exponent - 136); exponent 0 is black whatever the mantissa.
TEST_F(ReadImage, RadianceIsLinear) {
  const RawImage image = read(
      "a.hdr", hdr(2, 2, {128, 64, 32, 129, 255, 1, 0, 255, 200, 200, 200, 0, 1, 128, 255, 1}));
  EXPECT_TRUE(image.linear);
  EXPECT_EQ(image.channels, 3);

  const std::vector<float> expected = {
      1, 0.5f, 0.25f, std::ldexp(255.0f, 119), std::ldexp(1.0f, 119),    0,
      0, 0,    0,     std::ldexp(1.0f, -135),  std::ldexp(128.0f, -135), std::ldexp(255.0f, -135)};
  EXPECT_EQ(image.values, expected);
}

TEST_F(ReadImage, RadianceWithRunLengths) {
  const RawImage image = read("a.hdr", hdrRuns(9, 2, {128, 64, 0, 128}));
  ASSERT_EQ(image.values.size(), 54u);
  for (const auto i : indices(18)) EXPECT_EQ(linearPixel(image, i), Rgb(0.5f, 0.25f, 0));
}

TEST_F(ReadImage, ReadImageDecodesSrgb) {
  const Image image = readImage(save("a.bmp", bmp(3, 2, kSixPixels)), limits_);
  EXPECT_EQ(image.window, (Crop{0, 0, 3, 2}));
  EXPECT_EQ(image.at(0, 0), Rgb(1, 0, 0));

  // IEC 61966-2-1 by hand: code 10 is on the straight part, 90 on the power part.
  EXPECT_FLOAT_EQ(image.at(0, 1).x, static_cast<float>(10 / 255.0 / 12.92));
  EXPECT_FLOAT_EQ(image.at(2, 1).z,
                  static_cast<float>(std::pow((90 / 255.0 + 0.055) / 1.055, 2.4)));
}

// The colors are premultiplied, as those of EXR files are.
TEST_F(ReadImage, GrayIsSpreadAndMultipliedByAlpha) {
  const Image image = readImage(save("a.png", png(1, 1, 8, 4, {0, 255, 9})), limits_);
  EXPECT_EQ(image.at(0, 0), Rgb(9.0f / 255));
}

// Pictures that are compared keep all bits of a PNG, of which textures have 8.
TEST_F(ReadImage, PicturesKeepSixteenBits) {
  const Image gray =
      readImage(save("g.png", png(2, 1, 16, 0, {0, 0x12, 0x34, 0x12, 0x35})), limits_);
  EXPECT_EQ(gray.at(0, 0), Rgb(static_cast<float>(srgbToLinear(0x1234 / 65535.0))));
  EXPECT_EQ(gray.at(1, 0), Rgb(static_cast<float>(srgbToLinear(0x1235 / 65535.0))));

  const std::string clear = save("a.png", png(1, 1, 16, 4, {0, 255, 255, 0x80, 1}));
  const auto alpha = static_cast<float>(0x8001 / 65535.0);
  EXPECT_EQ(readImage(clear, limits_).at(0, 0), Rgb(alpha));
  EXPECT_EQ(readLayers(clear, limits_).at(0).floats(), std::vector{alpha});
}

TEST_F(ReadImage, SideAndByteLimitsHold) {
  const std::string file = save("a.bmp", bmp(3, 2, kSixPixels));
  for (const auto& [limits, status] : {std::pair{ImageLimits{3, 1000}, ExitStatus::done},
                                       {{2, 1000}, ExitStatus::limit},
                                       {{3, 17}, ExitStatus::limit}}) {
    limits_ = limits;
    EXPECT_EQ(readStatus(file), status) << limits.side;
  }
}

TEST_F(ReadImage, WhatIsNoImageIsSaidSo) {
  EXPECT_EQ(readStatus(path("absent.png")), ExitStatus::io);
  EXPECT_EQ(readStatus(folder_), ExitStatus::io);
  EXPECT_EQ(readStatus("empty.png", {}), ExitStatus::badScene);
  EXPECT_EQ(readStatus("text.png", {'h', 'e', 'l', 'l', 'o'}), ExitStatus::badScene);
  EXPECT_EQ(readStatus("gif.gif", {'G', 'I', 'F', '8', '9', 'a', 1, 0, 1, 0, 0, 0, 0}),
            ExitStatus::badScene);
}

TEST_F(ReadImage, RealFilesLoad) {
  const std::string folder = dataFolder().string();
  if (!std::filesystem::exists(folder + "/env"))
    GTEST_SKIP() << "SKIPPED: no test data in '" << folder << "'; set WHIT_DATA";

  int images = 0;
  for (const char* part : {"/env", "/crytek_sponza/textures"}) {
    for (const auto& entry : std::filesystem::directory_iterator(folder + part)) {
      const std::string extension = entry.path().extension().string();
      if (!contains(std::array{".exr", ".hdr", ".jpg", ".png"}, extension)) continue;

      SCOPED_TRACE(entry.path().string());
      const RawImage image = read(entry.path().string());
      const std::size_t found = image.linear ? image.values.size() : image.codes.size();
      EXPECT_EQ(found, image.pixels() * static_cast<std::size_t>(image.channels));
      EXPECT_GT(found, 0u);
      ++images;
    }
  }
  EXPECT_GE(images, 3);
}

// Both files hold the same picture, one in scanlines of DWAB and one in tiles of ZIP.
TEST_F(ReadImage, RealScanlinesAndTilesAgree) {
  const std::string folder = dataFolder().string() + "/env/";
  if (!std::filesystem::exists(folder + "courtyard_zip.exr"))
    GTEST_SKIP() << "SKIPPED: no '" << folder << "courtyard_zip.exr'; set WHIT_DATA";

  const RawImage lines = read(folder + "courtyard.exr"), tiles = read(folder + "courtyard_zip.exr");
  EXPECT_EQ(lines.width, 1024);
  EXPECT_EQ(lines.height, 512);
  EXPECT_EQ(lines.values, tiles.values);
}

}  // namespace
}  // namespace whit
