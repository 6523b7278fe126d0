#include "accuracy/sweep.h"

#include <map>
#include <numeric>
#include <random>

#include "accuracy/error_meter.h"
#include "accuracy/points.h"
#include "accuracy/report.h"
#include "accuracy/timing.h"
#include "core/index.h"
#include "core/stopwatch.h"

namespace whit::accuracy {

namespace {

// Returns the knobs to sweep. Those that are left out are added to `idle`.
std::vector<Knob> sweptKnobs(const SweepSettings& settings, std::vector<IdleKnob>& idle) {
  const bool transport = settings.truth == Truth::transport;
  if (transport && settings.knobs.empty() && !settings.full) return knobsTowardsTransport();

  std::vector<Knob> knobs = chooseKnobs(settings.knobs);
  if (transport) return knobs;

  // Against Whitted's model, indirect light would count as an error.
  std::erase_if(knobs, [&](const Knob& knob) {
    if (knob.cause != Cause::transport) return false;
    idle.push_back({knob.name, "the model leaves it out: --truth transport measures it"});
    return true;
  });
  return knobs;
}

// Returns the limits of what is measured. They follow from the rays of a frame, and from those of a
// sample of the exact picture.
Scope scopeOf(const RenderOptions& base, EffectSet effects, const SweepSettings& settings,
              const FrameSource& baseline, ReferenceCache& cache) {
  Scope scope{settings.full ? kFull : kQuick, 0, 0, !settings.knobs.empty(), base.spp, 0};
  if (settings.referenceSpp > 0) {
    scope.limits.samples = scope.limits.leastSamples = settings.referenceSpp;
  }

  scope.cutoff = exactCutoff(effects, settings.full);
  const ReferencePicture& exact = cache.get(exactAtSameSamples(base, scope.cutoff), nullptr);
  scope.raysPerSample = exact.rays / base.spp;
  scope.msPerSample = exact.renderMs / base.spp;
  scope.mostMs = referenceMs(settings.timingSeconds.value_or(scope.limits.timingSeconds));
  scope.frameRays = static_cast<double>(baseline.stats.allRays());
  return scope;
}

SceneSweep startSweep(const Scene& scene, const FrameSource& baseline, const Scope& scope) {
  SceneSweep sweep;
  sweep.scene = scene.name;
  sweep.width = baseline.film.image.windowWidth();
  sweep.height = baseline.film.image.windowHeight();
  sweep.machine = baseline.renderer.machine();
  sweep.referenceCutoff = scope.cutoff;
  sweep.referenceSamples = scope.samples();
  return sweep;
}

void choosePoints(const RenderOptions& base, EffectSet effects, const SweepSettings& settings,
                  const Scope& scope, SceneSweep& sweep) {
  const std::vector<Knob> knobs = sweptKnobs(settings, sweep.idle);
  PointList list = makePoints(base, effects, knobs);
  if (settings.truth == Truth::transport) addTransportPoints(base, effects, knobs, list);
  sweep.idle.insert(sweep.idle.end(), list.idle.begin(), list.idle.end());

  // The limits leave out points that would take too long or come too close to the reference.
  for (Point& point : list.points) {
    const std::string because = scope.leavesOut(point);
    if (because.empty()) {
      sweep.points.push_back(std::move(point));
    } else {
      sweep.idle.push_back({point.label(), because});
    }
  }

  if (scope.longFrames() && !scope.chosenKnobs) {
    sweep.idle.push_back({"path divergences", "measured for '" + sweep.points.front().label() +
                                                  "' only, because frames take long"});
  }
}

TransportPicture transportTruth(const Scene& scene, const Camera& camera, const RenderOptions& base,
                                Scope& scope, Progress* progress) {
  // A picture with one sample tells how many rays each sample of a pass costs.
  FrameSource one(scene, camera, transportOptions(base, 1));
  const double rays = static_cast<double>(one.render().allRays());
  const RenderOptions options = transportOptions(base, scope.transportSamples(rays));

  TransportPicture picture = renderTransport(scene, camera, options, progress);
  scope.transportPaths = picture.passes * transportPaths(options);
  return picture;
}

// Returns a random order, in which a quick sweep puts the minor values last.
std::vector<std::size_t> chooseOrder(const std::vector<Point>& points,
                                     const SweepSettings& settings) {
  std::vector<std::size_t> order(points.size() - 1);
  std::iota(order.begin(), order.end(), std::size_t{1});
  std::mt19937 random(settings.seed);
  std::shuffle(order.begin(), order.end(), random);
  std::stable_partition(order.begin(), order.end(),
                        [&](std::size_t i) { return settings.full || !points[i].minor; });
  return order;
}

// Returns true for an approximation that changes neither rays nor pixels: it does not apply to this
// scene.
bool changesNothing(const Point& point, const FrameSource& frames, const FrameSource& baseline) {
  if (point.kind != PointKind::knob || point.cause != Cause::algorithm) return false;

  for (const auto k : indices(kRayKindCount)) {
    if (frames.stats.meter.tally[k].rays != baseline.stats.meter.tally[k].rays) return false;
  }
  return frames.film.image.pixels == baseline.film.image.pixels;
}

// `baseline` is the point of `baselineFrames`.
void measureErrors(Point& point, FrameSource& frames, const Point& baseline,
                   const FrameSource& baselineFrames, ErrorMeter& errors) {
  // A point with the picture of the baseline shares its errors and needs no pictures of its own.
  if (frames.film.image.pixels == baselineFrames.film.image.pixels) {
    static_cast<PointErrors&>(point) = static_cast<const PointErrors&>(baseline);
    point.stats = frames.stats;
    return;
  }

  errors.measure(point, frames);
  errors.addPictures(point, frames.film.image);

  // Knobs of arithmetic leave samples and algorithm as they are.
  if (point.cause == Cause::arithmetic) {
    point.sampling = baseline.sampling;
    point.algorithm = baseline.algorithm;
    point.transport = baseline.transport;
  }
}

// Removes the points without a measurement from the results and lists them as idle, with the
// reason by label.
void leaveOut(const std::map<std::string, std::string>& unmeasured, SceneSweep& sweep) {
  for (const Point& point : sweep.points) {
    const auto found = unmeasured.find(point.label());
    if (found != unmeasured.end()) sweep.idle.push_back({found->first, found->second});
  }
  std::erase_if(sweep.points, [&](const Point& p) { return unmeasured.contains(p.label()); });
}

// Computes times without drift, and fronts, which need all points.
void finish(const Timing& baselineTiming, SceneSweep& sweep) {
  Point& baseline = sweep.points.front();
  baseline.timing = baselineTiming;

  // Times follow from the ratios to the baseline, in which the drift of the machine cancels.
  for (Point& point : sweep.points) {
    point.timing.steadyMs = point.timing.ratio * baseline.timing.medianMs;
  }
  markFronts(sweep.points);

  // The report shows a combination's pictures only if it is on the front.
  for (Point& point : sweep.points) {
    if (point.kind != PointKind::joint || point.onFront) continue;
    point.imagePng.clear();
    point.totalMapPng.clear();
    point.sameSamplesMapPng.clear();
  }
}

}  // namespace

SceneSweep sweepScene(const Scene& scene, const RenderOptions& base, const SweepSettings& settings,
                      Progress* progress) {
  const Camera camera = chooseCamera(scene, base);
  const EffectSet effects = scene.effects.without(base.disable);
  FrameSource baseline(scene, camera, base);
  baseline.render();

  ReferenceCache cache(scene, camera);
  Scope scope = scopeOf(base, effects, settings, baseline, cache);
  SceneSweep sweep = startSweep(scene, baseline, scope);
  PointTimer timer(baseline, 1000 * settings.timingSeconds.value_or(scope.limits.timingSeconds));

  std::optional<TransportPicture> transport;
  if (settings.truth == Truth::transport) {
    transport = transportTruth(scene, camera, base, scope, progress);
    sweep.transport = static_cast<const TransportFacts&>(*transport);
  }

  choosePoints(base, effects, settings, scope, sweep);
  ErrorMeter errors(scene, base, scope, std::move(transport), cache, progress);
  sweep.referenceMs = errors.referenceMs();
  sweep.truthPng = errors.pngOf(errors.truth());

  Point& standard = sweep.points.front();
  errors.measure(standard, baseline);
  errors.addPictures(standard, baseline.film.image);

  std::map<std::string, std::string> unmeasured;  // label and reason
  const std::vector<std::size_t> order = chooseOrder(sweep.points, settings);
  const Stopwatch clock;  // the pictures that points are measured against do not count
  for (const auto k : indices(order)) {
    Point& point = sweep.points[order[k]];
    const std::size_t remaining = order.size() - k;
    reportProgress(progress, sweep.scene + ": " + point.label(),
                   static_cast<double>(k) / static_cast<double>(order.size()));

    // Timing has a budget of its own, so the limit applies to the other work only.
    if (scope.isOver((clock.ms() - timer.spentMs()) / 1000)) {
      unmeasured[point.label()] = Scope::kOverBecause;
      continue;
    }

    FrameSource frames(scene, camera, point.options);
    frames.render();  // this frame allocates; its time counts only if there is no time for another
    if (changesNothing(point, frames, baseline)) {
      unmeasured[point.label()] =
          "the same rays and the same picture as '" + standard.label() + "'";
      continue;
    }

    timer.time(point, frames, remaining);
    measureErrors(point, frames, standard, baseline, errors);
    sweep.order.push_back(point.label());
  }

  leaveOut(unmeasured, sweep);
  finish(timer.baselineTiming(), sweep);
  return sweep;
}

}  // namespace whit::accuracy
