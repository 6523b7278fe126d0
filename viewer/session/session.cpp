#include "viewer/session/session.h"

#include <algorithm>
#include <cmath>

#include "bake/edit_scene.h"
#include "core/error.h"
#include "core/option_table.h"
#include "core/text.h"
#include "engine/open_scene.h"
#include "io/files.h"
#include "viewer/session/control.h"

namespace whit::view {

namespace {

constexpr float kExposureLimit = 64;
constexpr double kLongestStep = 0.1;  // seconds: a stall does not make the camera leap
// A drag of this length with the right button counts as a notch of the wheel.
constexpr double kPixelsPerNotch = 20;

std::shared_ptr<OpenScene> emptyScene() {
  // The scene has light, so that notice() does not explain why the picture is black.
  const Json root{{"whit", 1}, {"ambient", {{"color", 1}}}};
  const auto text = std::make_shared<const SceneText>(SceneText{"", root, {}});
  return openScene({"", text}, {}, false);
}

}  // namespace

std::vector<std::string> shippedNames() {
  std::vector<std::string> names;
  for (const auto& file : shippedScenes()) names.push_back(file.stem().string());
  return names;
}

bool isMeasuredView(FrameRequest measured, const FrameRequest& request) {
  measured.options = request.options;
  return sameSubject(measured, request);
}

void Session::rememberCosts() {
  if (!state_.shown.costs.empty()) {
    state_.costs = state_.shown.costs;
    measuredFor_ = state_.shown.request;
  } else if (!isMeasuredView(measuredFor_, state_.shown.request)) {
    state_.costs.clear();
  }
}

Session::Session(const ViewOptions& options, const std::shared_ptr<OpenScene>& scene,
                 std::function<void()> onChange)
    : Session(options, scene != nullptr, scene ? scene : emptyScene(), std::move(onChange)) {}

Session::Session(const ViewOptions& options, bool hasScene, const std::shared_ptr<OpenScene>& scene,
                 std::function<void()> onChange)
    : options_(options),
      hasScene_(hasScene),
      reader_(options.common),
      thread_(scene, options.common, std::move(onChange)),
      control_(scene->scene.cameras.front(), 1),
      resolution_(options.rate, options.common.render.spp) {
  state_.scene = scene;
  state_.edited = editedScene(*scene);
  state_.options = cli::optionsFor(scene->scene, options.common);
  clearCamera(state_.options);
  state_.view = options.view;
  enterScene(hasScene ? options.scene : "", hasScene);
}

// Begins with a scene that was not shown before: with the first one at the camera and the time of
// the command line, otherwise at its first camera and its own time.
void Session::enterScene(const std::string& name, bool isFirst) {
  isFirst_ = isFirst;
  watch(name);
  forgetRays();
  subject_ = subjectOf(scene());
  state_.ownSky = state_.edited.sky;
  savedSettings_ = readSettings_ = state_.edited.settings;
  history_ = History(present());

  const cli::CommonOptions& given = options_.common;
  state_.timeline = timelineOf(scene(), isFirst ? given.load.instant : Instant());
  if (state_.scene->isMade) state_.timeline.animations.clear();  // others would have to be read
  pathTime_.reset();
  restSeconds_ = 0;

  const std::vector<Camera>& cameras = scene().cameras;
  const Camera start = isFirst ? chooseCamera(scene(), given.render) : cameras.front();
  control_ = CameraControl(start, cruisingSpeed(scene()));
  show(start);

  // If the view is that of one of the scene's cameras, it moves with that camera.
  state_.followed.reset();
  for (std::size_t i = 0; i < cameras.size() && !state_.followed; ++i) {
    if (sameView(cameras[i], start)) state_.followed = i;
  }
}

void Session::act(const Message& message) {
  try {
    message.verb->act(*this, message);
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

void Session::act(const std::string& lines) {
  for (const Message& message : readMessages(lines)) act(message);
}

void Session::fail(const std::string& error, ExitStatus status) {
  state_.error = error;
  state_.status = status;
  ++state_.errors;
}

void Session::say(const std::string& message, double seconds) {
  state_.message = message;
  messageSeconds_ = seconds;
}

void Session::setWindow(const ImageSize& pixels, double height, double scale) {
  windowHeight_ = std::max(height, 1.0);
  dragScale_ = scale;

  // A new window size counts as motion, so that the first picture for it comes at once.
  if (std::exchange(windowSize_, pixels) != pixels) restSeconds_ = 0;
}

std::string Session::notice() const {
  std::string text;
  for (const std::string& part :
       {state_.message, reader_.text(), thread_.progress(), state_.shown.dark}) {
    if (!part.empty()) text += (text.empty() ? "" : "; ") + part;
  }
  return text;
}

void Session::advance(double elapsed) {
  const double seconds = std::min(elapsed, kLongestStep);
  heldSeconds_ += seconds;
  const bool moved = moveCamera(takeMotion(), seconds), played = play(seconds);
  restSeconds_ = moved || played ? 0 : restSeconds_ + seconds;

  watchSceneFile();
  followRays();
  askForFrame();

  messageSeconds_ -= elapsed;
  if (messageSeconds_ <= 0) state_.message.clear();
  history_.wait(elapsed);
}

bool Session::isActive() const {
  return pathTime_ || state_.timeline.playing || restSeconds_ < kSettleSeconds ||
         heldSeconds_ < kHeldSeconds || reader_.busy();
}

bool Session::isComplete() const {
  const FrameRequest& shown = state_.shown.request;
  return showsScene() && shown.options.size == shown.window && !shown.plain &&
         shown.spp >= state_.options.spp && sameSubject(shown, requestFor({}, true));
}

void Session::holdStill() {
  pathTime_.reset();
  state_.timeline.playing = false;
}

// Drags and keys that walk take the camera off the path that it flies along.
void Session::drag(Drag& sum, const Message& message) {
  sum.x += message.numbers[0];
  sum.y += message.numbers[1];
  if (sum.any()) pathTime_.reset();
}

void Session::hold(const Message& message) {
  const auto& n = message.numbers;
  held_ = {.forward = n[0],
           .right = n[1],
           .up = n[2],
           .fast = n[5] > 0,
           .turnRight = n[3],
           .turnUp = n[4]};

  if (n[0] != 0 || n[1] != 0 || n[2] != 0) pathTime_.reset();
  const bool any = std::ranges::any_of(n, [](double number) { return number != 0; });
  heldSeconds_ = any ? 0 : kHeldSeconds;
}

// Returns what keys and drags ask for, and forgets the drags.
CameraMotion Session::takeMotion() {
  if (heldSeconds_ > kHeldSeconds) held_ = CameraMotion();
  const Drags drags = std::exchange(drags_, Drags());
  CameraMotion motion = held_;

  // The left button orbits, or looks around in a room; the right one goes forward and back.
  motion.turnX = drags.left.x / dragScale_;
  motion.turnY = drags.left.y / dragScale_;
  motion.wheel = drags.wheel - drags.right.y / dragScale_ / kPixelsPerNotch;

  motion.panX = drags.middle.x / windowHeight_;
  motion.panY = drags.middle.y / windowHeight_;
  return motion;
}

bool Session::moveCamera(const CameraMotion& motion, double seconds) {
  if (pathTime_) {
    flyPath(seconds);
    return true;
  }
  const bool moved = control_.step(motion, seconds);
  if (moved) state_.followed.reset();
  return moved;
}

bool Session::play(double seconds) {
  if (!state_.timeline.step(seconds)) return false;
  followCamera();
  return true;
}

// Follows a camera that moves until the user moves the view.
void Session::followCamera() {
  if (!state_.followed || !state_.timeline.there) return;
  show(whit::cameraAt(scene(), *state_.followed, state_.timeline.seconds));
}

void Session::flyPath(double seconds) {
  const std::vector<Keyframe>& path = scene().cameraPath;

  *pathTime_ += seconds;
  if (*pathTime_ > path.back().time) *pathTime_ = path.front().time;
  show(cameraAt(path, *pathTime_));
}

// Shows an error of the tracing thread, and returns to the options of the picture that is shown,
// which are known to work.
void Session::takeTracingError() {
  const std::string error = thread_.takeError();
  if (error.empty()) return;

  if (state_.shown.scene) {
    const auto size = state_.options.size;
    state_.options = state_.shown.request.options;
    state_.options.size = size;
    history_.takeBack(present());
  }
  fail(error);
}

// Takes the answer to a pick and the samples of an unfinished picture, which are shown without a
// new frame. Returns whether there was one of them.
bool Session::takeAnswers() {
  bool answered = false;
  // An answer to an earlier pick may come after the last one.
  if (auto pick = thread_.takePick(); pick && picked_ && samePick(pick->query, *picked_)) {
    state_.rays = std::move(*pick);
    if (std::exchange(selects_, false)) {
      state_.selected = select(state_.rays);
      ++state_.selections;
    }
    answered = true;
  }
  if (auto frame = thread_.takeUnfinished()) {
    state_.unfinished = std::move(frame);
    answered = true;
  }
  return answered;
}

bool Session::fetchFrame() {
  showReadScene();
  takeTracingError();
  const bool answered = takeAnswers();
  if (!thread_.take(state_.shown)) return answered;

  state_.unfinished.reset();
  if (state_.shown.scene != state_.scene && followScene()) {
    // The picture is from the camera of the other scene, and one like it may be asked for again.
    state_.shown = TracedFrame();
    asked_.reset();
    return false;
  }

  // An automatic exposure is measured once, and then stays while the view changes.
  const FrameRequest& request = state_.shown.request;
  if (state_.options.exposure.automatic) {
    state_.options.exposure = request.options.exposure;
    history_.settleExposure(request.options.exposure);
  }

  // An edit that failed is taken back.
  if (request.edits == edits_) {
    state_.edited = *state_.shown.edited;
    history_.takeBack(present());
  }

  if (!state_.shown.warning.empty()) say("warning: " + state_.shown.warning);

  learnTimes();
  rememberCosts();
  if (state_.shown.measured == 1) state_.measures = false;
  return true;
}

// Takes over the scene of the frame that was just fetched. Returns whether it is another one.
bool Session::followScene() {
  // An edit, too, may have had the scene read again.
  const bool came = state_.shown.scene == coming_, elsewhere = came && !comingName_.empty();
  if (came) coming_.reset();

  const bool isOutdated = came && !elsewhere && edits_ != readEdits_;
  const EditedScene wanted = state_.edited;
  takeScene(elsewhere);

  // Edits that were made while the scene was read again are made in the new one as well.
  if (isOutdated) {
    state_.edited = wanted;
    history_.replace(present());
    postEdit();
  }
  return elsewhere;
}

void Session::learnTimes() {
  if (!hasScene_) return;  // the empty scene says nothing about others

  // The cost of a sample decides the resolution of the next picture in motion.
  const FrameRequest& request = state_.shown.request;
  if (request.view == viewToTrace(request.interruptible)) {
    resolution_.learn(state_.shown.stats.frameMs, samplesOf(request), request.plain);
  }
  if (!request.plain) resolution_.setNoisy(state_.shown.sampled);

  // The frame rate is shown as a mean over the last pictures in motion, the newest counting most.
  constexpr double kNewest = 0.2;  // weight of the newest picture
  const double ms = std::exchange(sincePicture_, Stopwatch()).ms();
  double& mean = state_.pictureMs;
  if (request.interruptible) {
    mean = 0;
  } else {
    mean = mean > 0 ? std::lerp(mean, ms, kNewest) : 1000 / resolution_.rate();
  }
}

FrameRequest Session::requestFor(const Sharpness& sharpness, bool still) const {
  const auto side = [&](int pixels) {
    return std::max(1, static_cast<int>(std::lround(pixels * sharpness.scale)));
  };

  FrameRequest request;
  request.window = windowSize_;
  request.camera = control_.camera();
  request.options = state_.options;
  request.options.size = ImageSize{side(request.window.width), side(request.window.height)};

  request.spp = sharpness.spp;
  // An automatic exposure is measured with all rays.
  request.plain = sharpness.plain && !state_.options.exposure.automatic;
  request.view = viewToTrace(still);
  request.measureKnobs = still && sharpness.scale >= 1 && state_.measures;

  request.reloads = reloads_;
  request.edits = edits_;
  request.seconds = state_.timeline.time();
  request.interruptible = still;
  return request;
}

// In motion the picture itself takes the place of its reference.
DebugView Session::viewToTrace(bool still) const {
  return still || !showsReference(state_.view) ? state_.view : DebugView::none;
}

// More samples would blur the values of a debug view and delay a measurement.
bool Session::supersamples() const {
  return supersample_ && state_.view == DebugView::none && !state_.measures;
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
    const bool shown = state_.shown.scene && sameSubject(request, state_.shown.request);
    const double scale =
        shown ? static_cast<double>(state_.shown.request.options.size->width) / window.width : 0;

    resolution_.startSharpening(static_cast<double>(window.width) * window.height, scale);
    stillFor_ = request;
    request = requestFor(resolution_.still(supersamples()), true);
  }

  // A step that is shown already is followed by the next one; after the last the picture is sharp.
  while (state_.shown.scene && samePicture(request, state_.shown.request)) {
    if (!resolution_.sharpen(supersamples())) {
      state_.sharp = !thread_.busy() && !reader_.busy();
      break;
    }
    request = requestFor(resolution_.still(supersamples()), true);
  }
  return request;
}

// Asks for the rays of the picked pixel again when anything but the viewpoint has changed.
void Session::followRays() {
  if (!picked_) return;

  // The query keeps the camera and the size of the pick; everything else follows the picture.
  RayQuery query = *picked_;
  query.picture.options = state_.shown.request.options;
  query.picture.options.size = picked_->picture.options.size;
  query.picture.reloads = reloads_;
  query.picture.edits = edits_;
  query.picture.seconds = state_.shown.request.seconds;

  if (queried_ && sameRays(query, *queried_)) return;
  thread_.query(query);
  queried_ = query;
}

void Session::askForFrame() {
  state_.sharp = false;
  const ImageSize window = windowSize_;
  if (window.width < 1 || window.height < 1) return;

  resolution_.setSamples(state_.options.spp, hasSampledRays(state_.options));

  const FrameRequest request =
      restSeconds_ >= kSettleSeconds ? stillRequest(window) : movingRequest(window);
  if (asked_ && samePicture(request, *asked_)) return;
  if (thread_.ask(request)) asked_ = request;
}

void Session::edit(const std::vector<std::string>& settings, const EditedScene& edited) {
  state_.edited = edited;
  addEdit(settings, state_.edited);
  postEdit();
  history_.add(present());
}

void Session::undo() {
  const std::optional<UserState> past = history_.undo();
  if (!past) {
    say("there is nothing to undo");
    return;
  }

  restSeconds_ = 0;
  state_.options = past->options;
  say("undone");

  // The members of the scene come with its next picture.
  if (past->settings == state_.edited.settings && past->givenSky == state_.edited.givenSky) return;
  state_.edited.settings = past->settings;
  state_.edited.givenSky = past->givenSky;
  postEdit();
}

void Session::postEdit() {
  ++edits_;
  restSeconds_ = 0;
  if (coming_) return;  // the scene that is shown is replaced; followScene() makes the edit
  thread_.edit({state_.scene, state_.edited.settings, state_.edited.givenSky});
}

void Session::watch(const std::string& scene) {
  state_.sceneName = scene;
  if (state_.scene->isMade) return;
  sceneFile_ = findScene(parseSceneName(scene).file, options_.common.load.shippedScenes);
  sceneFileTime_ = state_.scene->fileTime;
}

void Session::watchSceneFile() {
  const auto time = timeOf(sceneFile_);
  if (time == sceneFileTime_ || time == std::filesystem::file_time_type::min()) return;
  sceneFileTime_ = time;
  reload();
}

// The scene that is shown stays alive until the other one has been read.
void Session::load(const SceneChoice& choice) {
  state_.error.clear();
  state_.message.clear();
  readEdits_ = edits_;
  readAnimation_ = choice.animation;
  reader_.read(choice);
}

bool Session::close() {
  if (!state_.error.empty()) {
    state_.error.clear();
    return true;
  }
  if (!reader_.busy()) return false;

  reader_.giveUp();
  opening_.clear();
  if (hasScene_) say("the scene stays as it is");
  return true;
}

void Session::showReadScene() {
  try {
    std::unique_ptr<Engine> scene = reader_.take();
    if (!scene) return;

    coming_ = scene->opened();
    comingName_ = std::exchange(opening_, "");
    thread_.load(std::move(scene));
    ++reloads_;
    restSeconds_ = 0;
  } catch (const std::exception& error) {
    opening_.clear();
    // A program that cannot read its first scene ends as any other command does.
    fail(error.what(), hasScene_ ? ExitStatus::checkFailed : failureOf(error).status);
  }
}

void Session::reload() {
  const bool isOnItsWay = reader_.busy() || coming_;
  readAgain(isOnItsWay ? readAnimation_ : state_.timeline.animation);
}

void Session::readAgain(const std::string& animation) {
  // While another scene is on its way, state_.sceneName is still that of the old one.
  std::string next = opening_;
  if (next.empty() && coming_) next = comingName_;
  if (!next.empty()) {
    open(next);
    return;
  }

  if (state_.scene->isMade) {
    throwUsage("the scene was made by a program: it cannot be read again here");
  }

  // Edits stay. Only what the user has chosen may be outside the scene's folder.
  const EditedScene& edited = state_.edited;
  const bool isEdited =
      edited.settings != readSettings_ || edited.givenSky != options_.common.load.sky;
  load({state_.sceneName, edited.settings, animation,
        isEdited ? std::optional(edited.givenSky) : std::nullopt, state_.options, isFirst_});
}

void Session::setTime(double seconds) {
  Timeline& timeline = state_.timeline;
  if (!timeline.there) throwUsage("nothing moves in this scene");
  timeline.seconds = std::min(seconds, timeline.length);
  timeline.playing = false;  // a time that is set by hand stops the clock
  restSeconds_ = 0;
  followCamera();
}

void Session::chooseAnimation(const std::string& name) {
  const Timeline& timeline = state_.timeline;
  if (std::ranges::find(timeline.animations, name) == timeline.animations.end()) {
    throwUsage("no animation is called '" + name + "'");
  }

  // The time bar follows when the animation has been read.
  readAgain(name);
}

// Takes the options of the scene that was just read where the user has not changed them. The
// exposure for one scene says nothing about another.
void Session::takeOptions(const Scene& last, bool elsewhere) {
  const RenderOptions before = cli::optionsFor(last, options_.common);
  const RenderOptions own = cli::optionsFor(scene(), options_.common);
  for (const std::string& name : sceneOptionNames()) {
    const bool isKept = !elsewhere || name != "exposure";
    if (isKept && optionText(state_.options, name) != optionText(before, name)) continue;
    setOption(state_.options, name, optionText(own, name));
  }
}

// Called when the frame that was just fetched shows another scene, or the scene read again.
void Session::takeScene(bool elsewhere) {
  const std::shared_ptr<const OpenScene> last = std::exchange(state_.scene, state_.shown.scene);
  const std::lock_guard lock(state_.scene->moving);

  // Edits do not outlive a scene, but the user's options do.
  state_.edited = *state_.shown.edited;
  takeOptions(last->scene, elsewhere);
  if (elsewhere) {
    enterScene(comingName_, !std::exchange(hasScene_, true));
    say("opened " + state_.sceneName);
    return;
  }

  // A scene that was read again keeps the camera and the time.
  if (state_.edited.settings == readSettings_) state_.ownSky = state_.edited.sky;
  followSize();
  history_.replace(present());
  if (scene().cameraPath.empty()) pathTime_.reset();

  const Timeline before = state_.timeline;
  Timeline& timeline = state_.timeline;
  timeline = timelineOf(scene(), {std::nullopt, state_.scene->load.instant.animation});

  // Another animation begins at its start.
  const bool goesOn = timeline.animation == before.animation;
  timeline.seconds = goesOn ? std::min(before.seconds, timeline.length) : 0;
  timeline.playing = timeline.there && before.playing;

  // The camera that was followed may be gone, or show another view.
  if (state_.followed) {
    const std::vector<Camera>& cameras = scene().cameras;
    const std::size_t followed = *state_.followed;
    const bool stays = followed < cameras.size() &&
                       (timeline.there || sameView(cameras[followed], control_.camera()));
    if (!stays) state_.followed.reset();
  }
  say("the scene was read again");
}

// Lets the camera orbit and walk as the size of the scene asks for, if that has changed.
void Session::followSize() {
  const Box before = std::exchange(subject_, subjectOf(scene()));
  if (subject_.lower == before.lower && subject_.upper == before.upper) return;
  control_ = CameraControl(control_.camera(), cruisingSpeed(scene()));
  show(control_.camera());
}

void Session::show(const Camera& camera) { control_.set(camera, boundsToOrbit(subject_, camera)); }

void Session::fitView() {
  if (!control_.orbits()) {
    jumpToNumber(0);
    return;
  }
  control_.fit(static_cast<double>(windowSize_.width) / std::max(windowSize_.height, 1));
  jump(control_.camera());
}

std::string Session::command() const {
  const TracedFrame& shown = state_.shown;
  if (!showsScene()) return "";
  if (shown.scene->isMade) return "# The scene was made by a program: no command renders it.";

  const std::lock_guard lock(shown.scene->moving);
  return viewCommand(state_.sceneName, options_.common, shown, viewOptions());
}

// Returns the options of the picture shown; for a view that is not sharp yet, those that it will
// have when it is.
RenderOptions Session::viewOptions() const {
  RenderOptions options = state_.shown.options;
  if (!isComplete()) {
    options.size = windowSize_;
    options.spp = state_.options.spp;
  }
  return options;
}

SavedScene Session::saveScene() {
  // The lock keeps the animation from moving the scene while it is written.
  const std::lock_guard lock(state_.scene->moving);
  SavedScene saved = view::saveScene(options_.common.load, state_.sceneName, state_.shown,
                                     control_.camera(), viewOptions(), state_.options);
  savedSettings_ = state_.shown.edited->settings;
  return saved;
}

void Session::changeOptions(const RenderOptions& options) {
  state_.options = options;
  restSeconds_ = 0;
  history_.add(present());
}

void Session::chooseOption(const std::string& name, const std::string& value) {
  const std::vector<Control> controls = controlsOf(state_.options);
  if (std::ranges::find(controls, name, &Control::name) == controls.end()) {
    throwUsage("the viewer has no control for '" + name + "'");
  }
  RenderOptions next = state_.options;
  setOption(next, name, value);
  changeOptions(next);
}

void Session::chooseEffect(const std::string& name, bool on) {
  RenderOptions next = state_.options;
  parseEffects(name).forEach([&](Effect effect) {
    next.disable = on ? next.disable.without(effect) : next.disable.with(effect);
  });
  changeOptions(next);
}

void Session::choosePreset(const std::string& name) {
  RenderOptions next = state_.options;
  applyPreset(name, next);
  changeOptions(next);
}

void Session::expose(float step) {
  RenderOptions next = state_.options;
  float& ev = next.exposure.ev;
  ev = std::clamp(ev + step, -kExposureLimit, kExposureLimit);
  changeOptions(next);
  say(formatted("exposure %+.2f EV", static_cast<double>(ev)));
}

void Session::showNextView() {
  const std::size_t next = (static_cast<std::size_t>(state_.view) + 1) % kDebugViewNames.size();
  chooseView(kDebugViewNames[next]);
  say(std::string("view: ") + kDebugViewNames[next] +
      (showsReference(state_.view) ? ", traced at rest" : ""));
}

void Session::chooseView(const std::string& name) {
  parseValue(kViewOption, name, state_.view);
  restSeconds_ = 0;
}

void Session::measure() {
  state_.measures = !state_.measures;
  if (state_.measures) holdStill();  // costs are measured at rest
  restSeconds_ = 0;
}

void Session::playOrPause() {
  Timeline& timeline = state_.timeline;
  if (timeline.there) {
    timeline.playing = !timeline.playing;
  } else if (scene().cameraPath.empty()) {
    say("nothing moves in this scene, and it has no camera path");
  } else if (pathTime_) {
    pathTime_.reset();
  } else {
    pathTime_ = scene().cameraPath.front().time;
    state_.followed.reset();
  }
}

void Session::forgetRays() {
  picked_.reset();
  queried_.reset();
  state_.rays = RayPick();
  state_.selected = Selection();
}

void Session::jumpToNumber(std::size_t number) {
  const std::vector<Camera>& cameras = scene().cameras;
  if (number >= cameras.size()) {
    say("the scene has " + std::to_string(cameras.size()) + " cameras");
    return;
  }

  jump(whit::cameraAt(scene(), number, state_.timeline.seconds));
  state_.followed = number;
  say("camera " + cameras[number].name);
}

void Session::jump(const Camera& camera) {
  show(camera);
  state_.followed.reset();
  pathTime_.reset();
  restSeconds_ = 0;
}

void Session::pick(double x, double y) {
  if (!showsScene()) return;

  RayQuery query;
  query.picture.camera = state_.shown.request.camera;
  query.picture.options.size = windowSize_;
  query.x = std::min(static_cast<int>(x), windowSize_.width - 1);
  query.y = std::min(static_cast<int>(y), windowSize_.height - 1);

  // The answer also selects the surface and its strongest light in the scene's tab.
  picked_ = query;
  selects_ = true;
}

void Session::lookFromAside() {
  if (state_.rays.scene) jump(state_.rays.aside);
}

void Session::openShipped(const std::string& name) {
  if (!choosesScene()) throwUsage("a scene is open already");
  const std::vector<std::string> names = shippedNames();
  if (std::ranges::find(names, name) == names.end()) throwUsage("no shipped scene has this name");
  open(name);
}

void Session::open(const std::string& name) {
  opening_ = name;
  if (hasScene_) {
    // Settings belong to the scene that has them.
    load({.name = name, .options = state_.options, .isFirst = false});
  } else {
    const LoadOptions& given = options_.common.load;
    load({.name = name, .settings = given.settings, .animation = given.instant.animation});
  }
}

}  // namespace whit::view
