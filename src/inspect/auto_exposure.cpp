#include "inspect/auto_exposure.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/channels.h"
#include "core/display.h"
#include "core/index.h"
#include "core/quantile.h"
#include "core/vec3.h"
#include "render/film.h"

namespace whit {

namespace {

// Pixels on the long side of the picture that is measured. The highlights of models are small and
// few, so that fewer pixels would meet them in one view and miss them in the next.
constexpr int kLongSide = 64, kLongSideOfModels = 192, kDepth = 8;
// Levels are those of the picture, after the tone curve. The mean of the surfaces becomes kMiddle.
constexpr double kMiddle = 0.3;
// This share of the surfaces' pixels stays below kBright, and this share of all pixels below
// kClear, so that a background does not burn out around a dark model.
constexpr double kBrightShare = 0.93, kBright = 0.95, kClearShare = 0.8, kClear = 0.8;
// The surfaces may be up to kMostForSky darker (in EV), so that half of the sky stays below kSky:
// what is dark before a gray sky is meant to be dark.
constexpr double kSky = 0.5, kMostForSky = 2;
// For this share of a model's pixels, the brightest channel stays below the code 255, unless the
// picture would then be more than kMostForHighlights EV darker. The bound is stricter than what is
// promised (0.5 % of the model), because not all pixels are looked at and the exposure is rounded.
constexpr double kUnclippedShare = 0.996, kUnclipped = 0.95, kMostForHighlights = 3;
constexpr double kDarkest = 1.0e-2;  // share of the bright ones' level; darker pixels count as this
constexpr double kSteps = 8;         // steps in an EV
constexpr double kMostEv = 32;

struct Luminances {
  std::vector<double> surfaces, sky;  // luminances of the pixels that show the one or the other
  std::vector<double> channels;       // the brightest channel of each pixel of a surface
};

// Renders a small picture. Fixed options make it independent of how the picture that is asked for
// is computed.
Luminances luminancesOf(Renderer& renderer, const Camera& camera) {
  const Scene& scene = renderer.scene();
  const int longer = std::max(scene.width, scene.height);
  const int longSide = scene.isModel ? kLongSideOfModels : kLongSide;
  const auto side = [&](int of) { return std::max(1, (of * longSide + longer / 2) / longer); };

  const RenderOptions asked = renderer.options();
  RenderOptions fixed;
  fixed.depth = kDepth;
  fixed.effects = asked.effects;
  fixed.disable = asked.disable;
  fixed.channels = ChannelSet().with(Channel::material);

  Film film;
  film.image = Image(side(scene.width), side(scene.height));
  film.wantDisplay = false;
  renderer.setOptions(fixed);
  renderer.render(camera, film);
  renderer.setOptions(asked);

  Luminances all;
  const auto materials = film.channels.numbers(Channel::material);
  for (const auto i : indices(film.image.pixels)) {
    const Rgb& pixel = film.image.pixels[i];
    const double l = luminance(pixel);
    if (!(l >= 0) || !std::isfinite(l)) continue;

    const std::uint32_t material = materials[i];
    if (material == kNoNumber || scene.materials[material].name == kGroundShadowName) {
      all.sky.push_back(l);
    } else {
      all.surfaces.push_back(l);
      all.channels.push_back(double{maxComponent(pixel)});
    }
  }
  return all;
}

// Log2 of the exposed luminance that the tone curve turns into `level`.
double exposed(ToneCurve curve, double level) {
  // The tone curve is monotonic, so that bisection inverts it.
  double low = -kMostEv, high = kMostEv;
  for (int i = 0; i < 64; ++i) {
    const double middle = (low + high) / 2;
    if (applyToneCurve(curve, std::exp2(middle)) < level) {
      low = middle;
    } else {
      high = middle;
    }
  }

  return low;
}

}  // namespace

float exposureFor(Renderer& renderer, const Camera& camera) {
  auto [surfaces, sky, channels] = luminancesOf(renderer, camera);
  const auto curve = renderer.options().toneCurve;
  const double bright = quantile(surfaces, kBrightShare), middleOfSky = quantile(sky, 0.5);
  if (!(bright > 0)) return 0;

  // The mean is geometric, over luminances that are clamped below the bright ones.
  double mean = 0;
  for (const double l : surfaces) {
    mean +=
        std::log2(std::clamp(l, kDarkest * bright, bright)) / static_cast<double>(surfaces.size());
  }

  // The mean becomes kMiddle unless bright surfaces would then exceed kBright.
  double ev = std::min(exposed(curve, kMiddle) - mean, exposed(curve, kBright) - std::log2(bright));

  // A bright sky may darken the surfaces by at most kMostForSky.
  if (middleOfSky > 0) {
    ev = std::clamp(exposed(curve, kSky) - std::log2(middleOfSky), ev - kMostForSky, ev);
  }

  // Most pixels of surfaces and sky together stay below kClear.
  surfaces.insert(surfaces.end(), sky.begin(), sky.end());
  ev = std::min(ev, exposed(curve, kClear) - std::log2(quantile(surfaces, kClearShare)));

  // The highlights of a model keep their shape.
  if (renderer.scene().isModel) {
    const double highlight = quantile(channels, kUnclippedShare);
    ev = std::clamp(exposed(curve, kUnclipped) - std::log2(highlight), ev - kMostForHighlights, ev);
  }

  // Adding 0.0 turns -0 into 0, so that no minus sign is printed.
  return static_cast<float>(std::clamp(std::round(ev * kSteps) / kSteps, -kMostEv, kMostEv) + 0.0);
}

void chooseExposure(Renderer& renderer, const Camera& camera, RenderOptions& options) {
  if (!options.exposure.automatic) return;
  options.exposure = {exposureFor(renderer, camera), false};
  renderer.setOptions(options);
}

}  // namespace whit
