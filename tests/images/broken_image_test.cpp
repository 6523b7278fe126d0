// Hostile and damaged files: an Error or the right picture, never a crash, an endless loop or
// made-up pixels.
#include <cstring>

#include "every_format.h"

namespace whit {
namespace {

using BrokenImage = EveryFormat;

bool samePicture(const RawImage& a, const RawImage& b) {
  return a.width == b.width && a.height == b.height && a.channels == b.channels &&
         a.codes == b.codes && a.values == b.values;
}

TEST_F(BrokenImage, EveryPrefixIsAnErrorOrTheWholePicture) {
  for (const FormatSample& sample : samples()) {
    SCOPED_TRACE(sample.name);
    const RawImage whole = read(sample.name, sample.bytes);
    std::size_t refused = 0;

    for (const auto size : indices(sample.bytes)) {
      const std::string file = save(sample.name, slice(sample.bytes, 0, size));
      const std::string refusal = refusalOf(
          ExitStatus::badScene, [&] { EXPECT_TRUE(samePicture(read(file), whole)) << size; });
      if (refusal.empty()) continue;
      EXPECT_TRUE(refusal.starts_with(file + ": ")) << refusal;
      ++refused;
    }

    // Only what follows the pixels may go missing: BMP's first row is followed by 2 bytes of
    // padding.
    EXPECT_GE(refused, sample.bytes.size() - 2);
  }
}

// Sizes are refused by what the header says; the files hold no pixels at all.
TEST_F(BrokenImage, HugeClaimsAreRefusedBeforeDecoding) {
  EXPECT_EQ(readStatus("a.tga", tga(65535, 65535, {})), ExitStatus::limit);
  EXPECT_EQ(readStatus("a.bmp", bmp(100000, 1, Bytes(300000, 0))), ExitStatus::limit);
  EXPECT_EQ(readStatus("a.png", png(1 << 20, 1 << 20, 8, 2, {0})), ExitStatus::limit);
  // Within the limits, but more than can be packed into so few bytes.
  EXPECT_EQ(readStatus("c.png", png(30000, 30000, 8, 2, {0})), ExitStatus::badScene);
  EXPECT_EQ(readStatus("b.png", png(40000, 10, 8, 2, {0})), ExitStatus::limit);
  EXPECT_EQ(readStatus("a.hdr", hdr(1 << 20, 1 << 20, {})), ExitStatus::limit);
  // 32768 x 32768 RGB floats are 12 GiB: inside the side limit, beyond the byte limit.
  EXPECT_EQ(readStatus("b.hdr", hdr(32768, 32768, {})), ExitStatus::limit);
}

TEST_F(BrokenImage, HugeExrClaimsAreRefusedBeforeDecoding) {
  writeExr(path("good.exr"), Image(5, 4, {1, 1, 4, 4}), {});
  const Bytes good = load(path("good.exr"));
  // "dataWindow" 0 "box2i" 0, a length of 4 bytes, then xMin yMin xMax yMax.
  const std::string key("dataWindow\0box2i\0", 17);
  const auto at = std::search(good.begin(), good.end(), key.begin(), key.end()) - good.begin() + 21;

  const auto statusWith = [&](const std::array<std::int32_t, 4>& box) {
    Bytes bytes = good;
    std::memcpy(bytes.data() + at, box.data(), sizeof box);
    return readStatus("huge.exr", bytes);
  };

  constexpr std::int32_t kMax = 2147483647, kMin = -kMax - 1;
  EXPECT_EQ(statusWith({1, 1, 3, 3}), ExitStatus::done);
  EXPECT_EQ(statusWith({0, 0, 100000, 3}), ExitStatus::limit);
  EXPECT_NE(statusWith({kMin, kMin, kMax, kMax}), ExitStatus::done);
  EXPECT_NE(statusWith({3, 3, 1, 1}), ExitStatus::done);
  EXPECT_NE(statusWith({10, 10, 12, 12}), ExitStatus::done);  // outside the display window
}

// The Huffman table claims 16 * 255 codes, where 256 is the most there can be.
TEST_F(BrokenImage, JpegWithTooManyCodesIsRefused) {
  Bytes file = {0xff, 0xd8, 0xff, 0xc4, 0x10, 0x03, 0x13};  // 2 + 1 + 16 + 16 * 255 bytes long
  append(file, Bytes(16, 255));
  append(file, Bytes(16 * 255, 7));
  append(file, slice(jpegGray200(), 2));
  EXPECT_EQ(readStatus("a.jpg", file), ExitStatus::badScene);
}

// 64 MiB of zeros pack to 64 KiB; the image claims a single pixel.
TEST_F(BrokenImage, PngThatUnpacksToTooMuchIsRefused) {
  EXPECT_EQ(readStatus("bomb.png", png(1, 1, 8, 0, Bytes(64u << 20, 0))), ExitStatus::badScene);
}

}  // namespace
}  // namespace whit
