// Reading TGA. Truevision, "TGA File Format Specification", version 2.0, 1991.
#include <array>

#include "io/image/image_bytes.h"
#include "io/image/image_decoders.h"

namespace whit {

namespace {

using Codes = std::array<std::uint8_t, 4>;

enum TgaKind { kPalette = 1, kColor = 2, kGray = 3 };

// 0: there are no such pixels.
int channelsOf(int kind, int bits) {
  if (kind == kGray) return bits == 8 ? 1 : bits == 16 ? 2 : 0;
  return bits == 32 ? 4 : bits == 24 || bits == 16 || bits == 15 ? 3 : 0;
}

class TgaReader {
 public:
  TgaReader(const std::string& path, std::span<const std::uint8_t> file, const ImageLimits& limits)
      : path_(path), bytes_(path, file), limits_(limits) {}

  RawImage read() {
    readHeader();
    image_.channels = channelsOf(kind_, kind_ == kPalette ? entryBits_ : bits_);
    if (image_.channels == 0 || (kind_ == kPalette && bits_ != 8 && bits_ != 16)) {
      bytes_.fail("expected pixels of 8 to 32 bits, found " + std::to_string(bits_) +
                  (kind_ == kPalette ? " and a palette of " + std::to_string(entryBits_) : ""));
    }
    image_.held = holdImage(path_, image_.width, image_.height,
                            static_cast<std::uint64_t>(image_.channels), limits_);
    readPalette();
    readPixels();
    if (image_.channels == 4 && alphaBits_ == 0) repairAlpha(image_.codes);
    return std::move(image_);
  }

 private:
  void readHeader() {
    const std::size_t nameBytes = bytes_.next();
    hasPalette_ = bytes_.next() != 0;
    const int type = bytes_.next();
    kind_ = type & ~kRunLengths;
    inRuns_ = (type & kRunLengths) != 0;
    if (kind_ < kPalette || kind_ > kGray || (kind_ == kPalette && !hasPalette_)) {
      bytes_.fail("expected TGA's image type 1, 2, 3, 9, 10 or 11, found " + std::to_string(type));
    }
    firstEntry_ = bytes_.number(2);
    entries_ = bytes_.number(2);
    entryBits_ = bytes_.next();
    bytes_.skip(4);  // where the image stands on a screen
    image_.width = static_cast<int>(bytes_.number(2));
    image_.height = static_cast<int>(bytes_.number(2));
    bits_ = bytes_.next();
    const int descriptor = bytes_.next();
    alphaBits_ = descriptor & 0x0f;
    fromRight_ = (descriptor & 0x10) != 0;
    fromTop_ = (descriptor & 0x20) != 0;
    if ((descriptor & 0xc0) != 0) bytes_.fail("expected rows in order, found them interleaved");
    bytes_.skip(nameBytes);
  }

  void readPalette() {
    if (!hasPalette_) return;
    if (kind_ != kPalette) return bytes_.skip(std::uint64_t{entries_} * ((entryBits_ + 7u) / 8));
    for (std::uint32_t i = 0; i < entries_; ++i) palette_.push_back(readCodes(entryBits_));
  }

  Codes readCodes(int bits) {
    if (kind_ == kGray) {
      const std::uint8_t gray = bytes_.next();
      return {gray, bits == 16 ? bytes_.next() : std::uint8_t{255}};
    }
    if (bits < 24) {
      const std::uint32_t c = bytes_.number(2);
      return {codeOf(c >> 10 & 31, 31), codeOf(c >> 5 & 31, 31), codeOf(c & 31, 31)};
    }
    Codes codes{};
    for (const std::size_t channel : {2u, 1u, 0u}) codes[channel] = bytes_.next();
    if (bits == 32) codes[3] = bytes_.next();
    return codes;
  }

  Codes readPixel() {
    if (kind_ != kPalette) return readCodes(bits_);
    const std::uint32_t index = bytes_.number(bits_ / 8);
    if (index < firstEntry_ || index - firstEntry_ >= palette_.size()) {
      bytes_.fail("expected a color of the palette, of which there are " +
                  std::to_string(entries_) + " from number " + std::to_string(firstEntry_) +
                  ", found number " + std::to_string(index));
    }
    return palette_[index - firstEntry_];
  }

  void readPixels() {
    const auto width = static_cast<std::uint64_t>(image_.width);
    const std::uint64_t count = width * static_cast<std::uint64_t>(image_.height);
    const auto pixelBytes = static_cast<std::uint64_t>((bits_ + 7) / 8);
    // Before memory is taken: what the file must have at least.
    bytes_.need(inRuns_ ? (count + kLongestRun - 1) / kLongestRun * (1 + pixelBytes)
                        : count * pixelBytes);
    image_.codes.resize(count * static_cast<std::uint64_t>(image_.channels));
    for (std::uint64_t done = 0; done < count;) {
      const std::uint32_t packet = inRuns_ ? bytes_.next() : 0;
      const bool isRun = (packet & 0x80) != 0;
      const std::uint64_t length = inRuns_ ? (packet & 0x7f) + 1 : count;
      if (length > count - done) bytes_.fail("expected pixels up to the image's end, found more");
      Codes codes{};
      for (std::uint64_t i = 0; i < length; ++i, ++done) {
        if (i == 0 || !isRun) codes = readPixel();
        store(codes, done % width, done / width);
      }
    }
  }

  // Columns and rows as they are in the file.
  void store(const Codes& codes, std::uint64_t x, std::uint64_t y) {
    const auto width = static_cast<std::uint64_t>(image_.width);
    if (fromRight_) x = width - 1 - x;
    if (!fromTop_) y = static_cast<std::uint64_t>(image_.height) - 1 - y;
    const auto channels = static_cast<std::uint64_t>(image_.channels);
    for (std::uint64_t c = 0; c < channels; ++c)
      image_.codes[(y * width + x) * channels + c] = codes[c];
  }

  static constexpr int kRunLengths = 8;  // added to the type
  static constexpr std::uint64_t kLongestRun = 128;

  const std::string& path_;
  ImageBytes bytes_;
  const ImageLimits& limits_;
  int kind_ = 0, bits_ = 0, entryBits_ = 0, alphaBits_ = 0;
  bool hasPalette_ = false, inRuns_ = false, fromRight_ = false, fromTop_ = false;
  std::uint32_t firstEntry_ = 0, entries_ = 0;
  std::vector<Codes> palette_;
  RawImage image_;
};

}  // namespace

RawImage decodeTga(const std::string& path, std::span<const std::uint8_t> file,
                   const ImageLimits& limits) {
  return TgaReader(path, file, limits).read();
}

}  // namespace whit
