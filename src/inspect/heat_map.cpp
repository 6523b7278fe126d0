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

// The scale beneath the image, in rows of its own pixels from the top: gap, bar, ticks, digits,
// gap.
constexpr int kBarTop = 2, kBarRows = 6, kTickRows = 2, kDigitTop = 11, kScaleRows = 18;
constexpr int kMargin = 5;         // beside the bar, half a label
constexpr int kLeastColumns = 64;  // below this the labels would touch
constexpr int kColumnsPerZoom = 320;

// Digits of 3x5 pixels, a row in three bits, the left pixel in the highest.
constexpr std::array<std::array<std::uint8_t, 5>, 10> kDigits{{{7, 5, 5, 5, 7},
                                                               {2, 6, 2, 2, 7},
                                                               {7, 1, 7, 4, 7},
                                                               {7, 1, 3, 1, 7},
                                                               {5, 5, 7, 1, 1},
                                                               {7, 4, 7, 1, 7},
                                                               {7, 4, 7, 5, 7},
                                                               {7, 1, 1, 2, 2},
                                                               {7, 5, 7, 5, 7},
                                                               {7, 5, 7, 1, 7}}};

// Draws in coarse pixels, `zoom` of the image's a side, below row `top`.
class ScalePainter {
 public:
  ScalePainter(DisplayImage& image, int top, int zoom) : image_(image), top_(top), zoom_(zoom) {}

  int columns() const { return image_.width / zoom_; }

  void set(int x, int y, const Color& color) {
    for (int dy = 0; dy < zoom_; ++dy)
      for (int dx = 0; dx < zoom_; ++dx) {
        const int row = top_ + y * zoom_ + dy, column = x * zoom_ + dx;
        const std::size_t pixel = static_cast<std::size_t>(row) * image_.width + column;
        std::copy(color.begin(), color.end(), image_.rgba.data() + 4 * pixel);
      }
  }

  void digits(int center, int y, const std::string& text, const Color& color) {
    int left = center - (4 * static_cast<int>(text.size()) - 1) / 2;
    for (const char c : text) {
      for (int row = 0; row < 5; ++row)
        for (int column = 0; column < 3; ++column)
          if (kDigits[static_cast<std::size_t>(c - '0')][static_cast<std::size_t>(row)] >>
                  (2 - column) &
              1)
            set(left + column, y + row, color);
      left += 4;
    }
  }

 private:
  DisplayImage& image_;
  int top_, zoom_;
};

void drawScale(ScalePainter painter) {
  constexpr Color kInk{255, 255, 255};
  const int length = painter.columns() - 2 * kMargin - 1;
  for (int x = 0; x <= length; ++x)
    for (int y = 0; y < kBarRows; ++y)
      painter.set(kMargin + x, kBarTop + y, heatColor(static_cast<double>(x) / length));
  for (const int tick : kHeatTicks) {
    const int x = kMargin + static_cast<int>(std::lround(heatPosition(tick) * length));
    for (int y = 0; y < kTickRows; ++y) painter.set(x, kBarTop + kBarRows + y, kInk);
    painter.digits(x, kDigitTop, std::to_string(tick), kInk);
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

DisplayImage heatMap(const Image& a, const Image& b) {
  checkComparable(a, b);
  const std::vector<std::uint8_t> codes =
      codeDifferences(toDisplay(a, 0, ToneCurve::none), toDisplay(b, 0, ToneCurve::none));
  const int width = a.windowWidth(), height = a.windowHeight();
  DisplayImage map;
  map.width = std::max(width, kLeastColumns);
  const int zoom = std::max(1, map.width / kColumnsPerZoom);
  map.height = height + kScaleRows * zoom;
  map.rgba.assign(
      std::size_t{4} * static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height),
      0);
  for (std::size_t i = 3; i < map.rgba.size(); i += 4) map.rgba[i] = 255;
  std::array<Color, 256> colors{};
  for (int code = 0; code < 256; ++code)
    colors[static_cast<std::size_t>(code)] = heatColor(heatPosition(code));
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const std::size_t x = i % static_cast<std::size_t>(width);
    const std::size_t y = i / static_cast<std::size_t>(width);
    const Color& color = colors[codes[i]];
    std::copy(color.begin(), color.end(),
              map.rgba.data() + 4 * (y * static_cast<std::size_t>(map.width) + x));
  }
  drawScale(ScalePainter(map, height, zoom));
  return map;
}

}  // namespace whit
