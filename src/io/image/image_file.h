// Images in and out. What is read is told by its content, save for TGA, which has no signature and
// goes by its name.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/image.h"
#include "core/warnings.h"
#include "io/memory_budget.h"

namespace whit {

using ImageMetadata = std::vector<std::pair<std::string, std::string>>;

struct ImageLimits {
  int side = 32768;                              // pixels
  std::uint64_t bytes = std::uint64_t{4} << 30;  // decoded
  // Where there is one, what decoding takes is held in it: the file, the decoder's own memory, and
  // the image for as long as that lives.
  MemoryBudget* budget = nullptr;
};

// Decoded but not yet interpreted: 8-bit files keep their codes (values code / 255, not
// linearised), HDR and EXR are linear floats. 1 to 4 channels, interleaved, rows from the top.
struct RawImage {
  int width = 0, height = 0, channels = 0;
  bool linear = false;
  std::vector<std::uint8_t> codes;  // when !linear
  std::vector<float> values;  // when linear; sanitised: NaN and negatives 0, inf 65504, counted
  MemoryHold held;            // of these
};

// PNG, JPEG, TGA, BMP, Radiance HDR, OpenEXR. Throws Error(io) if it cannot be read, badScene if it
// cannot be understood, limit if it is larger than `limits` allow.
RawImage readRawImage(const std::string& path, const ImageLimits& limits, Warnings& warnings);

// Decodes a file that is in memory: PNG, JPEG, BMP or Radiance HDR. `name` is for errors.
RawImage decodeRawImage(const std::string& name, std::span<const std::uint8_t> file,
                        const ImageLimits& limits, Warnings& warnings);

// True if the file holds linear light without an upper bound (Radiance HDR, OpenEXR), by its first
// bytes; false where it cannot be read.
bool holdsRadiance(const std::string& path);

// Pixel number `i` as linear RGB: 8-bit codes are decoded from sRGB, gray is spread to three
// channels, alpha is dropped.
Rgb linearPixel(const RawImage& raw, std::size_t i);

// As linear RGB: 8-bit codes decoded from sRGB, gray spread to three channels, alpha dropped. EXR
// keeps its data window (the part inside the display window), and floats keep their bits, NaN and
// infinities included.
Image readImage(const std::string& path, const ImageLimits& limits, Warnings& warnings);

// How the pixels of an EXR are kept: floats compressed without loss, or as they are; as half
// floats, those beyond the largest (65504) as that one; or as half floats with OpenEXR's lossy
// DWAA.
enum class ExrStorage { zip, none, half, dwaa };

// Refers to the values of a channel beside the colors: one for each pixel of the window, row by row
// from the top, `stride` values apart.
struct LayerView {
  std::string name;
  bool countsThings = false;    // 32-bit unsigned numbers, otherwise floats
  const void* first = nullptr;  // the value of the first pixel
  std::size_t stride = 1;
};

// Linear RGB with metadata as string attributes; data window = image.window. `layers` keep all
// their bits: Error(usage) for dwaa. Up to `threads` compress it. The same arguments give the same
// bytes, whatever `threads`.
void writeExr(const std::string& path, const Image& image, const ImageMetadata& metadata,
              ExrStorage storage = ExrStorage::zip, int threads = 1,
              const std::vector<LayerView>& layers = {});
// The string attributes of an EXR's first part that are not OpenEXR's own. Throws as readImage
// does.
ImageMetadata readExrMetadata(const std::string& path);
// sRGB PNG with the metadata as text chunks; alpha is left out. Keywords are cut at PNG's 79 bytes.
void writePng(const std::string& path, const DisplayImage& image, const ImageMetadata& metadata);

// Values of 16 bits, rows from the top: one a pixel, or three.
struct DeepImage {
  int width = 0, height = 0, channels = 1;
  std::vector<std::uint16_t> values;
};
// Writes 16 bits per channel; `isSrgb`: three values are sRGB colors.
void writePng(const std::string& path, const DeepImage& image, bool isSrgb,
              const ImageMetadata& metadata);
// The text chunks of a PNG that has been decoded to its end. Throws Error(io) if it cannot be read,
// badScene if it is damaged or cut off.
ImageMetadata readPngMetadata(const std::string& path);
// The bytes of such a file.
std::string encodePng(const DisplayImage& image, const ImageMetadata& metadata = {});

}  // namespace whit
