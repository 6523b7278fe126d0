// Hostile and damaged files: an Error or the right picture, never a crash, an endless loop or
// made-up pixels.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfTiledOutputFile.h>

#include <half.h>

#include "image_samples.h"

namespace whit {
namespace {

struct Sample {
  std::string name;
  Bytes bytes;
};

class BrokenImage : public ImageTest {
 protected:
  Bytes exr() {
    Image image(5, 4, {1, 1, 4, 4});
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      image.pixels[i] = Rgb(static_cast<float>(i), 0.5f, 0.25f);
    writeExr(path("sample.exr"), image, {{"name", "text"}});
    return load(path("sample.exr"));
  }
  Bytes tiledExr() {
    Imf::Header header(9, 7);
    header.channels().insert("Y", Imf::Channel(Imf::HALF));
    header.setTileDescription(Imf::TileDescription(4, 4, Imf::ONE_LEVEL));

    {
      std::vector<half> values(63, half(0.5f));
      Imf::TiledOutputFile file(path("tiled.exr").c_str(), header);
      Imf::FrameBuffer frame;
      frame.insert("Y", Imf::Slice(Imf::HALF, reinterpret_cast<char*>(values.data()), sizeof(half),
                                   9 * sizeof(half)));
      file.setFrameBuffer(frame);
      file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    }
    return load(path("tiled.exr"));
  }
  std::vector<Sample> samples() {
    const Bytes codes = {9, 8, 7, 6, 5, 4, 3, 2, 1, 11, 12, 13};

    // A filter byte, which is 0, begins each of PNG's rows.
    Bytes rows = {0};
    append(rows, Bytes(codes.begin(), codes.begin() + 6));
    rows.push_back(0);
    append(rows, Bytes(codes.begin() + 6, codes.end()));

    return {{"a.tga", tga(2, 2, codes)},
            {"a.bmp", bmp(2, 2, codes)},
            {"a.png", png(2, 2, 8, 2, rows)},
            {"a.jpg", jpegGray200()},
            {"a.hdr", hdr(2, 2, Bytes(16, 130))},
            {"b.hdr", hdrRuns(20, 3, {1, 2, 3, 130})},
            {"a.exr", exr()},
            {"b.exr", tiledExr()}};
  }
};

bool samePicture(const RawImage& a, const RawImage& b) {
  return a.width == b.width && a.height == b.height && a.channels == b.channels &&
         a.codes == b.codes && a.values == b.values;
}

TEST_F(BrokenImage, EveryPrefixIsAnErrorOrTheWholePicture) {
  for (const Sample& sample : samples()) {
    SCOPED_TRACE(sample.name);
    const RawImage whole = readRawImage(save(sample.name, sample.bytes), limits_, warnings_);
    std::size_t refused = 0;

    for (std::size_t size = 0; size < sample.bytes.size(); ++size) {
      const std::string file = save(
          sample.name,
          Bytes(sample.bytes.begin(), sample.bytes.begin() + static_cast<std::ptrdiff_t>(size)));
      try {
        EXPECT_TRUE(samePicture(readRawImage(file, limits_, warnings_), whole)) << size;
      } catch (const Error& e) {
        EXPECT_EQ(e.status(), ExitStatus::badScene) << size << ": " << e.what();
        EXPECT_EQ(std::string(e.what()).rfind(file + ": ", 0), 0u) << e.what();
        ++refused;
      }
    }

    // Only what follows the pixels may go missing: BMP's first row is followed by 2 bytes of
    // padding.
    EXPECT_GE(refused, sample.bytes.size() - 2);
  }
}

// Sizes are refused by what the header says; the files hold no pixels at all.
TEST_F(BrokenImage, HugeClaimsAreRefusedBeforeDecoding) {
  const auto status = [&](const std::string& name, const Bytes& bytes) {
    return statusOf([&] { readRawImage(save(name, bytes), limits_, warnings_); });
  };
  EXPECT_EQ(status("a.tga", tga(65535, 65535, {})), ExitStatus::limit);
  EXPECT_EQ(status("a.bmp", bmp(100000, 1, Bytes(300000, 0))), ExitStatus::limit);
  EXPECT_EQ(status("a.png", png(1 << 20, 1 << 20, 8, 2, {0})), ExitStatus::limit);
  // Within the limits, but more than can be packed into so few bytes.
  EXPECT_EQ(status("c.png", png(30000, 30000, 8, 2, {0})), ExitStatus::badScene);
  EXPECT_EQ(status("b.png", png(40000, 10, 8, 2, {0})), ExitStatus::limit);
  EXPECT_EQ(status("a.hdr", hdr(1 << 20, 1 << 20, {})), ExitStatus::limit);
  // 32768 x 32768 RGB floats are 12 GiB: inside the side limit, beyond the byte limit.
  EXPECT_EQ(status("b.hdr", hdr(32768, 32768, {})), ExitStatus::limit);
}

TEST_F(BrokenImage, HugeExrClaimsAreRefusedBeforeDecoding) {
  const Bytes good = exr();
  // "dataWindow" 0 "box2i" 0, a length of 4 bytes, then xMin yMin xMax yMax.
  const std::string key("dataWindow\0box2i\0", 17);
  const auto at = std::search(good.begin(), good.end(), key.begin(), key.end()) - good.begin() + 21;

  const auto withWindow = [&](const std::array<std::int32_t, 4>& box) {
    Bytes bytes = good;
    std::memcpy(bytes.data() + at, box.data(), sizeof box);
    return save("huge.exr", bytes);
  };
  const auto status = [&](const std::string& file) {
    return statusOf([&] { readRawImage(file, limits_, warnings_); });
  };

  constexpr std::int32_t kMax = 2147483647, kMin = -kMax - 1;
  EXPECT_EQ(status(withWindow({1, 1, 3, 3})), ExitStatus::done);
  EXPECT_EQ(status(withWindow({0, 0, 100000, 3})), ExitStatus::limit);
  EXPECT_NE(status(withWindow({kMin, kMin, kMax, kMax})), ExitStatus::done);
  EXPECT_NE(status(withWindow({3, 3, 1, 1})), ExitStatus::done);
  EXPECT_NE(status(withWindow({10, 10, 12, 12})), ExitStatus::done);  // outside the display window
}

// The Huffman table claims 16 * 255 codes, where 256 is the most there can be.
TEST_F(BrokenImage, JpegWithTooManyCodesIsRefused) {
  Bytes file = {0xff, 0xd8, 0xff, 0xc4, 0x10, 0x03, 0x13};  // 2 + 1 + 16 + 16 * 255 bytes long
  append(file, Bytes(16, 255));
  append(file, Bytes(16 * 255, 7));
  const Bytes rest = jpegGray200();
  append(file, Bytes(rest.begin() + 2, rest.end()));
  EXPECT_EQ(statusOf([&] { readRawImage(save("a.jpg", file), limits_, warnings_); }),
            ExitStatus::badScene);
}

// 64 MiB of zeros pack to 64 KiB; the image claims a single pixel.
TEST_F(BrokenImage, PngThatUnpacksToTooMuchIsRefused) {
  const std::string file = save("bomb.png", png(1, 1, 8, 0, Bytes(64u << 20, 0)));
  EXPECT_EQ(statusOf([&] { readRawImage(file, limits_, warnings_); }), ExitStatus::badScene);
}

}  // namespace
}  // namespace whit
