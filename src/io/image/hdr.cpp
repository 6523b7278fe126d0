// Reading Radiance HDR: G. Ward, "Real Pixels", Graphics Gems II, 1991; Radiance's file formats.
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "io/files.h"
#include "io/image/image_decoders.h"

namespace whit {

namespace {

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
    for (std::size_t i = 0; i < count; ++i) {
      if (i == 0 || !isRun) value = bytes.next();
      row[done++][component] = value;
    }
  }
}

void readRow(ImageBytes& bytes, std::vector<Rgbe>& row) {
  constexpr std::size_t kShortest = 8, kLongest = 0x7fff;  // in runs of components
  row[0] = readPixel(bytes);
  const bool inRuns = row.size() >= kShortest && row.size() <= kLongest && row[0][0] == 2 &&
                      row[0][1] == 2 && row[0][2] < 128;
  if (inRuns) {
    const auto length = static_cast<std::size_t>(row[0][2] << 8 | row[0][3]);
    if (length != row.size()) {
      bytes.fail("expected a row of " + std::to_string(row.size()) + " pixels, found one of " +
                 std::to_string(length));
    }
    for (std::size_t component = 0; component < 4; ++component) readRuns(bytes, component, row);
    return;
  }
  for (std::size_t i = 1; i < row.size(); ++i) row[i] = readPixel(bytes);
}

}  // namespace

RawImage decodeHdr(const std::string& path, std::span<const std::uint8_t> file,
                   const ImageLimits& limits) {
  constexpr std::string_view kFormat = "FORMAT=", kKnown = "32-bit_rle_rgbe";
  ImageBytes bytes(path, file);
  for (std::string text; !(text = nextText(bytes)).empty();) {
    if (text.starts_with(kFormat) && text.substr(kFormat.size()) != kKnown) {
      bytes.fail("expected FORMAT=32-bit_rle_rgbe, found " + excerpt(text));
    }
  }
  int columns = 0, rows = 0;
  if (std::sscanf(nextText(bytes).c_str(), "-Y %9d +X %9d", &rows, &columns) != 2) {
    bytes.fail("expected a size such as \"-Y 300 +X 480\"");
  }
  RawImage image = startImage(path, columns, rows, 3, true, limits);
  const auto width = static_cast<std::size_t>(image.width);
  const auto height = static_cast<std::size_t>(image.height);
  bytes.need(height * sizeof(Rgbe));  // at least, before memory is taken
  image.values.reserve(width * height * 3);
  std::vector<Rgbe> row(width);
  for (std::size_t y = 0; y < height; ++y) {
    readRow(bytes, row);
    for (const Rgbe& pixel : row) {
      constexpr int kBias = 128 + 8;  // of the exponent, and of mantissas below 256
      const float scale = pixel[3] == 0 ? 0 : std::ldexp(1.0f, pixel[3] - kBias);
      for (std::size_t c = 0; c < 3; ++c) {
        image.values.push_back(static_cast<float>(pixel[c]) * scale);
      }
    }
  }
  return image;
}

}  // namespace whit
