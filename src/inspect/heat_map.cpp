#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/display.h"
#include "inspect/metrics.h"

namespace whit {

namespace {

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
