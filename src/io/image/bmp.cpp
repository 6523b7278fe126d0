// Reading BMP, of Windows and OS/2: Microsoft, "Bitmap Storage"; IBM, "OS/2 Bitmap File Format".
#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>

#include "io/image/image_bytes.h"
#include "io/image/image_decoders.h"

namespace whit {

namespace {

enum Compression : std::uint32_t { kNone = 0, kRuns8 = 1, kRuns4 = 2, kMasks = 3, kMasksAlpha = 6 };

constexpr std::uint32_t kFileHeaderBytes = 14, kCoreHeaderBytes = 12, kInfoHeaderBytes = 40;

// The shift and scale that bring the bits of a mask to 256 codes; 0 for an empty mask.
struct Mask {
  std::uint32_t bits = 0;
  std::uint8_t of(std::uint32_t pixel) const {
    if (bits == 0) return 0;
    const int shift = std::countr_zero(bits);
    return codeOf((pixel & bits) >> shift, bits >> shift);
  }
  bool isOneRow() const {
    const std::uint64_t row = bits == 0 ? 0 : std::uint64_t{bits} >> std::countr_zero(bits);
    return (row & (row + 1)) == 0;
  }
};

class BmpReader {
 public:
  BmpReader(const std::string& path, std::span<const std::uint8_t> file, const ImageLimits& limits)
      : path_(path), bytes_(path, file), limits_(limits) {}

  RawImage read() {
    readHeaders();
    image_.channels = masks_[3].bits != 0 ? 4 : 3;
    image_.held = holdImage(path_, image_.width, image_.height,
                            static_cast<std::uint64_t>(image_.channels), limits_);
    readPalette();
    if (dataBegin_ < bytes_.at()) bytes_.fail("expected the pixels behind the headers");
    bytes_.skip(dataBegin_ - bytes_.at());
    if (compression_ == kRuns8 || compression_ == kRuns4) {
      readRuns();
    } else {
      readRows();
    }
    if (image_.channels == 4) repairAlpha(image_.codes);
    return std::move(image_);
  }

 private:
  void readHeaders() {
    bytes_.skip(10);
    dataBegin_ = bytes_.number(4);
    headerBytes_ = bytes_.number(4);
    if (headerBytes_ != kCoreHeaderBytes && (headerBytes_ < 16 || headerBytes_ > 124)) {
      bytes_.fail("expected a header of 12 or 16 to 124 bytes, found one of " +
                  std::to_string(headerBytes_));
    }
    const bool core = headerBytes_ == kCoreHeaderBytes;
    const std::uint32_t width = bytes_.number(core ? 2 : 4), height = bytes_.number(core ? 2 : 4);
    bytes_.skip(2);  // planes: 1
    bits_ = static_cast<int>(bytes_.number(2));
    if (headerBytes_ >= 20) compression_ = bytes_.number(4);
    if (headerBytes_ >= 36) {
      bytes_.skip(12);  // length of the data, pixels a meter
      colors_ = bytes_.number(4);
    }
    const auto signedHeight = static_cast<std::int32_t>(height);
    fromTop_ = !core && signedHeight < 0;
    const std::int64_t rows = core ? height : std::abs(std::int64_t{signedHeight});
    checkImageSize(path_, static_cast<std::int32_t>(width), rows, 1, limits_);
    image_.width = static_cast<int>(width);
    image_.height = static_cast<int>(rows);
    checkForm();
    readMasks();
  }

  bool isMasked() const { return compression_ == kMasks || compression_ == kMasksAlpha; }

  void checkForm() const {
    constexpr std::uint32_t kSecondOs2Bytes = 64;  // whose compressions are others
    const bool masked =
        isMasked() && headerBytes_ >= kInfoHeaderBytes && headerBytes_ != kSecondOs2Bytes;
    const bool right = compression_ == kNone
                           ? bits_ == 1 || bits_ == 2 || bits_ == 4 || bits_ == 8 || bits_ == 16 ||
                                 bits_ == 24 || bits_ == 32
                       : compression_ == kRuns8 ? bits_ == 8
                       : compression_ == kRuns4 ? bits_ == 4
                                                : masked && (bits_ == 16 || bits_ == 32);
    if (right) return;
    bytes_.fail(
        "expected 1, 2, 4, 8, 16, 24 or 32 bits a pixel, run lengths of 8 or 4 bits, or "
        "masks of 16 or 32, found " +
        std::to_string(bits_) + " bits and compression " + std::to_string(compression_));
  }

  // Red, green, blue, alpha: part of later headers, behind the earlier one.
  void readMasks() {
    const std::size_t end = kFileHeaderBytes + headerBytes_;
    if (isMasked()) {
      bytes_.skip(4);  // how many colors are important
      const bool behind = headerBytes_ == kInfoHeaderBytes && compression_ == kMasksAlpha;
      for (std::size_t i = 0; i < (behind || headerBytes_ >= 56 ? 4u : 3u); ++i) {
        masks_[i].bits = bytes_.number(4);
        if (!masks_[i].isOneRow()) bytes_.fail("expected a mask of neighboring bits");
      }
    } else if (bits_ == 16) {
      masks_ = {Mask{0x7c00}, Mask{0x3e0}, Mask{0x1f}, Mask{0}};
    } else if (bits_ >= 24) {
      masks_ = {Mask{0xff0000}, Mask{0xff00}, Mask{0xff}, Mask{bits_ == 32 ? 0xff000000 : 0}};
    }
    if (end > bytes_.at()) bytes_.skip(end - bytes_.at());
  }

  // As many colors as fit before the pixels, whatever the header says.
  void readPalette() {
    if (bits_ > 8) return;
    const std::uint32_t entryBytes = headerBytes_ == kCoreHeaderBytes ? 3 : 4;
    const std::uint32_t most = 1u << bits_;
    const std::size_t room = dataBegin_ > bytes_.at() ? (dataBegin_ - bytes_.at()) / entryBytes : 0;
    const std::uint32_t named = colors_ == 0 ? most : std::min(colors_, most);
    for (std::size_t i = std::min<std::size_t>(named, room); i > 0; --i) {
      std::array<std::uint8_t, 3> color{};
      for (const std::size_t channel : {2u, 1u, 0u}) color[channel] = bytes_.next();
      palette_.push_back(color);
      bytes_.skip(entryBytes - 3);
    }
    if (palette_.empty()) bytes_.fail("expected a palette");
  }

  std::uint8_t* pixel(int x, int row) {
    const int y = fromTop_ ? row : image_.height - 1 - row;
    return image_.codes.data() +
           (static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
            static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(image_.channels);
  }

  void storeColor(std::uint32_t index, std::uint8_t* to) const {
    if (index >= palette_.size()) {
      bytes_.fail("expected one of the palette's " + std::to_string(palette_.size()) +
                  " colors, found number " + std::to_string(index));
    }
    std::copy(palette_[index].begin(), palette_[index].end(), to);
  }

  void takePixels() {
    image_.codes.resize(static_cast<std::size_t>(image_.width) *
                        static_cast<std::size_t>(image_.height) *
                        static_cast<std::size_t>(image_.channels));
  }

  // Each row but the last in the file ends at a multiple of four bytes.
  void readRows() {
    const std::uint64_t rowBits =
        static_cast<std::uint64_t>(image_.width) * static_cast<std::uint64_t>(bits_);
    const std::uint64_t used = (rowBits + 7) / 8, stride = (rowBits + 31) / 32 * 4;
    bytes_.need(stride * (static_cast<std::uint64_t>(image_.height) - 1) + used);
    takePixels();
    for (int row = 0; row < image_.height; ++row) {
      if (row > 0) bytes_.skip(stride - used);
      readRow(row);
    }
  }

  void readRow(int row) {
    std::uint32_t packed = 0;
    for (int x = 0; x < image_.width; ++x) {
      std::uint8_t* to = pixel(x, row);
      if (bits_ > 8) {
        const std::uint32_t value = bytes_.number(bits_ / 8);
        for (int c = 0; c < image_.channels; ++c)
          to[c] = masks_[static_cast<std::size_t>(c)].of(value);
        continue;
      }
      const int at = x * bits_ % 8;
      if (at == 0) packed = bytes_.next();
      storeColor(packed >> (8 - bits_ - at) & ((1u << bits_) - 1), to);
    }
  }

  // Pixels that are passed over have the palette's first color.
  void readRuns() {
    takePixels();
    for (int row = 0; row < image_.height; ++row) {
      for (int x = 0; x < image_.width; ++x) storeColor(0, pixel(x, row));
    }
    enum Escape { kEndOfRow = 0, kEndOfImage = 1, kMove = 2 };
    int x = 0, row = 0;
    while (row < image_.height) {
      const int count = bytes_.next(), value = bytes_.next();
      if (count > 0) {
        readRun(x, row, count, value);
      } else if (value == kEndOfImage) {
        break;
      } else if (value == kEndOfRow) {
        x = 0;
        ++row;
      } else if (value == kMove) {
        x = std::min(x + bytes_.next(), image_.width);
        row += bytes_.next();
      } else {
        readPlain(x, row, value);
      }
    }
  }

  // Writers fill rows up to a multiple of four bytes.
  void storeNext(std::uint32_t index, int& x, int row) {
    if (x < image_.width) storeColor(index, pixel(x++, row));
  }

  // The value's two halves in turn where a pixel has 4 bits.
  void readRun(int& x, int row, int count, int value) {
    for (int i = 0; i < count; ++i) storeNext(indexIn(value, i), x, row);
  }

  // Pixel by pixel, up to a multiple of two bytes.
  void readPlain(int& x, int row, int count) {
    int value = 0;
    for (int i = 0; i < count; ++i) {
      if (bits_ == 8 || i % 2 == 0) value = bytes_.next();
      storeNext(indexIn(value, i), x, row);
    }
    if ((count * bits_ + 7) / 8 % 2 == 1) bytes_.skip(1);
  }

  std::uint32_t indexIn(int value, int i) const {
    if (bits_ == 8) return static_cast<std::uint32_t>(value);
    return static_cast<std::uint32_t>(i % 2 == 0 ? value >> 4 : value & 15);
  }

  const std::string& path_;
  ImageBytes bytes_;
  const ImageLimits& limits_;
  std::uint32_t dataBegin_ = 0, headerBytes_ = 0, compression_ = kNone, colors_ = 0;
  int bits_ = 0;
  bool fromTop_ = false;
  std::array<Mask, 4> masks_;
  std::vector<std::array<std::uint8_t, 3>> palette_;
  RawImage image_;
};

}  // namespace

bool isBmp(std::span<const std::uint8_t> file) {
  return file.size() >= 2 && file[0] == 'B' && file[1] == 'M';
}

RawImage decodeBmp(const std::string& path, std::span<const std::uint8_t> file,
                   const ImageLimits& limits) {
  return BmpReader(path, file, limits).read();
}

}  // namespace whit
