// What each key does.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cstdio>

#include "viewer/app.h"
#include "viewer/view_files.h"

namespace whit::view {

namespace {

constexpr float kExposureStep = 0.25f, kExposureLimit = 64;

std::string cameraFile(const Scene& scene) { return scene.name + "-camera.json"; }

bool flies(int key) {
  for (const int known : {GLFW_KEY_W, GLFW_KEY_A, GLFW_KEY_S, GLFW_KEY_D, GLFW_KEY_Q, GLFW_KEY_E}) {
    if (key == known) return true;
  }
  return false;
}

}  // namespace

void App::attempt(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::exception& error) {
    fail(error.what());
  }
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
    attempt([&] { handleKey(key); });
    attempt([&] { handlePictureKey(key); });
    attempt([&] { handleViewKey(key); });
  }
  if (!input.dropped.empty()) open(input.dropped.front());
}

// That makes the picture shown.
std::string App::command() const { return renderCommand(sceneName_, options_.common, shown_); }

void App::obey(const ScriptCommand& command) {
  using Kind = ScriptCommand::Kind;
  if (command.kind == Kind::resize) {
    window_.resize({static_cast<int>(command.x), static_cast<int>(command.y)});
  } else if (command.kind == Kind::minimize) {
    window_.minimize();
  } else if (command.kind == Kind::restore) {
    window_.restore();
  } else if (command.kind == Kind::panel) {
    settings_.tab = command.file;
  } else {
    surviveErrors_ = command.kind == Kind::showErrors;
  }
}

void App::jump(const Camera& camera) {
  control_.set(camera);
  pathTime_.reset();
  restSeconds_ = 0;
  latency_.changed(serial_ + 1);
}

// Keys about window and files.
void App::handleKey(int key) {
  switch (key) {
    case GLFW_KEY_ESCAPE:
      window_.close();
      break;
    case GLFW_KEY_F:
      window_.toggleFullScreen();
      break;
    case GLFW_KEY_H:
      settings_.shown = !settings_.shown;
      break;
    case GLFW_KEY_R:
      reload();
      break;
    case GLFW_KEY_F12:
      if (!shown_.scene) break;
      say("saved " + savePicture(shown_, command()) +
          (shown_.request.view == DebugView::none
               ? " (.png, .exr, .json)"
               : " (.png: the view; .exr, .json: the picture below it)"));
      break;
    case GLFW_KEY_C:
      if (!shown_.scene) break;
      std::printf("%s\n", command().c_str());
      std::fflush(stdout);
      say("printed the view as options of whit render");
      break;
    default:
      break;
  }
}

// Keys about how the picture is made and shown.
void App::handlePictureKey(int key) {
  const auto expose = [&](float step) {
    float& exposure = settings_.options.exposure;
    exposure = std::clamp(exposure + step, -kExposureLimit, kExposureLimit);
    restSeconds_ = 0;
    char text[32];
    std::snprintf(text, sizeof text, "exposure %+.2f EV", static_cast<double>(exposure));
    say(text);
  };
  const auto scale = [&](int step) {
    resolution_.stepLargestScale(step);
    restSeconds_ = 0;
    say("largest scale " + std::to_string(std::lround(100 * resolution_.largestScale())) + " %");
  };
  switch (key) {
    case GLFW_KEY_LEFT_BRACKET:
      expose(-kExposureStep);
      break;
    case GLFW_KEY_RIGHT_BRACKET:
      expose(kExposureStep);
      break;
    case GLFW_KEY_EQUAL:  // the plus of many keyboards, without Shift
    case GLFW_KEY_KP_ADD:
      scale(1);
      break;
    case GLFW_KEY_MINUS:
    case GLFW_KEY_KP_SUBTRACT:
      scale(-1);
      break;
    case GLFW_KEY_V: {
      const std::size_t next = static_cast<std::size_t>(settings_.view) + 1;
      settings_.view = static_cast<DebugView>(next % kDebugViewNames.size());
      restSeconds_ = 0;
      say(std::string("view: ") + kDebugViewNames[static_cast<std::size_t>(settings_.view)]);
      break;
    }
    case GLFW_KEY_N:
      settings_.supersample = !settings_.supersample;
      say(settings_.supersample ? "supersamples at rest" : "no more samples at rest");
      break;
    case GLFW_KEY_M:
      settings_.measureKnobs = true;
      say("measuring what each knob and effect costs");
      break;
    case GLFW_KEY_X:
      settings_.compare = settings_.compare == CompareMode::off     ? CompareMode::split
                          : settings_.compare == CompareMode::split ? CompareMode::heatMap
                                                                    : CompareMode::off;
      showPicture();
      break;
    default:
      break;
  }
}

// Keys that choose the viewpoint.
void App::handleViewKey(int key) {
  if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9) {
    const auto number = static_cast<std::size_t>(key - GLFW_KEY_1);
    if (number >= scene().cameras.size()) {
      say("the scene has " + std::to_string(scene().cameras.size()) + " cameras");
      return;
    }
    jump(scene().cameras[number]);
    say("camera " + scene().cameras[number].name);
  } else if (key == GLFW_KEY_SPACE) {
    if (scene().cameraPath.empty()) {
      say("the scene has no camera path");
    } else if (pathTime_) {
      pathTime_.reset();
    } else {
      pathTime_ = scene().cameraPath.front().time;
    }
  } else if (key == GLFW_KEY_F5) {
    writeCamera(cameraFile(scene()), control_.camera());
    say("saved the camera as " + cameraFile(scene()));
  } else if (key == GLFW_KEY_F9) {
    jump(readCamera(cameraFile(scene())));
    say("camera of " + cameraFile(scene()));
  }
}

}  // namespace whit::view
