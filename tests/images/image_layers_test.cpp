#include <png.h>

#include <algorithm>
#include <cmath>

#include "has_text.h"
#include "image_samples.h"
#include "io/image/image_layers.h"

namespace whit {
namespace {

using Codes = std::vector<std::uint16_t>;

// Channels of the pixels of a 4x3 picture that are in a window, with values that half floats and 16
// bits would not hold.
ChannelLayers sampleChannels(const Crop& window = {0, 0, 4, 3}) {
  ChannelLayers layers;
  layers.resize(parseChannels("depth,position,normal,albedo,uv,object,material,triangle,rays"),
                cellsOf(window.x1 - window.x0, window.y1 - window.y0));
  std::size_t i = 0;
  for (int row = window.y0; row < window.y1; ++row) {
    for (int column = window.x0; column < window.x1; ++column, ++i) {
      const auto pixel = static_cast<std::uint32_t>(4 * row + column);
      const auto x = static_cast<float>(pixel);
      ChannelValues v;
      v.z = 1.0f / 3 + x;
      v.distance = 1e-7f * x;
      v.position = {x, -x, 70001.25f};
      v.normal = {0, x / 12, -1};
      v.albedo = {0.1f, x / 12, 1};
      v.uv = {x, 0.5f};
      v.object = 0xfffffff0u + pixel;
      v.material = 3;
      v.triangle = 1u << 24;

      // Pixel 5 shows no surface.
      layers.keep(i, pixel == 5 ? ChannelValues() : v);
      layers.numbers(Channel::rays)[i] = pixel;
    }
  }
  return layers;
}

void expectSame(const std::vector<ImageLayer>& found, const std::vector<ImageLayer>& wanted) {
  ASSERT_EQ(found.size(), wanted.size());
  for (const std::size_t k : indices(wanted)) {
    EXPECT_EQ(found[k].name, wanted[k].name);
    EXPECT_EQ(found[k].words, wanted[k].words) << found[k].name;
  }
}

class ImageLayers : public ImageTest {
 protected:
  std::string write(const std::string& name, const ChannelLayers& layers,
                    ExrStorage storage = ExrStorage::zip, const Crop& window = {0, 0, 4, 3}) {
    writeExr(path(name), Image(4, 3, window), {}, storage, 1, layersOf(layers));
    return path(name);
  }
};

TEST_F(ImageLayers, KeepEveryBit) {
  const ChannelLayers layers = sampleChannels();
  std::vector<ImageLayer> wanted = layersOf(layers);
  std::ranges::sort(wanted, {}, &ImageLayer::name);
  for (const ExrStorage storage : {ExrStorage::zip, ExrStorage::none, ExrStorage::half}) {
    expectSame(readLayers(write("a.exr", layers, storage), limits_), wanted);
  }

  EXPECT_EQ(statusOf([&] { write("b.exr", layers, ExrStorage::dwaa); }), ExitStatus::usage);
}

TEST_F(ImageLayers, AreInTheOrderOfTheirNames) {
  std::string names;
  for (const ImageLayer& l : readLayers(write("a.exr", sampleChannels()), limits_)) {
    names += l.name + (l.countsThings ? "! " : " ");
  }
  EXPECT_EQ(names,
            "albedo.B albedo.G albedo.R depth.Z depth.distance material.id! normal.X normal.Y "
            "normal.Z object.id! position.X position.Y position.Z rays.count! triangle.id! uv.U "
            "uv.V ");
}

TEST_F(ImageLayers, PartsAreMerged) {
  // The parts overlap by a column, in which they agree.
  std::vector<std::string> parts;
  for (const Crop& window : {Crop{0, 0, 3, 3}, Crop{2, 0, 4, 3}}) {
    parts.push_back(write(std::to_string(parts.size()) + ".exr", sampleChannels(window),
                          ExrStorage::zip, window));
  }
  const MergedImage merged = mergeImages(parts, limits_, warnings_);
  EXPECT_TRUE(warnings_.entries().empty());
  writeExr(path("m.exr"), merged.image, {}, ExrStorage::zip, 1, merged.layers);
  expectSame(readLayers(path("m.exr"), limits_),
             readLayers(write("w.exr", sampleChannels()), limits_));
}

TEST_F(ImageLayers, OfTheLaterPartCount) {
  ChannelLayers later = sampleChannels();
  for (std::uint32_t& count : later.numbers(Channel::rays)) count += 7;
  const std::string first = write("a.exr", sampleChannels()), second = write("b.exr", later);
  expectSame(mergeImages({first, second}, limits_, warnings_).layers, readLayers(second, limits_));
}

TEST_F(ImageLayers, APartThatLacksOneIsRefused) {
  ChannelLayers less;
  less.resize(parseChannels("depth"), 12);
  const std::string all = write("a.exr", sampleChannels()), some = write("s.exr", less);

  for (const auto& parts : {std::vector{all, some}, std::vector{some, all}}) {
    EXPECT_TRUE(
        hasText(refusalOf(ExitStatus::usage, [&] { mergeImages(parts, limits_, warnings_); }),
                "s.exr: lacks the channel"));
  }
}

// Returns the values of a PNG of 16 bits as libpng reads them.
Codes readPng16(const std::string& path, int& channels, bool& isSrgb) {
  std::FILE* const file = std::fopen(path.c_str(), "rb");
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_read_info(png, info);
  EXPECT_EQ(png_get_bit_depth(png, info), 16);
  isSrgb = png_get_valid(png, info, PNG_INFO_sRGB | PNG_INFO_gAMA | PNG_INFO_cHRM) != 0;
  channels = png_get_channels(png, info);

  Codes values;
  std::vector<std::uint8_t> row(png_get_rowbytes(png, info));
  for (png_uint_32 y = 0; y < png_get_image_height(png, info); ++y) {
    png_read_row(png, row.data(), nullptr);
    for (std::size_t i = 0; i < row.size(); i += 2) {
      values.push_back(static_cast<std::uint16_t>(row[i] << 8 | row[i + 1]));
    }
  }

  png_destroy_read_struct(&png, &info, nullptr);
  std::fclose(file);
  return values;
}

class ChannelPng : public ImageLayers {
 protected:
  // Writes a picture of two pixels, of which the first has these values and the second shows no
  // surface, and returns the codes in the file.
  Codes codes(Channel channel, const ChannelValues& values, std::uint32_t rays = 1) {
    ChannelLayers layers;
    layers.resize(ChannelSet().with(channel), 2);
    layers.keep(0, values);
    layers.keep(1, {});
    if (channel == Channel::rays) layers.numbers(channel)[0] = layers.numbers(channel)[1] = rays;

    writeChannelPng(path("a.png"), Image(2, 1), layers, channel, {});
    return readPng16(path("a.png"), components_, isSrgb_);
  }
  ExitStatus statusOf(Channel channel, const ChannelValues& values, std::uint32_t rays = 1) {
    return whit::statusOf([&] { codes(channel, values, rays); });
  }
  int components_ = 0;
  bool isSrgb_ = false;  // the file names the color space of its codes
};

TEST_F(ChannelPng, DepthIsInThousandthsOfAUnit) {
  ChannelValues v;
  v.z = 1.2344f;
  v.distance = 9;
  EXPECT_EQ(codes(Channel::depth, v), (Codes{1234, 0}));
  EXPECT_EQ(components_, 1);

  v.z = 65.535f;
  EXPECT_EQ(codes(Channel::depth, v), (Codes{65535, 0}));
  v.z = 65.536f;
  EXPECT_EQ(statusOf(Channel::depth, v), ExitStatus::limit);
  v.z = -1;
  EXPECT_EQ(statusOf(Channel::depth, v), ExitStatus::limit);
}

TEST_F(ChannelPng, VectorsAndColors) {
  ChannelValues v;
  v.normal = {1, -1, 0};
  EXPECT_EQ(codes(Channel::normal, v), (Codes{65535, 0, 32768, 0, 0, 0}));
  EXPECT_EQ(components_, 3);

  v.albedo = {1, 0, 0.0031308f / 2};  // the linear part of sRGB
  EXPECT_EQ(codes(Channel::albedo, v),
            (Codes{65535, 0, static_cast<std::uint16_t>(std::lround(12.92 * 0.0015654 * 65535)), 0,
                   0, 0}));

  v.uv = {1.25f, -0.25f};
  EXPECT_EQ(codes(Channel::uv, v), (Codes{16384, 49151, 0, 0, 0, 0}));
  EXPECT_EQ(statusOf(Channel::position, v), ExitStatus::usage);
  EXPECT_EQ(statusOf(Channel::motion, v), ExitStatus::usage);

  v.roughness = 0.25f;
  v.metallic = 1;
  EXPECT_EQ(codes(Channel::roughness, v), (Codes{16384, 0}));
  EXPECT_EQ(codes(Channel::metallic, v), (Codes{65535, 0}));
  EXPECT_EQ(components_, 1);
}

// Programs that show a picture convert the codes of a color space, which would falsify data.
TEST_F(ChannelPng, OnlyColorsAreSrgb) {
  ChannelValues v;
  v.object = v.material = v.triangle = 1;
  for (const std::size_t i : indices(kChannels)) {
    const auto channel = static_cast<Channel>(i);
    if (statusOf(channel, v) != ExitStatus::done) continue;
    EXPECT_EQ(isSrgb_, channel == Channel::albedo) << kChannels[i].name;
  }
}

TEST_F(ChannelPng, NumbersAreWholeOrRefused) {
  ChannelValues v;
  v.object = 65534;
  v.material = 0;
  v.triangle = 65535;
  EXPECT_EQ(codes(Channel::object, v), (Codes{65534, 65535}));
  EXPECT_EQ(codes(Channel::material, v), (Codes{0, 65535}));
  EXPECT_EQ(statusOf(Channel::triangle, v), ExitStatus::limit);
  EXPECT_EQ(codes(Channel::rays, v, 65535), (Codes{65535, 65535}));
  EXPECT_EQ(statusOf(Channel::rays, v, 65536), ExitStatus::limit);
}

}  // namespace
}  // namespace whit
