// Radiance HDR: forms of the header, and damage.
#include "image_samples.h"

namespace whit {
namespace {

class ReadHdr : public ImageTest {
 protected:
  std::string refusalOf(const std::string& head, const Bytes& rgbe = {}) {
    return errorOf("a.hdr", hdrOf(head, rgbe));
  }
  // Returns the reds of an image of gray pixels.
  std::vector<float> reds(const Bytes& file) {
    const RawImage image = read("a.hdr", file);
    std::vector<float> result;
    for (std::size_t i = 0; i < image.values.size(); i += 3) result.push_back(image.values[i]);
    return result;
  }
};

TEST_F(ReadHdr, FilesWithoutAFormatAreRgbe) {
  EXPECT_EQ(reds(hdrOf("#?RGBE\r\n\r\n-Y 1 +X 1\n", {16, 16, 16, 136})), (std::vector<float>{16}));
}

// The runs repeat the first pixel twice, and the second one 4 and then 256 times.
TEST_F(ReadHdr, RunsOfOlderFiles) {
  std::vector<float> expected(3, 16.0f);
  expected.insert(expected.end(), 1 + 4 + 256, 32.0f);
  EXPECT_EQ(reds(hdrOf("#?RGBE\n\n-Y 1 +X 264\n",
                       {16, 16, 16, 136, 1, 1, 1, 2, 32, 32, 32, 136, 1, 1, 1, 4, 1, 1, 1, 1})),
            expected);
  EXPECT_EQ(refusalOf("#?RGBE\n\n-Y 1 +X 3\n", {16, 16, 16, 136, 1, 1, 1, 3}),
            ": byte 26: expected a run up to the row's end, found a longer one");
}

// Values are divided by the product of all lines; lines of earlier pictures are indented.
TEST_F(ReadHdr, ExposuresAndColorCorrectionsAreUndone) {
  const auto rgb = [&](const std::string& lines) {
    const Bytes file = hdrOf("#?RADIANCE\n" + lines + "\n-Y 1 +X 1\n", {16, 32, 64, 136});
    return linearPixel(read("a.hdr", file), 0);
  };
  EXPECT_EQ(rgb("EXPOSURE=4.0\nEXPOSURE= 2\n\tEXPOSURE=7\n"), Rgb(2, 4, 8));
  EXPECT_EQ(rgb("COLORCORR=1 2 4\nEXPOSURE=0.5\n"), Rgb(32, 32, 32));
  EXPECT_EQ(refusalOf("#?RGBE\nEXPOSURE=0\n\n"),
            ": byte 18: expected a factor above 0 for each channel, found EXPOSURE=0");
  EXPECT_EQ(refusalOf("#?RGBE\nCOLORCORR=1 2\n\n"),
            ": byte 21: expected a factor above 0 for each channel, found COLORCORR=1 2");
}

TEST_F(ReadHdr, OtherPrimariesAreSaidToBeLeftOut) {
  const auto warnedOf = [&](const std::string& primaries) {
    Warnings warnings;
    readRawImage(save("a.hdr", hdrOf("#?RGBE\n" + primaries + "\n-Y 1 +X 1\n", {1, 1, 1, 136})),
                 limits_, warnings);
    return warnings.entries().size();
  };
  EXPECT_EQ(warnedOf(""), 0u);
  EXPECT_EQ(warnedOf("PRIMARIES=.64 .33 .29 .6 .15 .06 .333 .333\n"), 0u);
  EXPECT_EQ(warnedOf("PRIMARIES= 0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329\n"), 0u);
  EXPECT_EQ(warnedOf("PRIMARIES=0 0 0 0 0 0 0 0\n"), 0u) << "as Photoshop writes it";
  EXPECT_EQ(warnedOf("PRIMARIES=0.708 0.292 0.17 0.797 0.131 0.046 0.3127 0.329\n"), 1u);
}

TEST_F(ReadHdr, DamageIsToldWithItsPlace) {
  EXPECT_EQ(refusalOf("#?RGBE\nFORMAT=32-bit_rle_xyze\n\n"),
            ": byte 30: expected FORMAT=32-bit_rle_rgbe, found FORMAT=32-bit_rle_xyze");
  EXPECT_EQ(refusalOf("#?RGBE\n\n+Y 1 +X 1\n"),
            ": byte 18: expected a size such as \"-Y 300 +X 480\"");
  EXPECT_EQ(refusalOf("#?RGBE\n\n-Y 1 +X 8\n", {2, 2, 0, 9}),
            ": byte 22: expected a row of 8 pixels, found one of 9");
  EXPECT_EQ(refusalOf("#?RGBE\n\n-Y 1 +X 8\n", {2, 2, 0, 8, 137, 1}),
            ": byte 23: expected pixels up to the row's end, found more or none");
  EXPECT_EQ(refusalOf("#?RGBE\n\n-Y 1 +X 8\n", {2, 2, 0, 8, 136, 1}),
            ": byte 24: the file is cut short");
}

}  // namespace
}  // namespace whit
