#include "viewer/view_files.h"

#include <algorithm>
#include <filesystem>

#include "cli/app/image_output.h"
#include "cli/app/interrupt.h"
#include "core/error.h"
#include "core/formatted.h"
#include "core/option_table.h"
#include "io/atomic_file.h"
#include "io/paths.h"
#include "io/read_file.h"
#include "io/scene/describe_scene.h"
#include "io/scene/scene_settings.h"
#include "io/scene/scene_view.h"
#include "scene/members.h"

namespace whit::view {

namespace {

constexpr int kPictureLimit = 9999;

std::string quoted(const std::string& word) {
  constexpr const char* kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/%@";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

void clearCamera(RenderOptions& options) {
  options.camera.clear();
  forEachCameraOption([&](auto option, auto /*member*/) { (options.*option).reset(); });
}

// Sets the options to one of the scene's cameras, or to the first one and the members that differ.
void setCamera(const Scene& scene, const Camera& camera, RenderOptions& options) {
  clearCamera(options);
  const auto same = std::find_if(scene.cameras.begin(), scene.cameras.end(),
                                 [&](const Camera& known) { return sameView(known, camera); });
  if (same == scene.cameras.begin()) return;
  if (same != scene.cameras.end()) {
    options.camera = same->name;
    return;
  }
  const Camera& first = scene.cameras.front();
  forEachCameraOption([&](auto option, auto member) {
    if (camera.*member != first.*member) options.*option = camera.*member;
  });
}

std::string freeName(const std::string& scene) {
  for (int i = 1; i <= kPictureLimit; ++i) {
    std::string name = scene + formatted("-%04d", i);
    const auto taken = [&](const char* extension) {
      return std::filesystem::exists(name + extension);
    };
    if (!taken(".png") && !taken(".exr") && !taken(".json")) return name;
  }
  throwIo("'" + scene + "-9999' is taken: there are too many saved pictures in this folder");
}

std::string commandWith(const std::string& scene, const std::string& picture, RenderOptions options,
                        const RenderOptions& usual) {
  // The options that a preset sets are stated one by one.
  options.quality = usual.quality;
  const auto said = pictureOptions(usual);
  std::string text = "whit render " + quoted(scene) + " -o " + quoted(picture + ".png");
  for (const auto& option : pictureOptions(options)) {
    if (std::find(said.begin(), said.end(), option) != said.end()) continue;
    const auto& [name, value] = option;
    text += " " + (name == "strict" ? "--strict" : quoted("--" + name + "=" + value));
  }
  return text;
}

// Returns whether these settings name a sky outside the scene's folder.
bool skyLeavesFolder(const std::string& scene, const std::string& shippedScenes,
                     const std::vector<std::string>& settings) {
  Json root = Json::object();
  for (const std::string& setting : settings) {
    const SceneSetting parsed = parseSceneSetting(setting);
    if (parsed.tokens == std::vector<std::string>{"sky"}) root["sky"] = parsed.value;
  }
  const auto folder = findScene(parseSceneName(scene).file, shippedScenes).parent_path();
  return movePaths(root, folder, folder);
}

}  // namespace

std::string renderCommand(const std::string& scene, const cli::CommonOptions& common,
                          const TracedFrame& frame, RenderOptions options) {
  const Scene& shown = frame.scene->scene;
  // The metadata's options have "auto" resolved, which can choose other instructions.
  setCamera(shown, frame.request.camera, options);
  if (options.size == ImageSize{shown.width, shown.height}) options.size.reset();
  RenderOptions usual;
  if (shown.isModel) applyModelDefaults(usual, {});
  std::string text = commandWith(scene, shown.name, options, usual);
  if (frame.request.seconds) text += formatted(" --time %.17g", *frame.request.seconds);
  if (frame.request.seconds && !frame.animation.empty()) {
    text += " --animation " + quoted(frame.animation);
  }
  for (const std::string& setting : frame.settings) text += " --set " + quoted(setting);
  if (!frame.sky.empty()) text += " --sky " + quoted(frame.sky);
  if (common.load.allowOutside ||
      skyLeavesFolder(scene, common.load.shippedScenes, frame.settings)) {
    text += " --allow-outside";
  }
  return text;
}

std::string commandFor(const SavedScene& saved, const Scene& scene, RenderOptions options) {
  clearCamera(options);
  if (options.size == ImageSize{scene.width, scene.height}) options.size.reset();
  const std::string name = std::filesystem::path(saved.file).stem().string();
  return commandWith(saved.file, name, options, {}) +
         (saved.leavesFolder ? " --allow-outside" : "");
}

std::string savePicture(const TracedFrame& frame, const std::string& command) {
  const cli::WriteScope scope;
  std::string name = freeName(frame.scene->scene.name);
  cli::writeImage(name + ".png", frame.film, frame.options, frame.metadata);
  cli::writeImage(name + ".exr", frame.film, frame.options, frame.metadata);
  writeCamera(name + ".json", frame.request.camera, command);
  return name;
}

void writeCamera(const std::string& file, const Camera& camera, const std::string& command) {
  Json json = describe(camera);
  if (!command.empty()) json["command"] = command;
  const cli::WriteScope scope;
  writeTextFile(file, json.dump(2) + "\n");
}

Camera readCamera(const std::string& file) {
  const JsonDocument document{file, parseJson(readTextFile(file, kJsonBytesLimit), file), {}};
  JsonObject object((JsonValue(document)));
  object.need("eye");
  object.need("at");
  object.find("command");
  Camera camera;
  camera.name = "saved";
  whit::readCamera(object, camera);
  object.finish();
  return camera;
}

}  // namespace whit::view
