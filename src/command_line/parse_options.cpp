#include "command_line/parse_options.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>

#include "command_line/help_text.h"
#include "core/error.h"
#include "core/machine_limits.h"
#include "core/option_table.h"
#include "core/text.h"
#include "io/files.h"
#include "io/json_reader.h"
#include "io/scene/scene_sections.h"

namespace whit::cli {

namespace {

// `command` is as it is typed: "whit render".
[[noreturn]] void throwUnknownOption(const std::string& name, const OptionList& list,
                                     const std::string& command) {
  std::vector<std::string> names{"--help", "--help-all"};
  for (const OptionList::Entry& e : list.entries) names.push_back("--" + e.name);
  throwUsage(noOption(name, names) + "; " + command + " --help-all lists them");
}

// An option as it was typed: "--name=value", "--name" or, of one letter, "-n", "-nvalue".
struct TypedOption {
  std::string name;
  std::optional<std::string> value;
  bool isLetter = false;
};

TypedOption splitOption(const std::string& word) {
  // The value of a letter may follow at once, as in -n4 or -n=4.
  if (word[1] != '-') {
    const std::size_t value = word.size() > 2 && word[2] == '=' ? 3 : 2;
    if (word.size() == 2) return {word, std::nullopt, true};
    return {word.substr(0, 2), word.substr(value), true};
  }

  const std::size_t equals = word.find('=');
  if (equals == std::string::npos) return {word, std::nullopt};
  return {word.substr(0, equals), word.substr(equals + 1)};
}

// Returns true if the word is more likely an option behind a forgotten value than a value. A value
// that looks so can be given as --json=--odd.
bool looksLikeOption(const std::string& word, const OptionList& list) {
  if (word.size() > 2 && word.starts_with("--")) return true;
  return std::ranges::any_of(list.entries, [&](const OptionList::Entry& entry) {
    return !entry.shortName.empty() && word == "-" + entry.shortName;
  });
}

// Sets the values of all options and operands. At a request for help it stops and returns that
// word; otherwise it returns an empty text.
std::string takeWords(const std::vector<std::string>& words, const OptionList& list,
                      const std::string& command) {
  std::vector<std::string> operands;
  bool onlyOperands = false;

  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (onlyOperands || word.size() < 2 || word[0] != '-') {
      operands.push_back(word);
      continue;
    }

    if (word == "-h" || word == "--help" || word == "--help-all") return word;
    // All words after "--" are operands.
    onlyOperands = word == "--";
    if (onlyOperands) continue;

    const TypedOption typed = splitOption(word);
    const auto entry = std::ranges::find_if(list.entries, [&](const OptionList::Entry& e) {
      return typed.isLetter ? typed.name == "-" + e.shortName : typed.name == "--" + e.name;
    });
    if (entry == list.entries.end()) throwUnknownOption(typed.name, list, command);

    // A flag without a value means true; any other option takes the next word.
    if (typed.value || entry->placeholder.empty()) {
      entry->set(typed.value.value_or("true"));
    } else if (i + 1 < words.size() && !looksLikeOption(words[i + 1], list)) {
      entry->set(words[++i]);
    } else {
      const std::string found = i + 1 < words.size() ? ", found '" + words[i + 1] + "'" : "";
      throwUsage(typed.name + ": expected " + entry->placeholder + " after it" + found);
    }
  }

  const OptionList::Operand& wanted = list.operand;
  if (operands.size() < wanted.least) {
    throwUsage("expected " + wanted.placeholder + ": " + wanted.help);
  }
  if (operands.size() > wanted.most) {
    throwUsage("one word too many: '" + operands[wanted.most] + "'");
  }

  if (wanted.values) *wanted.values = operands;
  return "";
}

std::string textOf(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// Adds the camera that a file describes to the scene, under the name of the file, and chooses it.
void takeCameraFile(const std::string& file, CommonOptions& common) {
  constexpr std::uint64_t kBytesLimit = 1u << 20;
  const JsonDocument document{file, parseJson(readTextFile(file, kBytesLimit), file), {}};

  // It is read here as well, so that errors name its file in place of the scene's.
  JsonObject object{JsonValue(document)};
  if (object.has("pose") || object.has("K")) {
    object.value().fail(
        "eye, at, up, k as [fx, fy, cx, cy] and kSize, which Python's "
        "whit.Camera.from_k(K, pose, size).members gives",
        "a matrix K or a pose");
  }
  object.need("eye");
  object.need("at");
  Camera camera;
  readCamera(object, camera);
  SceneDescription unused;
  readMotion(object, {}, unused);
  object.finish();

  const std::string name = std::filesystem::path(file).stem().string();
  common.load.settings.push_back("/cameras/" + escapePointer(name) + "=" + textOf(document.root));
  common.render.camera = name;
  common.cameraFile = file;
}

// Turns the options of a model's view into members of its scene.
void takeView(CommonOptions& common) {
  refuseIf(
      (common.azimuth || common.zoom) && common.given.contains("camera"),
      "--azimuth and --zoom place the camera that a model is supplied with: leave out --camera");

  const auto set = [&](const std::string& text) { common.load.settings.push_back(text); };
  if (common.azimuth) set("/azimuth=" + shortest(*common.azimuth));
  if (common.zoom) set("/zoom=" + shortest(*common.zoom));
  if (common.ground) set("/ground=true");
}

}  // namespace

void listReportOptions(OptionList& list, CommonOptions& common) {
  list.group("Reporting");
  list.flag("quiet", "nothing on standard error but warnings and errors", common.quiet).common =
      true;
  list.value({"progress", "auto|never"}, "progress bar (auto: on a terminal)", common.progress)
      .common = true;
}

void listCommonOptions(OptionList& list, CommonOptions& common) {
  const std::size_t own = list.entries.size();
  list.group("Rendering");
  forEachOption(common.render, [&](const OptionSpec& spec, auto& field) {
    OptionList::Entry& entry = list.value(spec, std::string(spec.help), field);
    entry.everyday = spec.everyday;
    if (entry.name == "camera") {
      entry.placeholder = "NAME|FILE.json";
      entry.help += ", or one with the members of a scene file's camera";
    }
    if (entry.name == "tonemap") entry.help += "; of models without a scene file filmic";
    if (entry.name == "background") entry.help += "; of models without a scene file c8c8c8";

    // The names of the given options are kept, because presets and scenes must not override them.
    entry.set = [set = std::move(entry.set), &common, name = entry.name](const std::string& text) {
      if (name == "up" && (text == "x" || text == "y" || text == "z")) {
        common.load.settings.push_back("/up=\"" + text + "\"");
        return;
      }
      common.given.insert(name);
      if (name == "camera" && extensionOf(text) == ".json") {
        takeCameraFile(text, common);
      } else {
        set(text);
      }
    };
  });

  list.group("Loading");
  list.flag("allow-outside", "let the scene name files outside its own folder",
            common.load.allowOutside)
      .everyday = false;
  list.many({"set", "POINTER=VALUE"},
            "replaces a member of the scene file, named by JSON pointer, by a value in JSON: "
            "/lights/0/intensity=40; may be repeated",
            common.load.settings);
  list.value({"sky", "FILE"},
             "environment light: none, a studio with soft boxes, or an equirectangular image "
             "(default: the scene's own; of models the studio)",
             common.load.sky)
      .placeholder = "none|studio|FILE";
  list.value({"time", "SECONDS", -1e9, 1e9},
             "time at which animations and the camera path are sampled (default: models stand as "
             "their files have them, without animations)",
             common.load.instant.seconds);
  list.value({"animation", "NAME"}, "animation that is played (default: the first of each model)",
             common.load.instant.animation)
      .everyday = false;
  list.many({"variant", "NAME"}, "materials of a glTF model that has several sets (see whit info)",
            common.load.settings)
      .set = [&common](const std::string& name) {
    common.load.settings.push_back("/variant=" + textOf(name));
  };
  OptionList::Entry& viewpoint = list.many(
      {"viewpoint", "outside|inside"},
      "side from which a model is seen, in place of the cameras in its file", common.load.settings);
  viewpoint.everyday = false;
  viewpoint.set = [&common](const std::string& side) {
    common.load.settings.push_back("/viewpoint=" + textOf(side));
  };
  list.value({"azimuth", "DEG", -360, 360},
             "direction from which a model is seen: 0 is its front, 90 its right, 180 its back",
             common.azimuth);
  list.value({"zoom", "X", 0.01, 100}, "how much nearer than usual a model is seen", common.zoom);
  list.flag("ground", "a soft shadow on the ground below a model", common.ground);
  list.value({"max-memory", "GB", 0.001, 1e6},
             "limit of memory for geometry and images (default: what the machine and its control "
             "group have left, at most 16)",
             common.maxMemoryGb)
      .everyday = false;

  // Every option that was added above is common to all commands that render.
  for (std::size_t i = own; i < list.entries.size(); ++i) list.entries[i].common = true;
  listReportOptions(list, common);

  list.whenParsed = [&common] {
    applyQuality(common.render, common.given);
    takeView(common);
    common.load.threads = common.render.threads;
    common.load.size = common.render.size;
    common.load.camera = common.render.camera;
    common.load.sphereSegments = common.render.sphereSegments;
    common.load.maxMemoryBytes = common.maxMemoryGb
                                     ? static_cast<std::uint64_t>(*common.maxMemoryGb * 1e9)
                                     : defaultMaxMemory();
  };
}

RenderOptions optionsFor(const Scene& scene, const CommonOptions& common) {
  RenderOptions options = common.render;
  applySceneOptions(scene.options, common.given, options);
  return options;
}

RenderOptions optionsToMeasure(const Scene& scene, const CommonOptions& common) {
  return scene.isModel ? optionsFor(scene, common) : common.render;
}

void requireSeparateFiles(const std::vector<std::string>& written, const CommonOptions& common,
                          const std::vector<std::string>& scenes,
                          const std::vector<std::string>& pictures) {
  std::vector<std::string> read = pictures;
  read.insert(read.end(), {common.load.sky, common.cameraFile});
  for (const std::string& scene : scenes) read.push_back(findScene(parseSceneName(scene).file));

  // Different names of one file, such as a link or a path with "..", lead to the same place.
  const auto placeOf = [](const std::string& file) {
    std::error_code error;
    auto place = std::filesystem::weakly_canonical(std::filesystem::absolute(file, error), error);
    return error ? std::filesystem::path(file) : place;
  };
  std::map<std::filesystem::path, std::string> known;
  for (const std::string& file : read) known.emplace(placeOf(file), file);

  for (const std::string& file : written) {
    std::error_code error;
    if (file.empty() || std::filesystem::is_other(file, error)) continue;

    const auto [other, isNew] = known.emplace(placeOf(file), file);
    if (isNew) continue;
    refuseIf(file == "-",
             "standard output takes one output, '-o -' or '--json -': name a file for the other");
    throwUsage("cannot write '" + file + "': it is the same as '" + other->second +
               "', which is read or written too: name another file");
  }
}

bool parseOptions(const std::string& usage, const std::string& summary, const OptionList& list,
                  const std::vector<std::string>& words) {
  if (words == std::vector<std::string>{"--man"}) {
    std::fputs(manOptions(usage, summary, list).c_str(), stdout);
    return false;
  }
  if (!words.empty() && words[0] == "--complete") {
    std::fputs(completions({words.begin() + 1, words.end()}, list).c_str(), stdout);
    return false;
  }

  // The words of the command end where its operands begin.
  const std::string command =
      usage.substr(0, usage.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ[") - 1);
  const std::string help = takeWords(words, list, command);
  if (help.empty()) {
    if (list.whenParsed) list.whenParsed();
    return true;
  }

  const HelpTier tier = help == "--help-all" ? HelpTier::all : HelpTier::everyday;
  std::fputs(helpText(usage, summary, list, tier, helpWidth()).c_str(), stdout);
  return false;
}

}  // namespace whit::cli
