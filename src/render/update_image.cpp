#include "render/update_image.h"

#include <cmath>

#include "core/display.h"
#include "core/pixel.h"
#include "core/srgb.h"
#include "render/film.h"
#include "simd/kernels.h"

namespace whit {

namespace {

void keepAsHalves(const RadianceColumns& radiance, std::size_t n) {
  for (float* const column : {radiance.r, radiance.g, radiance.b}) {
    for (std::size_t i = 0; i < n; ++i) column[i] = roundedToHalf(column[i]);
  }
}

void keepAsCodes(const Chunk& c) {
  const RadianceColumns radiance = c.radiance;
  const std::uint32_t* const codes = c.codes;
  simd::encodeDisplay({.radiance = radiance, .n = c.n, .codes = c.codes});
  for (std::size_t i = 0; i < c.n; ++i) {
    radiance.r[i] = linearOfCode(static_cast<int>(codes[i] & 0xFFu));
    radiance.g[i] = linearOfCode(static_cast<int>(codes[i] >> 8 & 0xFFu));
    radiance.b[i] = linearOfCode(static_cast<int>(codes[i] >> 16 & 0xFFu));
  }
}

}  // namespace

void encodeForDisplay(Chunk& c) {
  const RenderOptions& o = c.options();
  simd::encodeDisplay({std::exp2(o.exposure.ev), o.toneCurve, o.srgb, c.radiance, c.n, c.codes});
}

void updateImage(Chunk& c) {
  if (c.options().film == FilmPrecision::half) keepAsHalves(c.radiance, c.n);
  if (c.options().film == FilmPrecision::eightBit) keepAsCodes(c);
  Film& film = *c.film;
  if (film.wantDisplay) encodeForDisplay(c);
  // Locals: what memory may alias would be read again for every pixel.
  const int left = film.image.window.x0, top = film.image.window.y0;
  const auto width = static_cast<std::size_t>(film.image.windowWidth());
  const float *r = c.radiance.r, *g = c.radiance.g, *b = c.radiance.b;
  const std::uint32_t* const pixels = c.pixels.data();
  const std::uint32_t* const codes = film.wantDisplay ? c.codes : nullptr;
  auto* const display = reinterpret_cast<std::uint32_t*>(film.display.rgba.data());
  Rgb* const image = film.image.pixels.data();
  const std::size_t n = c.n;
  for (std::size_t i = 0; i < n; ++i) {
    const auto x = static_cast<std::size_t>(pixelX(pixels[i]) - left);
    const auto y = static_cast<std::size_t>(pixelY(pixels[i]) - top);
    Rgb& pixel = image[y * width + x];
    pixel.x = r[i], pixel.y = g[i], pixel.z = b[i];
    if (codes) display[y * width + x] = codes[i];
  }
}

std::uint64_t countNonFinite(const Chunk& c) {
  const float *r = c.radiance.r, *g = c.radiance.g, *b = c.radiance.b;
  std::uint64_t count = 0;
  // The sum is finite only if its terms are, or cancel; infinities of one sign do not.
  for (std::size_t i = 0; i < c.n; ++i) count += !std::isfinite(r[i] + g[i] + b[i]);
  return count;
}

}  // namespace whit
