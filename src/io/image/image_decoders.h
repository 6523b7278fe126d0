// The decoders behind image_file.h; private to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
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

// The bytes of a file, which decoders read one after the other.
class ImageBytes {
 public:
  ImageBytes(const std::string& path, std::span<const std::uint8_t> file)
      : path_(path), file_(file) {}

  std::size_t at() const { return at_; }
  std::size_t left() const { return file_.size() - at_; }
  // These throw badScene if the file has fewer bytes left.
  void need(std::uint64_t bytes) const {
    if (bytes > left()) fail("the file is cut short");
  }
  void skip(std::uint64_t bytes) {
    need(bytes);
    at_ += bytes;
  }
  std::uint8_t next() {
    need(1);
    return file_[at_++];
  }
  // Reads a number of this many bytes, the lowest first.
  std::uint32_t number(int bytes) {
    std::uint32_t value = 0;
    for (int i = 0; i < bytes; ++i) value |= std::uint32_t{next()} << (8 * i);
    return value;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throwBadScene(path_ + ": byte " + std::to_string(at_), what);
  }

 private:
  const std::string& path_;
  std::span<const std::uint8_t> file_;
  std::size_t at_ = 0;
};

// The decoders throw as readRawImage() does; a file that is cut short or has wrong checksums is
// badScene.
RawImage decodePng(const std::string& path, std::span<const std::uint8_t> file,
                   const ImageLimits& limits);
RawImage decodeJpeg(const std::string& path, std::span<const std::uint8_t> file,
                    const ImageLimits& limits);
RawImage decodeWebp(const std::string& path, std::span<const std::uint8_t> file,
                    const ImageLimits& limits);
RawImage decodeBmp(const std::string& path, std::span<const std::uint8_t> file,
                   const ImageLimits& limits);
RawImage decodeHdr(const std::string& path, std::span<const std::uint8_t> file,
                   const ImageLimits& limits);
RawImage decodeTga(const std::string& path, std::span<const std::uint8_t> file,
                   const ImageLimits& limits);

// The first part of an OpenEXR file; values keep their bits.
struct ExrImage {
  int width = 0, height = 0;  // of the display window
  Crop window;                // the part of the display window that `raw` holds
  RawImage raw;               // 1 channel: Y, 2: Y A, 3: R G B, 4: R G B A
};
bool isExrFile(const std::string& path);  // by its first bytes
// Reads scanlines or tiles (level 0), any compression, any channel type. A missing one of R, G and
// B is 0. With `wholeDisplay` the rest of the display window is 0, otherwise the image is the part
// of the data window inside it. Throws Error(badScene) for deep images, images of luminance and
// chroma, images without any of R, G, B, Y, and whatever OpenEXR rejects.
ExrImage decodeExr(const std::string& path, bool wholeDisplay, const ImageLimits& limits);

}  // namespace whit
