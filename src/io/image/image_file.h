// Reading and writing images. Formats are recognized by their content, except TGA, which has no
// signature and is recognized by its name.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/display.h"
#include "core/image.h"
#include "core/warnings.h"
#include "io/memory_budget.h"

namespace whit {

// An encoded image.
using FileBytes = std::span<const std::uint8_t>;
using ImageMetadata = std::vector<std::pair<std::string, std::string>>;

struct ImageLimits {
  int side = 32768;                              // pixels
  std::uint64_t bytes = std::uint64_t{4} << 30;  // decoded
  // If not null, the memory of decoding is held in it: the file, the decoder's own memory, and the
  // image while it exists.
  MemoryBudget* budget = nullptr;
};

// A decoded image: 8-bit files keep their codes (not linearised), HDR and EXR are linear floats. It
// has 1 to 4 interleaved channels and rows from the top.
struct RawImage {
  int width = 0, height = 0, channels = 0;
  bool linear = false;
  bool isCube = false;  // six square faces from the top, as OpenEXR's envmap "cube" has them
  std::vector<std::uint8_t> codes;  // when !linear
  std::vector<float> values;  // when linear; sanitised: NaN and negatives 0, inf 65504, counted
  std::string leftOut;        // a warning of what decoders leave out, or empty
  MemoryHold held;            // the memory of codes and values

  std::size_t pixels() const { return cellsOf(width, height); }
};

// Reads PNG, JPEG, WebP, TGA, BMP, Radiance HDR or OpenEXR, whose colors are premultiplied by alpha
// while those of other files are straight. Throws Error(io) if the file cannot be read, badScene if
// it is not a valid image, limit if it is larger than `limits` allow.
RawImage readRawImage(const std::string& path, const ImageLimits& limits, Warnings& warnings);

// The same with straight colors, which textures have: those of an EXR are divided by alpha.
RawImage readStraightImage(const std::string& path, const ImageLimits& limits, Warnings& warnings);

// Decodes a file that is in memory: PNG, JPEG, WebP, BMP or Radiance HDR. `name` is for errors.
RawImage decodeRawImage(const std::string& name, FileBytes file, const ImageLimits& limits,
                        Warnings& warnings);

// True if the file holds linear light without an upper bound (Radiance HDR, OpenEXR), by its first
// bytes; false where it cannot be read.
bool holdsRadiance(const std::string& path);

// Pixel number `i` as linear RGB: 8-bit codes are decoded from sRGB, gray is spread to three
// channels, alpha is dropped.
inline Rgb linearPixel(const RawImage& raw, std::size_t i) {
  const std::size_t first = i * static_cast<std::size_t>(raw.channels);
  const std::size_t step = raw.channels < 3 ? 0 : 1;  // gray is all three
  const std::size_t green = first + step, blue = green + step;
  if (raw.linear) return Rgb(raw.values[first], raw.values[green], raw.values[blue]);

  const std::array<float, 256>& linear = linearOfCodes();
  return Rgb(linear[raw.codes[first]], linear[raw.codes[green]], linear[raw.codes[blue]]);
}

// Reads an image as linear RGB, see linearPixel(), premultiplied by alpha. An EXR keeps its data
// window (the part inside the display window), and floats keep their bits, NaN and infinities
// included.
Image readImage(const std::string& path, const ImageLimits& limits);

// Storage of an EXR's pixels: floats with lossless compression or without any, half floats (values
// are clamped to 65504), or half floats with OpenEXR's lossy DWAA.
enum class ExrStorage { zip, none, half, dwaa };

// A channel beside the colors, such as "depth.Z": a value for each pixel of the data window, row by
// row from the top.
struct ImageLayer {
  std::string name;
  bool countsThings = false;         // 32-bit unsigned numbers, otherwise floats
  std::vector<std::uint32_t> words;  // numbers, or the bits of floats

  std::vector<float> floats() const;
};

// Writes linear RGB with metadata as string attributes; the data window is image.window. An image
// without pixels has no colors, only layers. `layers` keep all their bits, so dwaa with layers is
// Error(usage). Up to `threads` threads compress the pixels; the bytes do not depend on their
// number.
void writeExr(const std::string& path, const Image& image, const ImageMetadata& metadata,
              ExrStorage storage = ExrStorage::zip, int threads = 1,
              const std::vector<ImageLayer>& layers = {});

// Returns the string attributes of an EXR's first part except OpenEXR's own. Throws as readImage().
ImageMetadata readExrMetadata(const std::string& path);

// Returns the bytes of an EXR file with these pixels, metadata and layers.
std::string encodeExr(const Image& image, const ImageMetadata& metadata,
                      const std::vector<ImageLayer>& layers);

// Returns the bytes of an sRGB JPEG of a quality from 1 to 100; alpha is dropped.
std::string encodeJpeg(const DisplayImage& image, int quality = 93);

// Writes an sRGB PNG with the metadata as text chunks, with alpha if the image has some. Keywords
// are cut at PNG's 79 bytes.
void writePng(const std::string& path, const DisplayImage& image, const ImageMetadata& metadata);

// An image of 16-bit values, one or three for each pixel, in rows from the top.
struct Image16 {
  int width = 0, height = 0, channels = 1;
  std::vector<std::uint16_t> values;
};

// Writes a 16-bit PNG. `isSrgb` says that the three values of a pixel are an sRGB color.
void writePng(const std::string& path, const Image16& image, bool isSrgb,
              const ImageMetadata& metadata);

// Decodes a PNG and returns its text chunks. Throws Error(io) if it cannot be read, badScene if it
// is damaged or cut off.
ImageMetadata readPngMetadata(const std::string& path);

// Returns the bytes of an sRGB PNG.
std::string encodePng(const DisplayImage& image, const ImageMetadata& metadata = {});

}  // namespace whit
