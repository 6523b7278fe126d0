#include "render/false_colors.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "core/display.h"
#include "metrics/metrics.h"

namespace whit {

namespace {

constexpr double kOutliers = 0.005;  // share of the pixels that a scale may leave behind

void setCode(DisplayImage& display, std::size_t pixel, int r, int g, int b) {
  std::uint8_t* code = display.rgba.data() + 4 * pixel;
  code[0] = static_cast<std::uint8_t>(r);
  code[1] = static_cast<std::uint8_t>(g);
  code[2] = static_cast<std::uint8_t>(b);
  code[3] = 255;
}

int codeOf(float x) {
  return static_cast<int>(std::lround(255 * std::clamp(static_cast<double>(x), 0.0, 1.0)));
}

// Smallest and largest amount but for outliers.
std::pair<double, double> rangeOf(std::vector<double> amounts) {
  if (amounts.empty()) return {0, 0};
  std::sort(amounts.begin(), amounts.end());
  const auto last = static_cast<double>(amounts.size() - 1);
  return {amounts.front(), amounts[static_cast<std::size_t>(std::lround(last * (1 - kOutliers)))]};
}

std::string legendOf(const char* what, double low, double high) {
  char text[96];
  std::snprintf(text, sizeof text, "%s, from %.3g to %.3g", what, low, high);
  return text;
}

}  // namespace

void paintColors(const std::vector<WatchedPixel>& pixels, bool linear, DisplayImage& display) {
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto n = static_cast<float>(std::max(pixels[i].count, 1.0));
    const Rgb c = pixels[i].sum * (1 / n);
    const auto code = [&](float x) {
      return linear ? srgbCode(static_cast<double>(x)) : codeOf(x);
    };
    setCode(display, i, code(c.x), code(c.y), code(c.z));
  }
}

std::string paintDepth(const std::vector<WatchedPixel>& pixels, DisplayImage& display) {
  std::vector<double> distances;
  for (const WatchedPixel& p : pixels) {
    if (p.count > 0) distances.push_back(static_cast<double>(p.sum.x) / p.count);
  }
  const auto [low, high] = rangeOf(std::move(distances));
  constexpr double kFarthest = 0.08;  // still told from nothing
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const WatchedPixel& p = pixels[i];
    const double t = p.count > 0 ? static_cast<double>(p.sum.x) / p.count : high;
    const double depth = high > low ? std::min((t - low) / (high - low), 1.0) : 0;
    const int code = p.count > 0 ? codeOf(static_cast<float>(1 - (1 - kFarthest) * depth)) : 0;
    setCode(display, i, code, code, code);
  }
  return legendOf("distance", low, high);
}

std::vector<double> amountsOf(const std::vector<WatchedPixel>& pixels, double samples) {
  std::vector<double> amounts;
  amounts.reserve(pixels.size());
  for (const WatchedPixel& p : pixels) {
    amounts.push_back(static_cast<double>(p.sum.x) / (p.count > 0 ? p.count : samples));
  }
  return amounts;
}

std::string paintHeat(const std::vector<double>& amounts, const char* what, DisplayImage& display) {
  constexpr double kLongestScale = 1000;
  const auto [smallest, high] = rangeOf(amounts);
  const double low = std::max(smallest, high / kLongestScale);
  for (std::size_t i = 0; i < amounts.size(); ++i) {
    const double share = high > low ? std::log(amounts[i] / low) / std::log(high / low) : 0;
    const auto color = heatColor(share > 0 ? std::min(share, 1.0) : 0);
    setCode(display, i, color[0], color[1], color[2]);
  }
  return legendOf(what, low, high);
}

std::string paintShare(const std::vector<double>& shares, const char* what, DisplayImage& display) {
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const auto color = heatColor(std::clamp(shares[i], 0.0, 1.0));
    setCode(display, i, color[0], color[1], color[2]);
  }
  return legendOf(what, 0, 1);
}

}  // namespace whit
