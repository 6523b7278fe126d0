#include "inspect/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <string>

#include "core/display.h"
#include "core/error.h"
#include "inspect/flip.h"

namespace whit {

namespace {

constexpr double kRelativeEpsilon = 1e-2;

// Measures linear values. Pixels that are not finite in either image are only counted, because one
// of them would make every mean meaningless.
void measureLinear(const Image& a, const Image& b, ImageDifference& difference) {
  double squares = 0, relative = 0, sumA = 0, sumB = 0;
  std::uint64_t values = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    if (!isFinite(a.pixels[i]) || !isFinite(b.pixels[i])) {
      ++difference.nonFinite;
      continue;
    }
    values += 3;
    for (int c = 0; c < 3; ++c) {
      const double x = static_cast<double>(a.pixels[i][c]);
      const double reference = static_cast<double>(b.pixels[i][c]);
      const double square = (x - reference) * (x - reference);
      squares += square;
      relative += square / (reference * reference + kRelativeEpsilon);
      sumA += x;
      sumB += reference;
    }
  }
  if (values == 0) return;
  difference.rmse = std::sqrt(squares / static_cast<double>(values));
  difference.relmse = relative / static_cast<double>(values);
  difference.energyRatio = sumA == sumB ? 1 : sumA / sumB;
}

double psnr(const DisplayImage& a, const DisplayImage& b) {
  std::uint64_t squares = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    if (i % 4 == 3) continue;  // alpha
    const int d = int{a.rgba[i]} - int{b.rgba[i]};
    squares += static_cast<std::uint64_t>(d * d);
  }
  if (squares == 0) return std::numeric_limits<double>::infinity();
  const std::size_t values = a.rgba.size() / 4 * 3;
  return 10 *
         std::log10(255.0 * 255.0 * static_cast<double>(values) / static_cast<double>(squares));
}

void measureCodes(const DisplayImage& a, const DisplayImage& b, ImageDifference& difference) {
  std::uint64_t one = 0, two = 0;
  const std::vector<std::uint8_t> codes = codeDifferences(a, b);
  for (const int code : codes) {
    difference.maxCode = std::max(difference.maxCode, code);
    one += code >= 1;
    two += code >= 2;
  }
  const double percent = 100.0 / static_cast<double>(codes.size());
  difference.pixelsGe1CodePct = percent * static_cast<double>(one);
  difference.pixelsGe2CodesPct = percent * static_cast<double>(two);
}

std::string describe(const Image& image) {
  const Crop& w = image.window;
  return std::to_string(image.width) + "x" + std::to_string(image.height) + " with pixels " +
         std::to_string(w.x0) + "," + std::to_string(w.y0) + "," + std::to_string(w.x1) + "," +
         std::to_string(w.y1);
}

using Color = std::array<std::uint8_t, 3>;

constexpr int kLargest = kHeatTicks.back();  // codes; differences beyond have the last color

// The scale beneath the image, in rows of coarse pixels from the top: gap, bar, ticks, digits, gap.
constexpr int kBarTop = 2, kBarRows = 6, kTickRows = 2, kDigitTop = 11, kScaleRows = 18;
constexpr int kMargin = 5;         // beside the bar, half a label
constexpr int kLeastColumns = 64;  // below this the labels would touch
constexpr int kColumnsPerZoom = 320;

// Digits of 3x5 pixels: an octal digit for each row, the left pixel in the highest bit.
constexpr std::array kDigits{075557, 026227, 071747, 071717, 055711,
                             074717, 074757, 071122, 075757, 075717};

// Draws the scale below row `top`; a coarse pixel has `zoom` of the image's pixels a side.
void drawScale(DisplayImage& image, int top, int zoom) {
  constexpr Color kInk{255, 255, 255};
  const auto set = [&](int x, int y, const Color& color) {
    for (int i = 0; i < zoom * zoom; ++i) {
      const int row = top + y * zoom + i / zoom, column = x * zoom + i % zoom;
      const std::size_t pixel = static_cast<std::size_t>(row) * image.width + column;
      std::copy(color.begin(), color.end(), &image.rgba[4 * pixel]);
    }
  };
  const int length = image.width / zoom - 2 * kMargin - 1;
  for (int x = 0; x <= length; ++x) {
    for (int y = 0; y < kBarRows; ++y) {
      set(kMargin + x, kBarTop + y, heatColor(static_cast<double>(x) / length));
    }
  }
  for (const int tick : kHeatTicks) {
    const int x = kMargin + static_cast<int>(std::lround(heatPosition(tick) * length));
    for (int y = 0; y < kTickRows; ++y) set(x, kBarTop + kBarRows + y, kInk);
    const std::string text = std::to_string(tick);
    int left = x - (4 * static_cast<int>(text.size()) - 1) / 2;
    for (const char digit : text) {
      for (int i = 0; i < 15; ++i) {
        const bool inked = (kDigits[static_cast<std::size_t>(digit - '0')] >> (14 - i) & 1) != 0;
        if (inked) set(left + i % 3, kDigitTop + i / 3, kInk);
      }
      left += 4;
    }
  }
}

}  // namespace

void checkComparable(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.window != b.window)
    throwUsage("expected two images of the same size and crop, found " + describe(a) + " and " +
               describe(b));
  if (a.pixels.empty()) throwUsage("expected images with at least one pixel");
}

std::vector<std::uint8_t> codeDifferences(const DisplayImage& a, const DisplayImage& b) {
  std::vector<std::uint8_t> differences(a.rgba.size() / 4);
  for (std::size_t i = 0; i < differences.size(); ++i) {
    int largest = 0;
    for (std::size_t c = 0; c < 3; ++c)
      largest = std::max(largest, std::abs(int{a.rgba[4 * i + c]} - int{b.rgba[4 * i + c]}));
    differences[i] = static_cast<std::uint8_t>(largest);
  }
  return differences;
}

ImageDifference compareImages(const Image& a, const Image& b, float exposure, ToneCurve curve,
                              SrgbEncoding encodingOfA) {
  checkComparable(a, b);
  ImageDifference difference;
  measureLinear(a, b, difference);
  const DisplayImage shownA = toDisplay(a, exposure, curve, encodingOfA);
  const DisplayImage shownB = toDisplay(b, exposure, curve);
  difference.psnrDb = psnr(shownA, shownB);
  measureCodes(shownA, shownB, difference);
  const std::vector<float> flip = flipOfCodes(shownA, shownB);
  difference.flipMean =
      std::accumulate(flip.begin(), flip.end(), 0.0) / static_cast<double>(flip.size());
  return difference;
}

ValueDifference differenceOf(std::span<const float> a, std::span<const float> b) {
  ValueDifference result;
  double squares = 0;
  std::uint64_t compared = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool finite = std::isfinite(a[i]) && std::isfinite(b[i]);
    const bool equal = a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i]));
    result.differing += !equal;
    result.incomparable += !equal && !finite;
    if (!finite) continue;
    const double difference = std::abs(double{a[i]} - double{b[i]});
    result.largest = std::max(result.largest, difference);
    squares += difference * difference;
    ++compared;
  }
  if (compared > 0) result.rms = std::sqrt(squares / static_cast<double>(compared));
  return result;
}

ValueDifference differenceOf(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) {
  ValueDifference result;
  for (std::size_t i = 0; i < a.size(); ++i) result.differing += a[i] != b[i];
  return result;
}

double heatPosition(int codes) {
  return std::log2(1.0 + std::min(codes, kLargest)) / std::log2(1.0 + kLargest);
}

std::array<std::uint8_t, 3> heatColor(double t) {
  constexpr std::array<std::array<double, 3>, 5> kStops{
      {{0, 0, 0}, {70, 20, 120}, {180, 50, 100}, {245, 130, 40}, {255, 245, 170}}};
  const double at = t * (kStops.size() - 1);
  const std::size_t low = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  const double f = at - static_cast<double>(low);
  std::array<std::uint8_t, 3> color{};
  for (std::size_t c = 0; c < 3; ++c)
    color[c] = static_cast<std::uint8_t>(
        std::lround(kStops[low][c] + f * (kStops[low + 1][c] - kStops[low][c])));
  return color;
}

DisplayImage heatMap(const Image& a, const Image& b, bool scale) {
  checkComparable(a, b);
  const std::vector<std::uint8_t> codes =
      codeDifferences(toDisplay(a, 0, ToneCurve::none), toDisplay(b, 0, ToneCurve::none));
  const int width = a.windowWidth(), height = a.windowHeight();
  DisplayImage map;
  map.width = scale ? std::max(width, kLeastColumns) : width;
  const int zoom = std::max(1, map.width / kColumnsPerZoom);
  map.height = height + (scale ? kScaleRows * zoom : 0);
  map.rgba.assign(
      std::size_t{4} * static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height),
      0);
  for (std::size_t i = 3; i < map.rgba.size(); i += 4) map.rgba[i] = 255;
  std::array<Color, 256> colors{};
  for (int code = 0; code < 256; ++code) {
    colors[static_cast<std::size_t>(code)] = heatColor(heatPosition(code));
  }
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const std::size_t x = i % static_cast<std::size_t>(width);
    const std::size_t y = i / static_cast<std::size_t>(width);
    const Color& color = colors[codes[i]];
    std::copy(color.begin(), color.end(),
              &map.rgba[4 * (y * static_cast<std::size_t>(map.width) + x)]);
  }
  if (scale) drawScale(map, height, zoom);
  return map;
}

}  // namespace whit
