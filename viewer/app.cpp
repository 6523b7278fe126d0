#include "viewer/app.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "viewer/overlay.h"
#include "viewer/ray_panel.h"

namespace whit::view {

namespace {

constexpr double kIdleSeconds = 0.25;     // longest wait for events, between looks at the file
constexpr double kUndrawnSeconds = 0.05;  // longest time without drawing while a picture is due
// ImGui answers to an event within four frames: the first shows it, the second what it opened or
// changed, and in the others the tab and then the panel fit their contents.
constexpr int kFramesToAnswer = 4;

}  // namespace

// The size of the scene's picture is known only when it has been read; until then the window has a
// default size.
App::App(const ViewOptions& options, ScriptedUser* scripted)
    : options_(options),
      scripted_(scripted),
      shown_{readKeptSettings()},
      fitted_(sizeFor(Scene())),
      window_("whit", fitted_),
      session_(options, nullptr, &Window::wake) {
  if (shown_.panel) shown_.over = Over::panel;
  if (!options.scene.empty()) session_.open(options.scene);
}

KeptSettings App::kept() const {
  KeptSettings kept = shown_;
  kept.panel = shown_.over == Over::panel;
  // A size that the user has not chosen is not kept, so that the next scene is fitted anew.
  if (!window_.isFullScreen() && window_.size() != fitted_) kept.window = window_.size();
  return kept;
}

// Returns the size of a window that shows the scene: the one asked for, or else the largest with
// the scene's aspect that has room on the screen.
ImageSize App::sizeFor(const Scene& scene) const {
  const ImageSize room = Display::room(shown_.window);
  const double scale = std::min(static_cast<double>(room.width) / scene.width,
                                static_cast<double>(room.height) / scene.height);
  const auto scaled = [&](int side) { return std::max(static_cast<int>(side * scale), 1); };
  return options_.common.render.size.value_or(ImageSize{scaled(scene.width), scaled(scene.height)});
}

void App::run() {
  while (step()) {
    if (!window_.closing()) continue;
    if (mayLoseEdits("press Esc again")) return;
    window_.setClosing(false);
  }
}

bool App::step() {
  window_.poll(waitSeconds());
  const bool fresh = session_.fetchFrame();
  window_.poll(0);  // the next picture includes what the user did until this one came
  followScene();
  tellErrors();
  const double seconds = tick();

  // A script takes the place of the user's events.
  if (scripted_) window_.input = Input();
  if (scripted_ && !awaitsScene()) {
    if (!scripted_->act(session_.state().sharp, window_.input, shown_)) return false;
    if (!shown_.supersample) session_.endSupersampling();
  }

  // The next picture is requested first, so that it is traced while this one is drawn.
  session_.setWindow(window_.pixels(), window_.size().height, window_.scale());
  handleInput();
  session_.advance(seconds);
  if (savesPicture_ && session_.isComplete()) act("save-picture");
  tellErrors();

  if (fresh) showPicture();
  if (worthDrawing(fresh, seconds)) draw();
  window_.input.endFrame();
  return true;
}

double App::waitSeconds() const {
  if (scripted_) {
    return session_.isBusy() || awaitsScene() ? ScriptedUser::kSecondsPerFrame : 0;
  }
  if (drawAgain_ > 0) return 0;
  if (session_.isCommitted()) return kUndrawnSeconds;  // no request is taken until it is finished

  // While something moves the loop keeps the frame rate; otherwise events wake it.
  const bool active = !window_.input.held.empty() || session_.isActive();
  return active ? 1 / session_.rate() : kIdleSeconds;
}

// While a picture is under way this thread waits for it rather than draw the last one again.
bool App::worthDrawing(bool fresh, double seconds) {
  undrawnSeconds_ += seconds;
  drawAgain_ = window_.input.happened ? kFramesToAnswer : std::max(drawAgain_ - 1, 0);
  const bool awaited = session_.isCommitted() && undrawnSeconds_ < kUndrawnSeconds;
  const bool wanted = fresh || drawAgain_ > 0 || scripted_;
  if (awaited && !wanted) return false;

  undrawnSeconds_ = 0;
  return true;
}

double App::tick() {
  if (scripted_) return ScriptedUser::kSecondsPerFrame;
  return std::exchange(sinceTick_, Stopwatch()).ms() / 1000;
}

// Names another scene in the title and in the list of recent ones. The first one gives the window
// its size, and a hint that stays until a key or a click.
void App::followScene() {
  const ViewState& state = session_.state();
  if (state.sceneName == sceneName_) return;
  if (sceneName_.empty()) {
    fitted_ = sizeFor(state.scene->scene);
    window_.resize(fitted_);
    hints_ = true;
    session_.say("H: the keys, P: the panel. Drag to turn, the wheel goes forward",
                 std::numeric_limits<double>::infinity());
  }

  sceneName_ = state.sceneName;
  rememberRecent(sceneName_, shown_.recent);
  window_.setTitle("whit: " + state.scene->scene.name);
}

void App::tellErrors() {
  const ViewState& state = session_.state();
  if (std::exchange(errors_, state.errors) == state.errors) return;
  if (scripted_ && !scripted_->survivesErrors()) {
    throw Error(state.status, state.error);
  }
  std::fprintf(stderr, "whit-view: %s\n", printable(state.error).c_str());
}

// Fills the window with the frame.
void App::showPicture() {
  const ViewState& state = session_.state();
  if (state.unfinished) {
    window_.upload(state.unfinished->display, state.unfinished->request.window);
  } else {
    window_.upload(state.shown.film.display, state.shown.request.window);
  }
}

void App::draw() {
  window_.begin();
  const ViewState& state = session_.state();

  // Widgets add lines for the session to `said`, which are carried out once everything is drawn.
  std::vector<std::string> said;
  const float bottom = drawBottom(said);
  if (session_.choosesScene() && !session_.isReading()) drawScenes(shown_.recent, said);
  if (session_.showsScene()) {
    if (shown_.lines) drawRayLines(state.rays, state.shown.request.camera, panel_.pointedAt());
    drawOver(bottom, said);
    inspectPointed();
  }

  window_.end();
  if (scripted_) scripted_->drawn();
  window_.present();
  for (const std::string& line : said) act(line);
}

// Draws the time bar, errors, messages and the status, from the bottom of the window upwards.
// Returns the top of what it drew.
float App::drawBottom(std::vector<std::string>& said) const {
  const ViewState& state = session_.state();
  auto bottom = static_cast<float>(window_.size().height);
  if (shown_.words) bottom = drawTimeline(state.timeline, bottom, said);
  if (!state.error.empty()) {
    bottom = drawError(state.error, bottom, said);
  } else if (const std::string text = session_.notice(); shown_.words && !text.empty()) {
    bottom = drawMessage(text, bottom);
  }

  const bool showsStatus = shown_.over == Over::panel || state.shown.debug;
  if (!shown_.words || !session_.showsScene() || !showsStatus) return bottom;
  return drawStatus(state, bottom);
}

void App::drawOver(float bottom, std::vector<std::string>& said) {
  const ViewState& state = session_.state();
  if (shown_.over == Over::cameras) drawCameras(state, said);
  if (shown_.over == Over::keys) drawKeys(bottom);
  if (shown_.over != Over::panel) return;

  const SceneChange change = panel_.draw(state, bottom, shown_, said);
  if (!change.settings.empty()) session_.edit(change.settings, change.edited);
}

void App::inspectPointed() const {
  const TracedFrame& frame = session_.state().shown;
  const bool somebodyPoints = !scripted_ || window_.input.pointer;
  if (!shown_.words || !frame.debug || !somebodyPoints) return;

  const auto at = window_.pointed();
  if (!at) return;
  const std::string text = inspect(frame, window_.pixels(), window_.pixelAt(*at));
  drawInspection(text, at->x, at->y);
}

}  // namespace whit::view
