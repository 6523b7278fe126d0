// The actions of keys and mouse.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string_view>

#include "bake/edit_scene.h"
#include "core/text.h"
#include "viewer/app.h"
#include "viewer/view_files.h"

namespace whit::view {

namespace {

constexpr float kExposureStep = 0.25f, kExposureLimit = 64;
constexpr double kPixelsPerNotch = 20;  // dragged with the right button to move closer to a model
constexpr double kDoubleClickSeconds = 0.35, kDoubleClickPixels = 6;

// GLFW's codes of letters are their ASCII codes.
bool flies(int key) {
  return key < 128 && std::string_view("WASDQE").find(static_cast<char>(key)) != std::string::npos;
}

constexpr KeyHelp kHelp[] = {{"left drag", "orbit a model; look around in a room"},
                             {"middle or Shift drag", "pan"},
                             {"right drag", "move closer to a model; orbit in a room"},
                             {"wheel", "move closer to a model; speed in a room"},
                             {"Home, double click", "fit the model; first camera of a room"},
                             {"W A S D, Q E", "walk; down and up"},
                             {"Shift, arrows", "four times as fast; look around"},
                             {"click; T", "the rays of that pixel; their lines, or not"},
                             {"I", "what the pixel under the pointer holds, or not"},
                             {"1 ... 9", "cameras of the scene"},
                             {"Space", "fly the camera path"},
                             {"P", "play or pause what moves"},
                             {"[ ]", "exposure"},
                             {"F", "full screen"},
                             {"H", "this panel"},
                             {"V", "depth, normals and other views"},
                             {"N", "more samples at rest, or not"},
                             {"M", "measure what each knob and effect costs"},
                             {"C", "print and copy the view as whit render makes it"},
                             {"F12", "save PNG and EXR, print the command"},
                             {"R", "reload the scene"},
                             {"Ctrl+S", "save what was edited as a scene file"},
                             {"drop a file", "open it; an HDR or EXR image as the sky"},
                             {"Esc", "quit"}};

}  // namespace

std::span<const KeyHelp> keyHelp() { return kHelp; }

CameraMotion App::motionOf(const Input& input) const {
  const auto axis = [&](int positive, int negative) {
    return static_cast<double>(input.isHeld(positive)) -
           static_cast<double>(input.isHeld(negative));
  };
  CameraMotion motion;
  motion.forward = axis(GLFW_KEY_W, GLFW_KEY_S);
  motion.right = axis(GLFW_KEY_D, GLFW_KEY_A);
  motion.up = axis(GLFW_KEY_E, GLFW_KEY_Q);
  motion.fast = input.isHeld(GLFW_KEY_LEFT_SHIFT) || input.isHeld(GLFW_KEY_RIGHT_SHIFT);
  motion.turnRight = axis(GLFW_KEY_RIGHT, GLFW_KEY_LEFT);
  motion.turnUp = axis(GLFW_KEY_UP, GLFW_KEY_DOWN);
  motion.wheel = input.wheel;
  const double scale = 1 / window_.scale();
  const bool orbits = control_.orbits();
  const Input::Drag& orbit = orbits ? input.left : input.right;
  motion.orbitX = orbit.x * scale;
  motion.orbitY = orbit.y * scale;
  if (orbits) {
    motion.wheel -= input.right.y * scale / kPixelsPerNotch;
  } else {
    motion.lookX = input.left.x * scale;
    motion.lookY = input.left.y * scale;
  }
  const double height = std::max(window_.size().height, 1);
  motion.panX = input.middle.x / height;
  motion.panY = input.middle.y / height;
  return motion;
}

void App::show(const Camera& camera) { control_.set(camera, boundsToOrbit(scene(), camera)); }

void App::fitView() {
  if (!control_.orbits()) return jumpToNumber(0);
  const ImageSize window = window_.size();
  control_.fit(static_cast<double>(window.width) / std::max(window.height, 1));
  jump(control_.camera());
}

void App::handleInput() {
  Input& input = window_.input;
  if (input.left.any() || input.right.any() || input.middle.any()) pathTime_.reset();
  const auto click = window_.takeClick();
  const bool hinted = std::isinf(messageSeconds_);
  if (hinted && (click || !input.pressed.empty() || !input.commands.empty())) messageSeconds_ = 0;
  for (const int key : input.pressed) {
    if (flies(key)) pathTime_.reset();
    try {
      handleKey(key);
    } catch (const std::exception& error) {
      fail(error.what());
    }
  }
  for (const int key : input.commands) {
    settings_.saveScene |= key == GLFW_KEY_S;
    if (key == GLFW_KEY_C) printView();
  }
  if (click) pick(*click);
  if (!input.dropped.empty()) openFile(input.dropped.front());
}

void App::servePanel() {
  try {
    if (std::exchange(settings_.saveScene, false)) saveScene();
    if (std::exchange(settings_.timeline.another, false)) changeAnimation();
    if (!settings_.open.empty()) openFile(std::exchange(settings_.open, std::string()));
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

// Returns the command that makes the view shown with these options.
std::string App::command(const RenderOptions& options) const {
  const std::lock_guard lock(shown_.scene->moving);
  return renderCommand(sceneName_, options_.common, shown_, options);
}

// Returns the options of the picture shown; for a view that is not sharp yet, those that it will
// have when it is.
RenderOptions App::viewOptions() const {
  RenderOptions options = shown_.options;
  if (shown_.request.coarse || !shown_.request.interruptible) {
    const Sharpness full{1, settings_.options.spp};
    options.size = requestFor(full, true).options.size;
    options.spp = full.spp;
  }
  return options;
}

void App::handleKey(int key) {
  const std::map<int, std::function<void()>> actions{
      {GLFW_KEY_ESCAPE, [&] { window_.close(); }},
      {GLFW_KEY_F, [&] { window_.toggleFullScreen(); }},
      {GLFW_KEY_H, [&] { settings_.shown = !settings_.shown; }},
      {GLFW_KEY_HOME, [&] { fitView(); }},
      {GLFW_KEY_R, [&] { reload(); }},
      {GLFW_KEY_F12, [&] { savePicture(); }},
      {GLFW_KEY_C, [&] { printView(); }},
      {GLFW_KEY_LEFT_BRACKET, [&] { expose(-kExposureStep); }},
      {GLFW_KEY_RIGHT_BRACKET, [&] { expose(kExposureStep); }},
      {GLFW_KEY_V, [&] { showNextView(); }},
      {GLFW_KEY_N,
       [&] {
         settings_.supersample = !settings_.supersample;
         say(settings_.supersample ? "supersamples at rest" : "no more samples at rest");
       }},
      {GLFW_KEY_M,
       [&] {
         settings_.measureKnobs = settings_.shown = true;
         settings_.tab = "knobs";
         say("measuring what each knob and effect costs");
       }},
      {GLFW_KEY_I, [&] { settings_.inspects = !settings_.inspects; }},
      {GLFW_KEY_T, [&] { settings_.rays.lines = !settings_.rays.lines; }},
      {GLFW_KEY_SPACE, [&] { startOrStopPath(); }},
      {GLFW_KEY_P,
       [&] {
         if (!settings_.timeline.there) return say("nothing moves in this scene");
         settings_.timeline.playing = !settings_.timeline.playing;
       }},
  };
  const auto found = actions.find(key);
  if (found != actions.end()) found->second();
  if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9) {
    jumpToNumber(static_cast<std::size_t>(key - GLFW_KEY_1));
  }
}

void App::savePicture() {
  if (!shown_.scene) return;
  const std::string name = view::savePicture(shown_);
  std::printf("%s\n", command(shown_.options).c_str());
  std::fflush(stdout);
  say("saved " + name + ".png and .exr; the command that renders them is printed");
}

void App::printView() {
  if (!shown_.scene) return;
  const std::string text = command(viewOptions());
  std::printf("%s\n", text.c_str());
  std::fflush(stdout);
  window_.setClipboard(text);
  say(formatted("the view as whit render --spp %d makes it: printed, and in the clipboard",
                viewOptions().spp));
}

void App::saveScene() {
  if (!shown_.scene) return;
  const std::lock_guard lock(scene_->moving);
  const SavedScene saved = view::saveScene(options_.common.load, sceneName_, *scene_, edit_,
                                           control_.camera(), viewOptions(), settings_.options);
  std::printf("%s\n", saved.command.c_str());
  std::fflush(stdout);
  say("saved the scene as " + saved.file + "; the command that renders it is printed");
}

void App::expose(float step) {
  float& exposure = settings_.options.exposure.ev;
  exposure = std::clamp(exposure + step, -kExposureLimit, kExposureLimit);
  restSeconds_ = 0;
  say(formatted("exposure %+.2f EV", static_cast<double>(exposure)));
}

void App::showNextView() {
  const std::size_t next = (static_cast<std::size_t>(settings_.view) + 1) % kDebugViewNames.size();
  settings_.view = static_cast<DebugView>(next);
  restSeconds_ = 0;
  say(std::string("view: ") + kDebugViewNames[next]);
}

void App::startOrStopPath() {
  if (scene().cameraPath.empty()) {
    say("the scene has no camera path");
  } else if (pathTime_) {
    pathTime_.reset();
  } else {
    pathTime_ = scene().cameraPath.front().time;
  }
}

void App::pick(const Input::Click& place) {
  if (!shown_.scene) return;
  const double slack = kDoubleClickPixels * window_.scale();
  const bool again = clicked_ && clickSeconds_ < kDoubleClickSeconds &&
                     std::abs(place.x - clicked_->x) + std::abs(place.y - clicked_->y) <= slack;
  if (again) {
    clicked_.reset();
    forgetRays();
    settings_.shown = shownBeforeClick_;
    return fitView();
  }
  clicked_ = place;
  clickSeconds_ = 0;
  shownBeforeClick_ = settings_.shown;
  RayQuery query;
  query.picture.camera = shown_.request.camera;
  query.picture.options.size = window_.pixels();
  const auto [x, y] = window_.pixelAt(place);
  query.x = x, query.y = y;
  picked_ = query;
  settings_.rays.lines = true;
  selects_ = true;
  if (!settings_.shown || settings_.tabShown != "scene") settings_.tab = "rays";
  settings_.shown = true;
  settings_.keepClear = static_cast<float>(place.x);
}

void App::forgetRays() {
  picked_.reset();
  queried_.reset();
  rays_ = RayPick();
  settings_.rays = RayView();
}

void App::jumpToNumber(std::size_t number) {
  const std::vector<Camera>& cameras = scene().cameras;
  if (number >= cameras.size()) {
    say("the scene has " + std::to_string(cameras.size()) + " cameras");
    return;
  }
  jump(whit::cameraAt(scene(), number, settings_.timeline.seconds));
  followed_ = number;
  say("camera " + cameras[number].name);
}

void App::jump(const Camera& camera) {
  show(camera);
  followed_.reset();
  pathTime_.reset();
  restSeconds_ = 0;
}

}  // namespace whit::view
