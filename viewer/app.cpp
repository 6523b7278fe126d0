#include "viewer/app.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/interrupt.h"
#include "core/error.h"
#include "core/printable.h"
#include "io/image_file.h"
#include "viewer/panel.h"

namespace whit::view {

namespace {

constexpr double kIdleSeconds = 0.25;     // between looks at the scene file
constexpr double kLongestSeconds = 0.1;   // of one step: a stall does not make the camera leap
constexpr double kUndrawnSeconds = 0.05;  // at most, while a picture is awaited
constexpr double kMessageSeconds = 4;

}  // namespace

App::App(const ViewOptions& options, const std::shared_ptr<cli::OpenScene>& scene,
         std::optional<ScriptPlayer> script, Window& window)
    : options_(options),
      scene_(scene),
      script_(std::move(script)),
      surviveErrors_(!script_),
      window_(window),
      thread_(scene, options.common, &Window::wake),
      control_(chooseCamera(scene->scene, options.common.render), cruisingSpeed(scene->scene)),
      resolution_(options.rate, options.common.render.spp),
      read_{scene, scene->scene.materials, scene->scene.lights, {}},
      edit_(read_),
      traced_(read_) {
  watch(options.scene);
  settings_.rate = resolution_.rate();
  settings_.options = options.common.render;
  settings_.view = options.view;
}

void App::run() {
  while (!window_.closing() && step()) {
  }
}

bool App::step() {
  window_.poll(waitSeconds());
  const bool fresh = fetchFrame();
  window_.poll(0);  // once more: the next picture has what the user did before this one was there
  const double seconds = tick();
  ScriptStep step;
  if (script_) {
    window_.input = Input();  // a script is the only user
    step = script_->next(sharp_, window_.input);
    if (step.quit) return false;
    obey(step);
  }
  handleInput();
  restSeconds_ = moveCamera(seconds) ? 0 : restSeconds_ + seconds;
  watchSceneFile(seconds);
  askForFrame();  // before anything is drawn, which the next picture need not wait for
  if (fresh) showPicture();
  if (worthDrawing(step, fresh, seconds)) draw(step.screenshot);
  window_.input.endFrame();
  messageSeconds_ -= seconds;
  return true;
}

double App::waitSeconds() const {
  if (script_) return thread_.busy() ? kScriptSecondsPerFrame : 0;
  if (thread_.committed()) return kUndrawnSeconds;  // nothing can be asked for until it is there
  const bool active = !window_.input.held.empty() || pathTime_ || restSeconds_ < kSettleSeconds;
  return active ? 1 / resolution_.rate() : kIdleSeconds;
}

// A picture under way should find this thread waiting for it, not drawing the one before once more.
bool App::worthDrawing(const ScriptStep& step, bool fresh, double seconds) {
  undrawnSeconds_ += seconds;
  const bool awaited = thread_.committed() && undrawnSeconds_ < kUndrawnSeconds;
  const bool wanted = fresh || !step.screenshot.empty() || window_.input.pointer;
  if (awaited && !wanted) return false;
  undrawnSeconds_ = 0;
  return true;
}

double App::tick() {
  if (script_) return kScriptSecondsPerFrame;
  const double seconds = std::exchange(sinceTick_, Stopwatch()).ms() / 1000;
  return std::min(seconds, kLongestSeconds);
}

bool App::moveCamera(double seconds) {
  if (pathTime_) {
    flyPath(seconds);
    return true;
  }
  const bool moved = control_.step(motionOf(window_.input), seconds);
  if (moved) latency_.changed(serial_ + 1);
  return moved;
}

void App::flyPath(double seconds) {
  const std::vector<Keyframe>& path = scene().cameraPath;
  *pathTime_ += seconds;
  if (*pathTime_ > path.back().time) *pathTime_ = path.front().time;
  control_.set(cameraAt(path, *pathTime_));
}

bool App::fetchFrame() {
  const std::string error = thread_.takeError();
  if (!error.empty()) {
    opening_.clear();
    // Back to what is known to work.
    if (shown_.scene) settings_.options = shown_.request.options;
    edit_ = traced_;
    fail(error);
  }
  if (!thread_.take(shown_)) return false;
  latency_.fetched(shown_.request.serial);
  if (shown_.scene != scene_) {
    const bool elsewhere = !opening_.empty();
    takeScene();
    if (elsewhere) return false;  // seen from where the camera was in the other scene
  }
  const FrameRequest& request = shown_.request;
  if (settings_.options.exposure.automatic) settings_.options.exposure = request.options.exposure;
  if (request.edits != tracedEdits_ && request.edits == edits_) {
    tracedEdits_ = edits_;
    traced_ = edit_;
  }
  if (request.view == settings_.view) resolution_.learn(shown_.stats.frameMs, samplesOf(request));
  panel_.remember(shown_);
  if (shown_.request.measureKnobs) settings_.measureKnobs = false;
  return true;
}

// What the window is filled with: the frame, or how it compares.
void App::showPicture() {
  if (!shown_.scene) return;
  const DisplayImage& frame = shown_.film.display;
  const std::optional<Comparison>& comparison = shown_.comparison;
  if (!comparison || settings_.compare == CompareMode::off) {
    window_.upload(frame);
  } else if (settings_.compare == CompareMode::heatMap && comparison->complete()) {
    window_.upload(comparison->heatMap);
  } else {
    const int split = static_cast<int>(std::lround(split_ * frame.width));
    window_.upload(splitPicture(frame, *comparison, split));
  }
}

FrameRequest App::requestFor(const Sharpness& sharpness, bool still) const {
  const auto side = [&](int pixels) {
    return std::max(1, static_cast<int>(std::lround(pixels * sharpness.scale)));
  };
  const ImageSize window = window_.pixels();
  FrameRequest request;
  request.camera = control_.camera();
  request.options = settings_.options;
  request.options.size = ImageSize{side(window.width), side(window.height)};
  request.spp = sharpness.spp;
  request.view = settings_.view;
  request.withReference = still && settings_.compare != CompareMode::off;
  request.measureKnobs = still && settings_.measureKnobs;
  request.reloads = reloads_;
  request.edits = edits_;
  request.interruptible = still;
  return request;
}

void App::askForFrame() {
  sharp_ = false;
  const ImageSize window = window_.pixels();
  if (window.width < 1 || window.height < 1) return;
  resolution_.setRate(settings_.rate);
  resolution_.setSpp(settings_.options.spp);
  const bool still = restSeconds_ >= kSettleSeconds;
  // More samples would only blur what is to be compared or looked into.
  const bool refine = settings_.supersample && settings_.compare == CompareMode::off &&
                      settings_.view == DebugView::none && !settings_.measureKnobs;
  if (!still || !refine) resolution_.restartSharpening();
  const double pixels = static_cast<double>(window.width) * window.height;
  const double waitMs = thread_.busy() && asked_ && asked_->interruptible ? kBandMs : 0;
  FrameRequest request =
      requestFor(still ? resolution_.still() : resolution_.moving(pixels, waitMs), still);
  while (still && shown_.scene && samePicture(request, shown_.request)) {
    if (!refine || !resolution_.sharpen()) {
      sharp_ = !thread_.busy();
      break;
    }
    request = requestFor(resolution_.still(), true);
  }
  if (asked_ && samePicture(request, *asked_)) return;
  request.serial = serial_ + 1;
  if (!thread_.ask(request)) return;
  ++serial_;
  asked_ = request;
}

void App::drawPanel() {
  if (!settings_.shown || !shown_.scene) return;
  const PanelSettings before = settings_;
  const bool edited = panel_.draw(shown_, control_.speed(), settings_, edit_);
  if (edited) {
    ++edits_;
    edit_.settings = editSettings(read_, edit_);
    thread_.edit(edit_);
  }
  if (edited || settings_.options != before.options || settings_.view != before.view) {
    restSeconds_ = 0;
  }
  if (settings_.compare != before.compare) showPicture();
}

void App::draw(const std::string& screenshot) {
  window_.begin();
  if (settings_.compare != CompareMode::off && shown_.scene) {
    drawComparison(shown_, settings_.compare, split_, settings_.shown);
  }
  drawPanel();
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
  latency_.presented();
}

void App::say(const std::string& message) {
  message_ = message;
  messageSeconds_ = kMessageSeconds;
}

void App::fail(const std::string& error) {
  if (!surviveErrors_) throw Error(ExitStatus::checkFailed, error);
  std::fprintf(stderr, "whit-view: %s\n", printable(error).c_str());
  error_ = error;
}

}  // namespace whit::view
