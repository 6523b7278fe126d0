#include "viewer/app.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "bake/edit_scene.h"
#include "core/error.h"
#include "core/option_table.h"
#include "core/text.h"
#include "io/paths.h"

namespace whit::view {

namespace {

constexpr double kIdleSeconds = 0.25;     // longest wait for events, then the file is looked at
constexpr double kLongestSeconds = 0.1;   // longest step: a stall does not make the camera leap
constexpr double kUndrawnSeconds = 0.05;  // longest time without drawing while a picture is due
constexpr double kMessageSeconds = 4;
// ImGui answers to an event within three frames: the first shows it, the second what it opened or
// changed, and in the third windows fit their contents.
constexpr int kFramesToAnswer = 3;

std::filesystem::file_time_type timeOf(const std::filesystem::path& file) {
  std::error_code error;  // a file that is just being replaced is not an error
  return std::filesystem::last_write_time(file, error);
}

}  // namespace

App::App(const ViewOptions& options, const std::shared_ptr<cli::OpenScene>& scene, Window& window,
         const KeptSettings& kept, ScriptedUser* scripted)
    : options_(options),
      scene_(scene),
      scripted_(scripted),
      window_(window),
      thread_(scene, options.common, &Window::wake),
      control_(chooseCamera(scene->scene, options.common.render), cruisingSpeed(scene->scene)),
      resolution_(options.rate, options.common.render.spp),
      own_(cli::optionsFor(scene->scene, options.common)),
      read_(withoutEdits(scene)),
      edit_(read_),
      traced_(read_) {
  static_cast<KeptSettings&>(settings_) = kept;
  settings_.tab = kept.tabShown;
  watch(options.scene);
  settings_.rate = resolution_.rate();
  settings_.options = own_;
  settings_.view = options.view;
  settings_.timeline = timelineOf(scene->scene, options.common.load.instant);
  const Camera start = control_.camera();
  show(start);
  say(control_.orbits() ? "H: help. Drag to orbit, Shift to pan, wheel to move closer"
                        : "H: help. Drag to look around, W A S D to walk");
  messageSeconds_ = std::numeric_limits<double>::infinity();  // until a key or a click
  for (std::size_t i = 0; i < scene->scene.cameras.size() && !followed_; ++i) {
    if (sameView(scene->scene.cameras[i], start)) followed_ = i;
  }
}

void App::run() {
  while (!window_.closing() && step()) {
  }
}

bool App::step() {
  window_.poll(waitSeconds());
  const bool fresh = fetchFrame();
  window_.poll(0);  // the next picture includes what the user did until this one came
  const double seconds = tick();
  if (scripted_) {
    window_.input = Input();
    if (!scripted_->act(sharp_, window_.input, settings_)) return false;
  }
  handleInput();
  servePanel();
  const bool moved = moveCamera(seconds), played = play(seconds);
  restSeconds_ = moved || played ? 0 : restSeconds_ + seconds;
  watchSceneFile();
  followRays();
  askForFrame();  // before drawing, which the next picture need not wait for
  if (fresh) showPicture();
  if (worthDrawing(fresh, seconds)) draw();
  window_.input.endFrame();
  messageSeconds_ -= seconds;
  clickSeconds_ += seconds;
  return true;
}

double App::waitSeconds() const {
  if (scripted_) return thread_.busy() ? ScriptedUser::kSecondsPerFrame : 0;
  if (drawAgain_ > 0) return 0;
  if (thread_.committed()) return kUndrawnSeconds;  // no request is taken until it is finished
  const bool active = !window_.input.held.empty() || pathTime_ || settings_.timeline.playing ||
                      restSeconds_ < kSettleSeconds;
  return active ? 1 / resolution_.rate() : kIdleSeconds;
}

// While a picture is under way this thread waits for it rather than draw the last one again.
bool App::worthDrawing(bool fresh, double seconds) {
  undrawnSeconds_ += seconds;
  drawAgain_ = window_.input.happened ? kFramesToAnswer : std::max(drawAgain_ - 1, 0);
  const bool awaited = thread_.committed() && undrawnSeconds_ < kUndrawnSeconds;
  const bool wanted = fresh || drawAgain_ > 0 || scripted_;
  if (awaited && !wanted) return false;
  undrawnSeconds_ = 0;
  return true;
}

double App::tick() {
  if (scripted_) return ScriptedUser::kSecondsPerFrame;
  const double seconds = std::exchange(sinceTick_, Stopwatch()).ms() / 1000;
  return std::min(seconds, kLongestSeconds);
}

bool App::moveCamera(double seconds) {
  if (pathTime_) {
    flyPath(seconds);
    return true;
  }
  const bool moved = control_.step(motionOf(window_.input), seconds);
  if (moved) followed_.reset();
  return moved;
}

bool App::play(double seconds) {
  if (!settings_.timeline.step(seconds)) return false;
  followCamera();
  return true;
}

// Follows a camera that moves until the user moves the view.
void App::followCamera() {
  if (!followed_ || !settings_.timeline.there) return;
  show(whit::cameraAt(scene(), *followed_, settings_.timeline.seconds));
}

void App::flyPath(double seconds) {
  const std::vector<Keyframe>& path = scene().cameraPath;
  *pathTime_ += seconds;
  if (*pathTime_ > path.back().time) *pathTime_ = path.front().time;
  show(cameraAt(path, *pathTime_));
}

bool App::fetchFrame() {
  bool answered = false;
  const std::string error = thread_.takeError();
  if (!error.empty()) {
    opening_.clear();
    // The options and edits of the picture that is shown are known to work.
    if (shown_.scene) settings_.options = shown_.request.options;
    edit_ = traced_;
    fail(error);
  }
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
    const bool elsewhere = !opening_.empty();
    takeScene();
    if (elsewhere) return false;  // the picture is from the camera of the other scene
  }
  const FrameRequest& request = shown_.request;
  if (settings_.options.exposure.automatic) settings_.options.exposure = request.options.exposure;
  if (request.edits != tracedEdits_ && request.edits == edits_) {
    tracedEdits_ = edits_;
    traced_ = edit_;
  }
  if (request.view == settings_.view) resolution_.learn(shown_.stats.frameMs, samplesOf(request));
  resolution_.setSampled(shown_.sampled);
  panel_.remember(shown_);
  constexpr double kNewest = 0.2;  // weight of the newest picture
  const double ms = std::exchange(sincePicture_, Stopwatch()).ms();
  pictureMs_ = request.interruptible ? 0
               : pictureMs_ > 0      ? std::lerp(pictureMs_, ms, kNewest)
                                     : 1000 / resolution_.rate();
  if (shown_.measured == 1) settings_.measureKnobs = false;
  return true;
}

// Fills the window with the frame.
void App::showPicture() {
  if (!shown_.scene) return;
  if (unfinished_) {
    window_.upload(unfinished_->display, unfinished_->request.window);
  } else {
    window_.upload(shown_.film.display, shown_.request.window);
  }
}

FrameRequest App::requestFor(const Sharpness& sharpness, bool still) const {
  const auto side = [&](int pixels) {
    return std::max(1, static_cast<int>(std::lround(pixels * sharpness.scale)));
  };
  const bool finest = sharpness.scale >= 1;
  FrameRequest request;
  request.window = window_.pixels();
  request.camera = control_.camera();
  request.options = settings_.options;
  request.options.size = ImageSize{side(request.window.width), side(request.window.height)};
  request.spp = sharpness.spp;
  request.coarse = !finest;
  request.view = settings_.view;
  request.measureKnobs = still && finest && settings_.measureKnobs;
  request.reloads = reloads_;
  request.edits = edits_;
  request.seconds = settings_.timeline.time();
  request.interruptible = still;
  return request;
}

// More samples would blur what is looked into.
bool App::supersamples() const {
  return settings_.supersample && settings_.view == DebugView::none && !settings_.measureKnobs;
}

FrameRequest App::movingRequest(const ImageSize& window) {
  stillFor_.reset();
  const double pixels = static_cast<double>(window.width) * window.height;
  return requestFor(resolution_.moving(pixels), false);
}

// Returns the next step at rest, or the first one when the picture shows something new.
FrameRequest App::stillRequest(const ImageSize& window) {
  FrameRequest request = requestFor(resolution_.still(supersamples()), true);
  if (!stillFor_ || !sameSubject(request, *stillFor_)) {
    const bool shown = shown_.scene && sameSubject(request, shown_.request);
    const double scale =
        shown ? static_cast<double>(shown_.request.options.size->width) / window.width : 0;
    resolution_.startSharpening(static_cast<double>(window.width) * window.height, scale);
    stillFor_ = request;
    request = requestFor(resolution_.still(supersamples()), true);
  }
  while (shown_.scene && samePicture(request, shown_.request)) {
    if (!resolution_.sharpen(supersamples())) {
      sharp_ = !thread_.busy();
      break;
    }
    request = requestFor(resolution_.still(supersamples()), true);
  }
  return request;
}

// Asks for the rays of the picked pixel again when anything but the viewpoint has changed.
void App::followRays() {
  if (settings_.rays.forget) forgetRays();
  if (std::exchange(settings_.rays.fromAside, false) && rays_.scene) jump(rays_.aside);
  if (!picked_) return;
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

void App::askForFrame() {
  sharp_ = false;
  const ImageSize window = window_.pixels();
  if (window.width < 1 || window.height < 1) return;
  resolution_.setRate(settings_.rate);
  resolution_.setSpp(settings_.options.spp);
  // A new window size counts as motion, so that the first picture for it comes at once.
  if (std::exchange(windowSize_, window) != window) restSeconds_ = 0;
  const FrameRequest request =
      restSeconds_ >= kSettleSeconds ? stillRequest(window) : movingRequest(window);
  if (asked_ && samePicture(request, *asked_)) return;
  if (thread_.ask(request)) asked_ = request;
}

void App::drawPanel() {
  if (!settings_.shown || !shown_.scene) return;
  const PanelSettings before = settings_;
  const bool edited = panel_.draw(shown_, rays_, control_.speed(), settings_, read_.sky, edit_);
  if (drawTimeline(settings_.timeline)) {
    restSeconds_ = 0;
    followCamera();
  }
  if (edited) passOnEdit();
  if (edited || settings_.options != before.options || settings_.view != before.view) {
    restSeconds_ = 0;
  }
}

void App::passOnEdit() {
  ++edits_;
  edit_.settings = editSettings(read_, edit_);
  thread_.edit(edit_);
}

void App::inspectPointed() const {
  const bool somebodyPoints = !scripted_ || window_.input.pointer;
  if (!settings_.words || !settings_.inspects || !somebodyPoints || !shown_.scene) return;
  const auto at = window_.pointed();
  if (!at) return;
  drawInspection(inspect(shown_, window_.pixels(), window_.pixelAt(*at)), at->x, at->y);
}

void App::draw() {
  window_.begin();
  if (shown_.scene) drawRayLines(rays_, shown_.request.camera, settings_.rays);
  drawPanel();
  const bool says = settings_.words && messageSeconds_ > 0 && error_.empty();
  if (says) drawMessage(message_);
  if (shown_.scene && settings_.words && (settings_.shown || shown_.debug)) {
    drawStatus(shown_, unfinished_ ? &*unfinished_ : nullptr,
               pictureMs_ > 0 ? 1000 / pictureMs_ : 0, says);
  }
  inspectPointed();
  if (!error_.empty() && !drawError(error_)) error_.clear();
  window_.end();
  if (scripted_) scripted_->drawn();
  window_.present();
}

void App::say(const std::string& message) {
  message_ = message;
  messageSeconds_ = kMessageSeconds;
}

void App::fail(const std::string& error) {
  if (scripted_ && !scripted_->survivesErrors()) throw Error(ExitStatus::checkFailed, error);
  std::fprintf(stderr, "whit-view: %s\n", printable(error).c_str());
  error_ = error;
}

void App::watch(const std::string& scene) {
  sceneName_ = scene;
  rememberRecent(scene, settings_.recent);
  sceneFile_ = findScene(parseSceneName(scene).file);
  sceneFileTime_ = timeOf(sceneFile_);
}

void App::watchSceneFile() {
  const auto time = timeOf(sceneFile_);
  if (time == sceneFileTime_ || time == std::filesystem::file_time_type::min()) return;
  sceneFileTime_ = time;
  reload();
}

void App::load(const SceneChoice& choice, const std::string& message) {
  ++reloads_;
  restSeconds_ = 0;
  error_.clear();
  thread_.load(choice);
  say(message);
}

void App::reload() {
  if (!opening_.empty()) return open(opening_);  // sceneName_ is still that of the old scene
  load({sceneName_, scene_->settings, settings_.timeline.animation}, "reading the scene again");
}

void App::changeAnimation() {
  settings_.timeline.seconds = 0;
  reload();
}

void App::open(const std::string& name) {
  opening_ = name;
  load({name, {}, {}}, "reading " + name);  // settings belong to the scene that has them
}

// Opens a scene, or shows an image as the sky.
void App::openFile(const std::string& file) {
  const std::string extension = extensionOf(file);
  if (extension == ".hdr" || extension == ".exr") return showSky(file);
  open(file);
}

void App::showSky(const std::string& file) {
  edit_.sky = chooseSky(file);
  passOnEdit();
  restSeconds_ = 0;
  say("sky: " + file);
}

// Takes the options of the scene that was just read where the user has not changed them. The
// exposure for one scene says nothing about another.
void App::takeOptions() {
  const RenderOptions before = std::exchange(own_, cli::optionsFor(scene(), options_.common));
  for (const std::string& name : sceneOptionNames()) {
    const bool isKept = opening_.empty() || name != "exposure";
    if (isKept && optionText(settings_.options, name) != optionText(before, name)) continue;
    setOption(settings_.options, name, optionText(own_, name));
  }
}

// Called when the frame that was just fetched shows another scene, or the scene read again.
void App::takeScene() {
  scene_ = shown_.scene;
  const std::lock_guard lock(scene_->moving);
  read_ = edit_ = traced_ = withoutEdits(scene_);
  edits_ = tracedEdits_ = 0;
  takeOptions();
  if (opening_.empty()) {
    if (scene().cameraPath.empty()) pathTime_.reset();
    const Timeline before = settings_.timeline;
    settings_.timeline = timelineOf(scene(), {std::nullopt, before.animation});
    settings_.timeline.seconds = std::min(before.seconds, settings_.timeline.length);
    settings_.timeline.playing = settings_.timeline.there && before.playing;
    say("the scene was read again");
    return;
  }
  watch(opening_);
  opening_.clear();
  forgetRays();
  control_ = CameraControl(scene().cameras.front(), cruisingSpeed(scene()));
  show(control_.camera());
  pathTime_.reset();
  followed_ = 0;
  settings_.timeline = timelineOf(scene(), {});
  restSeconds_ = 0;
  window_.setTitle("whit: " + scene().name);
  say("opened " + sceneName_);
}

}  // namespace whit::view
