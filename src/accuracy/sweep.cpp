#include "accuracy/sweep.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "accuracy/report.h"
#include "accuracy/timing.h"
#include "core/display.h"
#include "core/quantile.h"
#include "core/stopwatch.h"
#include "core/worker_pool.h"
#include "inspect/metrics.h"
#include "inspect/path_divergence.h"
#include "inspect/reference_frame.h"
#include "io/image/image_file.h"
#include "output/digest.h"
#include "render/renderer.h"

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

ArithmeticError arithmeticError(Renderer& renderer, const Camera& camera, const Film& film,
                                const ReferencePaths& reference) {
  PathComparison paths = comparePaths(renderer, camera, film, reference);
  ArithmeticError error;
  error.divergences = paths.divergences;
  const double pixels = static_cast<double>(paths.diverged.size());
  error.divergencesPerMpx = 1e6 * static_cast<double>(paths.divergences) / pixels;

  // Pixels whose path diverged show no rounding error, so they count as equal.
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

class SceneSweeper {
 public:
  SceneSweeper(const Scene& scene, const RenderOptions& base, const SweepSettings& settings,
               Progress* progress)
      : scene_(scene),
        base_(base),
        settings_(settings),
        scope_{settings.full ? kFull : kQuick, 0, 0, !settings.knobs.empty(), base.spp, 0},
        camera_(chooseCamera(scene, base)),
        effects_(scene.effects.without(base.disable)),
        cutoff_(exactCutoff(effects_, settings.full)),
        cache_(scene, camera_),
        progress_(progress) {}

  SceneSweep run() {
    baseline_ = std::make_unique<FrameSource>(scene_, camera_, base_);
    baseline_->render();

    sweep_.scene = scene_.name;
    sweep_.width = baseline_->film.image.windowWidth();
    sweep_.height = baseline_->film.image.windowHeight();
    sweep_.machine = baseline_->renderer.machine();
    sweep_.referenceCutoff = cutoff_;

    chooseSamples();
    timer_.emplace(*baseline_,
                   1000 * settings_.timingSeconds.value_or(scope_.limits.timingSeconds));

    renderTransport();
    choosePoints();
    renderReferences();
    measureBaseline();
    measurePoints();
    finish();
    return std::move(sweep_);
  }

 private:
  // Chooses the samples of the reference by the rays that one sample of the exact picture needs.
  void chooseSamples() {
    scope_.raysPerSample = cache_.get(exactAtSameSamples(base_, cutoff_), nullptr).rays / base_.spp;
    scope_.frameRays = static_cast<double>(baseline_->stats.allRays());
    sweep_.referenceSamples = scope_.samples();
  }

  std::vector<Knob> sweptKnobs() {
    const bool transport = settings_.truth == Truth::transport;
    if (transport && settings_.knobs.empty() && !settings_.full) return knobsTowardsTransport();

    std::vector<Knob> knobs = chooseKnobs(settings_.knobs);
    if (transport) return knobs;

    // Against Whitted's model, indirect light would count as an error.
    std::erase_if(knobs, [&](const Knob& knob) {
      if (knob.cause != Cause::transport) return false;
      sweep_.idle.push_back({knob.name, "the model leaves it out: --truth transport measures it"});
      return true;
    });
    return knobs;
  }

  void choosePoints() {
    const std::vector<Knob> knobs = sweptKnobs();
    PointList list = makePoints(base_, effects_, knobs);
    if (settings_.truth == Truth::transport) addTransportPoints(base_, effects_, knobs, list);
    sweep_.idle.insert(sweep_.idle.end(), list.idle.begin(), list.idle.end());

    // The limits leave out points that would take too long or come too close to the reference.
    for (Point& point : list.points) {
      const std::string because = scope_.leavesOut(point);
      if (because.empty()) {
        sweep_.points.push_back(std::move(point));
      } else {
        sweep_.idle.push_back({point.label(), because});
      }
    }

    if (scope_.longFrames() && !scope_.chosenKnobs) {
      sweep_.idle.push_back({"path divergences", "measured for '" + sweep_.points.front().label() +
                                                     "' only, because frames take long"});
    }
  }

  void renderTransport() {
    if (settings_.truth == Truth::model) return;

    // A picture with one sample tells how many rays each sample of a pass costs.
    FrameSource one(scene_, camera_, transportOptions(base_, 1));
    const double rays = static_cast<double>(one.render().allRays());
    const RenderOptions options = transportOptions(base_, scope_.transportSamples(rays));

    transport_ = accuracy::renderTransport(scene_, camera_, options, progress_);
    scope_.transportPaths = transport_->passes * transportPaths(options);
    sweep_.transport = static_cast<const TransportFacts&>(*transport_);

    // The time limit of a quick sweep does not include this picture.
    points_ = Stopwatch();
  }

  // If all transport is the truth, the reference has Whitted's model alone.
  void renderReferences() {
    RenderOptions model = base_;
    if (transport_) model.indirect = 0;

    reference_ = &cache_.get(referenceOptions(model, sweep_.referenceSamples, cutoff_), progress_);
    exact_ = &cache_.get(exactAtSameSamples(base_, cutoff_), progress_).image;
    // This difference is the light that Whitted's model leaves out.
    if (transport_) leftOut_ = against(reference_->image, truth());
    sweep_.referenceMs = reference_->renderMs;
  }

  const Image& truth() const { return transport_ ? transport_->image : reference_->image; }

  // Sets the point's errors from its last frame. For a knob of arithmetic the errors of sampling
  // and algorithm are not set, because they are the baseline's.
  void measureErrors(Point& point, FrameSource& frames) {
    point.stats = frames.stats;
    const Image& image = frames.film.image;

    // Comparisons do not depend on each other and run in parallel.
    std::vector<std::function<void()>> comparisons;
    comparisons.emplace_back([&] { point.total = against(image, truth()); });
    // The point has the baseline's sampling if the exact options are the same.
    if (digestOf(exactAtSameSamples(point.options, cutoff_)) ==
        digestOf(exactAtSameSamples(base_, cutoff_))) {
      comparisons.emplace_back([&] { point.sameSamples = against(image, *exact_); });
    }
    runTogether(comparisons);

    const bool transports = transport_ && hasTransport(point.options);
    if (point.cause != Cause::arithmetic) {
      const Image& unapproximated = withoutApproximations(point, image);
      // The picture that more samples of the point converge to.
      const Image& limit = transports ? truth() : reference_->image;
      runTogether({[&] { point.sampling = against(unapproximated, limit); },
                   [&] { point.algorithm = against(image, unapproximated); }});
    }
    if (transport_) point.transport = transports ? noDifference() : *leftOut_;

    if (!scope_.comparesPaths(point)) return;
    point.arithmetic =
        arithmeticError(frames.renderer, camera_, frames.film, referencePaths(point, frames));
  }

  // Sets the point's pictures, which stay in memory.
  void addPictures(Point& point, const Image& image) const {
    point.imagePng = pngOf(image);
    point.totalMapPng = encodePng(heatMap(image, truth()));
    if (point.sameSamples) point.sameSamplesMapPng = encodePng(heatMap(image, *exact_));
  }

  // The displayed image.
  std::string pngOf(const Image& image) const {
    return encodePng(toDisplay(image, base_.exposure.ev, base_.toneCurve));
  }

  ImageDifference against(const Image& a, const Image& b) const {
    return compareImages(a, b, base_.exposure.ev, base_.toneCurve);
  }

  const Image& withoutApproximations(const Point& point, const Image& own) {
    const float cutoff = hasTransport(point.options) ? kTransportCutoff : cutoff_;
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
  const ReferencePaths& referencePaths(const Point& point, FrameSource& frames) {
    const RenderOptions defaults;
    RenderOptions seen = point.options;
    seen.packet = defaults.packet;
    const std::string digest = digestOf(seen);

    const auto found = referencePaths_.find(digest);
    if (found != referencePaths_.end()) return found->second;
    return referencePaths_
        .emplace(digest, traceReferencePaths(frames.renderer, camera_, frames.film))
        .first->second;
  }

  void measureBaseline() {
    Point& point = sweep_.points.front();
    measureErrors(point, *baseline_);
    addPictures(point, baseline_->film.image);
    sweep_.truthPng = pngOf(truth());
  }

  // A random order, in which a quick sweep puts the spare values last.
  std::vector<std::size_t> chooseOrder() const {
    std::vector<std::size_t> order(sweep_.points.size() - 1);
    std::iota(order.begin(), order.end(), std::size_t{1});
    std::mt19937 random(settings_.seed);
    std::shuffle(order.begin(), order.end(), random);
    std::stable_partition(order.begin(), order.end(),
                          [&](std::size_t i) { return settings_.full || !sweep_.points[i].spare; });
    return order;
  }

  void measurePoints() {
    std::map<std::string, std::string> unmeasured;  // label and reason
    const std::vector<std::size_t> order = chooseOrder();

    for (std::size_t k = 0; k < order.size(); ++k) {
      Point& point = sweep_.points[order[k]];
      reportProgress(progress_, sweep_.scene + ": " + point.label(),
                     static_cast<double>(k) / static_cast<double>(order.size()));

      // Timing has a budget of its own, so the limit applies to the other work only.
      if (scope_.isOver((points_.ms() - timer_->spentMs()) / 1000)) {
        unmeasured[point.label()] = Scope::kOverBecause;
        continue;
      }

      if (measurePoint(point, order.size() - k)) {
        sweep_.order.push_back(point.label());
      } else {
        unmeasured[point.label()] =
            "the same rays and the same picture as '" + sweep_.points.front().label() + "'";
      }
    }

    // Points without a measurement leave the results and are listed as idle, with the reason.
    for (const Point& point : sweep_.points) {
      const auto found = unmeasured.find(point.label());
      if (found != unmeasured.end()) sweep_.idle.push_back({found->first, found->second});
    }
    std::erase_if(sweep_.points, [&](const Point& p) { return unmeasured.contains(p.label()); });
  }

  // `points` is the number of points that are still to come, including this one. Returns false if
  // the point has the rays and the picture of the baseline.
  bool measurePoint(Point& point, std::size_t points) {
    FrameSource frames(scene_, camera_, point.options);
    frames.render();  // this frame allocates; its time counts only if there is no time for another
    // An approximation that changes neither rays nor pixels does not apply to this scene.
    if (point.kind == PointKind::knob && point.cause == Cause::algorithm && isBaseline(frames)) {
      return false;
    }

    timer_->time(point, frames, points);

    // A point with the picture of the baseline shares its errors and needs no pictures of its own.
    if (frames.film.image.pixels == baseline_->film.image.pixels) {
      static_cast<PointErrors&>(point) = static_cast<const PointErrors&>(sweep_.points.front());
      point.stats = frames.stats;
      return true;
    }

    measureErrors(point, frames);
    if (point.cause == Cause::arithmetic) copyErrorsOfRays(point, sweep_.points.front());
    addPictures(point, frames.film.image);
    return true;
  }

  // For points with the same samples and the same algorithm.
  static void copyErrorsOfRays(Point& point, const Point& from) {
    point.sampling = from.sampling;
    point.algorithm = from.algorithm;
    point.transport = from.transport;
  }

  bool isBaseline(const FrameSource& frames) const {
    for (std::size_t k = 0; k < kRayKindCount; ++k) {
      if (frames.stats.meter.tally[k].rays != baseline_->stats.meter.tally[k].rays) return false;
    }
    return frames.film.image.pixels == baseline_->film.image.pixels;
  }

  // Computes the baseline's time, times without drift, and fronts, which need all points.
  void finish() {
    Point& baseline = sweep_.points.front();
    baseline.timing = timer_->baselineTiming();

    // Times follow from the ratios to the baseline, in which the drift of the machine cancels.
    for (Point& point : sweep_.points)
      point.timing.settledMs = point.timing.ratio * baseline.timing.medianMs;
    markFronts(sweep_.points);

    // The report shows a combination's pictures only if it is on the front.
    for (Point& point : sweep_.points) {
      if (point.kind != PointKind::joint || point.onFront) continue;
      point.imagePng.clear();
      point.totalMapPng.clear();
      point.sameSamplesMapPng.clear();
    }
  }

  const Scene& scene_;
  RenderOptions base_;
  SweepSettings settings_;
  Scope scope_;
  Camera camera_;
  EffectSet effects_;
  float cutoff_;
  ReferenceCache cache_;
  Progress* progress_;
  std::unique_ptr<FrameSource> baseline_;
  std::optional<PointTimer> timer_;
  std::optional<TransportPicture> transport_;  // set if it is the truth
  // The reference, or the part of Whitted's model in the picture with all transport, and the exact
  // picture at equal samples; both are the cache's.
  const ReferencePicture* reference_ = nullptr;
  const Image* exact_ = nullptr;
  // The difference of the reference from the picture with all transport.
  std::optional<ImageDifference> leftOut_;
  std::map<std::string, Image> exactPackets_;  // key: digest of the options
  std::map<std::string, ReferencePaths> referencePaths_;
  Stopwatch points_;  // runs without the picture with all transport
  SceneSweep sweep_;
};

}  // namespace

std::vector<RgbD> PassMean::means(std::size_t first, std::size_t step) const {
  std::vector<RgbD> sums(passes_[0].pixels.size());
  double count = 0;
  for (std::size_t i = first; i < passes_.size(); i += step, ++count) {
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += RgbD(passes_[i].pixels[k]);
  }

  for (RgbD& sum : sums) sum = sum / count;
  return sums;
}

Image PassMean::picture(std::size_t first, std::size_t step) const {
  Image image = passes_[0];
  std::ranges::transform(means(first, step), image.pixels.begin(),
                         [](const RgbD& mean) { return Rgb(mean); });
  return image;
}

double PassMean::standardError() const {
  const std::vector<RgbD> mean = means(0, 1);
  double sum = 0;

  for (const Image& pass : passes_) {
    for (std::size_t k = 0; k < mean.size(); ++k) {
      const RgbD off = RgbD(pass.pixels[k]) - mean[k];
      sum += dot(off, off) / 3;
    }
  }

  // The variance of the passes about their mean, divided by their number, is the variance of the
  // mean.
  const auto passes = static_cast<double>(passes_.size());
  return std::sqrt(sum / (static_cast<double>(mean.size()) * (passes - 1)) / passes);
}

double PassMean::meanRadiance() const {
  const std::vector<RgbD> mean = means(0, 1);
  double sum = 0;
  for (const RgbD& m : mean) sum += (m.x + m.y + m.z) / 3;
  return sum / static_cast<double>(mean.size());
}

const ReferencePicture& ReferenceCache::get(const RenderOptions& options, Progress* progress) {
  const std::string digest = digestOf(options);
  const auto found = pictures_.find(digest);
  if (found != pictures_.end()) return found->second;

  Film film = makeFilm(scene_, options);
  film.wantDisplay = false;
  Renderer renderer(scene_, options);
  const FrameStats stats = renderReference(renderer, camera_, film, progress);

  ReferencePicture picture{std::move(film.image), stats.frameMs,
                           static_cast<double>(stats.allRays())};
  return pictures_.emplace(digest, std::move(picture)).first->second;
}

TransportPicture renderTransport(const Scene& scene, const Camera& camera,
                                 const RenderOptions& options, Progress* progress) {
  Film film = makeFilm(scene, options);
  film.wantDisplay = false;
  Renderer renderer(scene, options);
  PassMean passes;
  double ms = 0;

  for (int pass = 0; pass < kTransportPasses; ++pass) {
    renderer.setSeed(static_cast<std::uint32_t>(pass));
    ms += renderer.render(camera, film).frameMs;
    passes.add(film.image);
    reportProgress(progress, "all transport", static_cast<double>(pass + 1) / kTransportPasses);
  }

  // The even and the odd passes are independent, so they differ by their noise alone.
  const ImageDifference halves =
      compareImages(passes.half(false), passes.half(true), options.exposure.ev, options.toneCurve);
  return {{kTransportPasses, kTransportPasses * options.spp, passes.standardError(),
           passes.meanRadiance(), halves.flipMean, ms},
          passes.mean()};
}

SceneSweep sweepScene(const Scene& scene, const RenderOptions& base, const SweepSettings& settings,
                      Progress* progress) {
  return SceneSweeper(scene, base, settings, progress).run();
}

}  // namespace whit::accuracy
