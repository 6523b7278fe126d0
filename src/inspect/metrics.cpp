#include "inspect/metrics.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <string>

#include "core/display.h"
#include "core/error.h"
#include "core/index.h"
#include "core/text.h"

namespace whit {

namespace {

constexpr double kRelativeEpsilon = 1e-2;

bool equalOrNan(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

// Measures linear values. Pixels that are not finite in either image are only counted, because one
// of them would make every mean meaningless.
void measureLinear(const Image& a, const Image& b, ImageDifference& difference) {
  double squares = 0, relative = 0, sumA = 0, sumB = 0;
  std::uint64_t values = 0;

  for (const auto i : indices(a.pixels)) {
    if (!isFinite(a.pixels[i]) || !isFinite(b.pixels[i])) {
      ++difference.nonFinite;
      const Rgb &x = a.pixels[i], &y = b.pixels[i];
      const bool equal = equalOrNan(x.x, y.x) && equalOrNan(x.y, y.y) && equalOrNan(x.z, y.z);
      difference.incomparable += !equal;
      continue;
    }

    values += 3;
    for (int c = 0; c < 3; ++c) {
      const double x = double{a.pixels[i][c]}, reference = double{b.pixels[i][c]};
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
  for (const auto i : indices(a.rgba)) {
    if (i % 4 == 3) continue;  // alpha
    const int d = int{a.rgba[i]} - int{b.rgba[i]};
    squares += static_cast<std::uint64_t>(d * d);
  }

  if (squares == 0) return kInfinity;
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
  return concat(image.width, "x", image.height, " with pixels ", w.x0, ",", w.y0, ",", w.x1, ",",
                w.y1);
}

void checkComparable(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.window != b.window)
    throwUsage("expected two images of the same size and crop, found " + describe(a) + " and " +
               describe(b));
  if (a.pixels.empty()) throwUsage("expected images with at least one pixel");
}

}  // namespace

std::vector<std::uint8_t> codeDifferences(const DisplayImage& a, const DisplayImage& b) {
  std::vector<std::uint8_t> differences(a.rgba.size() / 4);

  for (const auto i : indices(differences)) {
    int largest = 0;
    for (const auto c : indices(3))
      largest = std::max(largest, std::abs(int{a.rgba[4 * i + c]} - int{b.rgba[4 * i + c]}));
    differences[i] = static_cast<std::uint8_t>(largest);
  }
  return differences;
}

ImageDifference compareImages(const Image& a, const Image& b, float exposure, ToneCurve curve) {
  checkComparable(a, b);

  ImageDifference difference;
  measureLinear(a, b, difference);

  // The other measures compare the images as they are displayed.
  const DisplayImage shownA = toDisplay(a, exposure, curve);
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

  for (const auto i : indices(a)) {
    const bool finite = std::isfinite(a[i]) && std::isfinite(b[i]);
    const bool equal = equalOrNan(a[i], b[i]);
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
  for (const auto i : indices(a)) result.differing += a[i] != b[i];
  return result;
}

std::array<std::uint8_t, 3> heatColor(double t) {
  constexpr std::array<std::array<double, 3>, 5> kStops{
      {{0, 0, 0}, {70, 20, 120}, {180, 50, 100}, {245, 130, 40}, {255, 245, 170}}};

  const double at = t * (kStops.size() - 1);
  const std::size_t low = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  const double f = at - static_cast<double>(low);

  std::array<std::uint8_t, 3> color{};
  for (const auto c : indices(3))
    color[c] = static_cast<std::uint8_t>(
        std::lround(kStops[low][c] + f * (kStops[low + 1][c] - kStops[low][c])));
  return color;
}

std::array<std::uint8_t, 3> heatOfCodes(int codes) {
  return heatColor(std::log2(1.0 + std::min(codes, kHeatCodes)) / std::log2(1.0 + kHeatCodes));
}

DisplayImage heatMap(const Image& a, const Image& b, float exposure, ToneCurve curve) {
  checkComparable(a, b);

  DisplayImage map = toDisplay(a, exposure, curve);
  const std::vector<std::uint8_t> codes = codeDifferences(map, toDisplay(b, exposure, curve));

  for (const auto i : indices(codes)) {
    std::ranges::copy(heatOfCodes(codes[i]), &map.rgba[4 * i]);
  }
  return map;
}

}  // namespace whit
