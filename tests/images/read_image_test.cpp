// Reading 8-bit and Radiance files: every sample's pixels are known from how its bytes were made.
#include "image_samples.h"
#include "io/files.h"

namespace whit {
namespace {

class ReadImage : public ImageTest {
 protected:
  RawImage raw(const std::string& name, const Bytes& bytes) {
    return readRawImage(save(name, bytes), limits_, warnings_);
  }
};

const Bytes kSixPixels = {255, 0, 0, 0, 255, 0, 0, 0, 255, 10, 20, 30, 40, 50, 60, 70, 80, 90};

void expectSixPixels(const RawImage& image) {
  EXPECT_EQ(image.width, 3);
  EXPECT_EQ(image.height, 2);
  EXPECT_EQ(image.channels, 3);
  EXPECT_FALSE(image.linear);
  EXPECT_TRUE(image.values.empty());
  EXPECT_EQ(image.codes, kSixPixels);
}

TEST_F(ReadImage, TgaKeepsItsCodes) { expectSixPixels(raw("a.TGA", tga(3, 2, kSixPixels))); }

TEST_F(ReadImage, BmpKeepsItsCodes) { expectSixPixels(raw("a.bmp", bmp(3, 2, kSixPixels))); }

TEST_F(ReadImage, PngKeepsItsCodes) {
  Bytes rows = {0};
  append(rows, Bytes(kSixPixels.begin(), kSixPixels.begin() + 9));
  rows.push_back(0);
  append(rows, Bytes(kSixPixels.begin() + 9, kSixPixels.end()));
  expectSixPixels(raw("a.png", png(3, 2, 8, 2, rows)));
}

TEST_F(ReadImage, ContentCountsMoreThanTheName) {
  expectSixPixels(raw("a.jpg", bmp(3, 2, kSixPixels)));
}

TEST_F(ReadImage, PngOfEveryChannelCount) {
  const Bytes gray = {0, 7};
  EXPECT_EQ(raw("1.png", png(1, 1, 8, 0, gray)).codes, (Bytes{7}));
  const Bytes grayAlpha = {0, 7, 8};
  EXPECT_EQ(raw("2.png", png(1, 1, 8, 4, grayAlpha)).codes, (Bytes{7, 8}));
  const Bytes rgba = {0, 1, 2, 3, 4};
  EXPECT_EQ(raw("4.png", png(1, 1, 8, 6, rgba)).codes, (Bytes{1, 2, 3, 4}));
}

// A code of 8 bits is 257 of 16 bits: 0x0080 and 0x0081 lie on both sides of a half.
TEST_F(ReadImage, SixteenBitPngIsRounded) {
  const RawImage image =
      raw("a.png", png(4, 1, 16, 0, {0, 0x12, 0xff, 0xff, 0xff, 0x00, 0x80, 0x00, 0x81}));
  EXPECT_EQ(image.channels, 1);
  EXPECT_EQ(image.codes, (Bytes{0x13, 0xff, 0x00, 0x01}));
}

TEST_F(ReadImage, JpegOfOneCoefficient) {
  const RawImage image = raw("a.jpg", jpegGray200());
  EXPECT_EQ(image.channels, 1);
  EXPECT_EQ(image.codes, Bytes(64, 200));
}

// The inks are 200, 150, 100 and 128 of 255. With Adobe's mark the codes mean the light that the
// inks let through.
TEST_F(ReadImage, JpegOfInks) {
  const auto expectCodes = [&](const Bytes& file, int r, int g, int b) {
    const RawImage image = raw("a.jpg", file);
    ASSERT_EQ(image.channels, 3);
    ASSERT_EQ(image.codes.size(), 192u);
    EXPECT_NEAR(image.codes[0], r, 1);
    EXPECT_NEAR(image.codes[190], g, 1);
    EXPECT_NEAR(image.codes[191], b, 1);
  };

  const auto file = [](const std::string& name) {
    const char* source = std::getenv("WHIT_SOURCE_DIR");
    std::ifstream in(std::string(source ? source : ".") + "/tests/fuzz/corpus/jpeg/" + name,
                     std::ios::binary);
    return Bytes(std::istreambuf_iterator<char>(in), {});
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
  const RawImage image =
      raw("a.hdr", hdr(2, 2, {128, 64, 32, 129, 255, 1, 0, 255, 200, 200, 200, 0, 1, 128, 255, 1}));
  EXPECT_TRUE(image.linear);
  EXPECT_EQ(image.channels, 3);

  const std::vector<float> expected = {
      1, 0.5f, 0.25f, std::ldexp(255.0f, 119), std::ldexp(1.0f, 119),    0,
      0, 0,    0,     std::ldexp(1.0f, -135),  std::ldexp(128.0f, -135), std::ldexp(255.0f, -135)};
  EXPECT_EQ(image.values, expected);
}

TEST_F(ReadImage, RadianceWithRunLengths) {
  const RawImage image = raw("a.hdr", hdrRuns(9, 2, {128, 64, 0, 128}));
  ASSERT_EQ(image.values.size(), 54u);
  for (std::size_t i = 0; i < 54; i += 3) {
    EXPECT_EQ(image.values[i], 0.5f);
    EXPECT_EQ(image.values[i + 1], 0.25f);
    EXPECT_EQ(image.values[i + 2], 0.0f);
  }
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

TEST_F(ReadImage, GrayIsSpreadAndAlphaDropped) {
  const Image image = readImage(save("a.png", png(1, 1, 8, 4, {0, 255, 9})), limits_);
  EXPECT_EQ(image.at(0, 0), Rgb(1, 1, 1));
}

TEST_F(ReadImage, SideAndByteLimitsHold) {
  const std::string file = save("a.bmp", bmp(3, 2, kSixPixels));
  const auto status = [&](const ImageLimits& limits) {
    return statusOf([&] { readRawImage(file, limits, warnings_); });
  };
  EXPECT_EQ(status({3, 1000}), ExitStatus::done);
  EXPECT_EQ(status({2, 1000}), ExitStatus::limit);
  EXPECT_EQ(status({3, 17}), ExitStatus::limit);
}

TEST_F(ReadImage, WhatIsNoImageIsSaidSo) {
  const auto status = [&](const std::string& file) {
    return statusOf([&] { readRawImage(file, limits_, warnings_); });
  };
  EXPECT_EQ(status(path("absent.png")), ExitStatus::io);
  EXPECT_EQ(status(folder_), ExitStatus::io);
  EXPECT_EQ(status(save("empty.png", {})), ExitStatus::badScene);
  EXPECT_EQ(status(save("text.png", {'h', 'e', 'l', 'l', 'o'})), ExitStatus::badScene);
  EXPECT_EQ(status(save("gif.gif", {'G', 'I', 'F', '8', '9', 'a', 1, 0, 1, 0, 0, 0, 0})),
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
      if (extension != ".exr" && extension != ".hdr" && extension != ".jpg" && extension != ".png")
        continue;

      SCOPED_TRACE(entry.path().string());
      const RawImage image = readRawImage(entry.path().string(), limits_, warnings_);
      const std::size_t values =
          static_cast<std::size_t>(image.width * image.height * image.channels);
      const std::size_t read = image.linear ? image.values.size() : image.codes.size();
      EXPECT_EQ(read, values);
      EXPECT_GT(values, 0u);
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

  const RawImage lines = readRawImage(folder + "courtyard.exr", limits_, warnings_);
  const RawImage tiles = readRawImage(folder + "courtyard_zip.exr", limits_, warnings_);
  EXPECT_EQ(lines.width, 1024);
  EXPECT_EQ(lines.height, 512);
  EXPECT_EQ(lines.values, tiles.values);
}

}  // namespace
}  // namespace whit
