// Reading BMP (Microsoft, "Bitmap Storage") and TGA (Truevision, "TGA File Format Specification",
// 1991). Both hold plain pixels, blue first.
#include <algorithm>
#include <array>
#include <cstdlib>

#include "io/image/image_decoders.h"

namespace whit {

namespace {

using Codes = std::array<std::uint8_t, 4>;

class PlainReader {
 public:
  PlainReader(const std::string& path, std::span<const std::uint8_t> file,
              const ImageLimits& limits)
      : path_(path), bytes_(path, file), limits_(limits) {}

  RawImage readBmp() {
    constexpr std::uint32_t kFileHeaderBytes = 14, kInfoHeaderBytes = 40, kLongestHeader = 124;
    bytes_.skip(10);
    const std::uint32_t dataBegin = bytes_.number(4), headerBytes = bytes_.number(4);
    if (headerBytes < kInfoHeaderBytes || headerBytes > kLongestHeader) {
      bytes_.fail("expected a header of 40 to 124 bytes, found one of " +
                  std::to_string(headerBytes));
    }
    const auto width = static_cast<std::int32_t>(bytes_.number(4));
    const auto height = static_cast<std::int32_t>(bytes_.number(4));
    bytes_.skip(2);  // planes: 1
    bits_ = static_cast<int>(bytes_.number(2));
    const std::uint32_t compression = bytes_.number(4);
    bytes_.skip(12);  // length of the data, pixels a meter
    const std::uint32_t colors = bytes_.number(4);
    bytes_.skip(4);  // how many colors are important
    constexpr std::uint32_t kMasks = 3;
    // Masks are those of the usual order, as programs write them that store alpha.
    const bool masked = compression == kMasks && bits_ == 32 && bytes_.number(4) == 0xff0000 &&
                        bytes_.number(4) == 0xff00 && bytes_.number(4) == 0xff;
    if ((compression != 0 && !masked) || (bits_ != 8 && bits_ != 24 && bits_ != 32)) {
      bytes_.fail("expected uncompressed pixels of 8, 24 or 32 bits, found " +
                  std::to_string(bits_) + " bits and compression " + std::to_string(compression));
    }
    skipTo(kFileHeaderBytes + headerBytes);
    if (bits_ == 8) readPalette(colors, dataBegin);
    if (dataBegin < bytes_.at()) bytes_.fail("expected the pixels behind the headers");
    skipTo(dataBegin);
    fromTop_ = height < 0;
    const std::size_t rowBytes =
        static_cast<std::size_t>(std::max(width, 0)) * static_cast<std::size_t>(bits_ / 8);
    readPixels(width, std::abs(std::int64_t{height}), false, (4 - rowBytes % 4) % 4);
    if (bits_ == 32) repairAlpha();
    return std::move(image_);
  }

  RawImage readTga() {
    constexpr int kRuns = 8, kColor = 2, kGray = 3;
    const std::size_t nameBytes = bytes_.next();
    const bool hasPalette = bytes_.next() != 0;
    const int type = bytes_.next();
    bytes_.skip(2);
    const std::uint64_t entries = bytes_.number(2), entryBits = bytes_.next();
    bytes_.skip(4);  // where the image stands on a screen
    const std::int64_t width = bytes_.number(2), height = bytes_.number(2);
    bits_ = bytes_.next();
    const int descriptor = bytes_.next();
    const bool known = (type & ~kRuns) == kGray ? bits_ == 8
                                                : (type & ~kRuns) == kColor && bits_ % 8 == 0 &&
                                                      bits_ >= 24 && bits_ <= 32;
    if (!known) {
      bytes_.fail(
          "expected TGA's image type 2 or 10 of 24 or 32 bits, or 3 or 11 of 8, found type " +
          std::to_string(type) + " of " + std::to_string(bits_) + " bits");
    }
    if ((descriptor & 0xd0) != 0) bytes_.fail("expected rows in order and from the left");
    fromTop_ = (descriptor & 0x20) != 0;
    bytes_.skip(nameBytes + (hasPalette ? entries * ((entryBits + 7) / 8) : 0));
    readPixels(width, height, (type & kRuns) != 0, 0);
    if (bits_ == 32 && (descriptor & 0x0f) == 0) repairAlpha();
    return std::move(image_);
  }

 private:
  void skipTo(std::size_t place) {
    if (place > bytes_.at()) bytes_.skip(place - bytes_.at());
  }

  // As many colors as fit before the pixels, whatever the header says.
  void readPalette(std::uint32_t colors, std::size_t dataBegin) {
    const std::size_t room = dataBegin > bytes_.at() ? (dataBegin - bytes_.at()) / 4 : 0;
    const std::size_t named = colors == 0 ? 256 : std::min(colors, 256u);
    for (std::size_t i = std::min(named, room); i > 0; --i) {
      palette_.push_back(readColor());
      bytes_.skip(1);
    }
    if (palette_.empty()) bytes_.fail("expected a palette");
  }

  Codes readColor() {
    Codes codes{};
    for (const std::size_t channel : {2u, 1u, 0u}) codes[channel] = bytes_.next();
    return codes;
  }

  Codes readPixel() {
    if (bits_ == 8) {
      const std::size_t value = bytes_.next();
      if (palette_.empty()) return {static_cast<std::uint8_t>(value)};
      if (value < palette_.size()) return palette_[value];
      bytes_.fail("expected one of the palette's " + std::to_string(palette_.size()) +
                  " colors, found number " + std::to_string(value));
    }
    Codes codes = readColor();
    if (bits_ == 32) codes[3] = bytes_.next();
    return codes;
  }

  // With `inRuns`, each packet begins with its length and whether it is one pixel repeated. Rows
  // but the last end with `padding` bytes.
  void readPixels(std::int64_t width, std::int64_t height, bool inRuns, std::size_t padding) {
    constexpr std::uint64_t kLongestRun = 128;
    image_ = startImage(path_, width, height,
                        bits_ > 8          ? bits_ / 8
                        : palette_.empty() ? 1
                                           : 3,
                        false, limits_);
    const auto channels = static_cast<std::size_t>(image_.channels);
    const auto columns = static_cast<std::uint64_t>(width);
    const auto rows = static_cast<std::uint64_t>(height);
    const auto pixelBytes = static_cast<std::uint64_t>(bits_ / 8);
    bytes_.need(inRuns ? (columns * rows + kLongestRun - 1) / kLongestRun * (1 + pixelBytes)
                       : columns * rows * pixelBytes + (rows - 1) * padding);
    image_.codes.resize(columns * rows * channels);
    std::uint32_t left = 0;  // of the packet
    bool isRun = false;
    Codes codes{};
    for (std::uint64_t row = 0; row < rows; ++row) {
      if (row > 0) bytes_.skip(padding);
      std::uint8_t* to =
          image_.codes.data() + (fromTop_ ? row : rows - 1 - row) * columns * channels;
      for (std::uint64_t x = 0; x < columns; ++x, to += channels) {
        const bool begins = inRuns && left == 0;
        if (begins) {
          const std::uint32_t head = bytes_.next();
          isRun = head >= kLongestRun;
          left = head % kLongestRun + 1;
        }
        if (begins || !isRun) codes = readPixel();
        if (inRuns) --left;
        std::copy_n(codes.begin(), channels, to);
      }
    }
    if (left > 0) bytes_.fail("expected pixels up to the image's end, found more");
  }

  // An alpha of 0 in every pixel was not meant.
  void repairAlpha() {
    std::uint8_t any = 0;
    for (std::size_t i = 3; i < image_.codes.size(); i += 4) any |= image_.codes[i];
    if (any != 0) return;
    for (std::size_t i = 3; i < image_.codes.size(); i += 4) image_.codes[i] = 255;
  }

  const std::string& path_;
  ImageBytes bytes_;
  const ImageLimits& limits_;
  int bits_ = 0;
  bool fromTop_ = false;
  std::vector<Codes> palette_;
  RawImage image_;
};

}  // namespace

RawImage decodeBmp(const std::string& path, std::span<const std::uint8_t> file,
                   const ImageLimits& limits) {
  return PlainReader(path, file, limits).readBmp();
}

RawImage decodeTga(const std::string& path, std::span<const std::uint8_t> file,
                   const ImageLimits& limits) {
  return PlainReader(path, file, limits).readTga();
}

}  // namespace whit
