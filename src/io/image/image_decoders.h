// The decoders behind image_file.h; private to this folder.
#pragma once

#include <cstdint>
#include <string>

#include "core/error.h"
#include "core/image.h"
#include "io/image/image_file.h"

namespace whit {

// Throws Error(badScene) if a side is below 1, Error(limit) if a side or the decoded bytes are
// beyond `limits`. Decoders call it with the size in the header before they allocate.
void checkImageSize(const std::string& path, std::int64_t width, std::int64_t height,
                    std::uint64_t bytesPerPixel, const ImageLimits& limits);

// Checks the limits as well, and holds the image's memory in the limits' budget.
[[nodiscard]] MemoryHold holdImage(const std::string& path, std::int64_t width, std::int64_t height,
                                   std::uint64_t bytesPerPixel, const ImageLimits& limits);

// An image without its pixels, whose memory is held as holdImage() does.
[[nodiscard]] RawImage startImage(const std::string& path, std::int64_t width, std::int64_t height,
                                  int channels, bool linear, const ImageLimits& limits);

// The decoders throw as readRawImage() does; a file that is cut short or has wrong checksums is
// badScene.
using ImageDecoder = RawImage(const std::string& path, FileBytes file, const ImageLimits& limits);
ImageDecoder decodePng, decodeJpeg, decodeWebp, decodeBmp, decodeHdr, decodeTga;

// decodePng() rounds PNGs of 16 bits to 8. decodePng16() keeps them, as linear light that is
// premultiplied by alpha.
bool isPng16(FileBytes file);
ImageDecoder decodePng16;
// Decodes a file that is no EXR, with all bits of a PNG.
RawImage decodeAllBits(const std::string& path, const ImageLimits& limits);

// A warning of images with other primaries than Rec. 709, whose numbers are taken as they are.
inline constexpr char kOtherPrimaries[] =
    "primaries of an image left out: its values are taken as those of Rec. 709";

// The first part of an OpenEXR file; values keep their bits.
struct ExrImage {
  int width = 0, height = 0;  // size of the display window
  Crop window;                // the part of the display window that `raw` holds
  RawImage raw;               // 1 channel: Y, 2: Y A, 3: R G B, 4: R G B A
};
bool isExrFile(const std::string& path);  // by its first bytes
// Reads scanlines or tiles (level 0), any compression, any channel type. A missing one of R, G and
// B is 0. Without any of R, G, B and Y the first layer that has them counts, but one called
// "Combined" before others. Luminance and chroma become R, G and B. With `wholeDisplay` the rest of
// the display window is 0, otherwise the image is the part of the data window inside it. Throws
// Error(badScene) for deep images, images without any of R, G, B, Y, and whatever OpenEXR rejects.
ExrImage decodeExr(const std::string& path, bool wholeDisplay, const ImageLimits& limits);

}  // namespace whit
