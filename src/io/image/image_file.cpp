#include "io/image/image_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "core/display.h"
#include "core/error.h"
#include "core/index.h"
#include "core/text.h"
#include "io/files.h"
#include "io/image/image_decoders.h"
#include "io/image/texture_from_image.h"

namespace whit {

namespace {

constexpr float kLargestHalf = 65504;

std::string sizeText(std::int64_t width, std::int64_t height) { return concat(width, "x", height); }

std::string_view asText(FileBytes file) {
  return {reinterpret_cast<const char*>(file.data()), file.size()};
}

// Names formats that are often used for textures but not supported.
std::string kindOf(FileBytes file) {
  constexpr std::pair<std::string_view, const char*> kBeginnings[] = {
      {"GIF8", "a GIF image"},
      {"RIFF", "a WebP image (this whit was built without libwebp-dev)"},
      {"DDS ", "a DDS texture"},
      {"\xabKTX", "a KTX texture (`ktx extract --transcode rgba8 IN OUT.png` converts it)"},
      {"II*", "a TIFF image"},
      {"MM", "a TIFF image"},
      {"8BPS", "a Photoshop image"},
      {"<", "a page of the web"},
      {"", "something else"}};

  if (file.empty()) return "an empty file";
  return std::ranges::find_if(
             kBeginnings, [&](const auto& known) { return asText(file).starts_with(known.first); })
      ->second;
}

// TGA files have no signature, so the list does not contain them.
struct Format {
  std::string_view beginning;
  ImageDecoder* decode;
};
constexpr Format kFormats[] = {{"\x89PNG\r\n\x1a\n", decodePng},
                               {"\xff\xd8\xff", decodeJpeg},
#ifdef WHIT_WEBP
                               {"RIFF", decodeWebp},
#endif
                               {"BM", decodeBmp},
                               {"#?RADIANCE", decodeHdr},
                               {"#?RGBE", decodeHdr}};

RawImage decodeBytes(const std::string& name, FileBytes file, const ImageLimits& limits) {
  for (const Format& format : kFormats) {
    if (asText(file).starts_with(format.beginning)) return format.decode(name, file, limits);
  }
  if (extensionOf(name) == ".tga") return decodeTga(name, file, limits);
  throwBadScene(
      name,
      "expected a PNG, JPEG, WebP, TGA, BMP, Radiance HDR or OpenEXR image, found " + kindOf(file));
}

RawImage decodeOther(const std::string& path, const ImageLimits& limits, bool allBits) {
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(path, error);
  // The budget counts the file only while it is decoded.
  const MemoryHold held(limits.budget, error ? 0 : size, 1, path);
  const std::string file = readFile(path, limits.bytes);
  if (allBits && isPng16(asBytes(file))) return decodePng16(path, asBytes(file), limits);
  return decodeBytes(path, asBytes(file), limits);
}

void sanitise(const std::string& path, RawImage& raw, Warnings& warnings) {
  if (!raw.leftOut.empty()) warnings.add(raw.leftOut, path);
  std::uint64_t nan = 0, negative = 0, infinite = 0;
  for (float& value : raw.values) {
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

// Makes premultiplied colors straight. Colors without coverage stay: they are light that no texture
// can show.
void divideByAlpha(RawImage& raw) {
  const auto channels = static_cast<std::size_t>(raw.channels);
  if (channels % 2 != 0) return;

  for (const auto i : indices(raw.values)) {
    const float alpha = raw.values[i - i % channels + channels - 1];
    const bool isColor = i % channels != channels - 1;
    if (isColor && alpha > 0) raw.values[i] /= alpha;
  }
}

RawImage decodeFile(const std::string& path, const ImageLimits& limits) {
  return isExrFile(path) ? decodeExr(path, true, limits).raw : decodeOther(path, limits, false);
}

}  // namespace

RawImage decodeAllBits(const std::string& path, const ImageLimits& limits) {
  return decodeOther(path, limits, true);
}

bool isExrFile(const std::string& path) { return readBeginning(path, 4) == "\x76\x2f\x31\x01"; }

void checkImageSize(const std::string& path, std::int64_t width, std::int64_t height,
                    std::uint64_t bytesPerPixel, const ImageLimits& limits) {
  if (width < 1 || height < 1)
    throwBadScene(path, "expected a size of at least 1x1, found " + sizeText(width, height));
  if (width > limits.side || height > limits.side)
    throwLimit(concat(path, ": ", sizeText(width, height), " is larger than the ", limits.side,
                      " pixels a side allowed"));

  // The product of the sides fits into 64 bits. The limit is divided by the bytes of a pixel,
  // because multiplying them could overflow.
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  if (pixels > limits.bytes / bytesPerPixel)
    throwLimit(concat(path, ": ", sizeText(width, height), " takes more than the ", limits.bytes,
                      " bytes allowed"));
}

MemoryHold holdImage(const std::string& path, std::int64_t width, std::int64_t height,
                     std::uint64_t bytesPerPixel, const ImageLimits& limits) {
  checkImageSize(path, width, height, bytesPerPixel, limits);
  const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  return {limits.budget, pixels, bytesPerPixel, path + ": " + sizeText(width, height)};
}

RawImage startImage(const std::string& path, std::int64_t width, std::int64_t height, int channels,
                    bool linear, const ImageLimits& limits) {
  RawImage raw;
  raw.held = holdImage(path, width, height,
                       static_cast<std::uint64_t>(channels) * (linear ? sizeof(float) : 1), limits);

  raw.width = static_cast<int>(width);
  raw.height = static_cast<int>(height);
  raw.channels = channels;
  raw.linear = linear;
  return raw;
}

RawImage readRawImage(const std::string& path, const ImageLimits& limits, Warnings& warnings) {
  RawImage raw = decodeFile(path, limits);
  sanitise(path, raw, warnings);
  return raw;
}

RawImage readStraightImage(const std::string& path, const ImageLimits& limits, Warnings& warnings) {
  RawImage raw = decodeFile(path, limits);
  divideByAlpha(raw);
  sanitise(path, raw, warnings);
  return raw;
}

RawImage decodeRawImage(const std::string& name, FileBytes file, const ImageLimits& limits,
                        Warnings& warnings) {
  RawImage raw = decodeBytes(name, file, limits);
  sanitise(name, raw, warnings);
  return raw;
}

bool holdsRadiance(const std::string& path) {
  try {
    return isExrFile(path) || readBeginning(path, 2) == "#?";
  } catch (const Error&) {
    return false;
  }
}

Image readImage(const std::string& path, const ImageLimits& limits) {
  ExrImage source;
  if (isExrFile(path)) {
    source = decodeExr(path, false, limits);
  } else {
    source.raw = decodeAllBits(path, limits);
    source.width = source.raw.width;
    source.height = source.raw.height;
    source.window = {0, 0, source.width, source.height};
  }

  Image image(source.width, source.height, source.window);
  for (const auto i : indices(image.pixels)) {
    image.pixels[i] = linearPixel(source.raw, i);
    // Codes are of straight colors.
    if (!source.raw.linear) image.pixels[i] *= valueAt(source.raw, i, 3);
  }
  return image;
}

}  // namespace whit
