#include "viewer/session/frame_tracer.h"

#include <algorithm>

#include "command_line/progress_bar.h"
#include "core/option_table.h"
#include "output/frame_summary.h"
#include "render/renderer.h"
#include "scene/members.h"

namespace whit::view {

namespace {

ImageSize filmSizeOf(const Film& film) { return {film.image.width, film.image.height}; }

void sizeFilm(Film& film, const ImageSize& size, const Crop& window) {
  if (filmSizeOf(film) == size && film.image.window == window) return;
  film.image = Image(size.width, size.height, window);
}

// Gives a renderer other options for as long as this object lives.
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

void clearCamera(RenderOptions& options) {
  options.camera.clear();
  forEachCameraOption([&](auto option, auto /*member*/) { (options.*option).reset(); });
}

void copySampledRays(const RenderOptions& from, RenderOptions& to) {
  to.glossy = from.glossy;
  to.indirect = from.indirect;
  to.lightSamples = from.lightSamples;
  to.ambientSamples = from.ambientSamples;
}

bool hasSampledRays(const RenderOptions& options) {
  RenderOptions plain = options;
  copySampledRays(RenderOptions(), plain);
  return plain != options;
}

FrameTracer::FrameTracer(std::shared_ptr<OpenScene> scene, const cli::CommonOptions& common)
    : warns_(common.warns), engine_(std::make_unique<Engine>(std::move(scene))) {
  RenderOptions options = common.render;
  clearCamera(options);
  engine_->setOptions(options, common.given);
  engine_->prepare();
}

void FrameTracer::load(std::unique_ptr<Engine> scene) {
  engine_ = std::move(scene);
  edited_.reset();
}

void FrameTracer::edit(const SceneEdit& edit) {
  // The edit is for the scene of this name. Pointers to scenes do not tell, because an earlier edit
  // may have had the same scene read again.
  if (!edit.scene || edit.scene->source.name != engine_->opened()->source.name) return;
  const auto known = engine_->opened()->warnings.entries();
  engine_->setSettings(editedLoad(edit));

  Warnings fresh;
  for (const auto& [kind, entry] : engine_->opened()->warnings.entries()) {
    if (known.contains(kind)) continue;
    fresh.note(kind, entry.first, entry.count);
    warning_ += (warning_.empty() ? "" : "; ") + kind + ": " + entry.first;
  }
  if (warns_) cli::printWarnings(fresh);
  edited_.reset();
}

RayPick FrameTracer::explain(const RayQuery& query) {
  Renderer& renderer = engine_->prepare();
  const Scene& scene = engine_->scene();

  // While the query is answered, the renderer has the query's options, except those that would need
  // other workers. It keeps its own if they would need another acceleration structure: then it
  // already traces a picture with other options, whose rays are asked for next.
  RenderOptions options = renderer.options();
  takeOver(query.picture.options, Rebuild::tables, options);
  if (!renderer.canSetOptions(options)) options = renderer.options();
  const OptionsInUse used(renderer, options);

  // The film has the size of the picture, but memory for the queried pixel only.
  Film film;
  sizeFilm(film, query.picture.options.size.value(),
           Crop{query.x, query.y, query.x + 1, query.y + 1});

  RayPick pick{engine_->opened(), query, {}, {}, {}, {}};
  pick.rays = explainRays(renderer, query.picture.camera, film, query.x, query.y);
  for (std::size_t i = 0; i < pick.rays.packets.nodes.size(); ++i) {
    pick.words.push_back(describeRay(scene, pick.rays, i));
  }
  pick.lines = linesOf(pick.rays.packets, query.picture.camera);
  pick.aside = cameraAside(pick.rays.packets, query.picture.camera, renderer.accel());
  return pick;
}

bool FrameTracer::trace(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls) {
  if (request.seconds && *request.seconds != engine_->seconds()) {
    engine_->setTime(*request.seconds);
  }

  RenderOptions options = request.options;
  options.spp = request.spp;
  if (request.plain) copySampledRays(RenderOptions(), options);
  // The command of the picture then makes the reference, too.
  if (request.view == DebugView::reference) options.mode = Mode::reference;
  engine_->setOptions(options);
  engine_->lookThrough(request.camera);  // an automatic exposure is measured there
  engine_->prepare();

  frame.costs.clear();
  frame.measured = 0;
  if (!tracePicture(request, frame, calls)) return false;

  finished_ = request;
  describe(request, frame);
  return !request.measureKnobs || measure(request, frame, calls);
}

void FrameTracer::describe(const FrameRequest& request, TracedFrame& frame) {
  const std::shared_ptr<OpenScene>& open = engine_->opened();
  const Scene& scene = open->scene;
  const Renderer& renderer = engine_->renderer();

  frame.scene = open;
  frame.request = request;
  // The renderer's exposure is a number even if the request's is automatic.
  frame.request.options.exposure = engine_->options().exposure;
  frame.options = engine_->options();
  copySampledRays(request.options, frame.options);
  frame.animation = open->load.instant.animation;
  frame.warning = std::exchange(warning_, "");

  frame.surfaces = surfacesText(scene.instancedTriangles, scene.instancedSpheres);
  frame.effects = renderer.plan().effects;
  frame.sampled = renderer.plan().sampled;
  frame.reasons = scene.reasons;
  frame.dark = noLightWarning(scene);
  frame.machine = renderer.machine();

  if (!edited_) edited_ = std::make_shared<const EditedScene>(editedScene(*open));
  frame.edited = edited_;

  frame.metadata = engine_->describe(request.camera, frame.film);
}

bool FrameTracer::measure(const FrameRequest& request, TracedFrame& frame,
                          const TraceCalls& calls) {
  // A smaller frame of the same view is timed, and its cost is scaled by the number of pixels.
  const ImageSize whole = request.options.size.value();
  const ImageSize size = measuredSize(whole, msPerSample_ * engine_->options().spp);
  sizeFilm(measured_, size, Crop{0, 0, size.width, size.height});
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

  const bool complete = measureKnobs(engine_->renderer(), engine_->options(), request.camera,
                                     measured_, scale, goesOn);
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
  if (complete && !request.plain) msPerSample_ = frame.stats.frameMs / samplesOf(request);
  return complete;
}

bool FrameTracer::traceAtOnce(const FrameRequest& request, TracedFrame& frame,
                              const TraceCalls& calls) {
  const FrameHooks hooks{calls.stopped, nullptr};
  if (!showsReference(request.view)) reference_.reset();

  if (showsReference(request.view)) {
    traceReference(request, frame, calls);
  } else if (request.view == DebugView::none) {
    frame.stats =
        engine_->renderer().render({.camera = request.camera, .film = frame.film, .hooks = &hooks});
  } else {
    const auto debug = std::make_shared<DebugPicture>();
    frame.stats =
        watchFrame(engine_->renderer(), request.camera, frame.film, request.view, *debug, &hooks);
    frame.debug = debug;
  }
  return !calls.stopped();
}

void FrameTracer::traceReference(const FrameRequest& request, TracedFrame& frame,
                                 const TraceCalls& calls) {
  FrameRequest picture = request;
  picture.view = DebugView::none;
  if (!referenceFor_ || !samePicture(picture, *referenceFor_)) reference_.reset();
  referenceFor_ = picture;

  const FrameHooks hooks{calls.stopped, nullptr};
  const auto debug = std::make_shared<DebugPicture>();
  frame.stats = watchReference(engine_->renderer(), request.camera, frame.film, request.view,
                               reference_, *debug, hooks, calls.progress);
  frame.debug = debug;
}

bool FrameTracer::accumulates(const FrameRequest& request) const {
  const RenderOptions& options = engine_->options();
  return request.interruptible && request.view == DebugView::none && options.spp > 1 &&
         !options.adaptive && engine_->renderer().plan().sampled;
}

// A finished picture of the same view stays until the new one has more samples; only then are the
// passes shown.
bool FrameTracer::traceInPasses(const FrameRequest& request, TracedFrame& frame,
                                const TraceCalls& calls) {
  const ImageSize size = filmSizeOf(frame.film);
  const int spp = engine_->options().spp;
  frame.stats = FrameStats();
  SampleSums sums(Crop{0, 0, size.width, size.height});

  const bool again =
      finished_ && sameSubject(*finished_, request) && finished_->options.size == size;
  const int shown = again ? finished_->spp : 0;

  // A pass has as many samples per pixel as fit into kPassMs, but few enough for kLeastPasses
  // passes. `passMs` is the time of one sample in every pixel.
  const double passMs = msPerSample_ * static_cast<double>(size.width) * size.height;
  const double wanted = passMs > 0 ? kPassMs / passMs : 1;
  const int most = static_cast<int>(std::clamp(wanted, 1.0, std::max(spp / kLeastPasses, 1.0)));
  const FrameHooks hooks{calls.superseded, nullptr};

  for (SampleRange part; part.end < spp; part.first = part.end) {
    part.end = std::min(part.first + most, spp);
    const FrameStats stats = engine_->renderer().render({.camera = request.camera,
                                                         .film = frame.film,
                                                         .part = part,
                                                         .sums = &sums,
                                                         .hooks = &hooks});
    if (calls.superseded()) return false;

    frame.stats.add(stats);
    frame.stats.frameMs += stats.frameMs;
    frame.stats.workers = stats.workers;
    if (part.end > 1) frame.sampleError = sums.relativeError(part.end);

    // The caller hands over the finished picture.
    if (part.end == spp) break;
    if (part.end > shown) {
      calls.showUnfinished({request, frame.film.display, part.end, frame.sampleError});
    }

    calls.answer();
  }
  return true;
}

}  // namespace whit::view
