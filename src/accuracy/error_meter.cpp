#include "accuracy/error_meter.h"

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "core/display.h"
#include "core/index.h"
#include "core/quantile.h"
#include "core/worker_pool.h"
#include "io/image/image_file.h"
#include "output/digest.h"

namespace whit::accuracy {

namespace {

// Returns the largest difference of a channel, in units of the last place of the largest channel of
// `b`.
double ulpsApart(const Rgb& a, const Rgb& b) {
  const float largest = maxComponent(abs(b));
  if (!std::isfinite(largest)) return 0;

  const float next = std::nextafter(largest, std::numeric_limits<float>::max());
  return double{maxComponent(abs(a - b))} / double{next - largest};
}

ImageDifference noDifference() {
  ImageDifference none;
  none.psnrDb = kInfinity;
  return none;
}

void runTogether(const std::vector<std::function<void()>>& tasks) {
  parallelFor(static_cast<int>(tasks.size()), tasks.size(),
              [&](std::size_t i, int) { tasks[i](); });
}

ArithmeticError arithmeticError(Renderer& renderer, const Camera& camera, const Film& film,
                                const ReferencePaths& reference) {
  PathComparison paths = comparePaths(renderer, camera, film, reference);
  ArithmeticError error;
  error.divergences = paths.divergences;
  const double pixels = static_cast<double>(paths.diverged.size());
  error.divergencesPerMpx = 1e6 * static_cast<double>(paths.divergences) / pixels;

  // Pixels whose path diverged show no rounding error, so they count as equal.
  std::vector<double> ulps;
  for (const auto i : indices(paths.diverged)) {
    if (paths.diverged[i]) {
      paths.packets.pixels[i] = paths.reference.pixels[i];
    } else {
      ulps.push_back(ulpsApart(paths.packets.pixels[i], paths.reference.pixels[i]));
    }
  }

  error.samePath = compareImages(paths.packets, paths.reference);
  error.medianUlp = quantile(ulps, 0.5);
  error.ulp999 = quantile(ulps, 0.999);
  error.worstUlp = quantile(ulps, 1);
  return error;
}

// The options of the reference, whose model never has all transport.
RenderOptions referenceOf(RenderOptions base, const Scope& scope, bool hasTransport) {
  if (hasTransport) base.indirect = 0;
  return referenceOptions(base, scope.samples(), scope.cutoff);
}

}  // namespace

ErrorMeter::ErrorMeter(const Scene& scene, const RenderOptions& base, const Scope& scope,
                       std::optional<TransportPicture> transport, ReferenceCache& cache,
                       Progress* progress)
    : scene_(scene),
      base_(base),
      scope_(scope),
      camera_(chooseCamera(scene, base)),
      transport_(std::move(transport)),
      reference_(cache.get(referenceOf(base, scope, transport_.has_value()), progress)),
      exact_(cache.get(exactAtSameSamples(base, scope.cutoff), progress).image) {
  // This difference is the light that Whitted's model leaves out.
  if (transport_) leftOut_ = against(reference_.image, truth());
}

void ErrorMeter::measure(Point& point, FrameSource& frames) {
  point.stats = frames.stats;
  const Image& image = frames.film.image;

  // Comparisons do not depend on each other and run in parallel.
  std::vector<std::function<void()>> comparisons;
  comparisons.emplace_back([&] { point.total = against(image, truth()); });
  // The point has the baseline's sampling if the exact options are the same.
  if (digestOf(exactAtSameSamples(point.options, scope_.cutoff)) ==
      digestOf(exactAtSameSamples(base_, scope_.cutoff))) {
    comparisons.emplace_back([&] { point.sameSamples = against(image, exact_); });
  }
  runTogether(comparisons);

  const bool transports = transport_ && hasTransport(point.options);
  if (point.cause != Cause::arithmetic) {
    const Image& unapproximated = withoutApproximations(point, image);
    // The picture that more samples of the point converge to.
    const Image& limit = transports ? truth() : reference_.image;
    runTogether({[&] { point.sampling = against(unapproximated, limit); },
                 [&] { point.algorithm = against(image, unapproximated); }});
  }
  if (transport_) point.transport = transports ? noDifference() : *leftOut_;

  if (!scope_.comparesPaths(point)) return;
  point.arithmetic =
      arithmeticError(frames.renderer, camera_, frames.film, referencePaths(point, frames));
}

void ErrorMeter::addPictures(Point& point, const Image& image) const {
  point.imagePng = pngOf(image);
  point.totalMapPng = mapPng(image, truth());
  if (point.sameSamples) point.sameSamplesMapPng = mapPng(image, exact_);
}

std::string ErrorMeter::pngOf(const Image& image) const {
  return encodePng(toDisplay(image, base_.exposure.ev, base_.toneCurve));
}

std::string ErrorMeter::mapPng(const Image& a, const Image& b) const {
  return encodePng(heatMap(a, b, base_.exposure.ev, base_.toneCurve));
}

ImageDifference ErrorMeter::against(const Image& a, const Image& b) const {
  return compareImages(a, b, base_.exposure.ev, base_.toneCurve);
}

const Image& ErrorMeter::withoutApproximations(const Point& point, const Image& own) {
  const float cutoff = hasTransport(point.options) ? kTransportCutoff : scope_.cutoff;
  const RenderOptions exact = exactIn(point.options, Cause::algorithm, cutoff);
  const std::string digest = digestOf(exact);
  if (digest == digestOf(point.options)) return own;
  const auto found = exactPackets_.find(digest);
  if (found != exactPackets_.end()) return found->second;

  FrameSource frames(scene_, camera_, exact);
  frames.render();
  return exactPackets_.emplace(digest, std::move(frames.film.image)).first->second;
}

// Paths of the scalar reference with the point's own options. Points whose options differ only in
// ways that the scalar reference ignores share them.
const ReferencePaths& ErrorMeter::referencePaths(const Point& point, FrameSource& frames) {
  const RenderOptions defaults;
  RenderOptions seen = point.options;
  seen.packet = defaults.packet;
  const std::string digest = digestOf(seen);

  const auto found = referencePaths_.find(digest);
  if (found != referencePaths_.end()) return found->second;
  return referencePaths_.emplace(digest, traceReferencePaths(frames.renderer, camera_, frames.film))
      .first->second;
}

}  // namespace whit::accuracy
