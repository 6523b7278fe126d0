#include "inspect/auto_exposure.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/display.h"
#include "core/quantile.h"
#include "core/vec3.h"
#include "core/worker_pool.h"
#include "reference/reference.h"
#include "render/embree_intersector.h"
#include "surfaces/initial_media.h"

namespace whit {

namespace {

constexpr int kLongSide = 64, kDepth = 8;
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
// promised (0.5 % of the model), because few pixels are looked at and the exposure is rounded.
constexpr double kUnclippedShare = 0.998, kUnclipped = 0.95, kMostForHighlights = 3;
constexpr double kDarkest = 1.0e-2;  // share of the bright ones' level; darker pixels count as this
constexpr double kSteps = 8;         // steps in an EV
constexpr double kMostEv = 32;
constexpr auto kNothing = PixelSurface::kNothing;

struct Luminances {
  std::vector<double> surfaces, sky;  // luminances of the pixels that show the one or the other
  std::vector<double> channels;       // the brightest channel of each pixel of a surface
};

Luminances luminancesOf(const Renderer& renderer, const Camera& camera) {
  const Scene& scene = renderer.scene();
  const int longer = std::max(scene.width, scene.height);
  const auto side = [&](int of) { return std::max(1, (of * kLongSide + longer / 2) / longer); };
  const int width = side(scene.width), height = side(scene.height);

  // Fixed settings and the scalar reference make the exposure independent of how the picture is
  // computed.
  reference::Settings settings;
  settings.options.depth = kDepth;
  settings.options.disable = renderer.options().disable;
  settings.threads = renderer.machine().threads;
  settings.effects = makePlan(scene, settings.options).effects;

  const EmbreeIntersector intersector(renderer.accel());
  const reference::Tracer tracer(scene, intersector, settings);
  const CameraFrame frame =
      frameWithMedia(scene, settings.effects, intersector, camera, width, height, 1);

  // Rows are joined in order, so that the result does not depend on the threads.
  std::vector<Luminances> rows(height);
  parallelFor(settings.threads, rows.size(), [&](std::size_t row, int) {
    reference::RayCounts counts;
    const int y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) {
      const Rgb pixel(tracer.center(frame, x, y, counts));
      const double l = luminance(pixel);
      if (!(l >= 0) || !std::isfinite(l)) continue;

      const std::uint32_t material = tracer.surfaceAtCenter(frame, x, y).material;
      if (material == kNothing || scene.materials[material].name == kGroundShadowName) {
        rows[row].sky.push_back(l);
      } else {
        rows[row].surfaces.push_back(l);
        rows[row].channels.push_back(double{maxComponent(pixel)});
      }
    }
  });

  Luminances all;
  for (const Luminances& row : rows) {
    all.surfaces.insert(all.surfaces.end(), row.surfaces.begin(), row.surfaces.end());
    all.sky.insert(all.sky.end(), row.sky.begin(), row.sky.end());
    all.channels.insert(all.channels.end(), row.channels.begin(), row.channels.end());
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

float exposureFor(const Renderer& renderer, const Camera& camera) {
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
