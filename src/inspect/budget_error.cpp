#include <algorithm>
#include <cmath>
#include <random>
#include <span>

#include "core/index.h"
#include "core/stopwatch.h"
#include "inspect/budget.h"
#include "inspect/prober.h"
#include "stages/lobes.h"

namespace whit {

namespace {

constexpr double kAssessShare = 0.01;    // time to assess the error, as a share of the picture's
constexpr double kChannelMargin = 1.25;  // factor of the noise that the channel `error` estimates
// The mean of k equal samples among black ones has the relative standard error 1 / sqrt(k) (Kish
// 1965 calls k the effective number of samples). Where fewer than kFewSamples decide a pixel and
// those around it, they tell little about the samples that were not drawn. Where the other pixels
// have less than the share kLeastKnown of the squared error, the error is not known.
constexpr double kFewSamples = 8, kLeastKnown = 0.5;

// The error is an estimate that nothing bounds.
void leaveUnknown(Receipt& r, double estimate) {
  r.error = estimate;
  r.high = kInfinity;
  if (!r.note.empty()) r.note += "; ";
  r.note += "the error is not known: few samples decide most of what was measured";
}

// Returns the root mean squares of radiance over the colors of the pixels that the channel `error`
// is pooled over.
std::vector<double> pooledRadiance(const Film& film) {
  // poolErrors() works on the channel `error`, so the radiance takes its place there.
  Film means;
  means.image = film.image;
  means.channels.resize(ChannelSet().with(Channel::error), film.image.pixels.size());
  const std::span<float> values = means.channels.floats(Channel::error);

  for (const auto i : indices(film.image.pixels)) {
    const Rgb& pixel = film.image.pixels[i];
    values[2 * i] = std::sqrt(dot(pixel, pixel) / 3);
  }
  poolErrors(means);

  // The channel has two floats for each pixel; only the first is pooled.
  std::vector<double> pooled;
  for (std::size_t i = 0; i < values.size(); i += 2) pooled.push_back(double{values[i]});
  return pooled;
}

double brightestRadiance(const Scene& scene, const Image& image) {
  float brightest = 0;
  for (const Rgb& pixel : image.pixels) brightest = std::max(brightest, maxComponent(pixel));
  for (const Material& m : scene.materials)
    brightest = std::max(brightest, maxComponent(m.emission));

  // Parts of the sky that are out of view may be brighter than any pixel.
  const Sky& sky = scene.sky;
  if (sky.kind == Sky::Kind::none) return double{brightest};
  for (const Rgb& color : {sky.zenith, sky.horizon, sky.ground}) {
    brightest = std::max(brightest, sky.scale * maxComponent(color));
  }
  for (const std::vector<float>* texels : {&sky.image.r, &sky.image.g, &sky.image.b}) {
    for (const float texel : *texels) brightest = std::max(brightest, sky.scale * texel);
  }

  return double{brightest};
}

// Three pictures that differ from the rendered one.
struct ChangedPictures {
  Image noisy;   // the image with noise of the estimated size
  Image steady;  // the same noise, only where enough samples decide a pixel
  Image whole;   // with the most light that ended paths could bring
};

ChangedPictures changedPictures(const Scene& scene, const Film& film) {
  ChangedPictures changed{film.image, film.image, film.image};
  const double brightest = brightestRadiance(scene, film.image);
  const std::span<const float> errors = film.channels.floats(Channel::error);
  const std::vector<double> radiance = pooledRadiance(film);
  std::mt19937 random;
  std::uniform_real_distribution<float> noise(-std::sqrt(3.0f), std::sqrt(3.0f));  // variance 1

  for (const auto i : indices(film.image.pixels)) {
    const double error = double{errors[2 * i]};
    const Rgb change(noise(random) * errors[2 * i]);
    changed.noisy.pixels[i] += change;
    if (kFewSamples * squared(error) <= squared(radiance[i])) changed.steady.pixels[i] += change;
    changed.whole.pixels[i] += Rgb(static_cast<float>(brightest * double{errors[2 * i + 1]}));
  }
  return changed;
}

}  // namespace

void assess(Receipt& r, Renderer& renderer, const Camera& camera, double ms, Film& film) {
  const Stopwatch clock;
  if (renderer.options().channels.has(Channel::error)) {
    const ChangedPictures changed = changedPictures(renderer.scene(), film);
    Prober prober(renderer, camera, film, r.budget.inCodes);
    // Squares of codes may come from a few pixels, so that a target in codes takes all.
    const double pixels =
        r.budget.inCodes ? prober.pixels() : 1e3 * kAssessShare * ms / kFlipMicroseconds;
    prober.chooseBlocks(kBlockSide, std::max(pixels / squared(kBlockSide), kLeastBlocks));

    const Image shown = prober.mosaic();
    r.ended = prober.difference(prober.mosaic(changed.whole), shown);
    const double sampled = prober.difference(prober.mosaic(changed.noisy), shown);

    double most = r.error, known = sampled;
    if (r.options.spp > 1) {
      // Samples that are spread evenly have less noise than the channel says.
      most = std::sqrt(squared(r.bias) + squared(sampled));
      r.setError(std::min(r.error, most));
      r.high = kChannelMargin * most;
      known = prober.difference(prober.mosaic(changed.steady), shown);
    }

    // Against one random path a pixel, what depth and other knobs leave out is measured too low.
    const bool isMeasured = r.options.spp > 1 && squared(r.bias) < 0.5 * squared(r.error);
    const bool isRandom = samplesLobes(renderer.plan().effects) && !isMeasured;
    if (isRandom || squared(known) < kLeastKnown * squared(sampled)) leaveUnknown(r, most);
  }

  film.channels.keepOnly(r.options.channels);
  renderer.setOptions(r.options);
  r.measuredMs = ms + clock.ms();
}

}  // namespace whit
