#include "viewer/session/frame_tracer.h"

#include <algorithm>
#include <mutex>

#include "bake/edit_scene.h"
#include "cli/app/frame_summary.h"
#include "cli/app/image_output.h"
#include "core/option_table.h"
#include "io/load_scene.h"
#include "render/renderer.h"

namespace whit::view {

namespace {

ImageSize filmSizeOf(const Film& film) { return {film.image.width, film.image.height}; }

void sizeFilm(Film& film, const ImageSize& size, const Crop& window) {
  if (filmSizeOf(film) == size && film.image.window == window) return;
  film.image = Image(size.width, size.height, window);
}

// Sets a renderer's options for its own lifetime.
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
    : common_(common), options_(cli::optionsFor(scene->scene, common)) {
  open(std::move(scene), common.load.instant.animation);
}

void FrameTracer::open(std::shared_ptr<cli::OpenScene> scene, const std::string& animation) {
  renderer_ = std::make_unique<Renderer>(scene->scene, options_);
  scene_ = std::move(scene);  // after the old renderer has gone, which needs the old scene
  editSettings_.clear();
  sky_ = skyOf(*scene_);
  ownSky_ = Sky();
  seconds_ = scene_->scene.motion.given.seconds;
  animation_ = animation;
}

void FrameTracer::load(const SceneChoice& choice) {
  cli::CommonOptions common = common_;
  common.load.settings = choice.settings;
  common.load.instant.animation = choice.animation;
  open(cli::openScene(choice.name, common, nullptr), choice.animation);
}

void FrameTracer::moveTo(double seconds) {
  const std::lock_guard lock(scene_->moving);
  moveScene(scene_->scene, seconds);
  renderer_->sceneMoved();
  seconds_ = seconds;
}

void FrameTracer::edit(ShadingEdit edit) {
  if (edit.scene != scene_) return;
  Sky opened;  // reading may fail, so it comes before any change
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
    moveTo(seconds_);  // edits of moving lights are edits of their start
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
  if (renderer_->canSetOptions(next)) {
    renderer_->setOptions(next);
  } else {
    renderer_ = std::make_unique<Renderer>(scene_->scene, next);
  }
  settleExposure(*renderer_, chooseCamera(scene_->scene, next), next);
  options_ = next;
}

RayPick FrameTracer::explain(const RayQuery& query) {
  RenderOptions options = renderer_->options();
  takeOver(query.picture.options, Rebuild::tables, options);
  const ImageSize size = options.size.value();
  Film film;
  sizeFilm(film, size, Crop{query.x, query.y, query.x + 1, query.y + 1});
  RayPick pick{scene_, query, {}, {}, {}, {}};
  const OptionsInUse used(*renderer_, options);
  pick.rays = cli::explainRays(*renderer_, query.picture.camera, film, query.x, query.y);
  for (std::size_t i = 0; i < pick.rays.packets.nodes.size(); ++i) {
    pick.words.push_back(cli::describeRay(scene_->scene, pick.rays, i));
  }
  pick.lines = linesOf(pick.rays.packets, query.picture.camera);
  pick.aside = cameraAside(pick.rays.packets, query.picture.camera, renderer_->accel());
  return pick;
}

bool FrameTracer::trace(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls) {
  if (request.seconds && *request.seconds != seconds_) moveTo(*request.seconds);
  applyOptions(request);
  frame.costs.clear();
  frame.measured = 0;
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
  return !request.measureKnobs || measure(request, frame, calls);
}

bool FrameTracer::measure(const FrameRequest& request, TracedFrame& frame,
                          const TraceCalls& calls) {
  const ImageSize whole = request.options.size.value();
  const ImageSize size = measuredSize(whole, msPerSample_ * options_.spp);
  sizeFilm(band_, size, Crop{0, 0, size.width, size.height});
  const double scale = static_cast<double>(whole.width) * whole.height /
                       (static_cast<double>(size.width) * size.height);
  const auto goesOn = [&](const std::vector<KnobCost>& sofar, double measured) {
    if (sofar.size() > frame.costs.size()) {
      frame.costs = sofar;
      frame.measured = measured;
      calls.publish(frame);
    }
    calls.answer();
    return !calls.superseded();
  };
  const bool complete = measureKnobs(*renderer_, options_, request.camera, band_, scale, goesOn);
  frame.measured = 1;
  return complete;
}

bool FrameTracer::tracePicture(const FrameRequest& request, TracedFrame& frame,
                               const TraceCalls& calls) {
  const ImageSize size = request.options.size.value();
  sizeFilm(frame.film, size, Crop{0, 0, size.width, size.height});
  sizeDisplay(frame.film);
  frame.debug.reset();
  frame.sampleError = 0;
  const bool complete = accumulates(request) ? traceInPasses(request, frame, calls)
                                             : traceAtOnce(request, frame, calls);
  if (complete) msPerSample_ = frame.stats.frameMs / samplesOf(request);
  return complete;
}

bool FrameTracer::traceAtOnce(const FrameRequest& request, TracedFrame& frame,
                              const TraceCalls& calls) {
  const FrameHooks hooks{calls.stopped, nullptr};
  if (request.view == DebugView::none) {
    frame.stats = renderer_->render(request.camera, frame.film, &hooks);
  } else {
    const auto debug = std::make_shared<DebugPicture>();
    frame.stats = watchFrame(*renderer_, request.camera, frame.film, request.view, *debug, &hooks);
    frame.debug = debug;
  }
  return !calls.stopped();
}

bool FrameTracer::accumulates(const FrameRequest& request) const {
  return request.interruptible && request.view == DebugView::none && options_.spp > 1 &&
         !options_.adaptive && renderer_->plan().features.has(Feature::streams);
}

// The pictures that are shown on the way have more samples than the one before; until then that
// one stays.
bool FrameTracer::traceInPasses(const FrameRequest& request, TracedFrame& frame,
                                const TraceCalls& calls) {
  const ImageSize size = filmSizeOf(frame.film);
  frame.stats = FrameStats();
  SampleSums sums(Crop{0, 0, size.width, size.height});
  const bool again =
      finished_ && sameSubject(*finished_, request) && finished_->options.size == size;
  const int shown = again ? finished_->spp : 0;
  const double passMs = msPerSample_ * static_cast<double>(size.width) * size.height;
  const double wanted = passMs > 0 ? kPassMs / passMs : 1;
  const int most =
      static_cast<int>(std::clamp(wanted, 1.0, std::max(options_.spp / kLeastPasses, 1.0)));
  const FrameHooks hooks{calls.superseded, nullptr};
  for (SampleRange part; part.end < options_.spp; part.first = part.end) {
    part.end = std::min(part.first + most, options_.spp);
    const FrameStats stats = renderer_->accumulate(request.camera, frame.film, part, sums, &hooks);
    if (calls.superseded()) return false;
    frame.stats.add(stats);
    frame.stats.frameMs += stats.frameMs;
    frame.stats.workers = stats.workers;
    if (part.end > 1) frame.sampleError = sums.relativeError(part.end);
    if (part.end == options_.spp) break;
    if (part.end > shown) {
      calls.showUnfinished({request, frame.film.display, part.end, frame.sampleError});
    }
    calls.answer();
  }
  return true;
}

}  // namespace whit::view
