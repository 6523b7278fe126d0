// OpenEXR: what is written comes back bit for bit, and other programs' files are understood.
#include <ImfChannelList.h>
#include <ImfEnvmap.h>
#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfTiledOutputFile.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>

#include "has_text.h"
#include "image_samples.h"
#include "io/image/texture_from_image.h"

namespace whit {
namespace {

std::uint32_t bits(float value) { return std::bit_cast<std::uint32_t>(value); }

void expectSameBits(const Image& a, const Image& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.window, b.window);
  ASSERT_EQ(a.pixels.size(), b.pixels.size());
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) EXPECT_EQ(bits(a.pixels[i][c]), bits(b.pixels[i][c])) << i;
}

// Channels of constant value on a data window, written through OpenEXR itself.
struct ForeignFile {
  Imath::Box2i display{{0, 0}, {3, 2}}, data{{0, 0}, {3, 2}};
  std::map<std::string, float> channels;
  Imf::PixelType type = Imf::FLOAT;
  Imf::Compression compression = Imf::ZIP_COMPRESSION;

  Imf::Header header() const {
    Imf::Header header(display, data);
    header.compression() = compression;
    for (const auto& [name, value] : channels) header.channels().insert(name, Imf::Channel(type));
    return header;
  }
};

// A smooth picture, whose values half floats can only round.
Image stored() {
  Image image(64, 48);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
      image.at(x, y) = {fx / 63 + 0.01f, fy / 47 + 0.01f, (fx + fy) / 110 + 0.01f};
    }
  }
  return image;
}

class ExrTest : public ImageTest {
 protected:
  void roundTrip(const Image& image) {
    writeExr(path("a.exr"), image, {});
    expectSameBits(readImage(path("a.exr"), limits_), image);
  }

  template <typename Output>
  static void fill(const ForeignFile& file, Output& output) {
    const auto width = static_cast<std::size_t>(file.data.max.x - file.data.min.x + 1);
    const auto height = static_cast<std::size_t>(file.data.max.y - file.data.min.y + 1);
    // The values must outlive the call that writes them.
    std::map<std::string, std::vector<float>> floats;
    std::map<std::string, std::vector<half>> halves;

    Imf::FrameBuffer frame;
    for (const auto& [name, value] : file.channels) {
      floats[name].assign(width * height, value);
      halves[name].assign(width * height, half(value));
      const bool isHalf = file.type == Imf::HALF;
      const void* values = isHalf ? static_cast<const void*>(halves[name].data())
                                  : static_cast<const void*>(floats[name].data());
      const std::size_t size = isHalf ? sizeof(half) : sizeof(float);
      frame.insert(name, Imf::Slice::Make(file.type, values, file.data, size, width * size));
    }

    output.setFrameBuffer(frame);
    if constexpr (requires { output.writeTiles(0, 0, 0, 0); })
      output.writeTiles(0, output.numXTiles() - 1, 0, output.numYTiles() - 1);
    else
      output.writePixels(file.data.max.y - file.data.min.y + 1);
  }
  std::string write(const ForeignFile& file) {
    Imf::OutputFile output(path("foreign.exr").c_str(), file.header());
    fill(file, output);
    return path("foreign.exr");
  }
  RawImage raw(const ForeignFile& file) { return readRawImage(write(file), limits_, warnings_); }
};

TEST_F(ExrTest, FloatsKeepTheirBits) {
  Image image(7, 5);
  std::uint32_t pattern = 0x01234567;
  for (Rgb& pixel : image.pixels)
    for (int c = 0; c < 3; ++c) {
      pattern = pattern * 1664525u + 1013904223u;
      pixel[c] = std::bit_cast<float>(pattern);
    }

  image.pixels[0] = Rgb(std::bit_cast<float>(0x7fc12345u), std::numeric_limits<float>::infinity(),
                        -std::numeric_limits<float>::infinity());
  image.pixels[1] =
      Rgb(std::numeric_limits<float>::denorm_min(), std::numeric_limits<float>::max(), -0.0f);
  roundTrip(image);
}

TEST_F(ExrTest, CropsKeepTheirPlace) {
  for (const Crop& crop : {Crop{0, 0, 1, 1}, Crop{99, 49, 100, 50}, Crop{13, 7, 60, 8},
                           Crop{0, 0, 100, 50}, Crop{5, 0, 6, 50}}) {
    Image image(100, 50, crop);
    float value = 0.1f;
    for (Rgb& pixel : image.pixels) {
      value += 1;
      pixel = Rgb(value, value * 2, value * 3);
    }
    roundTrip(image);
  }
  roundTrip(Image(1, 1));
}

TEST_F(ExrTest, MetadataComesBackAndTheBytesAreReproducible) {
  const Image image(4, 4);
  const ImageMetadata metadata = {{"crop", "0,0,4,4"},
                                  {"name", "atrium"},  // OpenEXR has an attribute of this name
                                  {"compression", "none"},
                                  {"scene", "caf\xc3\xa9"},
                                  {"type", "nonsense"}};
  writeExr(path("a.exr"), image, metadata);
  writeExr(path("b.exr"), image, metadata);
  EXPECT_EQ(load(path("a.exr")), load(path("b.exr")));

  ImageMetadata back = readExrMetadata(path("a.exr"));
  std::sort(back.begin(), back.end());
  EXPECT_EQ(back.size(), metadata.size());
  for (const auto& entry : metadata)
    EXPECT_NE(std::find(back.begin(), back.end(), entry), back.end()) << entry.first;
  EXPECT_EQ(readImage(path("a.exr"), limits_).pixels.size(), 16u);
}

// The places of points in the picture are worked out by hand: the eye looks along -z.
TEST_F(ExrTest, SaysHowTheWorldIsSeen) {
  const ImageMetadata metadata = {
      {"eye", "1,2,6"}, {"at", "1,2,0"}, {"up", "0,1,0"}, {"fov", "90"}};
  const auto matrices = [&](const ImageMetadata& said) {
    writeExr(path("a.exr"), Image(4, 2), said);
    const Imf::InputFile file(path("a.exr").c_str());
    EXPECT_EQ(file.header().find("eye"), file.header().end());  // it is stored as whit:eye
    EXPECT_TRUE(Imf::hasChromaticities(file.header()));
    return std::pair{Imf::worldToCamera(file.header()), Imf::worldToNDC(file.header())};
  };

  const auto expectAt = [](const Imath::M44f& matrix, const Imath::V3f& point,
                           const Imath::V3f& there) {
    Imath::V3f result;
    matrix.multVecMatrix(point, result);
    EXPECT_NEAR(result.x, there.x, 1e-6);
    EXPECT_NEAR(result.y, there.y, 1e-6);
    EXPECT_NEAR(result.z, there.z, 1e-6);
  };

  const auto [camera, ndc] = matrices(metadata);
  expectAt(camera, {1, 2, 6}, {0, 0, 0});
  expectAt(camera, {1.5f, 3, 2}, {0.5f, 1, 4});
  expectAt(ndc, {1, 2, 2}, {0.5f, 0.5f, 0.25f});
  expectAt(ndc, {1, 6, 2}, {0.5f, 0, 0.25f});  // the upper border, 45 degrees above
  expectAt(ndc, {9, -2, 2}, {1, 1, 0.25f});    // the lower right corner: twice as wide as high

  // Parallel rays show a height of 3 units, and the third coordinate stays the depth.
  ImageMetadata parallel = metadata;
  parallel.emplace_back("ortho", "3");
  const auto [sameCamera, flat] = matrices(parallel);
  EXPECT_EQ(sameCamera, camera);
  expectAt(flat, {4, 0.5f, -7}, {1, 1, 13});

  // A panorama has no matrix of a projection.
  writeExr(path("a.exr"), Image(4, 2),
           {{"eye", "1,2,6"}, {"at", "1,2,0"}, {"projection", "panorama"}});
  const Imf::InputFile panorama(path("a.exr").c_str());
  EXPECT_EQ(Imf::worldToCamera(panorama.header()), camera);
  EXPECT_FALSE(Imf::hasWorldToNDC(panorama.header()));
}

// Single precision would round both points of this view to quarters.
TEST_F(ExrTest, SaysHowTheWorldIsSeenFromFarAway) {
  const auto matrix = [&](const std::string& eye, const std::string& at) {
    writeExr(path("a.exr"), Image(4, 2), {{"eye", eye}, {"at", at}, {"fov", "90"}});
    return Imf::worldToCamera(Imf::InputFile(path("a.exr").c_str()).header());
  };

  const Imath::M44f near = matrix("0.1,2,6", "0.2,2,0");
  const Imath::M44f far = matrix("4000000.1,2,6", "4000000.2,2,0");

  constexpr float kDirection = 1e-7f;  // of a unit vector
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      EXPECT_NEAR(far[row][column], near[row][column], kDirection);
    }
  }

  for (int column = 0; column < 3; ++column) {
    const double moved = near[3][column] - 4e6 * near[0][column];
    EXPECT_NEAR(far[3][column], moved, 0x1p-22 * std::abs(moved) + 4e6 * kDirection);
  }
}

TEST_F(ExrTest, EveryCompressionIsRead) {
  for (int c = 0; c < Imf::NUM_COMPRESSION_METHODS; ++c) {
    ForeignFile file;
    file.channels = {{"R", 1}, {"G", 2}, {"B", 4}};
    file.compression = static_cast<Imf::Compression>(c);

    const RawImage image = raw(file);
    EXPECT_EQ(image.channels, 3);
    ASSERT_EQ(image.values.size(), 36u);
    // Lossy compressions keep constant powers of two to a part in a hundred.
    for (std::size_t i = 0; i < 36; ++i)
      EXPECT_NEAR(image.values[i], static_cast<float>(1 << (i % 3)), 0.04) << c;
  }
}

TEST_F(ExrTest, HalvesAndAlphaAreRead) {
  ForeignFile file;
  file.type = Imf::HALF;
  file.channels = {{"R", 0.5f}, {"G", 65504}, {"B", 6.0e-8f}, {"A", 0.25f}};
  const RawImage image = raw(file);
  EXPECT_EQ(image.channels, 4);
  EXPECT_EQ(image.values[0], 0.5f);
  EXPECT_EQ(image.values[1], 65504.0f);
  EXPECT_EQ(image.values[2], std::ldexp(1.0f, -24));
  EXPECT_EQ(image.values[3], 0.25f);
}

TEST_F(ExrTest, LuminanceAloneIsGray) {
  ForeignFile file;
  file.channels = {{"Y", 0.75f}, {"Z", 9}};
  EXPECT_EQ(raw(file).channels, 1);
  EXPECT_EQ(readImage(write(file), limits_).at(2, 1), Rgb(0.75f));
}

TEST_F(ExrTest, MissingChannelsAreBlack) {
  ForeignFile file;
  file.channels = {{"G", 0.5f}};
  EXPECT_EQ(readImage(write(file), limits_).at(3, 2), Rgb(0, 0.5f, 0));
}

TEST_F(ExrTest, NoColorAtAllIsAnError) {
  ForeignFile file;
  file.channels = {{"Z", 1}, {"layer.X", 1}};
  try {
    raw(file);
    FAIL() << "read";
  } catch (const Error& e) {
    EXPECT_EQ(e.status(), ExitStatus::badScene);
    EXPECT_TRUE(hasText(std::string(e.what()), "layer.X")) << e.what();
  }
}

// OpenEXR would take what follows the list for an attribute, and allocate what that claims to take.
TEST_F(ExrTest, ListsOfChannelsEndWithTheirAttribute) {
  ForeignFile file;
  file.channels = {{"G", 0.5f}};
  Bytes bytes = load(write(file));

  // Another list of one channel, "A", without the empty name at its end.
  constexpr int kAttributesAt = 8, kChannelBytes = 18;
  Bytes attribute{'m', 'o', 'r', 'e', 0, 'c', 'h', 'l', 'i', 's', 't', 0, kChannelBytes,
                  0,   0,   0,   'A', 0, 2,   0,   0,   0,   0,   0,   0, 0,
                  1,   0,   0,   0,   1, 0,   0,   0};
  bytes.insert(bytes.begin() + kAttributesAt, attribute.begin(), attribute.end());
  const std::string message = errorOf("list.exr", bytes);
  EXPECT_EQ(message,
            ": header: expected the list of channels 'more' to end where its attribute does");
}

// Windows need neither begin at 0 nor lie inside one another.
TEST_F(ExrTest, DataWindowIsTakenRelativeToTheDisplayWindow) {
  ForeignFile file;
  file.channels = {{"R", 1}, {"G", 1}, {"B", 1}};
  file.display = {{-10, 5}, {-1, 14}};
  file.data = {{-12, 7}, {-8, 30}};  // beyond the left and the bottom

  const Image image = readImage(write(file), limits_);
  EXPECT_EQ(image.width, 10);
  EXPECT_EQ(image.height, 10);
  EXPECT_EQ(image.window, (Crop{0, 2, 3, 10}));
  for (const Rgb& pixel : image.pixels) EXPECT_EQ(pixel, Rgb(1));

  // As a texture the picture is filled up with black.
  const RawImage filled = raw(file);
  EXPECT_EQ(filled.width, 10);
  EXPECT_EQ(filled.height, 10);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 10; ++x)
      EXPECT_EQ(filled.values[static_cast<std::size_t>(3 * (10 * y + x))],
                x < 3 && y >= 2 ? 1.0f : 0.0f);
}

TEST_F(ExrTest, TilesAreRead) {
  ForeignFile file;
  file.display = file.data = {{0, 0}, {36, 20}};
  file.channels = {{"R", 1}, {"G", 2}, {"B", 3}};

  Imf::Header header = file.header();
  header.setTileDescription(Imf::TileDescription(16, 8, Imf::MIPMAP_LEVELS));
  {
    Imf::TiledOutputFile output(path("tiled.exr").c_str(), header);
    fill(file, output);
  }

  const Image image = readImage(path("tiled.exr"), limits_);
  EXPECT_EQ(image.window, (Crop{0, 0, 37, 21}));
  for (const Rgb& pixel : image.pixels) EXPECT_EQ(pixel, Rgb(1, 2, 3));
}

TEST_F(ExrTest, OfSeveralPartsTheFirstIsRead) {
  ForeignFile first, second;
  first.channels = {{"R", 1}, {"G", 1}, {"B", 1}};
  second.channels = {{"R", 9}, {"G", 9}, {"B", 9}};
  std::vector<Imf::Header> headers = {first.header(), second.header()};
  for (std::size_t i = 0; i < 2; ++i) {
    headers[i].setName(i == 0 ? "beauty" : "other");
    headers[i].setType(Imf::SCANLINEIMAGE);
  }

  {
    Imf::MultiPartOutputFile file(path("parts.exr").c_str(), headers.data(), 2);
    Imf::OutputPart one(file, 0), two(file, 1);
    fill(first, one);
    fill(second, two);
  }

  // Only the first part counts.
  EXPECT_EQ(readImage(path("parts.exr"), limits_).at(0, 0), Rgb(1));
}

// Chroma is stored for every fourth pixel, in half floats.
TEST_F(ExrTest, LuminanceAndChroma) {
  constexpr int kSide = 16;
  const std::vector<Imf::Rgba> pixels(kSide * kSide, Imf::Rgba(0.25f, 0.5f, 0.75f, 1));
  {
    Imf::RgbaOutputFile file(path("a.exr").c_str(), Imf::Header(kSide, kSide), Imf::WRITE_YC);
    file.setFrameBuffer(pixels.data(), 1, kSide);
    file.writePixels(kSide);
  }

  const Image image = readImage(path("a.exr"), limits_);
  const float wanted[] = {0.25f, 0.5f, 0.75f};
  constexpr float kHalf = 2e-3f;
  for (const Rgb& pixel : image.pixels) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(pixel[i], wanted[i], kHalf);
  }
}

// The channels are named as Blender names them. A layer that is no picture does not count.
TEST_F(ExrTest, ColorsInALayer) {
  ForeignFile file;
  file.channels = {{"Another.R", 9},
                   {"ViewLayer.Combined.R", 0.25f},
                   {"ViewLayer.Combined.G", 0.5f},
                   {"ViewLayer.Combined.B", 0.75f},
                   {"ViewLayer.Combined.A", 0.5f},
                   {"ViewLayer.Depth.Z", 7}};

  const RawImage image = raw(file);
  ASSERT_EQ(image.channels, 4);
  EXPECT_EQ(linearPixel(image, 0), Rgb(0.25f, 0.5f, 0.75f));

  file.channels = {{"position.X", 1}, {"position.Y", 1}};
  EXPECT_EQ(statusOf([&] { raw(file); }), ExitStatus::badScene);
}

// Each pixel holds its direction by OpenEXR's own functions, divided by its largest component: a
// linear function on each face, which interpolation keeps.
TEST_F(ExrTest, CubesBecomeSkies) {
  constexpr int kSide = 8;
  const Imath::Box2i data({0, 0}, {kSide - 1, 6 * kSide - 1});
  std::vector<Imf::Rgba> pixels(6 * kSide * kSide);
  for (int face = 0; face < 6; ++face) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const Imf::CubeMapFace side = static_cast<Imf::CubeMapFace>(face);
        const Imath::V2f within(static_cast<float>(x), static_cast<float>(y));
        const Imath::V3f d = Imf::CubeMap::direction(side, data, within);
        const float most = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
        const Imath::V2f at = Imf::CubeMap::pixelPosition(side, data, within);
        pixels[static_cast<std::size_t>(std::lround(at.y)) * kSide +
               static_cast<std::size_t>(std::lround(at.x))] =
            Imf::Rgba(1 + d.x / most, 1 + d.y / most, 1 + d.z / most);
      }
    }
  }

  {
    Imf::Header header(data, data);
    Imf::addEnvmap(header, Imf::ENVMAP_CUBE);
    Imf::RgbaOutputFile file(path("cube.exr").c_str(), header, Imf::WRITE_RGB);
    file.setFrameBuffer(pixels.data(), 1, kSide);
    file.writePixels(6 * kSide);
  }

  const EnvironmentImage sky = makeEnvironment(readRawImage(path("cube.exr"), limits_, warnings_));
  ASSERT_EQ(sky.width, 4 * kSide);
  ASSERT_EQ(sky.height, 2 * kSide);

  constexpr double kHalf = 2e-3;
  const Imath::Box2i window({0, 0}, {sky.width, sky.height});
  for (int y = 0; y < sky.height; ++y) {
    for (int x = 0; x < sky.width; ++x) {
      const Imath::V3f d = Imf::LatLongMap::direction(
          window, Imath::V2f(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f));
      const float most = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
      const auto i = static_cast<std::size_t>(y * sky.width + x);
      EXPECT_NEAR(sky.r[i], 1 + d.x / most, kHalf) << x << " " << y;
      EXPECT_NEAR(sky.g[i], 1 + d.y / most, kHalf) << x << " " << y;
      EXPECT_NEAR(sky.b[i], 1 + d.z / most, kHalf) << x << " " << y;
    }
  }
}

TEST_F(ExrTest, OtherPrimariesAreSaidToBeLeftOut) {
  const auto warnedOf = [&](const Imf::Chromaticities* primaries) {
    ForeignFile foreign;
    foreign.channels = {{"R", 1.0f}, {"G", 1.0f}, {"B", 1.0f}};
    Imf::Header header = foreign.header();
    if (primaries) Imf::addChromaticities(header, *primaries);
    {
      Imf::OutputFile output(path("primaries.exr").c_str(), header);
      fill(foreign, output);
    }
    Warnings warnings;
    readRawImage(path("primaries.exr"), limits_, warnings);
    return warnings.entries().size();
  };
  const Imf::Chromaticities rec709;
  const Imf::Chromaticities rec2020({0.708f, 0.292f}, {0.17f, 0.797f}, {0.131f, 0.046f},
                                    {0.3127f, 0.329f});
  EXPECT_EQ(warnedOf(nullptr), 0u);
  EXPECT_EQ(warnedOf(&rec709), 0u);
  EXPECT_EQ(warnedOf(&rec2020), 1u);
}

TEST_F(ExrTest, OddValuesAreMendedInTexturesOnly) {
  Image image(2, 1);
  image.pixels = {Rgb(std::nanf(""), -1, std::numeric_limits<float>::infinity()),
                  Rgb(-std::numeric_limits<float>::infinity(), 1e38f, 2)};
  writeExr(path("a.exr"), image, {});
  expectSameBits(readImage(path("a.exr"), limits_), image);
  EXPECT_TRUE(warnings_.entries().empty());

  const RawImage repaired = readRawImage(path("a.exr"), limits_, warnings_);
  EXPECT_EQ(repaired.values, (std::vector<float>{0, 0, 65504, 0, 1e38f, 2}));
  const auto entries = warnings_.entries();
  EXPECT_EQ(entries.at("image value that is not a number, taken as 0").count, 1u);
  EXPECT_EQ(entries.at("negative image value, taken as 0").count, 2u);
  EXPECT_EQ(entries.at("infinite image value, taken as 65504").count, 1u);

  Warnings strict(true);
  EXPECT_EQ(statusOf([&] { readRawImage(path("a.exr"), limits_, strict); }), ExitStatus::badScene);
}

TEST_F(ExrTest, UncompressedFloatsKeepTheirBits) {
  writeExr(path("a.exr"), stored(), {}, ExrStorage::none);
  expectSameBits(readImage(path("a.exr"), limits_), stored());
  const Imf::InputFile file(path("a.exr").c_str());
  EXPECT_EQ(file.header().compression(), Imf::NO_COMPRESSION);
}

// Values are rounded to the nearest half, by half a unit in the last of 11 bits at most. Values
// that are too large stay finite.
TEST_F(ExrTest, HalvesAreTheNearest) {
  Image image = stored();
  image.at(0, 0) = {1e6f, std::numeric_limits<float>::infinity(), -1e6f};
  image.at(1, 0) = {std::numeric_limits<float>::quiet_NaN(), 0, 65504};

  writeExr(path("a.exr"), image, {}, ExrStorage::half);
  const Image back = readImage(path("a.exr"), limits_);
  EXPECT_EQ(back.at(0, 0), (Rgb{65504, 65504, -65504}));
  EXPECT_TRUE(std::isnan(back.at(1, 0)[0]));
  EXPECT_EQ(back.at(1, 0)[2], 65504);

  for (std::size_t i = 2; i < image.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(back.pixels[i][c], image.pixels[i][c], image.pixels[i][c] / 2048) << i;
    }
  }
}

// OpenEXR's level of 45 is said to be lossless to the eye.
TEST_F(ExrTest, DwaaIsNear) {
  constexpr float kNear = 0.02f;

  writeExr(path("a.exr"), stored(), {}, ExrStorage::dwaa);
  const Image back = readImage(path("a.exr"), limits_);
  for (std::size_t i = 0; i < back.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(back.pixels[i][c], stored().pixels[i][c], kNear) << i;
  }

  const Imf::InputFile file(path("a.exr").c_str());
  EXPECT_EQ(file.header().compression(), Imf::DWAA_COMPRESSION);
}

TEST_F(ExrTest, TheBytesDoNotDependOnTheThreads) {
  for (const ExrStorage storage :
       {ExrStorage::zip, ExrStorage::none, ExrStorage::half, ExrStorage::dwaa}) {
    writeExr(path("one.exr"), stored(), {{"a", "b"}}, storage, 1);
    writeExr(path("many.exr"), stored(), {{"a", "b"}}, storage, 3);
    EXPECT_EQ(load(path("one.exr")), load(path("many.exr")));
  }
}

}  // namespace
}  // namespace whit
