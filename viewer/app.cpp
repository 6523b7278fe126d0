#include "viewer/app.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cli/interrupt.h"
#include "core/error.h"
#include "io/image_file.h"
#include "io/paths.h"
#include "viewer/motion.h"

namespace whit::view {

namespace {

constexpr double kIdleSeconds = 0.25;    // between looks at the scene file
constexpr double kWatchSeconds = 0.5;    // the same, at least
constexpr double kLongestSeconds = 0.1;  // of one step: a stall does not make the camera leap
constexpr double kMessageSeconds = 4;

std::filesystem::file_time_type timeOf(const std::filesystem::path& file) {
  std::error_code error;  // a file that is just being replaced is not an error
  return std::filesystem::last_write_time(file, error);
}

bool sameSettings(const PanelSettings& a, const PanelSettings& b) {
  return a.exposure == b.exposure && a.toneCurve == b.toneCurve && a.disable == b.disable;
}

}  // namespace

App::App(const ViewOptions& options, std::shared_ptr<const cli::OpenScene> scene,
         std::optional<ScriptPlayer> script, Window& window)
    : options_(options),
      scene_(scene),
      script_(std::move(script)),
      window_(window),
      thread_(scene, options.common, &Window::wake),
      control_(chooseCamera(scene->scene, options.common.render), cruisingSpeed(scene->scene)),
      resolution_(options.rate, options.common.render.spp),
      sceneFile_(findScene(parseSceneName(options.scene).file)),
      sceneFileTime_(timeOf(sceneFile_)),
      lastTick_(std::chrono::steady_clock::now()) {
  settings_.rate = resolution_.rate();
  settings_.exposure = options.common.render.exposure;
  settings_.toneCurve = options.common.render.toneCurve;
  settings_.disable = options.common.render.disable;
}

void App::run() {
  while (!window_.closing()) {
    window_.poll(waitSeconds());
    const double seconds = tick();
    ScriptPlayer::Step step;
    if (script_) {
      window_.input = Input();  // a script is the only user
      step = script_->next(sharp_, window_.input);
      if (step.quit) return;
    }
    handleKeys();
    restSeconds_ = moveCamera(seconds) ? 0 : restSeconds_ + seconds;
    watchSceneFile(seconds);
    fetchFrame();
    askForFrame();
    draw(step.screenshot);
    window_.input.endFrame();
    messageSeconds_ -= seconds;
  }
}

double App::waitSeconds() const {
  if (script_) return thread_.busy() ? kScriptSecondsPerFrame : 0;
  const bool active = !window_.input.held.empty() || pathTime_ || restSeconds_ < kSettleSeconds;
  return active ? 1 / resolution_.rate() : kIdleSeconds;
}

double App::tick() {
  if (script_) return kScriptSecondsPerFrame;
  const auto now = std::chrono::steady_clock::now();
  const double seconds = std::chrono::duration<double>(now - lastTick_).count();
  lastTick_ = now;
  return std::min(seconds, kLongestSeconds);
}

bool App::moveCamera(double seconds) {
  if (pathTime_) {
    flyPath(seconds);
    return true;
  }
  return control_.step(motionOf(window_.input), seconds);
}

void App::flyPath(double seconds) {
  const std::vector<Keyframe>& path = scene().cameraPath;
  *pathTime_ += seconds;
  if (*pathTime_ > path.back().time) *pathTime_ = path.front().time;
  control_.set(cameraAt(path, *pathTime_));
}

void App::watchSceneFile(double seconds) {
  watchSeconds_ += seconds;
  if (watchSeconds_ < kWatchSeconds) return;
  watchSeconds_ = 0;
  const auto time = timeOf(sceneFile_);
  if (time == sceneFileTime_ || time == std::filesystem::file_time_type::min()) return;
  sceneFileTime_ = time;
  reload();
}

void App::reload() {
  ++reloads_;
  restSeconds_ = 0;
  error_.clear();
  thread_.reload(options_.scene);
  say("reading the scene again");
}

void App::fetchFrame() {
  const std::string error = thread_.takeError();
  if (!error.empty()) fail(error);
  if (!thread_.take(shown_)) return;
  if (shown_.scene != scene_) {
    scene_ = shown_.scene;
    if (scene().cameraPath.empty()) pathTime_.reset();
    say("the scene was read again");
  }
  const FrameRequest& request = shown_.request;
  resolution_.learn(shown_.stats.frameMs,
                    static_cast<double>(request.size.width) * request.size.height * request.spp);
  if (!request.interruptible) panel_.remember(shown_.stats);
  window_.upload(shown_.film.display);
}

FrameRequest App::requestFor(const Sharpness& sharpness, bool still) const {
  const auto side = [&](int pixels) {
    return std::max(1, static_cast<int>(std::lround(pixels * sharpness.scale)));
  };
  const ImageSize window = window_.pixels();
  FrameRequest request;
  request.camera = control_.camera();
  request.size = {side(window.width), side(window.height)};
  request.spp = sharpness.spp;
  request.exposure = settings_.exposure;
  request.toneCurve = settings_.toneCurve;
  request.disable = settings_.disable;
  request.reloads = reloads_;
  request.interruptible = still;
  return request;
}

void App::askForFrame() {
  sharp_ = false;
  const ImageSize window = window_.pixels();
  if (window.width < 1 || window.height < 1) return;
  resolution_.setRate(settings_.rate);
  const bool still = restSeconds_ >= kSettleSeconds;
  if (!still) resolution_.restartSharpening();
  const double pixels = static_cast<double>(window.width) * window.height;
  FrameRequest request =
      requestFor(still ? resolution_.still() : resolution_.moving(pixels), still);
  while (still && shown_.scene && samePicture(request, shown_.request)) {
    if (!resolution_.sharpen()) {
      sharp_ = !thread_.busy();
      break;
    }
    request = requestFor(resolution_.still(), true);
  }
  if (asked_ && samePicture(request, *asked_)) return;
  asked_ = request;
  thread_.ask(request);
}

void App::draw(const std::string& screenshot) {
  window_.begin();
  const PanelSettings before = settings_;
  if (settings_.shown && shown_.scene) panel_.draw(shown_, control_.speed(), settings_);
  if (!sameSettings(before, settings_)) restSeconds_ = 0;
  if (!error_.empty()) {
    if (!Panel::drawError(error_)) error_.clear();
  } else if (settings_.shown && messageSeconds_ > 0) {
    Panel::drawMessage(message_);
  }
  window_.end();
  if (!screenshot.empty()) {
    const cli::WriteScope scope;
    writePng(screenshot, window_.readPixels(), {});
  }
  window_.present();
}

void App::say(const std::string& message) {
  message_ = message;
  messageSeconds_ = kMessageSeconds;
}

void App::fail(const std::string& error) {
  if (script_) throw Error(ExitStatus::checkFailed, error);
  std::fprintf(stderr, "whit-view: %s\n", error.c_str());
  error_ = error;
}

}  // namespace whit::view
