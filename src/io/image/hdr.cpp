// Reading Radiance HDR: G. Ward, "Real Pixels", Graphics Gems II, 1991; Radiance's file formats.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "io/image/image_bytes.h"
#include "io/image/image_decoders.h"

namespace whit {

namespace {

using Rgbe = std::array<std::uint8_t, 4>;

class HdrReader {
 public:
  HdrReader(const std::string& path, std::span<const std::uint8_t> file, const ImageLimits& limits)
      : path_(path), bytes_(path, file), limits_(limits) {}

  RawImage read() {
    readHeader();
    readSize();
    image_.linear = true;
    image_.channels = 3;
    image_.held = holdImage(path_, image_.width, image_.height, 3 * sizeof(float), limits_);
    bytes_.need(static_cast<std::uint64_t>(lines_) * sizeof(Rgbe));  // before memory is taken
    image_.values.resize(static_cast<std::size_t>(image_.width) *
                         static_cast<std::size_t>(image_.height) * 3);
    std::vector<Rgbe> line(static_cast<std::size_t>(length_));
    for (int i = 0; i < lines_; ++i) {
      readLine(line);
      for (int k = 0; k < length_; ++k) store(line[static_cast<std::size_t>(k)], i, k);
    }
    return std::move(image_);
  }

 private:
  std::string nextText() {
    constexpr std::size_t kLongestText = 1024;
    std::string text;
    for (char c; (c = static_cast<char>(bytes_.next())) != '\n'; text += c) {
      if (text.size() > kLongestText) bytes_.fail("expected a line of a Radiance header");
    }
    if (text.ends_with('\r')) text.pop_back();
    return text;
  }

  void readHeader() {
    constexpr std::string_view kFormat = "FORMAT=", kKnown = "32-bit_rle_rgbe";
    for (std::string text; !(text = nextText()).empty();) {
      if (text.starts_with(kFormat) && text.substr(kFormat.size()) != kKnown) {
        bytes_.fail("expected FORMAT=32-bit_rle_rgbe, found " + text);
      }
    }
  }

  // "-Y 300 +X 480": lines from the top, each from the left; other signs and the other order turn
  // the picture.
  void readSize() {
    const std::string text = nextText();
    char axes[2][3] = {};
    int sizes[2] = {};
    const int found =
        std::sscanf(text.c_str(), "%2s %9d %2s %9d", axes[0], &sizes[0], axes[1], &sizes[1]);
    byColumn_ = axes[0][1] == 'X';
    const auto isAxis = [](const char* axis, char name) {
      return (axis[0] == '-' || axis[0] == '+') && axis[1] == name;
    };
    if (found != 4 || !isAxis(axes[0], byColumn_ ? 'X' : 'Y') ||
        !isAxis(axes[1], byColumn_ ? 'Y' : 'X')) {
      bytes_.fail("expected a size such as \"-Y 300 +X 480\"");
    }
    lines_ = sizes[0];
    length_ = sizes[1];
    fromLeft_ = axes[byColumn_ ? 0 : 1][0] == '+';
    fromTop_ = axes[byColumn_ ? 1 : 0][0] == '-';
    image_.width = byColumn_ ? lines_ : length_;
    image_.height = byColumn_ ? length_ : lines_;
  }

  Rgbe readPixel() {
    Rgbe pixel;
    for (std::uint8_t& component : pixel) component = bytes_.next();
    return pixel;
  }

  void readLine(std::vector<Rgbe>& line) {
    constexpr std::size_t kShortest = 8, kLongest = 0x7fff;  // in runs of components
    const Rgbe first = readPixel();
    const bool inRuns = line.size() >= kShortest && line.size() <= kLongest && first[0] == 2 &&
                        first[1] == 2 && first[2] < 128;
    if (!inRuns) return readPixels(first, line);
    if (static_cast<std::size_t>(first[2] << 8 | first[3]) != line.size()) {
      bytes_.fail("expected a line of " + std::to_string(line.size()) + " pixels, found one of " +
                  std::to_string(first[2] << 8 | first[3]));
    }
    for (std::size_t component = 0; component < 4; ++component) readRuns(component, line);
  }

  void checkRun(std::size_t count, std::size_t done, const std::vector<Rgbe>& line) const {
    if (count == 0 || count > line.size() - done) {
      bytes_.fail("expected pixels up to the line's end, found more or none");
    }
  }

  void readRuns(std::size_t component, std::vector<Rgbe>& line) {
    for (std::size_t done = 0; done < line.size();) {
      const std::size_t head = bytes_.next();
      const bool isRun = head > 128;
      const std::size_t count = isRun ? head - 128 : head;
      checkRun(count, done, line);
      std::uint8_t value = 0;
      for (std::size_t i = 0; i < count; ++i) {
        if (i == 0 || !isRun) value = bytes_.next();
        line[done++][component] = value;
      }
    }
  }

  // One after the other; in the format's first form 1, 1, 1 and a number repeat the one before, and
  // the next such number counts 256 times as much.
  void readPixels(Rgbe pixel, std::vector<Rgbe>& line) {
    int shift = 0;
    for (std::size_t done = 0;;) {
      if (done > 0 && pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
        const std::size_t count = static_cast<std::size_t>(pixel[3]) << shift;
        checkRun(count, done, line);
        for (std::size_t i = 0; i < count; ++i, ++done) line[done] = line[done - 1];
        shift = std::min(shift + 8, 24);
      } else {
        line[done++] = pixel;
        shift = 0;
      }
      if (done == line.size()) return;
      pixel = readPixel();
    }
  }

  void store(const Rgbe& pixel, int line, int at) {
    const int column = byColumn_ ? line : at, row = byColumn_ ? at : line;
    const int x = fromLeft_ ? column : image_.width - 1 - column;
    const int y = fromTop_ ? row : image_.height - 1 - row;
    constexpr int kBias = 128 + 8;  // of the exponent, and of mantissas below 256
    const float scale = pixel[3] == 0 ? 0 : std::ldexp(1.0f, pixel[3] - kBias);
    float* to = image_.values.data() +
                (static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                 static_cast<std::size_t>(x)) *
                    3;
    for (std::size_t i = 0; i < 3; ++i) to[i] = static_cast<float>(pixel[i]) * scale;
  }

  const std::string& path_;
  ImageBytes bytes_;
  const ImageLimits& limits_;
  int lines_ = 0, length_ = 0;  // lines of pixels as they are in the file
  bool byColumn_ = false, fromLeft_ = true, fromTop_ = true;
  RawImage image_;
};

}  // namespace

bool isHdr(std::span<const std::uint8_t> file) {
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  return text.starts_with("#?RADIANCE") || text.starts_with("#?RGBE");
}

RawImage decodeHdr(const std::string& path, std::span<const std::uint8_t> file,
                   const ImageLimits& limits) {
  return HdrReader(path, file, limits).read();
}

}  // namespace whit
