#include "io/image/image_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>

#include "core/error.h"
#include "core/srgb.h"
#include "io/image/image_decoders.h"
#include "io/paths.h"
#include "io/read_file.h"

namespace whit {

namespace {

constexpr float kLargestHalf = 65504;

std::string sizeText(std::int64_t width, std::int64_t height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

bool isExrFile(const std::string& path) { return isExr(asBytes(readBeginning(path, 4))); }

// Names formats that are not read but often taken for textures.
std::string kindOf(std::span<const std::uint8_t> file) {
  constexpr std::pair<std::string_view, const char*> kBeginnings[] = {
      {"GIF8", "a GIF image"},       {"RIFF", "a WebP image"},   {"DDS ", "a DDS texture"},
      {"\xabKTX", "a KTX texture"},  {"II*", "a TIFF image"},    {"MM", "a TIFF image"},
      {"8BPS", "a Photoshop image"}, {"<", "a page of the web"}, {"", "something else"}};
  if (file.empty()) return "an empty file";
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  return std::find_if(std::begin(kBeginnings), std::end(kBeginnings),
                      [&](const auto& known) { return text.starts_with(known.first); })
      ->second;
}

RawImage decodeBytes(const std::string& name, std::span<const std::uint8_t> file,
                     const ImageLimits& limits) {
  if (isPng(file)) return decodePng(name, file, limits);
  if (isJpeg(file)) return decodeJpeg(name, file, limits);
  if (isBmp(file)) return decodeBmp(name, file, limits);
  if (isHdr(file)) return decodeHdr(name, file, limits);
  if (extensionOf(name) == ".tga") return decodeTga(name, file, limits);
  throwBadScene(
      name, "expected a PNG, JPEG, TGA, BMP, Radiance HDR or OpenEXR image, found " + kindOf(file));
}

RawImage decodeOther(const std::string& path, const ImageLimits& limits) {
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(path, error);
  const MemoryHold held(limits.budget, error ? 0 : size, 1, path);
  const std::string file = readFile(path, limits.bytes);
  return decodeBytes(path, asBytes(file), limits);
}

// The display window's values; what lies outside the data window is 0.
RawImage fillDisplay(const std::string& path, ExrPixels&& exr, const ImageLimits& limits) {
  RawImage raw;
  raw.width = exr.width;
  raw.height = exr.height;
  raw.channels = exr.channels;
  raw.linear = true;
  if (exr.window == Crop{0, 0, exr.width, exr.height}) {
    raw.values = std::move(exr.values);
    raw.held = std::move(exr.held);
    return raw;
  }
  const auto channels = static_cast<std::size_t>(exr.channels);
  raw.held = holdImage(path, exr.width, exr.height, channels * sizeof(float), limits);
  const std::size_t row = static_cast<std::size_t>(exr.width) * channels;
  const std::size_t part = static_cast<std::size_t>(exr.window.x1 - exr.window.x0) * channels;
  raw.values.resize(row * static_cast<std::size_t>(exr.height));
  for (int y = exr.window.y0; y < exr.window.y1; ++y) {
    const float* from = exr.values.data() + static_cast<std::size_t>(y - exr.window.y0) * part;
    std::copy(from, from + part,
              raw.values.data() + static_cast<std::size_t>(y) * row +
                  static_cast<std::size_t>(exr.window.x0) * channels);
  }
  return raw;
}

void sanitise(const std::string& path, std::vector<float>& values, Warnings& warnings) {
  std::uint64_t nan = 0, negative = 0, infinite = 0;
  for (float& value : values) {
    if (std::isnan(value)) {
      ++nan;
      value = 0;
    } else if (value < 0) {
      ++negative;
      value = 0;
    } else if (std::isinf(value)) {
      ++infinite;
      value = kLargestHalf;
    }
  }
  warnings.add("image value that is not a number, taken as 0", path, nan);
  warnings.add("negative image value, taken as 0", path, negative);
  warnings.add("infinite image value, taken as 65504", path, infinite);
}

}  // namespace

void checkImageSize(const std::string& path, std::int64_t width, std::int64_t height,
                    std::uint64_t bytesPerPixel, const ImageLimits& limits) {
  if (width < 1 || height < 1)
    throwBadScene(path, "expected a size of at least 1x1, found " + sizeText(width, height));
  if (width > limits.side || height > limits.side)
    throwLimit(path + ": " + sizeText(width, height) + " is larger than the " +
               std::to_string(limits.side) + " pixels a side allowed");
  // Sides below 2^32 and a few bytes a pixel: divide, so that nothing can overflow.
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  if (pixels > limits.bytes / bytesPerPixel)
    throwLimit(path + ": " + sizeText(width, height) + " takes more than the " +
               std::to_string(limits.bytes) + " bytes allowed");
}

MemoryHold holdImage(const std::string& path, std::int64_t width, std::int64_t height,
                     std::uint64_t bytesPerPixel, const ImageLimits& limits) {
  checkImageSize(path, width, height, bytesPerPixel, limits);
  const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  return {limits.budget, pixels, bytesPerPixel, path + ": " + sizeText(width, height)};
}

RawImage readRawImage(const std::string& path, const ImageLimits& limits, Warnings& warnings) {
  RawImage raw = isExrFile(path) ? fillDisplay(path, decodeExr(path, limits), limits)
                                 : decodeOther(path, limits);
  sanitise(path, raw.values, warnings);
  return raw;
}

RawImage decodeRawImage(const std::string& name, std::span<const std::uint8_t> file,
                        const ImageLimits& limits, Warnings& warnings) {
  RawImage raw = decodeBytes(name, file, limits);
  sanitise(name, raw.values, warnings);
  return raw;
}

bool holdsRadiance(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  std::vector<std::uint8_t> beginning(4);
  std::ifstream in(path, std::ios::binary);
  if (!in.read(reinterpret_cast<char*>(beginning.data()), 4)) return false;
  return isExr(beginning) || (beginning[0] == '#' && beginning[1] == '?');
}

Image readImage(const std::string& path, const ImageLimits& limits, Warnings&) {
  ExrPixels source;
  if (isExrFile(path)) {
    source = decodeExr(path, limits);
  } else {
    RawImage raw = decodeOther(path, limits);
    source = {raw.width, raw.height, {0, 0, raw.width, raw.height}, raw.channels, {}, {}};
    source.values = std::move(raw.values);
    source.values.reserve(raw.codes.size());
    for (const std::uint8_t code : raw.codes) source.values.push_back(linearOfCode(code));
  }
  Image image(source.width, source.height, source.window);
  const auto channels = static_cast<std::size_t>(source.channels);
  const float* value = source.values.data();
  for (Rgb& pixel : image.pixels) {
    pixel = channels < 3 ? Rgb(value[0]) : Rgb(value[0], value[1], value[2]);
    value += channels;
  }
  return image;
}

}  // namespace whit
