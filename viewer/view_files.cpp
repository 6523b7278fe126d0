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
#include "io/scene/json_text.h"
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

void sayNoCamera(RenderOptions& options) {
  options.camera.clear();
  forEachCameraOption([&](auto option, auto /*member*/) { (options.*option).reset(); });
}

// Names one of the scene's cameras: the same, or the first that the options can turn into it.
void sayCamera(const Scene& scene, const Camera& camera, RenderOptions& options) {
  sayNoCamera(options);
  const auto isSame = [&](const Camera& known) { return sameView(known, camera); };
  const auto canBecome = [&](Camera known) {
    forEachCameraOption([&](auto /*option*/, auto member) { known.*member = camera.*member; });
    return isSame(known);
  };
  const auto first = scene.cameras.begin(), end = scene.cameras.end();
  auto named = std::find_if(first, end, isSame);
  if (named == end) named = std::find_if(first, end, canBecome);
  if (named == end) named = first;
  if (named != first) options.camera = named->name;
  forEachCameraOption([&](auto option, auto member) {
    if (camera.*member != (*named).*member) options.*option = camera.*member;
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
  // What a preset stands for is said one by one.
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

// Whether these name a sky that the scene's folder does not hold.
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
  // Not the metadata's options: those have "auto" resolved, which can choose other instructions.
  sayCamera(shown, frame.request.camera, options);
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
  sayNoCamera(options);
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
  JsonObject object{JsonValue(document)};
  for (const char* name : {"eye", "at", "up", "fov"}) object.need(name);
  Camera camera;
  camera.name = "saved";
  readMembers(object, camera);
  if (camera.eye == camera.at) throwBadScene(file + "#/at", "expected eye and at to differ");
  return camera;
}

}  // namespace whit::view
