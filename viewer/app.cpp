#include "viewer/app.h"

#include <algorithm>
#include <cstdio>
#include <limits>

#include "core/error.h"
#include "core/text.h"
#include "io/files.h"

namespace whit::view {

namespace {

constexpr double kIdleSeconds = 0.25;     // longest wait for events, then the file is looked at
constexpr double kLongestSeconds = 0.1;   // longest step: a stall does not make the camera leap
constexpr double kUndrawnSeconds = 0.05;  // longest time without drawing while a picture is due
// ImGui answers to an event within three frames: the first shows it, the second what it opened or
// changed, and in the third windows fit their contents.
constexpr int kFramesToAnswer = 3;

}  // namespace

App::App(const ViewOptions& options, const std::shared_ptr<OpenScene>& scene, Window& window,
         const KeptSettings& kept, ScriptedUser* scripted)
    : Session(options, scene, &Window::wake), scripted_(scripted), window_(window) {
  static_cast<KeptSettings&>(settings_) = kept;
  rememberRecent(options.scene, settings_.recent);
  settings_.tab = kept.tabShown;

  say("H: help. Drag to turn, Shift to pan, wheel to go forward, W A S D to walk");
  messageSeconds_ = std::numeric_limits<double>::infinity();  // until a key or a click
}

void App::run() {
  while (step()) {
    if (!window_.closing()) continue;
    if (mayQuit()) return;
    window_.setClosing(false);
  }
}

bool App::step() {
  window_.poll(waitSeconds());
  const bool fresh = fetchFrame();
  window_.poll(0);  // the next picture includes what the user did until this one came
  const double seconds = tick();

  // A script takes the place of the user's events.
  if (scripted_) {
    window_.input = Input();
    if (!scripted_->act(sharp_, window_.input, settings_)) return false;
  }

  // The next picture is requested first, so that it is traced while this one is drawn.
  handleInput();
  servePanel();
  advance(keysAndDrags(), seconds);
  if (savesPicture_ && isComplete()) savePicture();

  if (fresh) showPicture();
  if (worthDrawing(fresh, seconds)) draw();
  window_.input.endFrame();
  return true;
}

double App::waitSeconds() const {
  if (scripted_) return thread_.busy() ? ScriptedUser::kSecondsPerFrame : 0;
  if (drawAgain_ > 0) return 0;
  if (thread_.committed()) return kUndrawnSeconds;  // no request is taken until it is finished

  // While something moves the loop keeps the frame rate; otherwise events wake it.
  const bool active = !window_.input.held.empty() || isActive();
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

// Fills the window with the frame.
void App::showPicture() {
  if (!shown_.scene) return;
  if (unfinished_) {
    window_.upload(unfinished_->display, unfinished_->request.window);
  } else {
    window_.upload(shown_.film.display, shown_.request.window);
  }
}

void App::drawPanel() {
  if (!shown_.scene) return;
  if (settings_.words && drawTimeline(settings_.timeline)) {
    restSeconds_ = 0;
    followCamera();
  }

  if (listsCameras_) {
    const auto chosen = drawCameras(scene().cameras, followed_);
    if (chosen) jumpToNumber(*chosen);
  }

  if (!settings_.shown) return;
  const PanelSettings before = settings_;
  const std::vector<std::string> edits =
      panel_.draw(shown_, rays_, costs_, settings_, ownSky_, edited_);

  // A change resets the rest, so that the picture sharpens again from coarse to fine.
  if (!edits.empty()) edit(edits);
  if (settings_.options != before.options || settings_.view != before.view) restSeconds_ = 0;
}

void App::inspectPointed() const {
  const bool somebodyPoints = !scripted_ || window_.input.pointer;
  if (!settings_.words || !shown_.debug || !somebodyPoints) return;

  const auto at = window_.pointed();
  if (!at) return;
  drawInspection(inspect(shown_, window_.pixels(), window_.pixelAt(*at)), at->x, at->y);
}

void App::draw() {
  window_.begin();
  if (shown_.scene) drawRayLines(rays_, shown_.request.camera, settings_.rays);
  drawPanel();

  const std::string text = notice();
  const bool says = settings_.words && !text.empty() && error_.empty();
  if (says) drawMessage(text);
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

void App::fail(const std::string& error) {
  if (scripted_ && !scripted_->survivesErrors()) throw Error(ExitStatus::checkFailed, error);
  std::fprintf(stderr, "whit-view: %s\n", printable(error).c_str());
  error_ = error;
}

// Opens a scene, or shows an image as the sky.
void App::openFile(const std::string& file) {
  const std::string extension = extensionOf(file);
  if (extension == ".hdr" || extension == ".exr") {
    showSky(file);
    return;
  }
  open(file);
}

void App::showSky(const std::string& file) {
  edited_.sky = skyFrom(file);
  std::vector<std::string> settings;
  stateSky(edited_, settings);
  edit(settings);
  say("sky: " + file);
}

}  // namespace whit::view
