// The actions of keys and mouse.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <string_view>

#include "core/text.h"
#include "viewer/app.h"
#include "viewer/session/view_files.h"

namespace whit::view {

namespace {

constexpr float kExposureStep = 0.25f;

// GLFW's codes of letters are their ASCII codes.
bool flies(int key) {
  return key < 128 && std::string_view("WASDQE").find(static_cast<char>(key)) != std::string::npos;
}

constexpr KeyHelp kHelp[] = {
    {"left drag", "orbit a model; look around in a room"},
    {"middle or Shift drag", "pan"},
    {"wheel, right drag", "move closer to a model; walk forward or back in a room"},
    {"F", "fit what is looked at; first camera of a room"},
    {"Home", "first camera"},
    {"W A S D, Q E", "walk; down and up"},
    {"Shift, arrows", "four times as fast; look around"},
    {"click; T", "the rays of that pixel; their lines, or not"},
    {"1 ... 9; L", "cameras of the scene; their list"},
    {"Space", "play or pause what moves, or fly the camera path"},
    {"[ ]", "exposure"},
    {"F11", "full screen"},
    {"H", "this panel"},
    {"V", "depth, normals and other views, with the value of each pixel"},
    {"C", "print and copy the view as whit render makes it"},
    {"F12", "save PNG and EXR at full resolution, print the command"},
    {"R", "reload the scene"},
    {"Ctrl+Z", "undo the last edit"},
    {"Ctrl+S", "save what was edited as a scene file"},
    {"drop a file", "open it; an HDR or EXR image as the sky"},
    {"Esc", "close what is open; then quit"}};

}  // namespace

std::span<const KeyHelp> keyHelp() { return kHelp; }

CameraMotion App::keysAndDrags() const {
  const Input& input = window_.input;

  // A pair of opposite keys gives -1, 0 or 1.
  const auto axis = [&](int positive, int negative) {
    return static_cast<double>(input.isHeld(positive)) -
           static_cast<double>(input.isHeld(negative));
  };

  CameraMotion motion = motionOf(input, window_.size().height, window_.scale());
  motion.forward = axis(GLFW_KEY_W, GLFW_KEY_S);
  motion.right = axis(GLFW_KEY_D, GLFW_KEY_A);
  motion.up = axis(GLFW_KEY_E, GLFW_KEY_Q);
  motion.fast = input.isHeld(GLFW_KEY_LEFT_SHIFT) || input.isHeld(GLFW_KEY_RIGHT_SHIFT);
  motion.turnRight = axis(GLFW_KEY_RIGHT, GLFW_KEY_LEFT);
  motion.turnUp = axis(GLFW_KEY_UP, GLFW_KEY_DOWN);
  return motion;
}

// Shows the error if the user's action fails.
template <typename Action>
void App::attempt(const Action& action) {
  try {
    action();
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

void App::handleInput() {
  Input& input = window_.input;
  // Dragging takes the camera off the path that it flies along.
  if (input.left.any() || input.right.any() || input.middle.any()) pathTime_.reset();

  // The hint of the start stays until the first key or click.
  const auto clicked = window_.takeClick();
  const bool hinted = std::isinf(messageSeconds_);
  if (hinted && (clicked || !input.pressed.empty() || !input.commands.empty())) messageSeconds_ = 0;

  for (const int key : input.pressed) {
    if (flies(key)) pathTime_.reset();
    attempt([&] { handleKey(key); });
  }

  // These keys were pressed together with Ctrl.
  for (const int key : input.commands) {
    settings_.saveScene |= key == GLFW_KEY_S;
    if (key == GLFW_KEY_Z) undoEdit();
  }

  if (clicked) attempt([&] { click(*clicked); });
  if (!input.dropped.empty()) attempt([&] { openFile(input.dropped.front()); });
}

void App::servePanel() {
  attempt([&] {
    if (std::exchange(settings_.saveScene, false)) saveScene();
    if (std::exchange(settings_.timeline.another, false)) changeAnimation();
    if (!settings_.open.empty()) openFile(std::exchange(settings_.open, std::string()));
  });
}

void App::handleKey(int key) {
  const std::map<int, std::function<void()>> actions{
      {GLFW_KEY_ESCAPE, [&] { closeOrQuit(); }},
      {GLFW_KEY_F11, [&] { window_.toggleFullScreen(); }},
      {GLFW_KEY_H, [&] { settings_.shown = !settings_.shown; }},
      {GLFW_KEY_F, [&] { fitView(window_.size()); }},
      {GLFW_KEY_HOME, [&] { jumpToNumber(0); }},
      {GLFW_KEY_L, [&] { listsCameras_ = !listsCameras_; }},
      {GLFW_KEY_R, [&] { reload(); }},
      {GLFW_KEY_F12,
       [&] {
         savesPicture_ = true;
         holdStill();
         say("the picture is saved as soon as it has full resolution and all samples; Esc: not");
       }},
      {GLFW_KEY_C, [&] { printView(); }},
      {GLFW_KEY_LEFT_BRACKET, [&] { expose(-kExposureStep); }},
      {GLFW_KEY_RIGHT_BRACKET, [&] { expose(kExposureStep); }},
      {GLFW_KEY_V, [&] { showNextView(); }},
      {GLFW_KEY_T, [&] { settings_.rays.lines = !settings_.rays.lines; }},
      {GLFW_KEY_SPACE, [&] { playOrPause(); }},
  };

  const auto found = actions.find(key);
  if (found != actions.end()) found->second();

  // The digits show the cameras of the scene.
  if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9) {
    jumpToNumber(static_cast<std::size_t>(key - GLFW_KEY_1));
  }
}

void App::closeOrQuit() {
  if (!error_.empty()) {
    error_.clear();
  } else if (reader_.busy()) {
    reader_.giveUp();
    opening_.clear();
    say("the scene stays as it is");
  } else if (std::exchange(savesPicture_, false)) {
    say("the picture is not saved");
  } else if (listsCameras_) {
    listsCameras_ = false;
  } else if (settings_.shown) {
    settings_.shown = false;
  } else if (rays_.scene) {
    forgetRays();
  } else if (window_.isFullScreen()) {
    window_.toggleFullScreen();
  } else {
    window_.setClosing(true);
  }
}

// Asks once before edits are lost, and again after further edits.
bool App::mayQuit() {
  const std::vector<std::string>& settings = edited_.settings;
  if (settings == savedSettings_ || settings == askedAbout_) return true;
  askedAbout_ = settings;
  say("there are edits that no file has: Ctrl+S saves them, Esc once more quits without them");
  return false;
}

void App::savePicture() {
  savesPicture_ = false;
  attempt([&] {
    const std::string name = view::savePicture(shown_);
    std::printf("%s\n", command(shown_.options).c_str());
    std::fflush(stdout);

    const Image& image = shown_.film.image;
    say(formatted("saved %s.png and .exr, %d x %d, %d samples a pixel", name.c_str(), image.width,
                  image.height, shown_.request.spp));
  });
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

  // The lock keeps the animation from moving the scene while it is written.
  const std::lock_guard lock(scene_->moving);
  const SavedScene saved = view::saveScene(options_.common.load, sceneName_, shown_,
                                           control_.camera(), viewOptions(), settings_.options);
  std::printf("%s\n", saved.command.c_str());
  std::fflush(stdout);
  savedSettings_ = shown_.edited->settings;
  say("saved the scene as " + saved.file + "; the command that renders it is printed");
}

void App::click(const Input::Click& place) {
  if (!shown_.scene) return;

  const auto [x, y] = window_.pixelAt(place);
  pick(x, y);

  // The scene's tab stays, because it shows the material and the light of the pixel.
  if (!settings_.shown || settings_.tabShown != "scene") settings_.tab = "rays";
  settings_.shown = true;
  settings_.keepClear = static_cast<float>(place.x);
}

}  // namespace whit::view
