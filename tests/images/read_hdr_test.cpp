// Radiance HDR: forms that are older or turned, and damage.
#include "image_samples.h"

namespace whit {
namespace {

class ReadHdr : public ImageTest {
 protected:
  static Bytes hdrOf(const std::string& head, const Bytes& rgbe) {
    Bytes file(head.begin(), head.end());
    append(file, rgbe);
    return file;
  }
  // The reds of an image of gray pixels.
  std::vector<float> reds(const Bytes& file) {
    const RawImage image = readRawImage(save("a.hdr", file), limits_, warnings_);
    std::vector<float> result;
    for (std::size_t i = 0; i < image.values.size(); i += 3) result.push_back(image.values[i]);
    return result;
  }
};

constexpr char kHead[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";

TEST_F(ReadHdr, EveryOrientation) {
  const Bytes pixels = {16, 16, 16, 136, 32, 32, 32, 136, 48, 48, 48, 136,
                        64, 64, 64, 136, 80, 80, 80, 136, 96, 96, 96, 136};
  const auto of = [&](const std::string& size) { return reds(hdrOf(kHead + size + "\n", pixels)); };
  using Reds = std::vector<float>;
  EXPECT_EQ(of("-Y 2 +X 3"), (Reds{16, 32, 48, 64, 80, 96}));
  EXPECT_EQ(of("+Y 2 +X 3"), (Reds{64, 80, 96, 16, 32, 48}));
  EXPECT_EQ(of("-Y 2 -X 3"), (Reds{48, 32, 16, 96, 80, 64}));
  EXPECT_EQ(of("+X 3 -Y 2"), (Reds{16, 48, 80, 32, 64, 96}));
  EXPECT_EQ(of("-X 3 +Y 2"), (Reds{96, 64, 32, 80, 48, 16}));
}

// 1, 1, 1 and a number repeat the pixel before; what follows such a one counts 256 times as much.
TEST_F(ReadHdr, RunsOfTheFirstForm) {
  const std::vector<float> few = reds(
      hdrOf(kHead + std::string("-Y 1 +X 5\n"), {16, 16, 16, 136, 1, 1, 1, 3, 32, 32, 32, 136}));
  EXPECT_EQ(few, (std::vector<float>{16, 16, 16, 16, 32}));
  const std::vector<float> many =
      reds(hdrOf(kHead + std::string("-Y 1 +X 515\n"),
                 {16, 16, 16, 136, 1, 1, 1, 1, 1, 1, 1, 2, 32, 32, 32, 136}));
  ASSERT_EQ(many.size(), 515u);
  EXPECT_EQ(many[513], 16);
  EXPECT_EQ(many[514], 32);
}

TEST_F(ReadHdr, FilesWithoutAFormatAreRgbe) {
  EXPECT_EQ(reds(hdrOf("#?RGBE\r\n\r\n-Y 1 +X 1\n", {16, 16, 16, 136})), (std::vector<float>{16}));
}

TEST_F(ReadHdr, DamageIsToldWithItsPlace) {
  EXPECT_EQ(errorOf("a.hdr", hdrOf("#?RGBE\nFORMAT=32-bit_rle_xyze\n\n", {})),
            ": byte 30: expected FORMAT=32-bit_rle_rgbe, found FORMAT=32-bit_rle_xyze");
  EXPECT_EQ(errorOf("a.hdr", hdrOf("#?RGBE\n\n-Y 1 +Y 1\n", {})),
            ": byte 18: expected a size such as \"-Y 300 +X 480\"");
  EXPECT_EQ(errorOf("a.hdr", hdrOf("#?RGBE\n\n-Y 1 +X 8\n", {2, 2, 0, 9})),
            ": byte 22: expected a line of 8 pixels, found one of 9");
  EXPECT_EQ(errorOf("a.hdr", hdrOf("#?RGBE\n\n-Y 1 +X 8\n", {2, 2, 0, 8, 137, 1})),
            ": byte 23: expected pixels up to the line's end, found more or none");
  EXPECT_EQ(errorOf("a.hdr", hdrOf("#?RGBE\n\n-Y 1 +X 8\n", {2, 2, 0, 8, 136, 1})),
            ": byte 24: the file is cut short");
}

}  // namespace
}  // namespace whit
