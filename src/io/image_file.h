// Images in and out. The format follows the file name's extension.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/image.h"
#include "core/warnings.h"
#include "scene/texture.h"

namespace whit {

using ImageMetadata = std::vector<std::pair<std::string, std::string>>;

struct ImageLimits {
  int side = 32768;                              // pixels
  std::uint64_t bytes = std::uint64_t{4} << 30;  // decoded
};

// Decoded but not yet interpreted: 8-bit files keep their codes (values code / 255, not
// linearised), HDR and EXR are linear floats. 1 to 4 channels, interleaved, rows from the top.
struct RawImage {
  int width = 0, height = 0, channels = 0;
  bool linear = false;
  std::vector<std::uint8_t> codes;  // when !linear
  std::vector<float> values;  // when linear; sanitised: NaN and negatives 0, inf 65504, counted
};

// PNG, JPEG, TGA, BMP, Radiance HDR, OpenEXR. Throws Error(io) if it cannot be read, badScene if it
// cannot be understood, limit if it is larger than `limits` allow.
RawImage readRawImage(const std::string& path, const ImageLimits& limits, Warnings& warnings);

// As linear RGB: 8-bit codes decoded from sRGB. EXR keeps its data window.
Image readImage(const std::string& path, const ImageLimits& limits, Warnings& warnings);

// Linear float (32-bit) RGB with metadata as string attributes; data window = image.window.
void writeExr(const std::string& path, const Image& image, const ImageMetadata& metadata);
// sRGB PNG with the metadata as text chunks.
void writePng(const std::string& path, const DisplayImage& image, const ImageMetadata& metadata);

// A texture of the given format. Colour textures decode sRGB from 8-bit codes.
Texture makeTexture(const std::string& name, const RawImage& raw, TexelFormat format);
EnvironmentImage makeEnvironment(const RawImage& raw);

}  // namespace whit
