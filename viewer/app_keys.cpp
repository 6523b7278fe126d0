// The actions of keys and mouse.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string_view>

#include "bake/move_scene.h"
#include "core/formatted.h"
#include "viewer/app.h"
#include "viewer/view_files.h"

namespace whit::view {

namespace {

constexpr float kExposureStep = 0.25f, kExposureLimit = 64;

std::string cameraFile(const Scene& scene) { return scene.name + "-camera.json"; }

// GLFW's codes of letters are their ASCII codes.
bool flies(int key) {
  return key < 128 && std::string_view("WASDQE").find(static_cast<char>(key)) != std::string::npos;
}

constexpr KeyHelp kHelp[] = {{"W A S D, Q E", "fly; down and up"},
                             {"Shift", "four times as fast"},
                             {"wheel", "speed"},
                             {"left drag, arrows", "look around"},
                             {"right drag", "orbit"},
                             {"click; T", "the rays of that pixel; their lines, or not"},
                             {"I", "what the pixel under the pointer holds, or not"},
                             {"1 ... 9", "cameras of the scene"},
                             {"Space", "fly the camera path"},
                             {"P", "play or pause what moves"},
                             {"+ -", "finer, coarser pixels"},
                             {"[ ]", "exposure"},
                             {"F", "full screen"},
                             {"H", "this panel"},
                             {"V", "depth, normals and other views"},
                             {"N", "more samples at rest, or not"},
                             {"M", "measure what each knob and effect costs"},
                             {"X", "against the reference; drag the line"},
                             {"C", "print and copy the view as whit render makes it"},
                             {"F12", "save PNG, EXR, camera and command"},
                             {"F5 F9", "save, restore the camera"},
                             {"R", "reload the scene"},
                             {"Ctrl+S", "save what was edited as a scene file"},
                             {"drop a file", "open it; an HDR or EXR image as the sky"},
                             {"Esc", "quit"}};

}  // namespace

std::span<const KeyHelp> keyHelp() { return kHelp; }

CameraMotion App::motionOf(const Input& input) {
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
  motion.lookX = input.lookX;
  motion.lookY = input.lookY;
  motion.orbitX = input.orbitX;
  motion.orbitY = input.orbitY;
  motion.wheel = input.wheel;
  return motion;
}

void App::handleInput() {
  Input& input = window_.input;
  const bool looks = input.lookX != 0 || input.lookY != 0;
  if (settings_.compare == CompareMode::split && shown_.comparison && looks) {
    split_ = std::clamp(split_ + input.lookX / std::max(window_.pixels().width, 1), 0.0, 1.0);
    input.lookX = input.lookY = 0;
    showPicture();
  }
  const bool dragged =
      input.lookX != 0 || input.lookY != 0 || input.orbitX != 0 || input.orbitY != 0;
  if (dragged) pathTime_.reset();
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
  if (const auto click = window_.takeClick()) pick(*click);
  if (!input.dropped.empty()) openFile(input.dropped.front());
}

void App::servePanel() {
  try {
    if (std::exchange(settings_.saveScene, false)) saveScene();
    if (std::exchange(settings_.timeline.another, false)) changeAnimation();
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
    const Sharpness full{resolution_.largestScale(), settings_.options.spp, kDepthLimit};
    options.size = requestFor(full, true).options.size;
    options.spp = full.spp;
    options.depth = settings_.options.depth;
  }
  return options;
}

void App::handleKey(int key) {
  const std::map<int, std::function<void()>> actions{
      {GLFW_KEY_ESCAPE, [&] { window_.close(); }},
      {GLFW_KEY_F, [&] { window_.toggleFullScreen(); }},
      {GLFW_KEY_H, [&] { settings_.shown = !settings_.shown; }},
      {GLFW_KEY_R, [&] { reload(); }},
      {GLFW_KEY_F12, [&] { savePicture(); }},
      {GLFW_KEY_C, [&] { printView(); }},
      {GLFW_KEY_LEFT_BRACKET, [&] { expose(-kExposureStep); }},
      {GLFW_KEY_RIGHT_BRACKET, [&] { expose(kExposureStep); }},
      {GLFW_KEY_EQUAL, [&] { stepScale(1); }},  // many keyboards have plus there, with Shift
      {GLFW_KEY_KP_ADD, [&] { stepScale(1); }},
      {GLFW_KEY_MINUS, [&] { stepScale(-1); }},
      {GLFW_KEY_KP_SUBTRACT, [&] { stepScale(-1); }},
      {GLFW_KEY_V, [&] { showNextView(); }},
      {GLFW_KEY_X, [&] { compareNext(); }},
      {GLFW_KEY_N,
       [&] {
         settings_.supersample = !settings_.supersample;
         say(settings_.supersample ? "supersamples at rest" : "no more samples at rest");
       }},
      {GLFW_KEY_M,
       [&] {
         settings_.measureKnobs = true;
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
      {GLFW_KEY_F5,
       [&] {
         writeCamera(cameraFile(scene()), control_.camera());
         say("saved the camera as " + cameraFile(scene()));
       }},
      {GLFW_KEY_F9,
       [&] {
         jump(readCamera(cameraFile(scene())));
         say("camera of " + cameraFile(scene()));
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
  say("saved " + view::savePicture(shown_, command(shown_.options)) + " (.png, .exr, .json)");
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
                                           control_.camera(), viewOptions());
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

void App::stepScale(int steps) {
  resolution_.stepLargestScale(steps);
  restSeconds_ = 0;
  say("largest scale " + std::to_string(std::lround(100 * resolution_.largestScale())) + " %");
}

void App::showNextView() {
  const std::size_t next = (static_cast<std::size_t>(settings_.view) + 1) % kDebugViewNames.size();
  settings_.view = static_cast<DebugView>(next);
  restSeconds_ = 0;
  say(std::string("view: ") + kDebugViewNames[next]);
}

void App::compareNext() {
  settings_.compare = settings_.compare == CompareMode::off     ? CompareMode::split
                      : settings_.compare == CompareMode::split ? CompareMode::heatMap
                                                                : CompareMode::off;
  showPicture();
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
  RayQuery query;
  query.picture.camera = shown_.request.camera;
  query.picture.options.size = window_.pixels();
  const auto [x, y] = window_.pixelAt(place);
  query.x = x, query.y = y;
  picked_ = query;
  settings_.rays.lines = true;
  selects_ = true;
  if (settings_.tabShown != "scene") settings_.tab = "rays";
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
  control_.set(camera);
  followed_.reset();
  pathTime_.reset();
  restSeconds_ = 0;
}

}  // namespace whit::view
