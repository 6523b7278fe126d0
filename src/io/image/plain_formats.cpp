// The formats that need no library: BMP (Microsoft, "Bitmap Storage"), TGA (Truevision, "TGA File
// Format Specification", 1991) and Radiance HDR (G. Ward, "Real Pixels", Graphics Gems II, 1991).
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "core/index.h"
#include "core/text.h"
#include "io/files.h"
#include "io/image/image_decoders.h"

namespace whit {
namespace {

// The bytes of a file, which decoders read one after the other.
class ImageBytes {
 public:
  ImageBytes(const std::string& path, FileBytes file) : path_(path), file_(file) {}

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
    throwBadScene(concat(path_, ": byte ", at_), what);
  }

 private:
  const std::string& path_;
  FileBytes file_;
  std::size_t at_ = 0;
};

using Codes = std::array<std::uint8_t, 4>;

class PlainReader {
 public:
  PlainReader(const std::string& path, FileBytes file, const ImageLimits& limits)
      : path_(path), bytes_(path, file), limits_(limits) {}

  RawImage readBmp() {
    constexpr std::uint32_t kFileHeaderBytes = 14, kInfoHeaderBytes = 40, kLongestHeader = 124;

    // The file header ends with the offset of the pixels, and the info header begins with its
    // length.
    bytes_.skip(10);
    const std::uint32_t dataBegin = bytes_.number(4), headerBytes = bytes_.number(4);
    if (headerBytes < kInfoHeaderBytes || headerBytes > kLongestHeader) {
      bytes_.fail(concat("expected a header of 40 to 124 bytes, found one of ", headerBytes));
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
    // The usual order of masks is accepted, because programs that store alpha write it.
    const bool masked = compression == kMasks && bits_ == 32 && bytes_.number(4) == 0xff0000 &&
                        bytes_.number(4) == 0xff00 && bytes_.number(4) == 0xff;
    if ((compression != 0 && !masked) || (bits_ != 8 && bits_ != 24 && bits_ != 32)) {
      bytes_.fail(concat("expected uncompressed pixels of 8, 24 or 32 bits, found ", bits_,
                         " bits and compression ", compression));
    }

    skipTo(kFileHeaderBytes + headerBytes);
    if (bits_ == 8) readPalette(colors, dataBegin);
    if (dataBegin < bytes_.at()) bytes_.fail("expected the pixels behind the headers");
    skipTo(dataBegin);

    // A negative height means rows from the top. Rows are padded to multiples of 4 bytes.
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

    // Bit 3 of the type means runs of equal pixels; the other bits tell colors from gray.
    const bool known = (type & ~kRuns) == kGray ? bits_ == 8
                                                : (type & ~kRuns) == kColor && bits_ % 8 == 0 &&
                                                      bits_ >= 24 && bits_ <= 32;
    if (!known) {
      bytes_.fail(
          concat("expected TGA's image type 2 or 10 of 24 or 32 bits, or 3 or 11 of 8, found type ",
                 type, " of ", bits_, " bits"));
    }

    // In the descriptor, bits 0 to 3 count the bits of alpha, bit 4 stands for columns from the
    // right, and bit 5 for rows from the top.
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

  // Reads as many colors as fit before the pixels, whatever the header says.
  void readPalette(std::uint32_t colors, std::size_t dataBegin) {
    // Each color takes four bytes: blue, green, red and one that is unused.
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
      bytes_.fail(concat("expected one of the palette's ", palette_.size(),
                         " colors, found number ", value));
    }

    Codes codes = readColor();
    if (bits_ == 32) codes[3] = bytes_.next();
    return codes;
  }

  // With `inRuns`, each packet begins with its length and whether it is one pixel repeated. Rows
  // but the last end with `padding` bytes.
  void readPixels(std::int64_t width, std::int64_t height, bool inRuns, std::size_t padding) {
    constexpr std::uint64_t kLongestRun = 128;
    int stored = palette_.empty() ? 1 : 3;
    if (bits_ > 8) stored = bits_ / 8;
    image_ = startImage(path_, width, height, stored, false, limits_);

    const std::size_t channels = image_.channels;
    const auto columns = static_cast<std::uint64_t>(width);
    const auto rows = static_cast<std::uint64_t>(height);
    const auto pixelBytes = static_cast<std::uint64_t>(bits_ / 8);

    // The length of the file is checked before memory is taken. One packet codes at most 128
    // pixels.
    bytes_.need(inRuns ? (columns * rows + kLongestRun - 1) / kLongestRun * (1 + pixelBytes)
                       : columns * rows * pixelBytes + (rows - 1) * padding);
    image_.codes.resize(columns * rows * channels);

    std::uint32_t left = 0;  // pixels left in the packet
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

  // Makes images opaque whose alpha is 0 everywhere: their writers left it unset.
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

using Rgbe = std::array<std::uint8_t, 4>;

std::string nextText(ImageBytes& bytes) {
  constexpr std::size_t kLongestText = 1024;
  std::string text;

  for (char c; (c = static_cast<char>(bytes.next())) != '\n'; text += c) {
    if (text.size() > kLongestText) bytes.fail("expected a line of a Radiance header");
  }

  if (text.ends_with('\r')) text.pop_back();
  return text;
}

Rgbe readPixel(ImageBytes& bytes) {
  Rgbe pixel;
  for (std::uint8_t& component : pixel) component = bytes.next();
  return pixel;
}

// Each component comes in packets: a count up to 128 and as many values, or 128 more than a count
// and one value to repeat.
void readRuns(ImageBytes& bytes, std::size_t component, std::vector<Rgbe>& row) {
  for (std::size_t done = 0; done < row.size();) {
    const std::size_t head = bytes.next();
    const bool isRun = head > 128;
    const std::size_t count = isRun ? head - 128 : head;
    if (count == 0 || count > row.size() - done) {
      bytes.fail("expected pixels up to the row's end, found more or none");
    }

    std::uint8_t value = 0;
    for (const auto i : indices(count)) {
      if (i == 0 || !isRun) value = bytes.next();
      row[done++][component] = value;
    }
  }
}

// Reads the rest of a row whose first pixel is there. In older files a pixel whose mantissas are
// all 1 repeats the one before as often as its exponent says; the next such pixel in a row counts
// 256 times as much.
void readOldRuns(ImageBytes& bytes, std::vector<Rgbe>& row) {
  constexpr unsigned kLargestShift = 24;
  unsigned shift = 0;
  for (std::size_t done = 1; done < row.size();) {
    const Rgbe pixel = readPixel(bytes);
    const bool isRun = pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1;
    if (!isRun) {
      row[done++] = pixel;
      shift = 0;
      continue;
    }

    const std::size_t count = std::size_t{pixel[3]} << shift;
    if (count > row.size() - done || shift > kLargestShift) {
      bytes.fail("expected a run up to the row's end, found a longer one");
    }
    std::fill_n(row.begin() + done, count, row[done - 1]);
    done += count;
    shift += 8;
  }
}

void readRow(ImageBytes& bytes, std::vector<Rgbe>& row) {
  constexpr std::size_t kShortest = 8, kLongest = 0x7fff;  // in runs of components

  // A row whose components come in runs begins with two bytes of 2 and the number of its pixels.
  row[0] = readPixel(bytes);
  const bool inRuns = row.size() >= kShortest && row.size() <= kLongest && row[0][0] == 2 &&
                      row[0][1] == 2 && row[0][2] < 128;

  if (inRuns) {
    const auto length = static_cast<std::size_t>(row[0][2] << 8 | row[0][3]);
    if (length != row.size()) {
      bytes.fail(concat("expected a row of ", row.size(), " pixels, found one of ", length));
    }
    for (const auto component : indices(4)) readRuns(bytes, component, row);
    return;
  }

  readOldRuns(bytes, row);
}

// The header of a Radiance file states how its values are scaled, and in which colors they are.
struct RadianceHeader {
  std::array<double, 3> divisor{1, 1, 1};  // the product of all EXPOSURE and COLORCORR
  bool hasOtherPrimaries = false;
};

// Reads the numbers behind the "=" of a line, of which there may be fewer than asked for.
std::vector<double> numbersOf(const std::string& line, std::size_t most) {
  std::vector<double> numbers;
  for (std::size_t at = line.find('=') + 1; numbers.size() < most;) {
    at = line.find_first_not_of(" \t", at);
    if (at == std::string::npos) break;

    // Unlike std::strtod, this does not depend on the locale of the program that uses the library.
    double number = 0;
    const char* const end = line.data() + line.size();
    const auto [next, error] = std::from_chars(line.data() + at, end, number);
    if (error != std::errc()) break;
    numbers.push_back(number);
    at = static_cast<std::size_t>(next - line.data());
  }
  return numbers;
}

// Returns true for the primaries of Rec. 709, for Radiance's own, which files without the line have
// as well, and for the zeros that Photoshop writes.
bool areUsualPrimaries(const std::vector<double>& found) {
  constexpr double kTolerance = 2e-3;
  constexpr std::array<double, 8> kUsual[] = {{},
                                              {{.64, .33, .30, .60, .15, .06, .3127, .329}},
                                              {{.64, .33, .29, .60, .15, .06, 1 / 3., 1 / 3.}}};
  return std::ranges::any_of(kUsual, [&](const auto& usual) {
    return std::ranges::equal(found, usual,
                              [](double a, double b) { return std::abs(a - b) < kTolerance; });
  });
}

// An empty line ends the header.
RadianceHeader readHeader(ImageBytes& bytes) {
  constexpr std::string_view kFormat = "FORMAT=", kKnown = "32-bit_rle_rgbe";
  RadianceHeader header;
  for (std::string text; !(text = nextText(bytes)).empty();) {
    if (text.starts_with(kFormat) && text.substr(kFormat.size()) != kKnown) {
      bytes.fail("expected FORMAT=32-bit_rle_rgbe, found " + excerpt(text));
    }
    if (text.starts_with("PRIMARIES=")) {
      header.hasOtherPrimaries = !areUsualPrimaries(numbersOf(text, 8));
    }

    const bool isExposure = text.starts_with("EXPOSURE=");
    if (!isExposure && !text.starts_with("COLORCORR=")) continue;
    const std::size_t count = isExposure ? 1 : 3;
    const std::vector<double> factors = numbersOf(text, count);
    for (std::size_t c = 0; c < 3 && factors.size() == count; ++c) {
      header.divisor[c] *= factors[c % count];
    }
    const auto isUsable = [](double x) { return x > 1e-30 && x < 1e30; };
    if (factors.size() != count || !std::ranges::all_of(header.divisor, isUsable)) {
      bytes.fail("expected a factor above 0 for each channel, found " + excerpt(text));
    }
  }
  return header;
}

}  // namespace

RawImage decodeBmp(const std::string& path, FileBytes file, const ImageLimits& limits) {
  return PlainReader(path, file, limits).readBmp();
}

RawImage decodeTga(const std::string& path, FileBytes file, const ImageLimits& limits) {
  return PlainReader(path, file, limits).readTga();
}

RawImage decodeHdr(const std::string& path, FileBytes file, const ImageLimits& limits) {
  ImageBytes bytes(path, file);
  const RadianceHeader header = readHeader(bytes);

  // Only rows from the top and columns from the left are read.
  int columns = 0, rows = 0;
  if (std::sscanf(nextText(bytes).c_str(), "-Y %9d +X %9d", &rows, &columns) != 2) {
    bytes.fail("expected a size such as \"-Y 300 +X 480\"");
  }

  RawImage image = startImage(path, columns, rows, 3, true, limits);
  if (header.hasOtherPrimaries) image.leftOut = kOtherPrimaries;
  const std::size_t width = image.width;
  const std::size_t height = image.height;
  bytes.need(height * sizeof(Rgbe));  // at least, before memory is taken
  image.values.reserve(width * height * 3);

  std::vector<Rgbe> row(width);
  for (std::size_t y = 0; y < height; ++y) {
    readRow(bytes, row);
    for (const Rgbe& pixel : row) {
      constexpr int kBias = 128 + 8;  // the exponent has a bias, and mantissas are below 256
      const float scale = pixel[3] == 0 ? 0 : std::ldexp(1.0f, pixel[3] - kBias);
      for (const auto c : indices(3)) {
        image.values.push_back(static_cast<float>(pixel[c]) * scale /
                               static_cast<float>(header.divisor[c]));
      }
    }
  }

  return image;
}

}  // namespace whit
