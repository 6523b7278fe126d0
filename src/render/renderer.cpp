#include "render/renderer.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/index.h"
#include "core/machine_limits.h"
#include "core/option_table.h"
#include "core/stopwatch.h"
#include "render/build_tables.h"
#include "render/embree_intersector.h"
#include "render/steps.h"
#include "sampling/sample_pattern.h"
#include "scene/members.h"
#include "simd/kernels.h"
#include "surfaces/initial_media.h"

namespace whit {

namespace {

// Points of a Fibonacci lattice on the sphere: none lies in a plane of symmetry that a model is
// likely to have.
Vec3f latticeDirection(int i, int n) {
  constexpr double kGoldenAngle = 2.399963229728653;
  const double y = 1 - (2 * i + 1.0) / n, r = std::sqrt(1 - y * y), turn = kGoldenAngle * i + 0.3;
  return Vec3f(Vec3d{r * std::cos(turn), y, r * std::sin(turn)});
}

bool moves(const Scene& scene, std::uint32_t camera) {
  const std::vector<MovingCamera>& moving = scene.motion.given.cameras;
  return std::ranges::any_of(moving, [&](const MovingCamera& m) { return m.camera == camera; });
}

// True if 256 rays from the eye, evenly in all directions, hit something.
bool isEnclosed(const Accel& accel, const Vec3f& eye) {
  constexpr int kDirections = 256;
  for (int i = 0; i < kDirections; ++i) {
    if (!accel.closest(eye, latticeDirection(i, kDirections)).found()) return false;
  }
  return true;
}

// True if the scene is closed around every camera and keyframe.
bool isEnclosed(const Scene& scene, const Accel& accel) {
  for (std::uint32_t i = 0; i < scene.cameras.size(); ++i) {
    if (!moves(scene, i) && !isEnclosed(accel, scene.cameras[i].eye)) return false;
  }
  for (const Keyframe& key : scene.cameraPath) {
    if (!isEnclosed(accel, key.camera.eye)) return false;
  }
  return true;
}

void chooseSimd(const std::string& name) {
  if (simd::chooseTarget(name)) return;
  std::string have;
  for (const std::string& target : simd::availableTargets()) have += " " + target;
  throwUsage("--simd " + name + " is not available here; there are: auto" + have);
}

// The effects of a plan that are built into the acceleration structure.
EffectSet builtIn(const Plan& plan) {
  constexpr EffectSet kBuiltIn =
      EffectSet().with(Effect::alphaMasks).with(Effect::instances).with(Effect::spheres);
  return EffectSet(plan.effects.bits() & kBuiltIn.bits());
}

}  // namespace

Plan planOf(const Scene& scene, const RenderOptions& options) {
  if (options.sphereSegments > 0 && scene.effects.has(Effect::spheres)) {
    throwUsage(
        "--sphere-segments takes effect when a scene is loaded; this scene was loaded with exact "
        "spheres, so load it again");
  }
  chooseSimd(options.simd);
  return makePlan(scene, options);
}

Renderer::Renderer(const Scene& scene, const RenderOptions& options, Progress* progress)
    : scene_(scene),
      options_(options),
      scheduler_(options.threads > 0 ? options.threads : usableThreads()),
      adaptive_(scheduler_) {
  const Stopwatch stopwatch;
  plan_ = planOf(scene, options);
  const int threads = scheduler_.threads();
  accel_.emplace(scene, options, plan_.effects, threads, progress);
  findSurroundings();
  tables_ = buildTables(scene, plan_.effects, options.shading, threads);
  machine_ = {simd::chosenTarget(), accel_->description(), accel_->packet(), threads};
  buildMs_ = stopwatch.ms();
}

// Finds out whether the cameras stand in a closed scene, and where its dielectrics are.
void Renderer::findSurroundings() {
  accel_->setEnclosed(false);
  lookedFrom_.reset();
  enclosed_ = options_.robust && options_.retry && isEnclosed(scene_, *accel_);
  dielectrics_ = dielectricBounds(scene_);
}

void Renderer::sceneMoved() {
  if (scene_.motion.ofGeometry) {
    accel_->sceneMoved();
    findSurroundings();
    refreshInstances(scene_, tables_);
  }
  if (scene_.motion.ofGeometry || scene_.motion.ofLights()) shadingChanged();
}

std::uint64_t Renderer::memoryBytes() const {
  return accel_->memoryBytes() + tables_.copiedTexels * sizeof(std::uint32_t) + scheduler_.bytes() +
         adaptive_.bytes();
}

CameraFrame Renderer::prepareView(const Camera& camera, const Film& film) {
  if (enclosed_ && lookedFrom_ != camera.eye) {
    lookedFrom_ = camera.eye;
    accel_->setEnclosed(false);
    accel_->setEnclosed(isEnclosed(*accel_, camera.eye));
  }
  if (earlier_) {
    earlier_->frame = makeCameraFrame(earlier_->camera, film.image.width, film.image.height);
  }
  CameraFrame frame = frameWithMedia(scene_, plan_.effects, EmbreeIntersector(*accel_), camera,
                                     film.image.width, film.image.height, options_.spp);
  if (frame.reach != Vec3d()) frame.mediaVary = startsMayLieInside(frame, dielectrics_);
  return frame;
}

FrameConstants Renderer::constantsOf(const CameraFrame& camera) const {
  return {&scene_, &tables_, &*accel_, plan_.effects, plan_.features, options_, camera, {}, seed_};
}

const std::vector<Vec2f>& Renderer::pattern() {
  const std::size_t samples = options_.spp;
  if (pattern_.size() != samples) pattern_ = samplePattern(options_.spp);
  return pattern_;
}

Frame Renderer::frameOf(const TraceRequest& request, bool adaptively) {
  Film& film = request.film;
  scheduler_.layOut(plan_, options_,
                    adaptively ? AdaptiveSampler::tracedWindow(film.image) : film.image.window);
  sizeDisplay(film);

  Frame frame;
  frame.constants = constantsOf(prepareView(request.camera, film));
  frame.samples = request.pattern ? *request.pattern : pattern();
  frame.endSample = frame.samples.size();
  if (request.sums) {
    frame.firstSample = request.part.first;
    frame.endSample = request.part.end;
    frame.sums = request.sums;
  }
  // Adaptive sampling has given the pixel its center alone.
  if (request.pattern && frame.samples.size() == 1) frame.constants.camera.footprint = 1;

  film.channels.resize(plan_.channels, film.image.pixels.size());
  if (!plan_.channels.empty()) {
    frame.constants.channels = {&film.channels, film.image.window,
                                static_cast<std::uint32_t>(nearestToCenter(frame.samples)),
                                earlier()};
  }
  frame.film = &film;
  frame.hooks = request.hooks;
  frame.observers = request.observers;
  return frame;
}

FrameStats Renderer::render(const TraceRequest& request) {
  const bool isWhole = !request.pixels && !request.pattern && !request.sums;
  const bool adaptively = adaptive() && isWhole && !request.uniform;
  const Frame frame = frameOf(request, adaptively);

  const Stopwatch stopwatch;
  const PixelLists& pixels = request.pixels ? *request.pixels : scheduler_.tiles();
  FrameStats stats = adaptively ? adaptive_.render(frame) : scheduler_.trace(frame, pixels);
  if (!request.pixels) {
    poolErrors(request.film);
    showBackground(options_, request.film);
  }
  stats.frameMs = stopwatch.ms();
  if (request.observers.empty()) stats.workers = machine_.threads;
  return stats;
}

std::vector<Vec2f> Renderer::samplesOf(const Camera& camera, Film& film) {
  if (!adaptive()) return pattern();
  render({camera, film});
  const Crop& pixel = film.image.window;
  return adaptive_.samplesAt(pixel.x0, pixel.y0, pattern());
}

void Renderer::replan(Plan next) {
  // Tracers follow the plan that is there; only the columns that they hold are made for one.
  if (next.features != plan_.features || next.effects != plan_.effects ||
      next.depth != plan_.depth || next.channels != plan_.channels) {
    scheduler_.forgetTracers();
  }
  plan_ = std::move(next);
}

void Renderer::shadingChanged() {
  Plan plan = makePlan(scene_, options_);
  refreshShading(scene_, plan.effects, options_.shading, machine_.threads, tables_);
  replan(std::move(plan));
}

void Renderer::setOptions(const RenderOptions& options) {
  Plan plan = makePlan(scene_, options);
  if (builtIn(plan) != builtIn(plan_)) {
    throwUsage(
        "alpha masks, spheres and instances are part of the acceleration structure: it has to be "
        "built anew");
  }
  if (rebuildNeeded(options_, options) >= Rebuild::tables)
    refreshShading(scene_, plan.effects, options.shading, machine_.threads, tables_);
  replan(std::move(plan));
  takeOver(options, Rebuild::tables, options_);
}

bool Renderer::canSetOptions(const RenderOptions& options) const {
  return rebuildNeeded(options_, options) <= Rebuild::tables &&
         builtIn(makePlan(scene_, options)) == builtIn(plan_);
}

std::vector<std::pair<std::string, std::string>> describeImage(const Scene& scene,
                                                               const Camera& camera,
                                                               const Renderer& renderer,
                                                               const Film& film,
                                                               const RenderOptions& options) {
  RenderOptions resolved = options;
  resolved.size = ImageSize{film.image.width, film.image.height};
  // A camera on a path has no name, so its members are written: all but numbers that are 0, which
  // nobody asked for.
  const Camera seen = fitted(camera, static_cast<double>(film.image.width) / film.image.height);
  forEachCameraOption([&](auto option, auto member) {
    const auto& value = seen.*member;
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, float>) {
      if (value == 0 && !(options.*option)) return;
      if (!isFramedByOptions(camera)) return;
    }
    using Option = typename std::remove_cvref_t<decltype(resolved.*option)>::value_type;
    resolved.*option = optionOf<Option>(value, scene.origin);
  });
  if (options.mode == Mode::packets) {
    resolved.packet = renderer.machine().packet;
    resolved.simd = renderer.machine().simd;
  }
  std::vector<std::pair<std::string, std::string>> metadata{
      {"software", "whit " WHIT_VERSION},
      {"scene", scene.name},
      {"effectsUsed", formatValue(OptionSpec{}, renderer.plan().effects)}};
  if (!isFramedByOptions(camera)) {
    metadata.emplace_back("projection", entryOf(kWords<Projection>, camera.projection));
  }
  for (auto& entry : pictureOptions(resolved)) metadata.push_back(std::move(entry));
  return metadata;
}

}  // namespace whit
