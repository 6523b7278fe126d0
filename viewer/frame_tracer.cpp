#include "viewer/frame_tracer.h"

#include <algorithm>

#include "app/image_output.h"
#include "farm/blocks.h"
#include "render/auto_exposure.h"
#include "render/describe_image.h"
#include "scene/edit_shading.h"

namespace whit::view {

namespace {

constexpr double kReferenceBandMs = 80;  // of the reference, each of which is shown
constexpr int kBandRows = 4;             // bands are multiples of it

ImageSize filmSizeOf(const Film& film) { return {film.image.width, film.image.height}; }

void sizeFilm(Film& film, const ImageSize& size, const Crop& window) {
  if (filmSizeOf(film) == size && film.image.window == window) return;
  film.image = Image(size.width, size.height, window);
}

}  // namespace

FrameTracer::FrameTracer(std::shared_ptr<cli::OpenScene> scene, const cli::CommonOptions& common)
    : common_(common),
      scene_(std::move(scene)),
      options_(common.render),
      renderer_(std::make_unique<Renderer>(scene_->scene, options_)) {}

void FrameTracer::load(const SceneChoice& choice) {
  cli::CommonOptions common = common_;
  common.load.settings = choice.settings;
  std::shared_ptr<cli::OpenScene> scene = cli::openScene(choice.name, common, nullptr);
  auto renderer = std::make_unique<Renderer>(scene->scene, options_);
  renderer_ = std::move(renderer);  // before the scene that the old one reads goes
  scene_ = std::move(scene);
  editSettings_.clear();
}

void FrameTracer::edit(ShadingEdit edit) {
  if (edit.scene != scene_) return;
  editShading(scene_->scene, std::move(edit.materials), std::move(edit.lights));
  renderer_->shadingChanged();
  editSettings_ = std::move(edit.settings);
}

void FrameTracer::applyOptions(const FrameRequest& request) {
  RenderOptions next = request.options;
  next.spp = request.spp;
  if (renderer_->canSetOptions(next)) {
    renderer_->setOptions(next);
  } else {
    renderer_ = std::make_unique<Renderer>(scene_->scene, next);
  }
  settleExposure(*renderer_, chooseCamera(scene_->scene, next), next);
  options_ = next;
}

bool FrameTracer::trace(const FrameRequest& request, TracedFrame& frame,
                        const Superseded& superseded, const Leaving& leaving,
                        const Publish& publish) {
  applyOptions(request);
  frame.comparison.reset();
  frame.costs.clear();
  if (!tracePicture(request, frame, superseded, leaving)) return false;
  frame.scene = scene_;
  frame.request = request;
  frame.request.options.exposure = options_.exposure;
  frame.options = options_;
  frame.metadata = describeImage(scene_->scene, request.camera, *renderer_, frame.film, options_);
  frame.settings = scene_->settings;
  frame.settings.insert(frame.settings.end(), editSettings_.begin(), editSettings_.end());
  cli::addSettings(frame.settings, scene_->sky, frame.metadata);
  frame.effects = renderer_->plan().effects;
  frame.reasons = scene_->scene.reasons;
  frame.machine = renderer_->machine();
  if (request.measureKnobs) {
    sizeFilm(band_, request.options.size.value(), frame.film.image.window);
    frame.costs = measureKnobs(*renderer_, options_, request.camera, band_, superseded);
    if (superseded()) return false;
  }
  return !request.withReference || traceReference(request, frame, superseded, publish);
}

bool FrameTracer::tracePicture(const FrameRequest& request, TracedFrame& frame,
                               const Superseded& superseded, const Leaving& leaving) {
  const ImageSize size = request.options.size.value();
  sizeFilm(frame.film, size, Crop{0, 0, size.width, size.height});
  frame.legend.clear();
  if (request.view != DebugView::none) {
    DebugFrame debug = renderDebugView(*renderer_, request.camera, frame.film, request.view);
    frame.stats = debug.stats;
    frame.legend = std::move(debug.legend);
    return true;
  }
  const double expectedMs = msPerSample_ * samplesOf(request);
  if (request.interruptible && expectedMs > kBandMs) {
    if (!traceInBands(request.camera, frame, kBandMs, superseded)) return false;
  } else if (expectedMs == 0 || expectedMs > kLongBandMs) {
    if (!traceInBands(request.camera, frame, kLongBandMs, leaving)) return false;
  } else {
    frame.stats = renderer_->render(request.camera, frame.film);
  }
  msPerSample_ = frame.stats.frameMs / samplesOf(request);
  return true;
}

bool FrameTracer::traceInBands(const Camera& camera, TracedFrame& frame, double bandMs,
                               const std::function<bool()>& givenUp) {
  const ImageSize size = filmSizeOf(frame.film);
  sizeDisplay(frame.film);
  const auto rowsIn = [&](double msPerRow) {
    const double rows = std::min(bandMs / msPerRow, static_cast<double>(size.height));
    return std::max(static_cast<int>(rows) / kBandRows * kBandRows, kBandRows);
  };
  int rows = msPerSample_ > 0 ? rowsIn(msPerSample_ * size.width * options_.spp) : kBandRows;
  frame.stats = FrameStats();
  for (int y = 0, end = 0; y < size.height; y = end) {
    if (givenUp()) return false;
    end = std::min(y + rows, size.height);
    sizeFilm(band_, size, Crop{0, y, size.width, end});
    const FrameStats stats = renderer_->render(camera, band_);
    if (msPerSample_ == 0) rows = rowsIn(std::max(stats.frameMs / (end - y), 1e-3));
    place(band_, frame.film);
    frame.stats.add(stats);
    frame.stats.frameMs += stats.frameMs;
    frame.stats.workers = stats.workers;
  }
  return true;
}

bool FrameTracer::traceReference(const FrameRequest& request, TracedFrame& frame,
                                 const Superseded& superseded, const Publish& publish) {
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
    if (superseded()) return false;
    publish(frame);
  }
  finishComparison(frame.film, options_.exposure.ev, options_.toneCurve, comparison);
  return true;
}

}  // namespace whit::view
