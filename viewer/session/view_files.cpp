#include "viewer/session/view_files.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "command_line/program.h"
#include "core/error.h"
#include "core/option_table.h"
#include "core/text.h"
#include "io/files.h"
#include "io/scene/scene_sections.h"
#include "io/scene/scene_settings.h"
#include "output/image_output.h"
#include "scene/members.h"

namespace whit::view {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kSettingsBytesLimit = 1 << 16;

// A command with a time begins with the camera that flies the path, if no other is named.
bool fliesPath(const TracedFrame& frame) {
  return frame.request.seconds && !frame.scene->scene.cameraPath.empty();
}

// Returns `from` with the members of `to` that options can give.
Camera turned(Camera from, const Camera& to) {
  // --fov and --ortho replace the aspect as well.
  const bool staysFitted = from.fov == to.fov && from.orthographicHeight == to.orthographicHeight;
  if (!staysFitted) from.aspect = 0;
  forEachCameraOption([&](auto /*option*/, auto member) { from.*member = to.*member; });
  return from;
}

// Returns the scene's camera that equals this one, or the first that options can turn into it for a
// picture of this aspect ratio. Returns null if there is none.
const Camera* cameraFor(const Camera& camera, const Scene& scene, double aspect) {
  const Camera seen = fitted(camera, aspect);
  const auto isSame = [&](const Camera& known) { return sameView(known, camera); };
  const auto canBecome = [&](const Camera& known) {
    return sameView(fitted(turned(known, camera), aspect), seen);
  };

  const auto first = scene.cameras.begin(), end = scene.cameras.end();
  auto named = std::find_if(first, end, isSame);
  if (named == end) named = std::find_if(first, end, canBecome);
  return named == end ? nullptr : &*named;
}

// Returns a name that no camera of the scene has.
std::string nameOfView(const Scene& scene) {
  const std::vector<std::string> names = namesIn(scene.cameras);
  std::string name = "view";
  for (int i = 2; std::ranges::find(names, name) != names.end(); ++i) name = concat("view ", i);
  return name;
}

// Sets the options that make the camera of the frame from one of the scene's. Returns the setting
// that adds it to the scene where none can become it; empty otherwise.
std::string setCamera(const TracedFrame& frame, RenderOptions& options) {
  const Scene& scene = frame.scene->scene;
  const ImageSize size = options.size.value();
  const double aspect = static_cast<double>(size.width) / size.height;

  // No option can give an aspect. A camera with one is described by what the picture shows of it,
  // which a camera without an aspect shows as well.
  Camera camera = frame.request.camera;
  const Camera* named = cameraFor(camera, scene, aspect);
  if (!named) {
    camera = fitted(camera, aspect);
    named = cameraFor(camera, scene, aspect);
  }
  if (!named) {
    options.camera = nameOfView(scene);
    Json added = describe(frame.request.camera);
    movePoints(added, scene.origin);
    return "/cameras/" + options.camera + "=" + added.dump();
  }

  const bool isFirst = named == &scene.cameras.front();
  if (!isFirst || fliesPath(frame)) options.camera = named->name;

  // Members that differ from those of the named camera become options of their own.
  forEachCameraOption([&](auto option, auto member) {
    using Option = typename std::remove_cvref_t<decltype(options.*option)>::value_type;
    if (camera.*member == named->*member) return;
    options.*option = optionOf<Option>(camera.*member, scene.origin);
  });

  // The reader fits the supplied camera of a model anew to a picture of another shape.
  if (!scene.isModel || !isFirst) return "";
  if (1.0 * size.width * scene.height == 1.0 * size.height * scene.width) return "";
  options.eye = optionOf<Vec3d>(camera.eye, scene.origin);
  options.at = optionOf<Vec3d>(camera.at, scene.origin);
  return "";
}

// Returns the first name that is free, of name(1), name(2) and so on.
template <typename Name>
std::string freeName(const Name& name, const std::vector<const char*>& extensions) {
  constexpr int kLimit = 9999;
  for (int i = 1; i <= kLimit; ++i) {
    const auto taken = [&](const char* extension) { return fs::exists(name(i) + extension); };
    if (std::ranges::none_of(extensions, taken)) return name(i);
  }
  throwIo("'" + name(kLimit) + "' is taken: there are too many saved files in this folder");
}

std::string renderOf(const std::string& scene, const std::string& picture) {
  return "whit render " + quoted(scene) + " -o " + quoted(picture + ".png");
}

// `text` is the command without options.
std::string commandWith(std::string text, RenderOptions options, const RenderOptions& usual) {
  // The options that a preset sets are stated one by one.
  options.quality = usual.quality;
  forEachOption(options, [&](const OptionSpec& spec, const auto& field) {
    const std::string name(spec.name), value = formatValue(spec, field);
    if (!spec.changesPicture || value == optionText(usual, name)) return;
    text += " " + (name == "strict" ? "--strict" : quoted("--" + name + "=" + value));
  });
  return text;
}

// Returns true if these settings name a sky outside the scene's folder.
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

// `document` is the scene's file with all settings.
Json editedFile(JsonDocument document, const SceneName& name, const EditedScene& edited) {
  for (const auto& [parameter, value] : name.parameters) {
    document.root["parameters"][parameter] = value;
  }
  if (!edited.givenSky.empty()) document.root["sky"] = describe(edited.sky);
  return std::move(document.root);
}

// Makes a scene that holds the model. Its cameras, lights and sky were supplied or come from the
// model's own file, so the scene has to state them.
Json sceneOfModel(const fs::path& path, const Scene& scene, const EditedScene& edited) {
  Json root{{"whit", 1}, {"size", {scene.width, scene.height}}};

  std::vector<std::string> names;
  for (const Camera& camera : scene.cameras) names.push_back(camera.name);
  names = distinctNames(names);
  root["cameras"] = Json::object();
  for (std::size_t i = 0; i < names.size(); ++i) {
    root["cameras"][names[i]] = describe(scene.cameras[i]);
  }

  root["lights"] = describe(edited.lights);
  root["ambient"] = describe(edited.ambient);
  root["sky"] = describe(edited.sky);

  // The item has the materials of the model, and what chooses among them.
  JsonDocument item{path.string(), {{"model", path.filename().string()}}, {}};
  for (const std::string& text : edited.settings) {
    const SceneSetting setting = parseSceneSetting(text);
    const std::string& section = setting.tokens.front();
    if (section == "materials" || section == "variant") applySceneSetting(setting, item);
  }

  // A model alone is turned upright and moved to the origin when it is read, but one in a scene
  // file is not.
  Json transform = Json::array();
  if (const Affine& turn = scene.upright; turn != Affine()) {
    const auto& [x, y, z, p] = turn;
    transform.push_back({{"matrix", {x.x, y.x, z.x, 0, x.y, y.y, z.y, 0, x.z, y.z, z.z, 0}}});
  }
  if (const Vec3d origin = scene.origin; origin != Vec3d()) {
    transform.push_back({{"translate", {-origin.x, -origin.y, -origin.z}}});
  }
  if (!transform.empty()) item.root["transform"] = std::move(transform);

  root["scene"] = Json::array({std::move(item.root)});
  return root;
}

// Makes `camera` the first one, under a name of its own, which is returned. The path's first
// keyframe states what it took from the old first camera.
std::string lookThrough(const Camera& camera, const Scene& scene, Json& root) {
  const Json others = root.contains("cameras") ? root["cameras"] : Json::object();
  std::string name = "saved";
  for (int i = 2; others.contains(name); ++i) name = "saved " + std::to_string(i);

  Json cameras{{name, describe(camera)}};
  for (const auto& [known, value] : others.items()) cameras[known] = value;
  root["cameras"] = std::move(cameras);

  if (scene.cameraPath.empty()) return name;
  Json& first = root["path"][0];
  const Json begin = describe(scene.cameraPath.front().camera);
  for (const auto& [key, value] : begin.items()) {
    if (!first.contains(key)) first[key] = value;
  }
  return name;
}

// Writes the options that differ from those that the scene states so far, which are in `stated`.
void stateOptions(const RenderOptions& chosen, RenderOptions& stated, Json& root) {
  for (const std::string& name : sceneOptionNames()) {
    const std::string value = optionText(chosen, name);
    if (name == "quality" || value == optionText(stated, name)) continue;

    setOption(stated, name, value);
    const bool isNumber = name != "background" && Json::accept(value);
    root["options"][name] = isNumber ? Json::parse(value) : Json(value);
  }
}

// A command does not name the size that the scene has by itself.
void resetOwnSize(const LoadOptions& load, const Scene& scene, RenderOptions& options) {
  if (!load.size && options.size == ImageSize{scene.width, scene.height}) options.size.reset();
}

std::string instantOf(const TracedFrame& frame) {
  if (!frame.request.seconds) return "";
  const std::string time = formatted(" --time %.17g", *frame.request.seconds);
  return frame.animation.empty() ? time : time + " --animation " + quoted(frame.animation);
}

std::string settingsFile() {
  const char* const config = std::getenv("XDG_CONFIG_HOME");
  if (config && *config) return std::string(config) + "/whit/viewer.json";
  const char* const home = std::getenv("HOME");
  return std::string(home ? home : "") + "/.config/whit/viewer.json";
}

std::string viewName(DebugView view) { return entryOf(kDebugViewNames, view); }

// The reference is a picture, which whit render makes as well.
bool isPicture(DebugView view) { return view == DebugView::none || view == DebugView::reference; }

}  // namespace

std::string viewCommand(const std::string& scene, const cli::CommonOptions& common,
                        const TracedFrame& frame, RenderOptions options) {
  const Scene& shown = frame.scene->scene;
  // The metadata's options have "auto" resolved, which can choose other instructions.
  const std::string addedCamera = setCamera(frame, options);
  resetOwnSize(common.load, shown, options);
  RenderOptions usual;
  applySceneOptions(shown.options, {}, usual);

  std::string text = renderOf(scene, shown.name);
  const DebugView view = frame.request.view;
  if (!isPicture(view)) text = "whit-view " + quoted(scene) + " --view=" + viewName(view);
  text = commandWith(text, options, usual);

  text += instantOf(frame);

  // The edits of the scene, and the permission to read a sky from elsewhere.
  const EditedScene& edited = *frame.edited;
  for (const std::string& setting : edited.settings) text += " --set " + quoted(setting);
  if (!addedCamera.empty()) text += " --set " + quoted(addedCamera);
  if (!edited.givenSky.empty()) text += " --sky " + quoted(edited.givenSky);
  if (common.load.allowOutside ||
      skyLeavesFolder(scene, common.load.shippedScenes, edited.settings)) {
    text += " --allow-outside";
  }
  return text;
}

SavedScene saveScene(const LoadOptions& load, const std::string& name, const TracedFrame& frame,
                     const Camera& camera, RenderOptions options, const RenderOptions& chosen) {
  const Scene& scene = frame.scene->scene;
  const EditedScene& edited = *frame.edited;
  const SceneName parsed = parseSceneName(name);
  const fs::path path = findScene(parsed.file, load.shippedScenes);

  // The scene's own file with the edits, or a scene that holds the model.
  LoadOptions read = load;
  read.settings = edited.settings;
  std::optional<JsonDocument> document = readDocument(name, read);  // none for a model
  Json root = document ? editedFile(std::move(*document), parsed, edited)
                       : sceneOfModel(path, scene, edited);
  // The reader may put a camera that flies the path, or a supplied one, before the others.
  if (fliesPath(frame) || root.contains("view")) {
    options.camera = lookThrough(camera, scene, root);
  } else if (!sameView(camera, scene.cameras.front())) {
    lookThrough(camera, scene, root);
  }

  RenderOptions stated;
  if (document) applySceneOptions(scene.options, {}, stated);
  stateOptions(chosen, stated, root);

  const auto nameOf = [&](int i) {
    return scene.name + "-edited" + (i == 1 ? "" : "-" + std::to_string(i));
  };
  const std::string saved = freeName(nameOf, {".json"}), file = saved + ".json";
  const bool leavesFolder = movePaths(root, path.parent_path(), ".");
  const cli::WriteScope scope;
  writeTextFile(file, root.dump(2) + "\n");

  resetOwnSize(load, scene, options);
  const std::vector<std::string> materials = namesIn(scene.materials);
  const bool hasGround = std::ranges::find(materials, kGroundShadowName) != materials.end();
  return {file,
          commandWith(renderOf(file, saved), options, stated) + instantOf(frame) +
              (leavesFolder ? " --allow-outside" : ""),
          !document && hasGround};
}

ImageMetadata pngMetadata(const TracedFrame& frame) {
  ImageMetadata metadata = frame.metadata;
  const DebugView view = frame.request.view;
  if (!isPicture(view)) metadata.emplace_back("view", viewName(view));
  return metadata;
}

std::string savePicture(const TracedFrame& frame) {
  const cli::WriteScope scope;
  const DebugView view = frame.request.view;
  const std::string kind = view == DebugView::none ? "" : "-" + viewName(view);
  const auto nameOf = [&](int i) { return frame.scene->scene.name + kind + formatted("-%04d", i); };
  const std::string name = freeName(nameOf, {".png", ".exr"});

  writeImage(name + ".png", frame.film, pngMetadata(frame));
  if (!isPicture(view)) return name + ".png";
  writeImage(name + ".exr", frame.film, frame.metadata);
  return name + ".png and .exr";
}

KeptSettings readKeptSettings() try {
  const std::string file = settingsFile();
  const Json json = parseJson(readTextFile(file, kSettingsBytesLimit), file);
  KeptSettings kept;
  kept.panel = json.at("panel");
  kept.tab = json.at("tab");
  kept.window = {json.at("window").at(0), json.at("window").at(1)};
  kept.recent = json.at("recent").get<std::vector<std::string>>();
  return kept;
} catch (const std::exception&) {
  return {};
}

void writeKeptSettings(const KeptSettings& kept) try {
  const Json json{{"panel", kept.panel},
                  {"tab", kept.tab},
                  {"window", {kept.window.width, kept.window.height}},
                  {"recent", kept.recent}};
  const fs::path file = settingsFile();
  fs::create_directories(file.parent_path());
  const cli::WriteScope scope;
  writeTextFile(file, json.dump(2) + "\n");
} catch (const std::exception& error) {
  std::fprintf(stderr, "whit-view: the viewer's settings were not saved: %s\n",
               printable(error.what()).c_str());
}

void rememberRecent(const std::string& scene, std::vector<std::string>& recent) {
  constexpr std::size_t kMostRecent = 10;
  const bool isFile = scene.find_first_of("./") != std::string::npos;
  const std::string name = isFile ? fs::absolute(scene).lexically_normal().string() : scene;
  std::erase(recent, name);
  recent.insert(recent.begin(), name);
  recent.resize(std::min(recent.size(), kMostRecent));
}

}  // namespace whit::view
