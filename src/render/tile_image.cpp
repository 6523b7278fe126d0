// From the samples of a batch to its pixels of the image.
#include <algorithm>
#include <cmath>

#include "core/film.h"
#include "core/pixel.h"
#include "core/srgb.h"
#include "render/tile_pass.h"

namespace whit {

void TileTracer::trace(const FrameJob& job, std::span<const std::uint32_t> pixels,
                       FrameStats& stats, RayLog* log) {
  StageClock clock(stats);
  for (std::size_t begin = 0; begin < pixels.size(); begin += capacity_) {
    const auto batch = pixels.subspan(begin, std::min(capacity_, pixels.size() - begin));
    Pass pass{job, batch, job.samples[0], stats, clock, log};
    if (job.samples.size() == 1 && !job.probes) {
      traceSample(pass);
    } else {
      traceSamples(pass);
    }
    updateImage(job, batch, stats);
    clock.lap(Stage::updateImage, 0);
  }
}

void TileTracer::traceSamples(Pass& pass) {
  const FrameJob& job = pass.job;
  const RadianceColumns& radiance = *levels_[0].radiance;
  const std::size_t n = pass.pixels.size(), count = job.samples.size();
  const auto probesOf = [&](std::size_t i) -> PixelProbes& {
    return job.probes->at(pixelX(pass.pixels[i]), pixelY(pass.pixels[i]));
  };
  sums_.assign(n, RgbD());
  const bool goesOn = job.firstSample > 0;
  for (std::size_t i = 0; goesOn && i < n; ++i) sums_[i] = probesOf(i).total;
  for (std::size_t s = job.firstSample; s < count; ++s) {
    pass.sample = job.samples[s];
    pass.sampleNumber = static_cast<std::uint32_t>(s);
    traceSample(pass);
    for (std::size_t i = 0; i < n; ++i) {
      sums_[i] += RgbD(Rgb{radiance.r[i], radiance.g[i], radiance.b[i]});
    }
    if (job.probes && !goesOn) keepCodes(pass);
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (job.probes && !goesOn) probesOf(i).total = sums_[i];
    const Rgb mean(sums_[i] / static_cast<double>(count));
    radiance.r[i] = mean.x, radiance.g[i] = mean.y, radiance.b[i] = mean.z;
  }
}

void TileTracer::keepCodes(const Pass& pass) {
  const std::size_t n = pass.pixels.size();
  codes_.resize(roundUpToBlock(n) + kBlock);
  simd::encodeDisplay(pass.job.exposureScale, pass.job.toneCurve, pass.job.srgb,
                      *levels_[0].radiance, n, codes_.data());
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t pixel = pass.pixels[i];
    pass.job.probes->at(pixelX(pixel), pixelY(pixel)).codes[pass.sampleNumber] = codes_[i];
  }
}

void TileTracer::keepAs(FilmPrecision precision, std::size_t n) {
  const RadianceColumns& radiance = *levels_[0].radiance;
  if (precision == FilmPrecision::half) {
    for (float* const column : {radiance.r, radiance.g, radiance.b}) {
      for (std::size_t i = 0; i < n; ++i) column[i] = roundedToHalf(column[i]);
    }
    return;
  }
  simd::encodeDisplay(1, ToneCurve::none, SrgbEncoding::exact, radiance, n, codes_.data());
  for (std::size_t i = 0; i < n; ++i) {
    radiance.r[i] = linearOfCode(static_cast<int>(codes_[i] & 0xFFu));
    radiance.g[i] = linearOfCode(static_cast<int>(codes_[i] >> 8 & 0xFFu));
    radiance.b[i] = linearOfCode(static_cast<int>(codes_[i] >> 16 & 0xFFu));
  }
}

void TileTracer::updateImage(const FrameJob& job, std::span<const std::uint32_t> pixels,
                             FrameStats& stats) {
  const RadianceColumns& radiance = *levels_[0].radiance;
  const std::size_t n = pixels.size();
  codes_.resize(roundUpToBlock(n) + kBlock);
  if (job.precision != FilmPrecision::single) keepAs(job.precision, n);
  Film& film = *job.film;
  if (film.wantDisplay) {
    simd::encodeDisplay(job.exposureScale, job.toneCurve, job.srgb, radiance, n, codes_.data());
  }
  // Locals: what memory may alias would be read again for every pixel.
  const int left = film.image.window.x0, top = film.image.window.y0;
  const auto width = static_cast<std::size_t>(film.image.windowWidth());
  const float *r = radiance.r, *g = radiance.g, *b = radiance.b;
  const std::uint32_t* codes = film.wantDisplay ? codes_.data() : nullptr;
  auto* const display = reinterpret_cast<std::uint32_t*>(film.display.rgba.data());
  Rgb* const image = film.image.pixels.data();
  std::uint64_t nonFinite = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const auto x = static_cast<std::size_t>(pixelX(pixels[i]) - left);
    const auto y = static_cast<std::size_t>(pixelY(pixels[i]) - top);
    Rgb& pixel = image[y * width + x];
    pixel.x = r[i], pixel.y = g[i], pixel.z = b[i];
    if (codes) display[y * width + x] = codes[i];
    // The sum is finite only if its terms are, or cancel; infinities of one sign do not.
    nonFinite += !std::isfinite(r[i] + g[i] + b[i]);
  }
  stats.nonFinitePixels += nonFinite;
}

}  // namespace whit
