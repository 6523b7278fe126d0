#include "viewer/frame_tracer.h"

#include <algorithm>
#include <limits>

#include "bake/edit_shading.h"
#include "bake/move_scene.h"
#include "cli/app/frame_summary.h"
#include "cli/app/image_output.h"
#include "core/option_table.h"
#include "core/stopwatch.h"
#include "farm/blocks.h"
#include "io/supply_view.h"
#include "render/auto_exposure.h"
#include "render/describe_image.h"
#include "render/shadow_cache_schedule.h"
#include "simd/deform_vertices.h"

namespace whit::view {

namespace {

constexpr double kReferenceBandMs = 80;  // of the reference, each of which is shown
constexpr int kMostRows = 64;
constexpr int kBlockRows = 4;  // blocks are as high, or a multiple of it

ImageSize filmSizeOf(const Film& film) { return {film.image.width, film.image.height}; }

void sizeFilm(Film& film, const ImageSize& size, const Crop& window) {
  if (filmSizeOf(film) == size && film.image.window == window) return;
  film.image = Image(size.width, size.height, window);
}

std::vector<RayWords> wordsFor(const Scene& scene, const cli::ExplainedRays& rays) {
  std::vector<RayWords> words;
  for (std::size_t i = 0; i < rays.packets.nodes.size(); ++i) {
    const RayNode& n = rays.packets.nodes[i];
    RayWords& w = words.emplace_back();
    w.met = cli::metText(scene, n);
    w.medium = cli::mediumName(scene, n.media);
    if (rays.partsFirstAt(i)) w.parting = cli::partingText(scene, rays, i);
    for (const LightContribution& light : n.lights) {
      w.lights.push_back(cli::lightName(scene, light.light));
    }
  }
  return words;
}

// A renderer's options, for as long as this lives.
class OptionsInUse {
 public:
  OptionsInUse(Renderer& renderer, const RenderOptions& options)
      : renderer_(renderer), before_(renderer.options()) {
    renderer_.setOptions(options);
  }
  ~OptionsInUse() { renderer_.setOptions(before_); }
  OptionsInUse(const OptionsInUse&) = delete;
  OptionsInUse& operator=(const OptionsInUse&) = delete;

 private:
  Renderer& renderer_;
  const RenderOptions before_;
};

}  // namespace

FrameTracer::FrameTracer(std::shared_ptr<cli::OpenScene> scene, const cli::CommonOptions& common)
    : common_(common),
      scene_(std::move(scene)),
      options_(common.render),
      sky_(skyOf(*scene_)),
      seconds_(scene_->scene.motion.given.seconds),
      animation_(common.load.instant.animation) {
  use(std::make_unique<Renderer>(scene_->scene, options_));
}

// The shadow cache is filled from the first picture on, because more will follow.
void FrameTracer::use(std::unique_ptr<Renderer> renderer) {
  renderer_ = std::move(renderer);
  const std::uint64_t most = common_.load.maxMemoryBytes;
  renderer_->expectFrames(cli::memoryLeft(renderer_->scene(), *renderer_, most),
                          ShadowCacheSchedule::kTurns);
}

bool FrameTracer::proveSome() {
  constexpr std::size_t kParts = 256;  // of each light: some 10 us a part and thread
  return renderer_->fillShadowCache({.mostParts = kParts}).parts > 0;
}

void FrameTracer::load(const SceneChoice& choice) {
  cli::CommonOptions common = common_;
  common.load.settings = choice.settings;
  common.load.instant.animation = choice.animation;
  std::shared_ptr<cli::OpenScene> scene = cli::openScene(choice.name, common, nullptr);
  auto renderer = std::make_unique<Renderer>(scene->scene, options_);
  use(std::move(renderer));  // before the scene that the old one reads goes
  scene_ = std::move(scene);
  editSettings_.clear();
  sky_ = skyOf(*scene_);
  ownSky_ = Sky();
  seconds_ = scene_->scene.motion.given.seconds;
  animation_ = choice.animation;
}

void FrameTracer::moveTo(double seconds) {
  const std::lock_guard lock(scene_->moving);
  moveScene(scene_->scene, seconds, simd::deformVertices);
  renderer_->sceneMoved();
  seconds_ = seconds;
}

void FrameTracer::edit(ShadingEdit edit) {
  if (edit.scene != scene_) return;
  Sky opened;  // first of all: files cannot be trusted
  if (edit.sky.source != sky_.source && !edit.sky.source.empty()) {
    Warnings warnings(common_.render.strict);
    opened = namedSky(edit.sky.source, common_.load.maxMemoryBytes, warnings);
  }
  editShading(scene_->scene, std::move(edit.materials), std::move(edit.lights));
  if (edit.sky != sky_ || !sameAmbient(edit.ambient, scene_->scene.ambient)) {
    editSurroundings(edit, std::move(opened));
  }
  renderer_->shadingChanged();
  if (!scene_->scene.motion.empty())
    moveTo(seconds_);  // lights that move are edited at their start
  editSettings_ = std::move(edit.settings);
}

void FrameTracer::editSurroundings(const ShadingEdit& edit, Sky opened) {
  const bool another = edit.sky.source != sky_.source;
  Sky next = std::move(!another ? scene_->scene.sky : edit.sky.source.empty() ? ownSky_ : opened);
  next.scale = edit.sky.scale;
  next.rotation = edit.sky.rotation;
  const Ambient ambient = edit.ambient.ofSky > 0
                              ? ambientFromSky(next, edit.ambient.ofSky, edit.ambient)
                              : edit.ambient;
  editSky(scene_->scene, next, ambient);
  if (another && sky_.source.empty()) ownSky_ = std::move(next);
  sky_ = edit.sky;
}

void FrameTracer::applyOptions(const FrameRequest& request) {
  RenderOptions next = request.options;
  next.spp = request.spp;
  next.depth = std::min(next.depth, request.depth);
  if (renderer_->canSetOptions(next)) {
    renderer_->setOptions(next);
  } else {
    use(std::make_unique<Renderer>(scene_->scene, next));
  }
  settleExposure(*renderer_, chooseCamera(scene_->scene, next), next);
  options_ = next;
}

RayPick FrameTracer::explain(const RayQuery& query) {
  RenderOptions options = renderer_->options();
  takeOver(query.options, Rebuild::tables, options);
  const ImageSize size = options.size.value();
  Film film;
  sizeFilm(film, size, Crop{query.x, query.y, query.x + 1, query.y + 1});
  RayPick pick{scene_, query, {}, {}, {}};
  const OptionsInUse used(*renderer_, options);
  pick.rays = cli::explainRays(*renderer_, query.camera, film, query.x, query.y);
  pick.words = wordsFor(scene_->scene, pick.rays);
  pick.lines = linesOf(pick.rays.packets);
  return pick;
}

bool FrameTracer::trace(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls) {
  if (request.seconds && *request.seconds != seconds_) moveTo(*request.seconds);
  applyOptions(request);
  frame.comparison.reset();
  frame.costs.clear();
  if (!tracePicture(request, frame, calls)) return false;
  finished_ = request;
  frame.scene = scene_;
  frame.request = request;
  frame.request.options.exposure = options_.exposure;
  frame.options = options_;
  frame.animation = animation_;
  frame.surfaces =
      cli::surfacesText(scene_->scene.instancedTriangles, scene_->scene.instancedSpheres);
  frame.metadata = describeImage(scene_->scene, request.camera, *renderer_, frame.film, options_);
  frame.settings = scene_->settings;
  frame.settings.insert(frame.settings.end(), editSettings_.begin(), editSettings_.end());
  frame.sky = scene_->sky;
  for (const std::string& setting : editSettings_) {
    if (setting.starts_with("/sky")) frame.sky.clear();
  }
  cli::addSettings(frame.settings, frame.sky, frame.metadata);
  frame.effects = renderer_->plan().effects;
  frame.sampled = renderer_->plan().features.has(Feature::streams);
  frame.reasons = scene_->scene.reasons;
  frame.machine = renderer_->machine();
  if (request.measureKnobs && !measure(request, frame, calls)) return false;
  return !request.withReference || traceReference(request, frame, calls);
}

// Milliseconds a pixel of frames in one piece, as those that are measured: blocks have taken
// longer. Of a coarse frame, and of finer ones while starting the workers may be most of the time.
double FrameTracer::probe(const Camera& camera, const ImageSize& whole) {
  double ms = 0;
  for (int coarser = 8; coarser >= 1 && ms < kMeasuredMs / 8; coarser /= 2) {
    const ImageSize size{std::max(whole.width / coarser, 1), std::max(whole.height / coarser, 1)};
    sizeFilm(band_, size, Crop{0, 0, size.width, size.height});
    renderer_->render(camera, band_);
    ms = renderer_->render(camera, band_).frameMs;
  }
  return ms / static_cast<double>(band_.image.pixels.size());
}

bool FrameTracer::measure(const FrameRequest& request, TracedFrame& frame,
                          const TraceCalls& calls) {
  const ImageSize whole = request.options.size.value();
  // Of each choice, what it takes where nothing is known beforehand.
  RenderOptions traced = options_;
  traced.shadowCache = ShadowCacheMode::off;
  const OptionsInUse used(*renderer_, traced);
  const double msPerPixel = probe(request.camera, whole);
  const ImageSize size = measuredSize(whole, msPerPixel);
  sizeFilm(band_, size, Crop{0, 0, size.width, size.height});
  const double scale = static_cast<double>(whole.width) * whole.height /
                       (static_cast<double>(size.width) * size.height);
  const auto show = [&](const std::vector<KnobCost>& sofar, std::size_t all) {
    const double done = static_cast<double>(sofar.size()) / static_cast<double>(all);
    calls.showUnfinished({request, {}, done, sofar});
  };
  frame.costs =
      measureKnobs(*renderer_, traced, request.camera, band_, scale, {calls.superseded, show});
  return !calls.superseded();
}

bool FrameTracer::tracePicture(const FrameRequest& request, TracedFrame& frame,
                               const TraceCalls& calls) {
  const ImageSize size = request.options.size.value();
  sizeFilm(frame.film, size, Crop{0, 0, size.width, size.height});
  frame.legend.clear();
  frame.watched.reset();
  const bool views = request.view != DebugView::none;
  if (views) watched_.assign(frame.film.image.pixels.size(), WatchedPixel());
  // One worker does it, and is looked at.
  constexpr double kViewCosts = 4;  // times as much, until it is known
  if (const bool viewed = learnedFor_ && learnedFor_->view != DebugView::none; viewed != views) {
    msPerSample_ *= views ? kViewCosts : 1 / kViewCosts;
  }
  const bool deeper = !learnedFor_ || options_.depth > learnedFor_->depth;
  constexpr double kDeeperCosts = 8;  // times as much, until it is known
  if (deeper) msPerSample_ *= kDeeperCosts;
  if (deeper || !sameSubject(request, *learnedFor_)) costs_.clear();
  learnedFor_ = request;
  learnedFor_->depth = options_.depth;
  const double expectedMs = msPerSample_ * samplesOf(request);
  part_ = {0, options_.spp};
  sums_.reset();
  frame.sampleError = 0;
  if (accumulates(request)) {
    if (!traceInPasses(request, frame, calls)) return false;
  } else if (request.interruptible && expectedMs > kBlockMs) {
    if (!traceInBlocks(request, frame, kBlockMs, calls.superseded, calls)) return false;
  } else if (expectedMs == 0 || expectedMs > kLongBlockMs) {
    if (!traceInBlocks(request, frame, kLongBlockMs, calls.leaving, calls)) return false;
  } else {
    sizeDisplay(frame.film);
    frame.stats = traceBlock(request, Crop{0, 0, size.width, size.height}, frame);
  }
  if (views) finishView(request, frame);
  msPerSample_ = frame.stats.frameMs / samplesOf(request);
  return true;
}

FrameStats FrameTracer::traceBlock(const FrameRequest& request, const Crop& block,
                                   TracedFrame& frame) {
  const ImageSize size = filmSizeOf(frame.film);
  const bool whole = block == Crop{0, 0, size.width, size.height};
  if (sums_) {
    sizeFilm(band_, size, block);
    const FrameStats stats = renderer_->accumulate(request.camera, band_, part_, *sums_);
    place(band_, frame.film);
    return stats;
  }
  if (whole && request.view == DebugView::none) {
    return renderer_->render(request.camera, frame.film);
  }
  sizeFilm(band_, size, block);
  const FrameStats stats = request.view == DebugView::none
                               ? renderer_->render(request.camera, band_)
                               : watchBlock(request, frame);
  place(band_, frame.film);
  return stats;
}

// Painted by the scale of the last picture of this view; before there is one, by what was seen so
// far.
FrameStats FrameTracer::watchBlock(const FrameRequest& request, TracedFrame& frame) {
  const DebugFrame seen = watchFrame(*renderer_, request.camera, band_, request.view);
  const Crop& block = band_.image.window;
  const auto width = static_cast<std::size_t>(block.x1 - block.x0);
  for (int y = block.y0; y < block.y1; ++y) {
    const std::size_t from = static_cast<std::size_t>(y - block.y0) * width;
    const std::size_t to = frame.film.image.index(block.x0, y);
    std::copy_n(seen.pixels.begin() + static_cast<std::ptrdiff_t>(from), width,
                watched_.begin() + static_cast<std::ptrdiff_t>(to));
  }
  if (scaleOf_ != request.view) {
    const AmountScale scale = scaleOf(request.view, seen.pixels, options_.spp);
    const bool first = block.x0 == 0 && block.y0 == 0;
    scale_ = first
                 ? scale
                 : AmountScale{std::min(scale_.low, scale.low), std::max(scale_.high, scale.high)};
  }
  paintView(request.view, seen.pixels, options_.spp, scale_, band_.display);
  return seen.stats;
}

void FrameTracer::finishView(const FrameRequest& request, TracedFrame& frame) {
  scale_ = scaleOf(request.view, watched_, options_.spp);
  scaleOf_ = request.view;
  paintView(request.view, watched_, options_.spp, scale_, frame.film.display);
  frame.legend = legendOf(request.view, scale_);
  frame.scale = scale_;
  frame.watched = std::make_shared<const std::vector<WatchedPixel>>(std::move(watched_));
}

// Whether that part of a picture takes no longer. Where dear pixels are is known from a coarser
// picture, or they are taken to be anywhere.
bool FrameTracer::fits(double blockMs, const ImageSize& size, const Crop& part) {
  constexpr double kUneven = 2;   // dear pixels over the mean, of many
  constexpr double kShortMs = 1;  // by the mean: what is shorter is not worth a block of its own
  const double known = costs_.highest(size, part), mean = msPerSample_;
  const double samples =
      static_cast<double>(part.x1 - part.x0) * (part.y1 - part.y0) * part_.count();
  if (mean == 0)
    return part.y1 - part.y0 <= kBlockRows;  // the first of all, which is coarse and flat
  return (known > 0 ? known : kUneven * mean) * samples <= blockMs || mean * samples <= kShortMs;
}

// Row by row: some rows of all columns, or where those would take too long a part of few rows, wide
// enough for all workers.
Crop FrameTracer::nextBlock(const ImageSize& size, const Crop& last, double blockMs,
                            DebugView view) {
  if (view == DebugView::occupancy) return nextTiles(size, last, blockMs);
  const int workers = view == DebugView::none ? renderer_->machine().threads : 1;
  const int narrowest = options_.tile * workers;
  const auto crop = [&](int x, int y, int width, int height) {
    return Crop{x, y, std::min(x + width, size.width), std::min(y + height, size.height)};
  };
  const auto widen = [&](Crop block) {
    for (Crop wider = block; block.x1 < size.width; block = wider) {
      wider.x1 = std::min(block.x1 + narrowest, size.width);
      if (!fits(blockMs, size, wider)) break;
    }
    return block;
  };
  const bool rowGoesOn = last.x1 > 0 && last.x1 < size.width;
  if (rowGoesOn) return widen(crop(last.x1, last.y0, narrowest, last.y1 - last.y0));
  const int y = last.y1;
  int rows = kBlockRows;
  if (!fits(blockMs, size, crop(0, y, size.width, rows))) {
    while (rows > 1 && !fits(blockMs, size, crop(0, y, size.width, rows))) rows /= 2;
    return widen(crop(0, y, narrowest, rows));
  }
  while (rows < kMostRows && fits(blockMs, size, crop(0, y, size.width, 2 * rows))) rows *= 2;
  return crop(0, y, size.width, rows);
}

// Whole ones, which rays go to Embree with as they do of the whole picture.
Crop FrameTracer::nextTiles(const ImageSize& size, const Crop& last, double blockMs) {
  const int tile = options_.tile;
  const bool rowGoesOn = last.x1 > 0 && last.x1 < size.width;
  const int x = rowGoesOn ? last.x1 : 0, y = rowGoesOn ? last.y0 : last.y1;
  const int bottom = std::min(y + tile, size.height);
  Crop block{x, y, std::min(x + tile, size.width), bottom};
  for (Crop wider = block; block.x1 < size.width; block = wider) {
    wider.x1 = std::min(block.x1 + tile, size.width);
    if (!fits(blockMs, size, wider)) break;
  }
  return block;
}

bool FrameTracer::traceBlocks(const FrameRequest& request, TracedFrame& frame, double blockMs,
                              const std::function<bool()>& givenUp,
                              const std::function<void(const Crop&)>& afterBlock) {
  const ImageSize size = filmSizeOf(frame.film);
  constexpr double kLeastMs = 1e-9;  // of a sample
  double leastMs = std::numeric_limits<double>::infinity();
  for (Crop block; block.y1 < size.height || block.x1 < size.width;) {
    if (givenUp()) return false;
    block = nextBlock(size, block, blockMs, request.view);
    const FrameStats stats = traceBlock(request, block, frame);
    frame.stats.add(stats);
    frame.stats.frameMs += stats.frameMs;
    frame.stats.workers = stats.workers;
    const double samples =
        static_cast<double>(block.x1 - block.x0) * (block.y1 - block.y0) * part_.count();
    // Without what any block takes, however small.
    leastMs = std::min(leastMs, stats.frameMs);
    costs_.learn(size, block, std::max((stats.frameMs - leastMs) / samples, kLeastMs));
    afterBlock(block);
  }
  return true;
}

bool FrameTracer::traceInBlocks(const FrameRequest& request, TracedFrame& frame, double blockMs,
                                const std::function<bool()>& givenUp, const TraceCalls& calls) {
  const ImageSize size = filmSizeOf(frame.film);
  sizeDisplay(frame.film);
  std::fill(frame.film.display.rgba.begin(), frame.film.display.rgba.end(), std::uint8_t{0});
  frame.stats = FrameStats();
  Stopwatch sinceShown;
  return traceBlocks(request, frame, blockMs, givenUp, [&](const Crop& block) {
    const bool last = block.y1 == size.height && block.x1 == size.width;
    if (last || sinceShown.ms() < kUnfinishedMs) return;
    sinceShown = Stopwatch();
    const double done = static_cast<double>(block.y0) / size.height;
    calls.showUnfinished({request, frame.film.display, done, {}});
  });
}

bool FrameTracer::accumulates(const FrameRequest& request) const {
  return request.interruptible && request.view == DebugView::none && options_.spp > 1 &&
         !options_.adaptive && renderer_->plan().features.has(Feature::streams);
}

// What is shown on the way has more samples than the picture before; until then that stays.
bool FrameTracer::traceInPasses(const FrameRequest& request, TracedFrame& frame,
                                const TraceCalls& calls) {
  const ImageSize size = filmSizeOf(frame.film);
  sizeDisplay(frame.film);
  frame.stats = FrameStats();
  sums_.emplace(Crop{0, 0, size.width, size.height});
  const bool again =
      finished_ && sameSubject(*finished_, request) && finished_->options.size == size;
  const int shown = again ? finished_->spp : 0;
  const double passMs = msPerSample_ * static_cast<double>(size.width) * size.height;
  const double wanted = passMs > 0 ? kPassMs / passMs : 1;
  const int most =
      static_cast<int>(std::clamp(wanted, 1.0, std::max(options_.spp / kLeastPasses, 1.0)));
  while (part_.first < options_.spp) {
    part_.end = std::min(part_.first + most, options_.spp);
    if (!traceBlocks(request, frame, kBlockMs, calls.superseded, [](const Crop&) {})) return false;
    if (part_.end > 1) frame.sampleError = sums_->relativeError(part_.end);
    part_.first = part_.end;
    if (part_.end == options_.spp) break;
    const double done = static_cast<double>(part_.end) / options_.spp;
    UnfinishedFrame sight{request, {}, done, {}, part_.end, frame.sampleError};
    if (part_.end > shown) sight.display = frame.film.display;
    calls.showUnfinished(std::move(sight));
  }
  sums_.reset();
  return true;
}

bool FrameTracer::traceReference(const FrameRequest& request, TracedFrame& frame,
                                 const TraceCalls& calls) {
  const ImageSize size = filmSizeOf(frame.film);
  Comparison& comparison = frame.comparison.emplace();
  sizeFilm(comparison.reference, size, Crop{0, 0, size.width, size.height});
  sizeDisplay(comparison.reference);
  double msPerRow = kReferenceBandMs;
  for (int y = 0; y < size.height; y = comparison.rows) {
    const int rows = std::max(static_cast<int>(kReferenceBandMs / msPerRow), 1);
    const int end = std::min(y + rows, size.height);
    sizeFilm(band_, size, Crop{0, y, size.width, end});
    const double ms = renderer_->renderReference(request.camera, band_).frameMs;
    place(band_, comparison.reference);
    comparison.referenceMs += ms;
    comparison.rows = end;
    msPerRow = std::max(ms / (end - y), 1e-3);
    if (calls.superseded()) return false;
    calls.publish(frame);
  }
  finishComparison(frame.film, options_.exposure.ev, options_.toneCurve, comparison);
  return true;
}

}  // namespace whit::view
