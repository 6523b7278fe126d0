// From the samples of a batch to its pixels of the image.
#include <algorithm>
#include <cmath>

#include "core/film.h"
#include "render/tile_pass.h"
#include "scene/sample_pattern.h"

namespace whit {

namespace {

// Packed display codes: what two of them have at least and at most, channel by channel.
template <typename Choose>
std::uint32_t eachChannel(std::uint32_t a, std::uint32_t b, Choose choose) {
  std::uint32_t result = 0;
  for (int shift = 0; shift < 24; shift += 8) {
    result |= choose(a >> shift & 0xFFu, b >> shift & 0xFFu) << shift;
  }
  return result;
}
std::uint32_t lower(std::uint32_t a, std::uint32_t b) {
  return eachChannel(a, b, [](auto x, auto y) { return std::min(x, y); });
}
std::uint32_t higher(std::uint32_t a, std::uint32_t b) {
  return eachChannel(a, b, [](auto x, auto y) { return std::max(x, y); });
}
bool within(std::uint32_t low, std::uint32_t high, int contrast) {
  for (int shift = 0; shift < 24; shift += 8) {
    const int spread =
        static_cast<int>(high >> shift & 0xFFu) - static_cast<int>(low >> shift & 0xFFu);
    if (spread > contrast) return false;
  }
  return true;
}

}  // namespace

void TileTracer::trace(const FrameJob& job, std::span<const std::uint32_t> pixels,
                       FrameStats& stats, RayLog* log) {
  StageClock clock(stats);
  const std::size_t count = job.samples.size();
  for (std::size_t begin = 0; begin < pixels.size(); begin += capacity_) {
    const auto batch = pixels.subspan(begin, std::min(capacity_, pixels.size() - begin));
    Pass pass{job, batch, job.samples[0], stats, clock, log};
    if (count == 1) {
      traceSample(pass);
      if (job.shares && job.lends && job.shareImpulses) lendImpulses(pass);
    } else {
      sums_.assign(3 * batch.size(), 0.0);
      const bool pilot = job.contrast && count > kPilotSamples;
      if (pilot) {
        addSamples(pass, 0, kPilotSamples);
        settleWhereSamplesAgree(pass);
      }
      if (pass.pixels.empty()) continue;
      addSamples(pass, pilot ? kPilotSamples : 0, count);
      average(sums_, count);
    }
    updateImage(job, pass.pixels, stats);
    clock.lap(Stage::updateImage, 0);
  }
}

void TileTracer::addSamples(Pass& pass, std::size_t first, std::size_t end) {
  const RadianceColumns& radiance = *levels_[0].radiance;
  const std::size_t n = pass.pixels.size();
  const bool pilot = pass.job.contrast && first == 0;
  for (std::size_t s = first; s < end; ++s) {
    pass.sample = pass.job.samples[s];
    pass.sampleNumber = static_cast<std::uint32_t>(s);
    traceSample(pass);
    for (std::size_t i = 0; i < n; ++i) {
      sums_[3 * i] += static_cast<double>(radiance.r[i]);
      sums_[3 * i + 1] += static_cast<double>(radiance.g[i]);
      sums_[3 * i + 2] += static_cast<double>(radiance.b[i]);
    }
    if (pilot) widenSpread(pass, s == first);
  }
}

void TileTracer::widenSpread(const Pass& pass, bool first) {
  const std::size_t n = pass.pixels.size();
  codes_.resize(roundUpToBlock(n) + kBlock);
  simd::encodeDisplay(pass.job.exposureScale, pass.job.toneCurve, pass.job.srgb,
                      *levels_[0].radiance, n, codes_.data());
  if (first) {
    lowest_.assign(codes_.begin(), codes_.begin() + static_cast<std::ptrdiff_t>(n));
    highest_ = lowest_;
    return;
  }
  for (std::size_t i = 0; i < n; ++i) {
    lowest_[i] = lower(lowest_[i], codes_[i]);
    highest_[i] = higher(highest_[i], codes_[i]);
  }
}

void TileTracer::settleWhereSamplesAgree(Pass& pass) {
  settled_.clear();
  settledSums_.clear();
  contrasting_.clear();
  contrasting_.reserve(pass.pixels.size() + 2 * kBlock);  // kernels read whole vectors
  for (std::size_t i = 0; i < pass.pixels.size(); ++i) {
    const auto* const sum = &sums_[3 * i];
    if (within(lowest_[i], highest_[i], *pass.job.contrast)) {
      settled_.push_back(pass.pixels[i]);
      settledSums_.insert(settledSums_.end(), sum, sum + 3);
    } else {
      std::copy(sum, sum + 3, &sums_[3 * contrasting_.size()]);
      contrasting_.push_back(pass.pixels[i]);
    }
  }
  sums_.resize(3 * contrasting_.size());
  average(settledSums_, kPilotSamples);
  updateImage(pass.job, settled_, pass.stats);
  pass.clock.lap(Stage::updateImage, 0);
  pass.pixels = contrasting_;
}

void TileTracer::average(const std::vector<double>& sums, std::size_t samples) {
  const RadianceColumns& radiance = *levels_[0].radiance;
  const auto count = static_cast<double>(samples);
  for (std::size_t i = 0; 3 * i < sums.size(); ++i) {
    radiance.r[i] = static_cast<float>(sums[3 * i] / count);
    radiance.g[i] = static_cast<float>(sums[3 * i + 1] / count);
    radiance.b[i] = static_cast<float>(sums[3 * i + 2] / count);
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
  const Crop& window = film.image.window;
  const auto width = static_cast<std::size_t>(film.image.windowWidth());
  auto* display = reinterpret_cast<std::uint32_t*>(film.display.rgba.data());
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t x = (pixels[i] & 0xFFFFu) - static_cast<std::size_t>(window.x0);
    const std::size_t y = (pixels[i] >> 16) - static_cast<std::size_t>(window.y0);
    const Rgb value{radiance.r[i], radiance.g[i], radiance.b[i]};
    film.image.pixels[y * width + x] = value;
    if (film.wantDisplay) display[y * width + x] = codes_[i];
    // The sum is finite only if its terms are, or cancel; infinities of one sign do not.
    stats.nonFinitePixels += !std::isfinite(value.x + value.y + value.z);
  }
}

}  // namespace whit
