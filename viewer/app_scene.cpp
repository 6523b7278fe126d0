// Opens scenes, and reads the scene again when its file changes.
#include "io/paths.h"
#include "viewer/app.h"

namespace whit::view {

namespace {

constexpr double kWatchSeconds = 0.5;  // shortest time between looks at the scene's file

std::filesystem::file_time_type timeOf(const std::filesystem::path& file) {
  std::error_code error;  // a file that is just being replaced is not an error
  return std::filesystem::last_write_time(file, error);
}

}  // namespace

void App::watch(const std::string& scene) {
  sceneName_ = scene;
  sceneFile_ = findScene(parseSceneName(scene).file);
  sceneFileTime_ = timeOf(sceneFile_);
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
  if (!opening_.empty()) return open(opening_);  // sceneName_ is still that of the old scene
  ++reloads_;
  restSeconds_ = 0;
  error_.clear();
  thread_.load({sceneName_, scene_->settings, settings_.timeline.animation});
  say("reading the scene again");
}

void App::changeAnimation() {
  settings_.timeline.seconds = 0;
  reload();
  say("animation " + settings_.timeline.animation);
}

void App::open(const std::string& name) {
  ++reloads_;
  restSeconds_ = 0;
  error_.clear();
  opening_ = name;
  thread_.load({name, {}, {}});  // settings belong to the scene that they were given with
  say("reading " + name);
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

// Called when the frame that was just fetched shows another scene, or the scene read again.
void App::takeScene() {
  scene_ = shown_.scene;
  const std::lock_guard lock(scene_->moving);
  read_ = edit_ = traced_ = withoutEdits(scene_);
  edits_ = tracedEdits_ = 0;
  if (opening_.empty()) {
    if (scene().cameraPath.empty()) pathTime_.reset();
    const Timeline before = settings_.timeline;
    settings_.timeline = timelineOf(scene(), {std::nullopt, before.animation});
    settings_.timeline.seconds = std::min(before.seconds, settings_.timeline.length);
    settings_.timeline.playing = settings_.timeline.there && before.playing;
    settings_.timeline.loops = before.loops;
    say("the scene was read again");
    return;
  }
  watch(opening_);
  opening_.clear();
  if (!options_.common.given.contains("exposure")) {
    settings_.options.exposure = {0, scene().isModel};
  }
  forgetRays();
  control_ = CameraControl(scene().cameras.front(), cruisingSpeed(scene()));
  pathTime_.reset();
  followed_ = 0;
  settings_.timeline = timelineOf(scene(), {});
  restSeconds_ = 0;
  window_.setTitle("whit: " + scene().name);
  say("opened " + sceneName_);
}

}  // namespace whit::view
