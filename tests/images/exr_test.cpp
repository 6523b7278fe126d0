// OpenEXR: what is written comes back bit for bit, and other programs' files are understood.
#include <ImfEnvmap.h>
#include <ImfInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "foreign_exr.h"
#include "has_text.h"
#include "image_samples.h"
#include "io/image/texture_from_image.h"

namespace whit {
namespace {

// A smooth picture, whose values half floats can only round.
Image smooth() {
  Image image(64, 48);
  Rgb value(0.01f);
  for (Rgb& pixel : image.pixels) {
    pixel = value;
    value += Rgb(0.0003f, 0.0002f, 0.0001f);
  }
  return image;
}

class ExrTest : public ImageTest {
 protected:
  Image readBack() { return readImage(path("a.exr"), limits_); }
  Image stored(const Image& image, ExrStorage storage = ExrStorage::zip) {
    writeExr(path("a.exr"), image, {}, storage);
    return readBack();
  }
  void expectStored(const Image& image, ExrStorage storage = ExrStorage::zip) {
    const Image back = stored(image, storage);
    EXPECT_EQ((ImageSize{back.width, back.height}), (ImageSize{image.width, image.height}));
    EXPECT_EQ(back.window, image.window);
    ASSERT_EQ(back.pixels.size(), image.pixels.size());
    EXPECT_EQ(std::memcmp(back.pixels.data(), image.pixels.data(), 12 * image.pixels.size()), 0)
        << "bits differ";
  }
  Imf::Header writtenHeader() { return Imf::InputFile(path("a.exr").c_str()).header(); }

  std::string write(const ForeignFile& file) {
    file.write(path("foreign.exr"));
    return path("foreign.exr");
  }
  RawImage raw(const ForeignFile& file) { return read(write(file)); }
  void writeRgba(const Imf::Header& header, Imf::RgbaChannels channels,
                 const std::vector<Imf::Rgba>& pixels) {
    Imf::RgbaOutputFile file(path("a.exr").c_str(), header, channels);
    file.setFrameBuffer(pixels.data(), 1, static_cast<std::size_t>(file.dataWindow().max.x + 1));
    file.writePixels(file.dataWindow().max.y + 1);
  }
};

TEST_F(ExrTest, FloatsKeepTheirBits) {
  Image image(7, 5);
  std::uint32_t pattern = 0x01234567;
  for (Rgb& pixel : image.pixels) {
    for (int c = 0; c < 3; ++c) {
      pattern = pattern * 1664525u + 1013904223u;
      pixel[c] = std::bit_cast<float>(pattern);
    }
  }

  using Limits = std::numeric_limits<float>;
  image.pixels[0] = {std::bit_cast<float>(0x7fc12345u), INFINITY, -INFINITY};
  image.pixels[1] = {Limits::denorm_min(), Limits::max(), -0.0f};
  expectStored(image);
  expectStored(image, ExrStorage::none);
  EXPECT_EQ(writtenHeader().compression(), Imf::NO_COMPRESSION);
}

TEST_F(ExrTest, CropsKeepTheirPlace) {
  for (const Crop& crop : {Crop{0, 0, 1, 1}, Crop{99, 49, 100, 50}, Crop{13, 7, 60, 8},
                           Crop{0, 0, 100, 50}, Crop{5, 0, 6, 50}}) {
    Image image(100, 50, crop);
    Rgb value(0.1f);
    for (Rgb& pixel : image.pixels) {
      pixel = value;
      value += Rgb(1, 2, 3);
    }
    expectStored(image);
  }
  expectStored(Image(1, 1));
}

TEST_F(ExrTest, MetadataComesBack) {
  const ImageMetadata metadata = {{"crop", "0,0,4,4"},
                                  {"name", "atrium"},  // OpenEXR has an attribute of this name
                                  {"compression", "none"},
                                  {"scene", "caf\xc3\xa9"},
                                  {"type", "nonsense"}};
  writeExr(path("a.exr"), Image(4, 4), metadata);
  EXPECT_TRUE(std::ranges::is_permutation(readExrMetadata(path("a.exr")), metadata));
}

// The places of points in the picture are worked out by hand: the eye looks along -z.
TEST_F(ExrTest, SaysHowTheWorldIsSeen) {
  ImageMetadata metadata = {{"eye", "1,2,6"}, {"at", "1,2,0"}, {"up", "0,1,0"}, {"fov", "90"}};
  const auto headerOf = [&](const ImageMetadata& said) {
    writeExr(path("a.exr"), Image(4, 2), said);
    const Imf::Header written = writtenHeader();
    EXPECT_EQ(written.find("eye"), written.end());  // it is stored as whit:eye
    EXPECT_TRUE(Imf::hasChromaticities(written));
    return written;
  };

  const auto expectAt = [](const Imath::M44f& matrix, const Imath::V3f& point,
                           const Imath::V3f& there) {
    EXPECT_TRUE((point * matrix).equalWithAbsError(there, 1e-6f)) << point * matrix;
  };

  const Imf::Header seen = headerOf(metadata);
  const Imath::M44f camera = Imf::worldToCamera(seen), ndc = Imf::worldToNDC(seen);
  expectAt(camera, {1, 2, 6}, {0, 0, 0});
  expectAt(camera, {1.5f, 3, 2}, {0.5f, 1, 4});
  expectAt(ndc, {1, 2, 2}, {0.5f, 0.5f, 0.25f});
  expectAt(ndc, {1, 6, 2}, {0.5f, 0, 0.25f});  // the upper border, 45 degrees above
  expectAt(ndc, {9, -2, 2}, {1, 1, 0.25f});    // the lower right corner: twice as wide as high

  // Parallel rays show a height of 3 units, and the third coordinate stays the depth.
  metadata.emplace_back("ortho", "3");
  const Imf::Header parallel = headerOf(metadata);
  EXPECT_EQ(Imf::worldToCamera(parallel), camera);
  expectAt(Imf::worldToNDC(parallel), {4, 0.5f, -7}, {1, 1, 13});

  // A panorama has no matrix of a projection.
  const Imf::Header panorama =
      headerOf({{"eye", "1,2,6"}, {"at", "1,2,0"}, {"projection", "panorama"}});
  EXPECT_EQ(Imf::worldToCamera(panorama), camera);
  EXPECT_FALSE(Imf::hasWorldToNDC(panorama));
}

// Single precision would round both points of this view to quarters.
TEST_F(ExrTest, SaysHowTheWorldIsSeenFromFarAway) {
  const auto matrix = [&](const std::string& eye, const std::string& at) {
    writeExr(path("a.exr"), Image(4, 2), {{"eye", eye}, {"at", at}, {"fov", "90"}});
    return Imf::worldToCamera(writtenHeader());
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
    file.compression = static_cast<Imf::Compression>(c);
    const RawImage image = raw(file);
    EXPECT_EQ(image.channels, 3);
    ASSERT_EQ(image.values.size(), 36u);
    // Lossy compressions keep constant powers of two to a part in a hundred.
    for (const std::size_t i : indices(image.pixels())) {
      EXPECT_LT(length(linearPixel(image, i) - Rgb(1, 2, 4)), 0.04f) << c;
    }
  }
}

TEST_F(ExrTest, HalvesAndAlphaAreRead) {
  ForeignFile file{{{"R", 0.5f}, {"G", 65504}, {"B", 6.0e-8f}, {"A", 0.25f}}};
  file.type = Imf::HALF;
  file.display = file.data = {{0, 0}, {0, 0}};
  const RawImage image = raw(file);
  EXPECT_EQ(image.channels, 4);
  EXPECT_EQ(image.values, (std::vector{0.5f, 65504.0f, std::ldexp(1.0f, -24), 0.25f}));
}

// OpenEXR's colors are premultiplied, and those of textures are not. Without coverage there is no
// color to divide, and quotients beyond floats are infinite.
TEST_F(ExrTest, ColorsOfTexturesAreDividedByAlpha) {
  struct Stored {
    std::map<std::string, float> channels;
    std::vector<float> texel;
  };
  constexpr float kLargestHalf = 65504;  // stands for infinity
  for (const Stored& s :
       {Stored{{{"R", 0.5f}, {"G", 0.25f}, {"B", 0.1f}, {"A", 0.5f}}, {1, 0.5f, 0.2f, 0.5f}},
        {{{"Y", 0.5f}, {"A", 0.25f}}, {2, 0.25f}},
        {{{"R", 0.5f}, {"G", 0.25f}, {"B", 0}, {"A", 0}}, {0.5f, 0.25f, 0, 0}},
        {{{"R", 0.5f}, {"G", 0.25f}, {"B", 0}}, {0.5f, 0.25f, 0}},
        {{{"Y", 1e38f}, {"A", 0.125f}}, {kLargestHalf, 0.125f}}}) {
    ForeignFile file{s.channels};
    file.display = file.data = {{0, 0}, {0, 0}};
    EXPECT_EQ(readStraightImage(write(file), limits_, warnings_).values, s.texel);
  }

  // Files of codes have straight colors already.
  const std::string codes = save("a.png", png(1, 1, 8, 4, {0, 100, 50}));
  EXPECT_EQ(readStraightImage(codes, limits_, warnings_).codes, (Bytes{100, 50}));
}

// Luminance alone is gray, and channels that are missing are black. Layers are named as Blender
// names them; one that is no picture does not count.
TEST_F(ExrTest, ColorsAreFoundByTheirNames) {
  struct Named {
    std::map<std::string, float> channels;
    int count;
    Rgb color;
  };
  for (const Named& n :
       {Named{{{"Y", 0.75f}, {"Z", 9}}, 1, Rgb(0.75f)}, Named{{{"G", 0.5f}}, 3, Rgb(0, 0.5f, 0)},
        Named{{{"Another.R", 9},
               {"ViewLayer.Combined.R", 0.25f},
               {"ViewLayer.Combined.G", 0.5f},
               {"ViewLayer.Combined.B", 0.75f},
               {"ViewLayer.Combined.A", 0.5f},
               {"ViewLayer.Depth.Z", 7}},
              4,
              Rgb(0.25f, 0.5f, 0.75f)}}) {
    const std::string file = write({n.channels});
    EXPECT_EQ(read(file).channels, n.count);
    EXPECT_EQ(readImage(file, limits_).at(3, 2), n.color);
  }
}

TEST_F(ExrTest, NoColorAtAllIsAnError) {
  for (const char* name : {"layer.X", "position.Y"}) {
    const std::string file = write({{{"Z", 1}, {name, 1}}});
    EXPECT_TRUE(hasText(refusalOf(ExitStatus::badScene, [&] { read(file); }), name));
  }
}

// OpenEXR would take what follows the list for an attribute, and allocate what that claims to take.
TEST_F(ExrTest, ListsOfChannelsEndWithTheirAttribute) {
  Bytes bytes = load(write({}));

  // Another list of one channel, "A", without the empty name at its end.
  constexpr int kAttributesAt = 8, kChannelBytes = 18;
  std::string attribute("more\0chlist\0", 12);
  attribute += {kChannelBytes, 0, 0, 0};
  attribute.append("A\0\2\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0", kChannelBytes);
  bytes.insert(bytes.begin() + kAttributesAt, attribute.begin(), attribute.end());
  EXPECT_EQ(errorOf("list.exr", bytes),
            ": header: expected the list of channels 'more' to end where its attribute does");
}

// Windows need neither begin at 0 nor lie inside one another.
TEST_F(ExrTest, DataWindowIsTakenRelativeToTheDisplayWindow) {
  ForeignFile file;
  file.display = {{-10, 5}, {-1, 14}};
  file.data = {{-12, 7}, {-8, 30}};  // beyond the left and the bottom

  const Image image = readImage(write(file), limits_);
  EXPECT_EQ((ImageSize{image.width, image.height}), (ImageSize{10, 10}));
  EXPECT_EQ(image.window, (Crop{0, 2, 3, 10}));
  for (const Rgb& pixel : image.pixels) EXPECT_EQ(pixel, Rgb(1, 2, 4));

  // As a texture the picture is filled up with black.
  const RawImage filled = raw(file);
  EXPECT_EQ((ImageSize{filled.width, filled.height}), (ImageSize{10, 10}));
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 10; ++x) {
      EXPECT_EQ(linearPixel(filled, cellAt(x, y, 10)), x < 3 && y >= 2 ? Rgb(1, 2, 4) : Rgb());
    }
  }
}

TEST_F(ExrTest, TilesAreRead) {
  ForeignFile file;
  file.display = file.data = {{0, 0}, {36, 20}};
  file.writeTiled(path("tiled.exr"));
  const Image image = readImage(path("tiled.exr"), limits_);
  EXPECT_EQ(image.window, (Crop{0, 0, 37, 21}));
  for (const Rgb& pixel : image.pixels) EXPECT_EQ(pixel, Rgb(1, 2, 4));
}

TEST_F(ExrTest, OfSeveralPartsTheFirstIsRead) {
  const ForeignFile first, second{{{"R", 9}, {"G", 9}, {"B", 9}}};
  std::vector<Imf::Header> headers = {first.header(), second.header()};
  headers[0].setName("beauty");
  headers[1].setName("other");
  for (Imf::Header& header : headers) header.setType(Imf::SCANLINEIMAGE);

  {
    Imf::MultiPartOutputFile file(path("parts.exr").c_str(), headers.data(), 2);
    first.fill(Imf::OutputPart(file, 0));
    second.fill(Imf::OutputPart(file, 1));
  }

  EXPECT_EQ(readImage(path("parts.exr"), limits_).at(0, 0), Rgb(1, 2, 4));
}

// Chroma is stored for every fourth pixel, in half floats.
TEST_F(ExrTest, LuminanceAndChroma) {
  constexpr int kSide = 16;
  writeRgba(Imf::Header(kSide, kSide), Imf::WRITE_YC,
            std::vector(kSide * kSide, Imf::Rgba(0.25f, 0.5f, 0.75f, 1)));

  constexpr float kHalf = 2e-3f;
  for (const Rgb& pixel : readBack().pixels) {
    EXPECT_LE(maxComponent(abs(pixel - Rgb(0.25f, 0.5f, 0.75f))), kHalf);
  }
}

// Each pixel holds its direction by OpenEXR's own functions, divided by its largest component: a
// linear function on each face, which interpolation keeps.
TEST_F(ExrTest, CubesBecomeSkies) {
  constexpr int kSide = 8;
  const auto colorOf = [](const Imath::V3f& d) {
    return Imath::V3f(1) + d / std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  };
  const Imath::Box2i data({0, 0}, {kSide - 1, 6 * kSide - 1});
  std::vector<Imf::Rgba> pixels(6 * kSide * kSide);
  for (int face = 0; face < 6; ++face) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const Imf::CubeMapFace side = static_cast<Imf::CubeMapFace>(face);
        const Imath::V2f within(static_cast<float>(x), static_cast<float>(y));
        const Imath::V3f color = colorOf(Imf::CubeMap::direction(side, data, within));
        const Imath::V2f at = Imf::CubeMap::pixelPosition(side, data, within);
        entryOf(pixels, std::lround(at.y) * kSide + std::lround(at.x)) =
            Imf::Rgba(color.x, color.y, color.z);
      }
    }
  }

  Imf::Header header(data, data);
  Imf::addEnvmap(header, Imf::ENVMAP_CUBE);
  writeRgba(header, Imf::WRITE_RGB, pixels);

  const EnvironmentImage sky = makeEnvironment(read(path("a.exr")));
  ASSERT_EQ((ImageSize{sky.width, sky.height}), (ImageSize{4 * kSide, 2 * kSide}));

  constexpr float kHalf = 2e-3f;
  const Imath::Box2i window({0, 0}, {sky.width, sky.height});
  for (int y = 0; y < sky.height; ++y) {
    for (int x = 0; x < sky.width; ++x) {
      const Imath::V3f color = colorOf(Imf::LatLongMap::direction(
          window, Imath::V2f(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f)));
      const auto i = cellAt(x, y, sky.width);
      EXPECT_TRUE(Imath::V3f(sky.r[i], sky.g[i], sky.b[i]).equalWithAbsError(color, kHalf))
          << x << " " << y;
    }
  }
}

TEST_F(ExrTest, OtherPrimariesAreSaidToBeLeftOut) {
  const auto warnedOf = [&](const Imf::Chromaticities* primaries) {
    const ForeignFile foreign;
    Imf::Header header = foreign.header();
    if (primaries) Imf::addChromaticities(header, *primaries);
    foreign.fill(Imf::OutputFile(path("primaries.exr").c_str(), header));
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
  image.pixels = {Rgb(NAN, -1, INFINITY), Rgb(-INFINITY, 1e38f, 2)};
  expectStored(image);
  EXPECT_TRUE(warnings_.entries().empty());

  EXPECT_EQ(read(path("a.exr")).values, (std::vector<float>{0, 0, 65504, 0, 1e38f, 2}));
  const auto entries = warnings_.entries();
  EXPECT_EQ(entries.at("image value that is not a number, taken as 0").count, 1u);
  EXPECT_EQ(entries.at("negative image value, taken as 0").count, 2u);
  EXPECT_EQ(entries.at("infinite image value, taken as 65504").count, 1u);

  Warnings strict(true);
  EXPECT_EQ(statusOf([&] { readRawImage(path("a.exr"), limits_, strict); }), ExitStatus::badScene);
}

// Values are rounded to the nearest half, by half a unit in the last of 11 bits at most. Values
// that are too large stay finite.
TEST_F(ExrTest, HalvesAreTheNearest) {
  Image image = smooth();
  image.at(0, 0) = {1e6f, INFINITY, -1e6f};
  image.at(1, 0) = {NAN, 0, 65504};

  const Image back = stored(image, ExrStorage::half);
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

  const Image image = smooth(), back = stored(image, ExrStorage::dwaa);
  for (const std::size_t i : indices(image.pixels)) {
    EXPECT_LT(maxComponent(abs(back.pixels[i] - image.pixels[i])), kNear) << i;
  }
  EXPECT_EQ(writtenHeader().compression(), Imf::DWAA_COMPRESSION);
}

TEST_F(ExrTest, TheBytesAreReproducibleByAnyThreads) {
  for (const ExrStorage storage :
       {ExrStorage::zip, ExrStorage::none, ExrStorage::half, ExrStorage::dwaa}) {
    writeExr(path("one.exr"), smooth(), {{"a", "b"}}, storage, 1);
    writeExr(path("many.exr"), smooth(), {{"a", "b"}}, storage, 3);
    EXPECT_EQ(load(path("one.exr")), load(path("many.exr")));
  }
}

}  // namespace
}  // namespace whit
