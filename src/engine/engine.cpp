#include "engine/engine.h"

#include <algorithm>
#include <utility>

#include "bake/edit_scene.h"
#include "core/error.h"
#include "core/machine_limits.h"
#include "core/option_table.h"
#include "core/stopwatch.h"
#include "core/text.h"
#include "inspect/auto_exposure.h"
#include "inspect/reference_frame.h"
#include "io/files.h"
#include "io/scene/scene_settings.h"

namespace whit {

namespace {

// Returns the settings of `after` that are new or were set again, in their order; none if a setting
// of `before` was removed.
std::optional<std::vector<SceneSetting>> touchedSettings(const std::vector<std::string>& before,
                                                         const std::vector<std::string>& after) {
  std::vector<SceneSetting> touched;
  std::vector<std::string> grown = before;  // with the touched ones added
  auto rest = before.begin();
  for (const std::string& setting : after) {
    const auto known = std::find(rest, before.end(), setting);
    if (known != before.end()) {
      rest = known + 1;
      continue;
    }

    // Settings that are new or were set again stand at the end of the list, so none of the settings
    // that follow is an old one.
    rest = before.end();
    touched.push_back(parseSceneSetting(setting));
    addSceneSetting(setting, grown);
  }

  if (grown != after) return std::nullopt;
  return touched;
}

bool touches(const std::vector<SceneSetting>& settings, const char* section) {
  return std::ranges::any_of(
      settings, [&](const SceneSetting& setting) { return setting.tokens.front() == section; });
}

}  // namespace

int threadsOf(const RenderOptions& options) {
  return options.threads > 0 ? options.threads : usableThreads();
}

Engine::Engine(std::shared_ptr<OpenScene> scene)
    : opened_(std::move(scene)), seconds_(opened_->scene.motion.given.seconds) {}

void Engine::forgetRenderer() {
  renderer_.reset();
  queries_.reset();
  optionsChanged_ = true;
}

void Engine::ownScene() {
  forgetRenderer();  // renderer and ray queries refer to the shared scene
  opened_ = std::make_shared<OpenScene>(*opened_);
}

std::shared_ptr<OpenScene> Engine::copyScene() {
  update();
  auto copy = std::make_shared<OpenScene>(*opened_);
  if (seconds_ != 0) copy->load.instant.seconds = seconds_;
  // No command line can state transforms that a program has set.
  copy->isMade |= !transforms_.empty();
  return copy;
}

void Engine::setOptions(const RenderOptions& options, const std::set<std::string>& given) {
  requested_ = options;
  given_ = given;
  optionsChanged_ = true;
}

void Engine::setOptions(const RenderOptions& options) {
  requested_ = options;
  given_.reset();
  optionsChanged_ = true;
}

RenderOptions Engine::requestedOptions() const {
  RenderOptions options = requested_;
  if (given_) {
    applyQuality(options, *given_);
    applySceneOptions(scene().options, *given_, options);
  }
  return options;
}

void Engine::edit(const std::string& setting, Progress* progress) {
  LoadOptions load = opened_->load;
  addSceneSetting(setting, load.settings);
  setSettings(load, progress);
}

void Engine::setSettings(const LoadOptions& load, Progress* progress) {
  // If settings were removed, the file's own values count again, and only the reader knows them.
  const auto touched = touchedSettings(opened_->load.settings, load.settings);
  if (!touched) {
    readAgain(opened_->source, load, progress);
    return;
  }

  // If anything fails below, document_ stays empty, because the document may then hold settings
  // that the scene does not have.
  std::optional<JsonDocument> document = std::exchange(document_, std::nullopt);
  if (!document) document = readSceneDocument();
  for (const SceneSetting& setting : *touched) applySceneSetting(setting, *document);

  queries_.reset();  // ray queries hold the masks of the materials
  const std::vector<std::uint8_t> media = scene().mediumOfMaterial;
  Warnings warnings(opened_->strict);
  if (!editScene(*touched, load, *document, warnings, opened_->scene)) {
    readAgain(opened_->source, load, progress);
    return;
  }

  // Other kinds than this one stay until the scene is read again, and each is noted once.
  if (touches(*touched, "materials")) opened_->warnings.forget(kSumWarning);
  const auto known = opened_->warnings.entries();
  for (const auto& [kind, entry] : warnings.entries()) {
    if (!known.contains(kind)) opened_->warnings.note(kind, entry.first, entry.count);
  }

  const LoadOptions loaded = opened_->load;
  document_ = std::move(document);
  opened_->load.settings = load.settings;
  opened_->load.sky = load.sky;
  optionsChanged_ = true;  // an automatic exposure has to be chosen again

  // Edits put lights that move where they start.
  moved_ |= touches(*touched, "lights") && scene().motion.ofLights();

  // The media around a camera depend on the cameras and on the surfaces that bound a medium.
  updateRenderer(touches(*touched, "cameras") || media != scene().mediumOfMaterial, loaded,
                 progress);
}

void Engine::updateRenderer(bool camerasChanged, const LoadOptions& loaded, Progress* progress) {
  if (!renderer_) return;
  try {
    if (camerasChanged) renderer_->camerasChanged();
    renderer_->shadingChanged();
  } catch (...) {
    renderer_.reset();
    try {
      readAgain(opened_->source, loaded, progress);  // the scene as it was
    } catch (...) {
      throwLimit("out of memory during an edit: open the scene again");
    }
    throw;
  }
}

void Engine::setMesh(const std::string& name, GivenMesh mesh, Progress* progress) {
  const SceneSource& source = opened_->source;
  auto changed = std::make_shared<SceneText>(source.text ? *source.text : SceneText());
  std::map<std::string, GivenMesh>& meshes = changed->parts.meshes;
  const auto found = meshes.find(name);
  if (found == meshes.end()) {
    throwUsage("updateMesh: the scene has no mesh '" + name + "' of a program's arrays" +
               didYouMean(name, keysOf(meshes), "mesh"));
  }

  found->second = std::move(mesh);
  readAgain({source.name, std::move(changed)}, opened_->load, progress);
}

JsonDocument Engine::readSceneDocument() const {
  const SceneSource& source = opened_->source;
  const LoadOptions& load = opened_->load;
  if (source.text) return readDocument(*source.text, load);
  if (std::optional<JsonDocument> document = readDocument(source.name, load)) return *document;

  const auto path = findScene(parseSceneName(source.name).file, load.shippedScenes);
  return describeModel(path.string(), scene(), load);
}

void Engine::readAgain(const SceneSource& source, const LoadOptions& load, Progress* progress) {
  std::shared_ptr<OpenScene> next = openScene(source, load, opened_->strict, progress);
  for (const auto& [pointer, transform] : transforms_) setPlace(next->scene, pointer, transform);

  forgetRenderer();
  earlier_.reset();
  opened_ = std::move(next);
  document_.reset();
  moved_ = !scene().motion.empty();
}

void Engine::setTime(double seconds) {
  seconds_ = seconds;
  moved_ = true;
}

void Engine::setTransform(const std::string& pointer, const Affine& transform) {
  setPlace(opened_->scene, pointer, transform);
  transforms_[pointer] = transform;
  moved_ = true;
}

void Engine::lookThrough(const std::optional<Camera>& camera) {
  optionsChanged_ |= camera || lookedThrough_;  // an automatic exposure is chosen again
  lookedThrough_ = camera;
}

Camera Engine::camera() const {
  if (!lookedThrough_) return chooseCamera(scene(), options_);
  return aimed(*lookedThrough_, scene().origin, options_);
}

void Engine::remember(const std::optional<Camera>& camera) {
  update();
  if (!options_.channels.has(Channel::motion)) return;
  earlier_ = rememberView(scene(), camera ? *camera : this->camera());
}

void Engine::update() {
  if (!moved_) return;
  const std::lock_guard lock(opened_->moving);
  moveScene(opened_->scene, seconds_);
  queries_.reset();
  if (renderer_) renderer_->sceneMoved();
  moved_ = false;
}

Renderer& Engine::prepare(Progress* progress) {
  update();
  if (!optionsChanged_) return *renderer_;

  options_ = requestedOptions();
  if (renderer_ && renderer_->canSetOptions(options_)) {
    renderer_->setOptions(options_);
  } else {
    renderer_.reset();  // two acceleration structures may need too much memory
    renderer_ = std::make_unique<Renderer>(scene(), options_, progress);
  }
  chooseExposure(*renderer_, camera(), options_);
  optionsChanged_ = false;
  return *renderer_;
}

const RayQueries& Engine::rayQueries(Progress* progress) {
  update();
  if (!queries_) {
    queries_ = std::make_unique<RayQueries>(scene(), threadsOf(requestedOptions()), progress);
  }
  return *queries_;
}

ImageMetadata Engine::describe(const Camera& camera, const Film& film) const {
  ImageMetadata about = describeImage(scene(), camera, *renderer_, film, options_);
  addSettings(opened_->load.settings, opened_->load.sky, about);
  return about;
}

Picture Engine::render(const PictureRequest& request, Film& film) {
  Renderer& renderer = prepare(request.progress);
  const Camera camera = request.camera ? *request.camera : this->camera();
  Picture picture;

  const std::optional<EarlierView> before = earlier_;
  remember(camera);
  renderer.setEarlier(before ? before : earlier_);

  // The options that are chosen for a budget hold for this picture alone: the next prepare()
  // replaces them.
  if (request.budget.isSet()) {
    reportProgress(request.progress, "choosing options", 0);
    picture.receipt = chooseOptions(renderer, camera, given_.value_or(std::set<std::string>()),
                                    request.budget, film);
    options_ = picture.receipt->options;
    optionsChanged_ = true;
  }

  const Stopwatch stopwatch;
  picture.about = describe(camera, film);
  try {
    picture.stats = renderFrame(renderer, options_.mode, camera, film, request.progress);
  } catch (...) {
    renderer.scheduler().forgetTracers();  // the tracers' queues are not empty
    throw;
  }
  if (picture.receipt) assess(*picture.receipt, renderer, camera, stopwatch.ms(), film);
  refuseNonFinite(scene(), options_, picture.stats);
  return picture;
}

std::uint64_t Engine::memoryBytes() const {
  return scene().memoryBytes() + (renderer_ ? renderer_->memoryBytes() : 0);
}

}  // namespace whit
