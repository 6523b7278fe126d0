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

// Pixels on the long side of the picture that is measured, and of the one for highlights: these are
// small and few, so that fewer pixels would meet them in one view and miss them in the next.
constexpr int kLongSide = 64, kLongSideForHighlights = 192, kDepth = 8;
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
constexpr auto kNothing = PixelSurface::kNothing;

struct Luminances {
  std::vector<double> surfaces, sky;  // luminances of the pixels that show the one or the other
  std::vector<double> channels;       // the brightest channel of each pixel of a surface

  void append(const Luminances& more) {
    surfaces.insert(surfaces.end(), more.surfaces.begin(), more.surfaces.end());
    sky.insert(sky.end(), more.sky.begin(), more.sky.end());
    channels.insert(channels.end(), more.channels.begin(), more.channels.end());
  }
};

// The scalar reference's pictures of a view. It and fixed settings make the exposure independent of
// how the picture is computed.
class SmallPictures {
 public:
  SmallPictures(const Renderer& renderer, const Camera& camera)
      : scene_(renderer.scene()),
        camera_(camera),
        settings_(settingsOf(renderer)),
        intersector_(renderer.accel()),
        tracer_(scene_, intersector_, settings_) {}

  // Measures the picture with that many pixels on its long side.
  Luminances measure(int longSide, bool withSky) const {
    const int longer = std::max(scene_.width, scene_.height);
    const auto side = [&](int of) { return std::max(1, (of * longSide + longer / 2) / longer); };
    const CameraFrame frame = frameWithMedia(scene_, settings_.effects, intersector_, camera_,
                                             side(scene_.width), side(scene_.height), 1);

    // Rows are joined in order, so that the result does not depend on the threads.
    std::vector<Luminances> rows(frame.height);
    parallelFor(settings_.threads, rows.size(), [&](std::size_t row, int) {
      for (int x = 0; x < frame.width; ++x) {
        measurePixel(frame, x, static_cast<int>(row), withSky, rows[row]);
      }
    });

    Luminances all;
    for (const Luminances& row : rows) all.append(row);
    return all;
  }

 private:
  static reference::Settings settingsOf(const Renderer& renderer) {
    reference::Settings settings;
    settings.options.depth = kDepth;
    settings.options.disable = renderer.options().disable;
    settings.threads = renderer.machine().threads;
    settings.effects = makePlan(renderer.scene(), settings.options).effects;
    return settings;
  }

  void measurePixel(const CameraFrame& frame, int x, int y, bool withSky, Luminances& row) const {
    const std::uint32_t material = tracer_.surfaceAtCenter(frame, x, y).material;
    const bool isSky = material == kNothing || scene_.materials[material].name == kGroundShadowName;
    if (isSky && !withSky) return;

    reference::RayCounts counts;
    const Rgb pixel(tracer_.center(frame, x, y, counts));
    const double l = luminance(pixel);
    if (!(l >= 0) || !std::isfinite(l)) return;

    if (isSky) {
      row.sky.push_back(l);
    } else {
      row.surfaces.push_back(l);
      row.channels.push_back(double{maxComponent(pixel)});
    }
  }

  const Scene& scene_;
  const Camera& camera_;
  reference::Settings settings_;
  EmbreeIntersector intersector_;
  reference::Tracer tracer_;
};

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
  const SmallPictures pictures(renderer, camera);
  auto [surfaces, sky, channels] = pictures.measure(kLongSide, /*withSky=*/true);
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
    channels = pictures.measure(kLongSideForHighlights, /*withSky=*/false).channels;
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
