// Writing PNG: pixels and metadata. That its bytes do not change from run to run is seen where
// films are resumed (cli_images_test.cpp).
#include "core/display.h"
#include "has_text.h"
#include "image_samples.h"

namespace whit {
namespace {

using PngTest = ImageTest;

DisplayImage gradient(int width, int height) {
  DisplayImage image{width, height, {}};
  for (int i = 0; i < width * height; ++i)
    append(image.rgba, {byteOf(i * 7), byteOf(i * 11), byteOf(255 - i), 255});
  return image;
}

TEST_F(PngTest, TextComesBackFromWholeFilesOnly) {
  const ImageMetadata metadata{{"software", "whit"}, {"place", "K\u00f6ln"}, {"eye", "1,2,3"}};
  writePng(path("a.png"), gradient(16, 16), metadata);
  EXPECT_EQ(readPngMetadata(path("a.png")), metadata);

  const Bytes whole = load(path("a.png"));
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{20}, whole.size() / 2, whole.size() - 9}) {
    // A file that is cut short is refused even where all its text is there.
    save("cut.png", slice(whole, 0, size));
    EXPECT_EQ(statusOf([&] { readPngMetadata(path("cut.png")); }), ExitStatus::badScene) << size;
  }

  Bytes damaged = whole;
  damaged[whole.size() - 30] ^= 1;  // one of the pixels, so that the checksum is wrong
  save("damaged.png", damaged);
  EXPECT_EQ(statusOf([&] { readPngMetadata(path("damaged.png")); }), ExitStatus::badScene);
  EXPECT_EQ(statusOf([&] { readPngMetadata(path("none.png")); }), ExitStatus::io);
}

// Every sRGB code survives reading, decoding to linear light and encoding: a gradient of 256 pixels
// has all of them in each channel.
TEST_F(PngTest, PixelsComeBack) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 9}, {9, 1}, {16, 16}}) {
    const DisplayImage image = gradient(width, height);
    writePng(path("a.png"), image, {});
    EXPECT_EQ(read(path("a.png")).channels, 3);  // opaque alpha is not stored

    const DisplayImage back = toDisplay(readImage(path("a.png"), limits_), 0, ToneCurve::none);
    EXPECT_EQ(back.width, width);
    EXPECT_EQ(back.height, height);
    EXPECT_EQ(back.rgba, image.rgba);
  }
}

TEST_F(PngTest, MetadataIsText) {
  writePng(path("a.png"), gradient(2, 2),
           {{"scene", "atrium"}, {"title", "caf\xc3\xa9"}, {std::string(100, 'k'), "long"}});

  const Bytes bytes = load(path("a.png"));
  const std::string file(bytes.begin(), bytes.end());
  // Text of ASCII is tEXt with keys of at most 79 characters, other text is iTXt. The type of a
  // chunk stands before its data.
  using namespace std::string_literals;
  for (const std::string& chunk : {"tEXtscene\0atrium"s, "tEXt" + std::string(79, 'k') + "\0long"s,
                                   "iTXttitle\0\0\0\0\0caf\xc3\xa9"s, "sRGB\0"s}) {
    EXPECT_TRUE(hasText(file, chunk));
  }
  EXPECT_FALSE(hasText(file, "tIME"));
}

TEST_F(PngTest, EmptyImagesAreRefused) {
  EXPECT_EQ(statusOf([&] { writePng(path("a.png"), DisplayImage{}, {}); }), ExitStatus::usage);
  EXPECT_EQ(statusOf([&] { writeExr(path("a.exr"), Image{}, {}); }), ExitStatus::usage);
  EXPECT_EQ(filesInFolder(), 0u);
}

}  // namespace
}  // namespace whit
