// Writing PNG: pixels, metadata, nothing that changes from run to run.
#include "core/display.h"
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

// Returns the data of each chunk of a type.
std::vector<std::string> chunks(const Bytes& file, const std::string& type) {
  std::vector<std::string> found;
  for (std::size_t at = 8; at + 12 <= file.size();) {
    const std::size_t size = std::size_t{file[at]} << 24 | std::size_t{file[at + 1]} << 16 |
                             std::size_t{file[at + 2]} << 8 | file[at + 3];
    const std::string chunk(file.begin() + static_cast<std::ptrdiff_t>(at + 4), file.end());
    if (chunk.starts_with(type)) found.push_back(chunk.substr(4, size));
    at += 12 + size;
  }
  return found;
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

TEST_F(PngTest, PixelsComeBack) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 9}, {9, 1}, {16, 16}}) {
    const DisplayImage image = gradient(width, height);
    writePng(path("a.png"), image, {});
    const RawImage back = read(path("a.png"));
    EXPECT_EQ(back.width, width);
    EXPECT_EQ(back.height, height);
    ASSERT_EQ(back.channels, 3);  // opaque alpha is not stored
    for (const std::size_t i : indices(back.codes))
      EXPECT_EQ(back.codes[i], image.rgba[i / 3 * 4 + i % 3]);
  }
}

// Every sRGB code survives decoding to linear light, encoding, writing and reading.
TEST_F(PngTest, All256CodesSurviveTheWholeWay) {
  DisplayImage image{256, 1, {}};
  for (int code = 0; code < 256; ++code) {
    append(image.rgba, {byteOf(code), byteOf(255 - code), byteOf(code), 255});
  }
  writePng(path("a.png"), image, {});
  const Image linear = readImage(path("a.png"), limits_);
  EXPECT_EQ(toDisplay(linear, 0, ToneCurve::none).rgba, image.rgba);
}

TEST_F(PngTest, MetadataIsText) {
  writePng(path("a.png"), gradient(2, 2),
           {{"scene", "atrium"}, {"title", "caf\xc3\xa9"}, {std::string(100, 'k'), "long"}});

  const Bytes file = load(path("a.png"));
  // Text of ASCII is tEXt with keys of at most 79 characters, other text is iTXt.
  using namespace std::string_literals;
  EXPECT_EQ(chunks(file, "tEXt"),
            (std::vector{"scene\0atrium"s, std::string(79, 'k') + "\0long"s}));
  EXPECT_EQ(chunks(file, "iTXt"), (std::vector{"title\0\0\0\0\0caf\xc3\xa9"s}));
  EXPECT_EQ(chunks(file, "sRGB"), (std::vector{"\0"s}));
  EXPECT_TRUE(chunks(file, "tIME").empty());
}

TEST_F(PngTest, BytesAreReproducible) {
  writePng(path("a.png"), gradient(5, 4), {{"a", "b"}});
  writePng(path("b.png"), gradient(5, 4), {{"a", "b"}});
  EXPECT_EQ(load(path("a.png")), load(path("b.png")));
}

TEST_F(PngTest, EmptyImagesAreRefused) {
  EXPECT_EQ(statusOf([&] { writePng(path("a.png"), DisplayImage{}, {}); }), ExitStatus::usage);
  EXPECT_EQ(statusOf([&] { writeExr(path("a.exr"), Image{}, {}); }), ExitStatus::usage);
  EXPECT_EQ(filesInFolder(), 0u);
}

}  // namespace
}  // namespace whit
