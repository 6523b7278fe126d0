#include "viewer/session/session.h"

#include <algorithm>
#include <cmath>

#include "bake/edit_scene.h"
#include "core/error.h"
#include "core/option_table.h"
#include "core/text.h"
#include "engine/open_scene.h"
#include "io/files.h"

namespace whit::view {

namespace {

constexpr float kExposureLimit = 64;
constexpr double kMessageSeconds = 4;
constexpr double kEditPauseSeconds = 0.5;  // a longer pause begins another edit
constexpr double kPixelsPerNotch = 20;     // dragged with the right button to go forward

std::filesystem::file_time_type timeOf(const std::filesystem::path& file) {
  std::error_code error;  // a file that is just being replaced is not an error
  return std::filesystem::last_write_time(file, error);
}

// All scales are multiples of 1/16.
std::string fraction(double scale) {
  int above = static_cast<int>(std::lround(scale * 16)), below = 16;
  while (above > 0 && above % 2 == 0 && below > 1) above /= 2, below /= 2;
  return below == 1 ? "full" : formatted("%d/%d", above, below);
}

}  // namespace

void listViewOptions(cli::OptionList& list, ViewOptions& options) {
  list.value({"rate", "N", kLeastRate, kLargestRate},
             "frames a second to hold while something moves (default: 60, on up to four cores 30)",
             options.rate);
  list.value(kViewOption, "what to show instead of the picture", options.view);
  cli::listCommonOptions(list, options.common);
}

void settleViewOptions(ViewOptions& options) {
  if (options.common.given.contains("crop")) {
    throwUsage("--crop: the viewer shows whole images; use whit render");
  }
  if (options.common.render.mode == Mode::reference) {
    throwUsage("--mode reference is too slow to look around with; use whit render");
  }
  options.common.load.instant.plays = true;
}

std::string errorText(double sampleError) {
  return sampleError > 0 ? formatted(", within about %.2g %%", 100 * sampleError) : "";
}

std::string samplesText(const UnfinishedFrame& frame) {
  return formatted("%d of %d samples", frame.samples, frame.request.spp) +
         errorText(frame.sampleError);
}

std::string sharpnessText(const FrameRequest& request) {
  const int window = std::max(request.window.width, 1);
  const int width = request.options.size ? request.options.size->width : window;
  std::string text = fraction(static_cast<double>(width) / window);
  if (request.spp != 1) text += formatted(", %d samples", request.spp);
  if (request.plain) text += ", without sampled rays";
  return text;
}

bool Timeline::step(double later) {
  if (!there || !playing) return false;
  seconds += later;
  if (seconds > length) seconds = length > 0 ? std::fmod(seconds, length) : 0;
  return true;
}

Timeline timelineOf(const Scene& scene, const Instant& instant) {
  Timeline timeline;
  timeline.seconds = instant.seconds.value_or(0);
  timeline.animation = instant.animation;

  for (const Animation& animation : scene.animations) {
    // A model's first animation plays unless another is named; motions of a scene file always do.
    const bool own = animation.name == kSceneMotion;
    if (!own && timeline.animation.empty()) timeline.animation = animation.name;
    if (!own) timeline.animations.push_back(animation.name);

    if (own || animation.name == timeline.animation) {
      timeline.length = std::max(timeline.length, animation.seconds);
    }
  }

  for (const MovingCamera& camera : scene.motion.given.cameras) {
    if (camera.node != kNoNode) continue;  // without a node it flies along the path
    timeline.length = std::max(timeline.length, static_cast<double>(scene.cameraPath.back().time));
  }

  // Motion set by a program has no length. A scene that was loaded to stand still may still list
  // animations.
  timeline.there = !scene.motion.empty() && timeline.length > 0;
  timeline.playing = timeline.there && !instant.seconds;
  if (timeline.animations.size() == 1) timeline.animations.clear();
  return timeline;
}

bool isMeasuredView(FrameRequest measured, const FrameRequest& request) {
  measured.options = request.options;
  return sameSubject(measured, request);
}

void Session::rememberCosts() {
  if (!shown_.costs.empty()) {
    costs_ = shown_.costs;
    measuredFor_ = shown_.request;
  } else if (!isMeasuredView(measuredFor_, shown_.request)) {
    costs_.clear();
  }
}

bool clip(ScreenLine& line, double width, double height) {
  // Each edge of the window bounds the line's parameter t from one side (Liang and Barsky 1984).
  double from = 0, to = 1;
  const double dx = line.x2 - line.x1, dy = line.y2 - line.y1;
  const auto keep = [&](double step, double room) {  // step * t <= room
    if (step == 0) return room >= 0;
    const double t = room / step;
    if (step > 0) {
      to = std::min(to, t);
    } else {
      from = std::max(from, t);
    }
    return from <= to;
  };

  const bool seen = keep(-dx, line.x1) && keep(dx, width - line.x1) && keep(-dy, line.y1) &&
                    keep(dy, height - line.y1);
  if (!seen) return false;

  line = {line.x1 + from * dx, line.y1 + from * dy, line.x1 + to * dx, line.y1 + to * dy};
  return true;
}

void select(const RayPick& pick, RayView& view) {
  view.material = view.light = kNoCounterpart;
  const RayNode& met = pick.rays.packets.nodes.front();
  if (met.triangle == kMiss) return;
  view.material = met.material;

  // The selected light is the one that adds most to the surface in its largest channel.
  double most = 0;
  for (const LightContribution& light : met.lights) {
    const double radiance = maxComponent(light.radiance);
    if (radiance <= most || light.light == kAmbientLight) continue;

    most = radiance;
    view.light = light.light;
  }
}

Session::Session(const ViewOptions& options, const std::shared_ptr<OpenScene>& scene,
                 std::function<void()> onChange)
    : options_(options),
      scene_(scene),
      reader_(options.common),
      thread_(scene, options.common, std::move(onChange)),
      control_(chooseCamera(scene->scene, options.common.render), cruisingSpeed(scene->scene)),
      resolution_(options.rate, options.common.render.spp),
      edited_(editedScene(*scene)),
      ownSky_(edited_.sky),
      readSettings_(edited_.settings),
      subject_(subjectOf(scene->scene)) {
  savedSettings_ = readSettings_;
  watch(options.scene);

  settings_.options = cli::optionsFor(scene->scene, options.common);
  settings_.view = options.view;
  settings_.timeline = timelineOf(scene->scene, options.common.load.instant);
  if (scene->isMade) settings_.timeline.animations.clear();  // others would have to be read

  // If the view is that of one of the scene's cameras, it moves with that camera.
  const Camera start = control_.camera();
  show(start);
  for (std::size_t i = 0; i < scene->scene.cameras.size() && !followed_; ++i) {
    if (sameView(scene->scene.cameras[i], start)) followed_ = i;
  }
}

void Session::say(const std::string& message) {
  message_ = message;
  messageSeconds_ = kMessageSeconds;
}

std::string Session::notice() const {
  const std::string message = messageSeconds_ > 0 ? message_ : "";
  std::string text;
  for (const std::string& part : {message, reader_.text(), thread_.progress(), shown_.dark}) {
    if (!part.empty()) text += (text.empty() ? "" : "; ") + part;
  }
  return text;
}

void Session::advance(const CameraMotion& motion, double seconds) {
  const bool moved = moveCamera(motion, seconds), played = play(seconds);
  restSeconds_ = moved || played ? 0 : restSeconds_ + seconds;
  watchSceneFile();
  followRays();
  askForFrame();
  messageSeconds_ -= seconds;
  sinceEdit_ += seconds;
}

bool Session::isActive() const {
  return pathTime_ || settings_.timeline.playing || restSeconds_ < kSettleSeconds || reader_.busy();
}

bool Session::isComplete() const {
  const FrameRequest& shown = shown_.request;
  return shown_.scene && shown.options.size == shown.window && !shown.plain &&
         shown.spp >= settings_.options.spp && sameSubject(shown, requestFor({}, true));
}

void Session::holdStill() {
  pathTime_.reset();
  settings_.timeline.playing = false;
}

CameraMotion Session::motionOf(const Drags& drags, double height, double scale,
                               CameraMotion motion) const {
  motion.wheel = drags.wheel;

  // The left button orbits, or looks around in a room; the right one goes forward and back.
  motion.turnX = drags.left.x / scale;
  motion.turnY = drags.left.y / scale;
  motion.wheel -= drags.right.y / scale / kPixelsPerNotch;

  motion.panX = drags.middle.x / std::max(height, 1.0);
  motion.panY = drags.middle.y / std::max(height, 1.0);
  return motion;
}

bool Session::moveCamera(const CameraMotion& motion, double seconds) {
  if (pathTime_) {
    flyPath(seconds);
    return true;
  }
  const bool moved = control_.step(motion, seconds);
  if (moved) followed_.reset();
  return moved;
}

bool Session::play(double seconds) {
  if (!settings_.timeline.step(seconds)) return false;
  followCamera();
  return true;
}

// Follows a camera that moves until the user moves the view.
void Session::followCamera() {
  if (!followed_ || !settings_.timeline.there) return;
  show(whit::cameraAt(scene(), *followed_, settings_.timeline.seconds));
}

void Session::flyPath(double seconds) {
  const std::vector<Keyframe>& path = scene().cameraPath;

  *pathTime_ += seconds;
  if (*pathTime_ > path.back().time) *pathTime_ = path.front().time;
  show(cameraAt(path, *pathTime_));
}

bool Session::fetchFrame() {
  showReadScene();
  bool answered = false;
  const std::string error = thread_.takeError();
  if (!error.empty()) {
    // The options of the picture that is shown are known to work.
    if (shown_.scene) settings_.options = shown_.request.options;
    fail(error);
  }

  // The answer to a pick and the samples of an unfinished picture are shown without a new frame.
  if (auto pick = thread_.takePick(); pick && picked_) {
    rays_ = std::move(*pick);
    if (std::exchange(selects_, false)) select(rays_, settings_.rays);
    answered = true;
  }
  if (auto frame = thread_.takeUnfinished()) {
    unfinished_ = std::move(frame);
    answered = true;
  }

  if (!thread_.take(shown_)) return answered;
  unfinished_.reset();
  if (shown_.scene != scene_) {
    // An edit, too, may have had the scene read again.
    const bool came = shown_.scene == coming_, elsewhere = came && !opening_.empty();
    if (came) {
      coming_.reset();
      undo_.clear();
    }
    takeScene(elsewhere);
    if (elsewhere) return false;  // the picture is from the camera of the other scene
  }

  // An automatic exposure is measured once, and then stays while the view changes.
  const FrameRequest& request = shown_.request;
  if (settings_.options.exposure.automatic) settings_.options.exposure = request.options.exposure;

  // An edit that failed is taken back.
  if (request.edits == edits_) edited_ = *shown_.edited;

  // The cost of a sample decides the resolution of the next picture in motion.
  if (request.view == viewToTrace(request.interruptible)) {
    resolution_.learn(shown_.stats.frameMs, samplesOf(request), request.plain);
  }
  if (!request.plain) resolution_.setSampled(shown_.sampled);
  rememberCosts();

  // The frame rate is shown as a mean over the last pictures in motion, the newest counting most.
  constexpr double kNewest = 0.2;  // weight of the newest picture
  const double ms = std::exchange(sincePicture_, Stopwatch()).ms();
  pictureMs_ = request.interruptible ? 0
               : pictureMs_ > 0      ? std::lerp(pictureMs_, ms, kNewest)
                                     : 1000 / resolution_.rate();
  if (shown_.measured == 1) settings_.measureKnobs = false;
  return true;
}

FrameRequest Session::requestFor(const Sharpness& sharpness, bool still) const {
  const auto side = [&](int pixels) {
    return std::max(1, static_cast<int>(std::lround(pixels * sharpness.scale)));
  };

  FrameRequest request;
  request.window = windowPixels();
  request.camera = control_.camera();
  request.options = settings_.options;
  request.options.size = ImageSize{side(request.window.width), side(request.window.height)};

  request.spp = sharpness.spp;
  // An automatic exposure is measured with all rays.
  request.plain = sharpness.plain && !settings_.options.exposure.automatic;
  request.view = viewToTrace(still);
  request.measureKnobs = still && sharpness.scale >= 1 && settings_.measureKnobs;

  request.reloads = reloads_;
  request.edits = edits_;
  request.seconds = settings_.timeline.time();
  request.interruptible = still;
  return request;
}

// In motion the picture itself takes the place of its reference.
DebugView Session::viewToTrace(bool still) const {
  return still || !showsReference(settings_.view) ? settings_.view : DebugView::none;
}

// More samples would blur the values of a debug view and delay a measurement.
bool Session::supersamples() const {
  return settings_.supersample && settings_.view == DebugView::none && !settings_.measureKnobs;
}

FrameRequest Session::movingRequest(const ImageSize& window) {
  stillFor_.reset();
  const double pixels = static_cast<double>(window.width) * window.height;
  return requestFor(resolution_.moving(pixels), false);
}

// Returns the next step at rest, or the first one when the picture shows something new.
FrameRequest Session::stillRequest(const ImageSize& window) {
  FrameRequest request = requestFor(resolution_.still(supersamples()), true);

  // A new view begins with the first step that is no coarser than what is shown of it already.
  if (!stillFor_ || !sameSubject(request, *stillFor_)) {
    const bool shown = shown_.scene && sameSubject(request, shown_.request);
    const double scale =
        shown ? static_cast<double>(shown_.request.options.size->width) / window.width : 0;

    resolution_.startSharpening(static_cast<double>(window.width) * window.height, scale);
    stillFor_ = request;
    request = requestFor(resolution_.still(supersamples()), true);
  }

  // A step that is shown already is followed by the next one; after the last the picture is sharp.
  while (shown_.scene && samePicture(request, shown_.request)) {
    if (!resolution_.sharpen(supersamples())) {
      sharp_ = !thread_.busy() && !reader_.busy();
      break;
    }
    request = requestFor(resolution_.still(supersamples()), true);
  }
  return request;
}

// Asks for the rays of the picked pixel again when anything but the viewpoint has changed.
void Session::followRays() {
  if (settings_.rays.forget) forgetRays();
  if (std::exchange(settings_.rays.fromAside, false) && rays_.scene) jump(rays_.aside);
  if (!picked_) return;

  // The query keeps the camera and the size of the pick; everything else follows the picture.
  RayQuery query = *picked_;
  query.picture.options = settings_.options;
  query.picture.options.size = picked_->picture.options.size;
  query.picture.reloads = reloads_;
  query.picture.edits = edits_;
  query.picture.seconds = shown_.request.seconds;

  if (queried_ && sameRays(query, *queried_)) return;
  thread_.query(query);
  queried_ = query;
}

void Session::askForFrame() {
  sharp_ = false;
  const ImageSize window = windowPixels();
  if (window.width < 1 || window.height < 1) return;

  resolution_.setSamples(settings_.options.spp, hasSampledRays(settings_.options));

  // A new window size counts as motion, so that the first picture for it comes at once.
  if (std::exchange(windowSize_, window) != window) restSeconds_ = 0;

  const FrameRequest request =
      restSeconds_ >= kSettleSeconds ? stillRequest(window) : movingRequest(window);
  if (asked_ && samePicture(request, *asked_)) return;
  if (thread_.ask(request)) asked_ = request;
}

void Session::edit(const std::vector<std::string>& settings) {
  // What is edited without a pause is one edit, as dragging a slider makes many.
  const bool goesOn = !undo_.empty() && sinceEdit_ < kEditPauseSeconds;
  if (!goesOn) undo_.push_back(edited_);
  sinceEdit_ = 0;
  addEdit(settings, edited_);
  postEdit();
}

void Session::undoEdit() {
  if (undo_.empty()) {
    say("there is no edit to undo");
    return;
  }

  edited_ = std::move(undo_.back());
  undo_.pop_back();
  sinceEdit_ = kEditPauseSeconds;  // what is edited next is another edit
  postEdit();
  say("the last edit is undone");
}

void Session::postEdit() {
  ++edits_;
  restSeconds_ = 0;
  if (coming_) return;  // the scene that is shown is replaced
  thread_.edit({scene_, edited_.settings, edited_.givenSky});
}

void Session::watch(const std::string& scene) {
  sceneName_ = scene;
  rememberRecent(scene, settings_.recent);
  if (scene_->isMade) return;
  sceneFile_ = findScene(parseSceneName(scene).file, options_.common.load.shippedScenes);
  sceneFileTime_ = timeOf(sceneFile_);
}

void Session::watchSceneFile() {
  const auto time = timeOf(sceneFile_);
  if (time == sceneFileTime_ || time == std::filesystem::file_time_type::min()) return;
  sceneFileTime_ = time;
  reload();
}

// The scene that is shown stays alive until the other one has been read.
void Session::load(const SceneChoice& choice) {
  error_.clear();
  messageSeconds_ = 0;
  reader_.read(choice, settings_.options);
}

void Session::showReadScene() {
  try {
    std::unique_ptr<Engine> scene = reader_.take();
    if (!scene) return;

    coming_ = scene->opened();
    thread_.load(std::move(scene));
    ++reloads_;
    restSeconds_ = 0;
  } catch (const std::exception& error) {
    opening_.clear();
    fail(error.what());
  }
}

void Session::reload() {
  if (!opening_.empty()) return open(opening_);  // sceneName_ is still that of the old scene
  if (scene_->isMade) throwUsage("the scene was made by a program: it cannot be read again here");
  load({sceneName_, readSettings_, settings_.timeline.animation});
}

void Session::changeAnimation() {
  settings_.timeline.seconds = 0;
  reload();
}

// Takes the options of the scene that was just read where the user has not changed them. The
// exposure for one scene says nothing about another.
void Session::takeOptions(const Scene& last, bool elsewhere) {
  const RenderOptions before = cli::optionsFor(last, options_.common);
  const RenderOptions own = cli::optionsFor(scene(), options_.common);
  for (const std::string& name : sceneOptionNames()) {
    const bool isKept = !elsewhere || name != "exposure";
    if (isKept && optionText(settings_.options, name) != optionText(before, name)) continue;
    setOption(settings_.options, name, optionText(own, name));
  }
}

// Called when the frame that was just fetched shows another scene, or the scene read again.
void Session::takeScene(bool elsewhere) {
  const std::shared_ptr<const OpenScene> last = std::exchange(scene_, shown_.scene);
  const std::lock_guard lock(scene_->moving);

  // Edits do not outlive a scene, but the user's options do.
  edited_ = *shown_.edited;
  if (elsewhere || edited_.settings == readSettings_) ownSky_ = edited_.sky;
  subject_ = subjectOf(scene());
  takeOptions(last->scene, elsewhere);

  // A scene that was read again keeps the camera and the time.
  if (!elsewhere) {
    if (scene().cameraPath.empty()) pathTime_.reset();
    const Timeline before = settings_.timeline;
    settings_.timeline = timelineOf(scene(), {std::nullopt, before.animation});
    settings_.timeline.seconds = std::min(before.seconds, settings_.timeline.length);
    settings_.timeline.playing = settings_.timeline.there && before.playing;
    say("the scene was read again");
    return;
  }

  // Another scene begins at its first camera and at its own time.
  watch(opening_);
  opening_.clear();
  forgetRays();
  savedSettings_ = readSettings_ = edited_.settings;

  control_ = CameraControl(scene().cameras.front(), cruisingSpeed(scene()));
  show(control_.camera());
  pathTime_.reset();
  followed_ = 0;

  settings_.timeline = timelineOf(scene(), {});
  restSeconds_ = 0;
  say("opened " + sceneName_);
  opened();
}

void Session::show(const Camera& camera) { control_.set(camera, boundsToOrbit(subject_, camera)); }

void Session::fitView(const ImageSize& window) {
  if (!control_.orbits()) return jumpToNumber(0);
  control_.fit(static_cast<double>(window.width) / std::max(window.height, 1));
  jump(control_.camera());
}

// Returns the command that makes the view shown with these options.
std::string Session::command(const RenderOptions& options) const {
  if (shown_.scene->isMade) return "# The scene was made by a program: no command renders it.";
  const std::lock_guard lock(shown_.scene->moving);
  return renderCommand(sceneName_, options_.common, shown_, options);
}

// Returns the options of the picture shown; for a view that is not sharp yet, those that it will
// have when it is.
RenderOptions Session::viewOptions() const {
  RenderOptions options = shown_.options;
  if (!isComplete()) {
    options.size = windowPixels();
    options.spp = settings_.options.spp;
  }
  return options;
}

void Session::expose(float step) {
  float& exposure = settings_.options.exposure.ev;
  exposure = std::clamp(exposure + step, -kExposureLimit, kExposureLimit);
  restSeconds_ = 0;
  say(formatted("exposure %+.2f EV", static_cast<double>(exposure)));
}

void Session::showNextView() {
  const std::size_t next = (static_cast<std::size_t>(settings_.view) + 1) % kDebugViewNames.size();
  settings_.view = static_cast<DebugView>(next);
  restSeconds_ = 0;
  say(std::string("view: ") + kDebugViewNames[next] +
      (showsReference(settings_.view) ? ", traced at rest" : ""));
}

void Session::playOrPause() {
  Timeline& timeline = settings_.timeline;
  if (timeline.there) {
    timeline.playing = !timeline.playing;
  } else if (scene().cameraPath.empty()) {
    say("nothing moves in this scene, and it has no camera path");
  } else if (pathTime_) {
    pathTime_.reset();
  } else {
    pathTime_ = scene().cameraPath.front().time;
  }
}

void Session::forgetRays() {
  picked_.reset();
  queried_.reset();
  rays_ = RayPick();
  settings_.rays = RayView();
}

void Session::jumpToNumber(std::size_t number) {
  const std::vector<Camera>& cameras = scene().cameras;
  if (number >= cameras.size()) {
    say("the scene has " + std::to_string(cameras.size()) + " cameras");
    return;
  }

  jump(whit::cameraAt(scene(), number, settings_.timeline.seconds));
  followed_ = number;
  say("camera " + cameras[number].name);
}

void Session::jump(const Camera& camera) {
  show(camera);
  followed_.reset();
  pathTime_.reset();
  restSeconds_ = 0;
}

void Session::pick(int x, int y) {
  if (!shown_.scene) return;

  RayQuery query;
  query.picture.camera = shown_.request.camera;
  query.picture.options.size = windowPixels();
  query.x = x;
  query.y = y;

  // The answer also selects the surface and its strongest light in the scene's tab.
  picked_ = query;
  settings_.rays.lines = true;
  selects_ = true;
}

void Session::open(const std::string& name) {
  opening_ = name;
  load({name, {}, {}});  // settings belong to the scene that has them
}

}  // namespace whit::view
