#include "inspect/false_colors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/display.h"
#include "inspect/metrics.h"

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
AmountScale rangeOf(std::vector<double> amounts) {
  if (amounts.empty()) return {};
  const auto last = static_cast<double>(amounts.size() - 1);
  const auto highest = amounts.begin() + std::lround(last * (1 - kOutliers));
  std::nth_element(amounts.begin(), highest, amounts.end());
  return {*std::min_element(amounts.begin(), highest + 1), *highest};
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

AmountScale depthScale(const std::vector<WatchedPixel>& pixels) {
  std::vector<double> distances;
  for (const WatchedPixel& p : pixels) {
    if (p.count > 0) distances.push_back(static_cast<double>(p.sum.x) / p.count);
  }
  return rangeOf(std::move(distances));
}

float depthGray(double share) {
  constexpr double kFarthest = 0.08;  // still told from nothing
  return static_cast<float>(1 - (1 - kFarthest) * std::clamp(share, 0.0, 1.0));
}

void paintDepth(const std::vector<WatchedPixel>& pixels, const AmountScale& scale,
                DisplayImage& display) {
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const WatchedPixel& p = pixels[i];
    const double t = p.count > 0 ? static_cast<double>(p.sum.x) / p.count : scale.high;
    const double depth = scale.high > scale.low ? (t - scale.low) / (scale.high - scale.low) : 0;
    const int code = p.count > 0 ? codeOf(depthGray(depth)) : 0;
    setCode(display, i, code, code, code);
  }
}

std::vector<double> amountsOf(const std::vector<WatchedPixel>& pixels, double samples) {
  std::vector<double> amounts;
  amounts.reserve(pixels.size());
  for (const WatchedPixel& p : pixels) {
    amounts.push_back(static_cast<double>(p.sum.x) / (p.count > 0 ? p.count : samples));
  }
  return amounts;
}

AmountScale heatScale(const std::vector<double>& amounts) {
  constexpr double kLongestScale = 1000;
  const AmountScale range = rangeOf(amounts);
  return {std::max(range.low, range.high / kLongestScale), range.high};
}

void paintHeat(const std::vector<double>& amounts, const AmountScale& scale,
               DisplayImage& display) {
  const bool flat = !(scale.high > scale.low);
  const double perLog = flat ? 0 : 1 / std::log(scale.high / scale.low);
  for (std::size_t i = 0; i < amounts.size(); ++i) {
    const double share = flat ? 0 : std::log(amounts[i] / scale.low) * perLog;
    const auto color = heatColor(share > 0 ? std::min(share, 1.0) : 0);
    setCode(display, i, color[0], color[1], color[2]);
  }
}

void paintShare(const std::vector<double>& shares, DisplayImage& display) {
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const auto color = heatColor(std::clamp(shares[i], 0.0, 1.0));
    setCode(display, i, color[0], color[1], color[2]);
  }
}

}  // namespace whit
