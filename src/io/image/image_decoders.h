// The decoders behind image_file.h; private to this folder.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/image.h"
#include "io/image/image_file.h"

namespace whit {

// Throws Error(badScene) if a side is below 1, Error(limit) if a side or the decoded bytes are
// beyond `limits`. Called with what a header claims, before anything of that size is allocated.
void checkImageSize(const std::string& path, std::int64_t width, std::int64_t height,
                    std::uint64_t bytesPerPixel, const ImageLimits& limits);

// Checks the limits likewise, and then holds the image's memory in the limits' budget.
[[nodiscard]] MemoryHold holdImage(const std::string& path, std::int64_t width, std::int64_t height,
                                   std::uint64_t bytesPerPixel, const ImageLimits& limits);

// Each format but TGA is told by how its files begin. The decoders throw as readRawImage does; a
// file that is cut short or whose checksums are wrong is badScene.
bool isPng(std::span<const std::uint8_t> file);
bool isJpeg(std::span<const std::uint8_t> file);
bool isBmp(std::span<const std::uint8_t> file);
bool isHdr(std::span<const std::uint8_t> file);
RawImage decodePng(const std::string& path, std::span<const std::uint8_t> file,
                   const ImageLimits& limits);
// Refuses CMYK.
RawImage decodeJpeg(const std::string& path, std::span<const std::uint8_t> file,
                    const ImageLimits& limits);
RawImage decodeBmp(const std::string& path, std::span<const std::uint8_t> file,
                   const ImageLimits& limits);
RawImage decodeHdr(const std::string& path, std::span<const std::uint8_t> file,
                   const ImageLimits& limits);
RawImage decodeTga(const std::string& path, std::span<const std::uint8_t> file,
                   const ImageLimits& limits);

// The first part of an OpenEXR file. `window`, in pixels from the display window's corner, is the
// part of the data window inside it; `values` holds that, interleaved, bits untouched.
struct ExrPixels {
  int width = 0, height = 0;  // display window
  Crop window;
  int channels = 0;  // 1: Y, 2: Y A, 3: R G B, 4: R G B A
  std::vector<float> values;
  MemoryHold held;  // of these
};
bool isExr(std::span<const std::uint8_t> beginning);
// Scanlines or tiles (level 0), any compression, any channel type. A missing one of R, G and B is
// 0; luminance/chroma images are converted. Throws Error(badScene) for deep images, images without
// any of R, G, B, Y, and whatever OpenEXR rejects.
ExrPixels decodeExr(const std::string& path, const ImageLimits& limits);

}  // namespace whit
