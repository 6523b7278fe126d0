#include "core/display.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "core/machine_limits.h"
#include "core/worker_pool.h"

namespace whit {

namespace {

// The least number in [0, 1] whose code is at least `code`, by bisection over the bits.
template <typename Float>
Float leastWithCode(int code) {
  Float low = 0, high = 1;
  if (code == 0) return low;

  // Invariant: the code of `low` is below `code`, the code of `high` is not.
  while (std::nextafter(low, high) < high) {
    const Float middle = low + (high - low) / 2;
    if (std::floor(255 * linearToSrgb(double{middle}) + 0.5) >= code) {
      high = middle;
    } else {
      low = middle;
    }
  }

  return high;
}

// Hable's rational curve with the published parameters: shoulder, linear strength and angle, toe
// strength, toe numerator and denominator.
constexpr double hable(double x) {
  constexpr double kA = 0.15, kB = 0.50, kC = 0.10, kD = 0.20, kE = 0.02, kF = 0.30;
  return (x * (kA * x + kC * kB) + kD * kE) / (x * (kA * x + kB) + kD * kF) - kE / kF;
}

constexpr double kHableWhite = hable(11.2);
// Both curves have converged here; beyond it x * x could overflow.
constexpr double kCurveEnd = 1e30;

}  // namespace

double srgbToLinear(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

double linearToSrgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

std::array<float, 256> makeLinearOfCodes() {
  std::array<float, 256> table{};
  for (int code = 0; code < 256; ++code) {
    entryOf(table, code) = static_cast<float>(srgbToLinear(code / 255.0));
  }
  return table;
}

int srgbCode(double linear) {
  // Finding the place among the least numbers of the codes is faster than a power.
  static const std::array<double, 256> least = [] {
    std::array<double, 256> of{};
    for (int code = 0; code < 256; ++code) entryOf(of, code) = leastWithCode<double>(code);
    return of;
  }();

  if (!(linear > 0)) return 0;  // NaN too
  return static_cast<int>(std::ranges::upper_bound(least, linear) - least.begin()) - 1;
}

const std::array<float, 257>& leastWithCodes() {
  static const std::array<float, 257> least = [] {
    std::array<float, 257> of{};
    for (int code = 0; code < 256; ++code) entryOf(of, code) = leastWithCode<float>(code);
    // No value has a code above 255, so the table ends with infinity.
    of[256] = kInfinity;
    return of;
  }();
  return least;
}

double applyToneCurve(ToneCurve curve, double x) {
  if (curve == ToneCurve::none) return x;
  x = std::min(x, kCurveEnd);
  return curve == ToneCurve::reinhard ? x / (1 + x) : hable(x) / kHableWhite;
}

std::array<std::uint8_t, 3> displayCodes(const Rgb& pixel, double exposureScale, ToneCurve curve) {
  const auto encode = [&](float channel) {
    const double exposed = exposureScale * static_cast<double>(channel);
    // NaN and negatives are black before the curve, which is only defined from 0 on.
    return static_cast<std::uint8_t>(srgbCode(exposed > 0 ? applyToneCurve(curve, exposed) : 0.0));
  };

  return {encode(pixel.x), encode(pixel.y), encode(pixel.z)};
}

DisplayImage toDisplay(const Image& image, float exposure, ToneCurve curve) {
  DisplayImage display;
  display.width = image.windowWidth();
  display.height = image.windowHeight();
  display.rgba.reserve(image.pixels.size() * 4);

  const double scale = std::exp2(static_cast<double>(exposure));
  for (const Rgb& pixel : image.pixels) {
    for (const std::uint8_t code : displayCodes(pixel, scale, curve)) display.rgba.push_back(code);
    display.rgba.push_back(255);
  }

  return display;
}

DisplayImage overBackground(const Image& image, std::span<const float> alpha,
                            const RenderOptions& options) {
  const Background& background = options.background;
  DisplayImage display{image.windowWidth(),
                       image.windowHeight(),
                       {},
                       background.kind == Background::Kind::transparent};

  display.rgba.resize(image.pixels.size() * 4);
  const double scale = std::exp2(static_cast<double>(options.exposure.ev));

  const auto fillPixel = [&](std::size_t i) {
    std::uint8_t* to = &display.rgba[4 * i];
    // Pixels are premultiplied by their coverage; the division gives the surfaces' own color.
    const Rgb surfaces = alpha[i] > 0 ? image.pixels[i] / alpha[i] : Rgb(0.0f);
    const auto codes = displayCodes(surfaces, scale, options.toneCurve);

    // Russian roulette may leave the mean a little beyond its limits.
    const double covered = std::clamp(double{alpha[i]}, 0.0, 1.0);

    // Mixing is done in linear light. A transparent picture keeps the codes of its surfaces,
    // because PNG stores colors that are not premultiplied.
    const bool mixes = !display.hasAlpha && covered < 1;
    for (const auto c : indices(3)) {
      const double behind{linearOfCode(background.color[c])};
      const double mixed = behind + (double{linearOfCode(codes[c])} - behind) * covered;
      to[c] = mixes ? static_cast<std::uint8_t>(srgbCode(mixed)) : codes[c];
    }

    const double opacity = display.hasAlpha ? covered : 1;
    to[3] = static_cast<std::uint8_t>(std::lround(255 * opacity));
  };

  constexpr std::size_t kChunk = 4096;  // pixels of a task
  const std::size_t pixels = image.pixels.size();
  const int threads = options.threads > 0 ? options.threads : usableThreads();
  parallelFor(threads, (pixels + kChunk - 1) / kChunk, [&](std::size_t chunk, int) {
    const std::size_t end = std::min((chunk + 1) * kChunk, pixels);
    for (std::size_t i = chunk * kChunk; i < end; ++i) fillPixel(i);
  });
  return display;
}

}  // namespace whit
