#include "accuracy/errors.h"

#include <cmath>
#include <functional>
#include <limits>

#include "accuracy/digest.h"
#include "core/display.h"
#include "core/quantile.h"
#include "core/worker_pool.h"
#include "io/image/image_file.h"

namespace whit::accuracy {

namespace {

// The largest difference of a channel, in units of the last place of the largest channel of `b`.
double ulpsApart(const Rgb& a, const Rgb& b) {
  const float largest = maxComponent(abs(b));
  if (!std::isfinite(largest)) return 0;
  const float next = std::nextafter(largest, std::numeric_limits<float>::max());
  return static_cast<double>(maxComponent(abs(a - b))) / static_cast<double>(next - largest);
}

ImageDifference noDifference() {
  ImageDifference none;
  none.psnrDb = std::numeric_limits<double>::infinity();
  return none;
}

void runTogether(const std::vector<std::function<void()>>& tasks) {
  parallelFor(static_cast<int>(tasks.size()), tasks.size(),
              [&](std::size_t i, int) { tasks[i](); });
}

}  // namespace

ArithmeticError arithmeticError(Renderer& renderer, const Camera& camera, const Film& film,
                                const ReferencePaths& reference) {
  PathComparison paths = comparePaths(renderer, camera, film, reference);
  ArithmeticError error;
  error.divergences = paths.divergences;
  const double pixels = static_cast<double>(paths.diverged.size());
  error.divergencesPerMpx = 1e6 * static_cast<double>(paths.divergences) / pixels;
  std::vector<double> ulps;
  for (std::size_t i = 0; i < paths.diverged.size(); ++i) {
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

ErrorMeter::ErrorMeter(const Scene& scene, const Camera& camera, const RenderOptions& base,
                       const Exactness& exactness, ReferenceCache& cache, int samples,
                       const TransportPicture* transport, Progress* progress)
    : scene_(scene),
      camera_(camera),
      base_(base),
      exactness_(exactness),
      reference_(&cache.get(
          referenceOptions(transport ? withoutTransport(base) : base, samples, exactness),
          progress)),
      exact_(&cache.get(exactAtSameSamples(base, exactness), progress)),
      transport_(transport),
      hdrFlip_(truth()) {
  if (transport_) leftOut_ = against(reference_->image, truth(), SrgbEncoding::exact);
}

ImageDifference ErrorMeter::against(const Image& a, const Image& b, SrgbEncoding encoding) const {
  return compareImages(a, b, base_.exposure.ev, base_.toneCurve, encoding);
}

const Image& ErrorMeter::limitOf(const Point& point) const {
  return transport_ && hasTransport(point.options) ? truth() : reference_->image;
}

const Image& ErrorMeter::withoutApproximations(const Point& point, const Image& own) {
  const Exactness exactness =
      hasTransport(point.options) ? Exactness{kTransportCutoff} : exactness_;
  const RenderOptions exact = exactIn(point.options, Cause::algorithm, exactness);
  const std::string digest = digestOf(exact);
  if (digest == digestOf(point.options)) return own;
  const auto found = exactPackets_.find(digest);
  if (found != exactPackets_.end()) return found->second;
  FrameSource frames(scene_, camera_, exact);
  frames.render();
  return exactPackets_.emplace(digest, std::move(frames.film.image)).first->second;
}

void ErrorMeter::measure(Point& point, FrameSource& frames, bool arithmetic) {
  point.stats = frames.stats;
  const Image& image = frames.film.image;
  const auto differenceOf = [&](const Image& a, const Image& b) {
    return against(a, b, &a == &image ? point.options.srgb : SrgbEncoding::exact);
  };
  std::vector<std::function<void()>> comparisons;
  comparisons.emplace_back([&] { point.totalHdrFlip = hdrFlip_.mean(image); });
  comparisons.emplace_back([&] { point.total = differenceOf(image, truth()); });
  // The point has the baseline's sampling if the exact options are the same.
  if (digestOf(exactAtSameSamples(point.options, exactness_)) ==
      digestOf(exactAtSameSamples(base_, exactness_))) {
    comparisons.emplace_back([&] { point.sameSamples = differenceOf(image, exact_->image); });
  }
  runTogether(comparisons);
  if (point.cause != Cause::arithmetic) {
    const Image& unapproximated = withoutApproximations(point, image);
    runTogether({[&] { point.sampling = differenceOf(unapproximated, limitOf(point)); },
                 [&] { point.algorithm = differenceOf(image, unapproximated); }});
  }
  if (transport_) point.transport = hasTransport(point.options) ? noDifference() : *leftOut_;
  if (!arithmetic) return;
  point.arithmetic =
      arithmeticError(frames.renderer, camera_, frames.film, referencePaths(point, frames));
}

const ReferencePaths& ErrorMeter::referencePaths(const Point& point, FrameSource& frames) {
  const RenderOptions defaults;
  RenderOptions seen = point.options;
  seen.shading.reciprocal = defaults.shading.reciprocal;
  seen.film = defaults.film;
  seen.srgb = defaults.srgb;
  seen.packet = defaults.packet;
  const std::string digest = digestOf(seen);
  const auto found = referencePaths_.find(digest);
  if (found != referencePaths_.end()) return found->second;
  return referencePaths_.emplace(digest, traceReferencePaths(frames.renderer, camera_, frames.film))
      .first->second;
}

std::string ErrorMeter::pngOf(const Image& image) const {
  return encodePng(toDisplay(image, base_.exposure.ev, base_.toneCurve));
}

void ErrorMeter::addPictures(Point& point, const Image& image) const {
  point.imagePng = pngOf(image);
  point.totalMapPng = encodePng(heatMap(image, truth()));
  if (point.sameSamples) point.sameSamplesMapPng = encodePng(heatMap(image, exact_->image));
}

}  // namespace whit::accuracy
