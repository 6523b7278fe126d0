#include "io/image_file.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "core/srgb.h"
#include "io/image_decoders.h"

namespace whit {

namespace {

constexpr float kLargestHalf = 65504;

std::string sizeText(std::int64_t width, std::int64_t height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

// At most `limit` bytes from the beginning; all when the file is no longer than that.
std::vector<std::uint8_t> readBytes(const std::string& path, std::uint64_t limit) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throwIo("cannot read '" + path + "': no such file");
  if (!std::filesystem::is_regular_file(path, error))
    throwIo("cannot read '" + path + "': not a file");
  const std::uint64_t size = std::filesystem::file_size(path, error);
  std::ifstream in(path, std::ios::binary);
  if (error || !in) throwIo("cannot read '" + path + "': " + std::strerror(errno));
  std::vector<std::uint8_t> bytes(std::min(size, limit));
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!in) throwIo("cannot read '" + path + "': reading stopped early");
  return bytes;
}

bool isExrFile(const std::string& path) { return isExr(readBytes(path, 4)); }

// stb_image counts in int.
void checkFileSize(const std::string& name, std::uint64_t size, const ImageLimits& limits) {
  const std::uint64_t longest = std::min<std::uint64_t>(limits.bytes, 0x7fffffff);
  if (size > longest)
    throwLimit(name + ": the file is longer than the " + std::to_string(longest) +
               " bytes allowed");
}

RawImage decodeBytes(const std::string& name, const std::vector<std::uint8_t>& file,
                     const ImageLimits& limits) {
  return isJpeg(file) ? decodeJpeg(name, file, limits) : decodeWithStb(name, file, limits);
}

RawImage decodeOther(const std::string& path, const ImageLimits& limits) {
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(path, error);
  checkFileSize(path, size, limits);
  const MemoryHold file(limits.budget, error ? 0 : size, 1, path);
  return decodeBytes(path, readBytes(path, limits.bytes), limits);
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

RawImage decodeRawImage(const std::string& name, const std::vector<std::uint8_t>& file,
                        const ImageLimits& limits, Warnings& warnings) {
  checkFileSize(name, file.size(), limits);
  const MemoryHold copy(limits.budget, file.size(), 1, name);
  RawImage raw = decodeBytes(name, file, limits);
  sanitise(name, raw.values, warnings);
  return raw;
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
