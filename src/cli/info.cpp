// whit info: what a scene holds, which effects it calls for and why, which kernels run.
#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "command_line/progress_bar.h"
#include "core/index.h"
#include "core/option_table.h"
#include "core/text.h"
#include "output/image_output.h"
#include "output/json_report.h"
#include "output/open_and_warn.h"
#include "render/renderer.h"

namespace whit::cli {

namespace {

// Every effect, whether it is on, and why.
Json effectsJson(const Scene& scene, const RenderOptions& options) {
  Json effects;
  for (int i = 0; i < kEffectCount; ++i) {
    const std::size_t index = i;
    const EffectReason& reason = scene.reasons[index];
    const bool disabled = options.disable.has(static_cast<Effect>(i));
    effects[std::string(kEffectNames[index].name)] = {
        {"on", reason.on && !disabled},
        {"because", reason.on && disabled ? "disabled by --disable" : reason.because}};
  }

  // An effect that an option would turn on says which one.
  for (const OptionalEffect& optional : optionalEffects(options)) {
    Json& row = effects[std::string(entryOf(kEffectNames, optional.effect).name)];
    if (optional.isOn || row["on"] == false) continue;
    row["on"] = false;
    row["because"] = row["because"].get<std::string>() + ", " + std::string(optional.otherwise);
  }
  return effects;
}

// Returns the options of the picture that were given or are not the defaults, and what set them.
Json optionsJson(const Scene& scene, const CommonOptions& common, const RenderOptions& options) {
  const RenderOptions defaults;
  RenderOptions stated;
  applySceneOptions(scene.options, {}, stated);
  Json rows = Json::object();
  for (const std::string& name : sceneOptionNames()) {
    const std::string value = optionText(options, name);
    const bool isGiven = common.given.contains(name), isStated = scene.options.contains(name);
    if (!isGiven && !isStated && value == optionText(defaults, name)) continue;

    const char* from = scene.isModel ? "model" : "scene";
    if (value != optionText(stated, name)) from = "--quality";
    if (isGiven) from = "command line";
    rows[name] = {{"value", value}, {"from", from}};
  }
  return rows;
}

Json infoJson(const OpenScene& open, const Plan& plan, const CommonOptions& common,
              const RenderOptions& options) {
  const Scene& scene = open.scene;
  Json json{{"scene", scene.name},
            {"triangles", scene.instancedTriangles},
            {"spheres", scene.instancedSpheres},
            {"instances", scene.instances.size()},
            {"bounds",
             {{"lower", jsonOf(scene.inFile(Vec3d(scene.lower)))},
              {"upper", jsonOf(scene.inFile(Vec3d(scene.upper)))}}},
            {"origin", jsonOf(scene.origin)},
            {"materials", scene.materials.size()},
            {"material_names", namesIn(scene.materials)},
            {"objects", scene.items.count},
            {"object_names", scene.items.names},
            {"lights", scene.lights.size()},
            {"textures", scene.textures.size()},
            {"sky", skyName(scene.sky)},
            {"memory_mb", static_cast<double>(scene.memoryBytes()) / 1e6},
            {"animations", Json::array()},
            {"variants", scene.variants},
            {"cameras", namesIn(scene.cameras)},
            {"options", optionsJson(scene, common, options)},
            {"warnings", Json::object()},
            {"effects", effectsJson(scene, options)},
            {"stages", Json::array()},
            {"kernels", Json::array()}};

  for (const Animation& animation : scene.animations) {
    json["animations"].push_back(
        {{"name", animation.name}, {"seconds", animation.seconds}, {"nodes", animation.nodes}});
  }
  for (const auto& [kind, entry] : open.warnings.entries()) {
    json["warnings"][kind] = {{"count", entry.count}, {"first", entry.first}};
  }

  for (const Stage stage : plan.stages()) {
    json["stages"].push_back(entryOf(kStageNames, stage));
  }
  for (const KernelUse& kernel : kernelsOf(plan)) {
    json["kernels"].push_back({{"stage", entryOf(kStageNames, kernel.stage)},
                               {"kernel", kernel.kernel},
                               {"target", kernel.target}});
  }
  return json;
}

std::string textOf(const Json& value) {
  if (value.is_string()) return printable(value.get<std::string>());
  return value.dump();
}

// Prints what infoJson() returns for people.
void printInfo(const Json& info, const OpenScene& open) {
  std::printf("%s\n", textOf(info["scene"]).c_str());
  for (const char* key :
       {"triangles", "spheres", "instances", "objects", "materials", "lights", "textures", "sky"}) {
    std::printf("  %-12s%s\n", key, textOf(info[key]).c_str());
  }

  std::printf("  %-12s%s to %s\n", "bounds", info["bounds"]["lower"].dump().c_str(),
              info["bounds"]["upper"].dump().c_str());
  if (open.scene.origin != Vec3d()) {
    std::printf("  %-12smoved by %s\n", "origin", info["origin"].dump().c_str());
  }

  std::printf("  %-12s", "cameras");
  for (const Json& camera : info["cameras"]) std::printf("%s ", textOf(camera).c_str());
  for (const Json& animation : info["animations"]) {
    std::printf("\n  %-12s%s: %g s, moves %s node%s", "animation",
                textOf(animation["name"]).c_str(), animation["seconds"].get<double>(),
                textOf(animation["nodes"]).c_str(), animation["nodes"] == 1 ? "" : "s");
  }

  const char* before = "\n  options     ";
  for (const auto& [name, option] : info["options"].items()) {
    std::printf("%s%s %s (%s)", before, name.c_str(), textOf(option["value"]).c_str(),
                textOf(option["from"]).c_str());
    before = ", ";
  }
  for (const Json& variant : info["variants"]) {
    std::printf("\n  %-12s%s", "variant", textOf(variant).c_str());
  }
  std::printf("\n  %-12s%.1f MB of geometry and images\n", "memory",
              info["memory_mb"].get<double>());
  std::printf("  %-12s%.0f ms to load\n", "time", open.loadMs);

  std::printf("\neffects\n");
  for (const auto& [name, effect] : info["effects"].items()) {
    std::printf("  %-18s%-5s%s\n", name.c_str(), effect["on"] == true ? "on" : "-",
                textOf(effect["because"]).c_str());
  }
  std::printf("\nstages\n");
  for (const Json& stage : info["stages"]) std::printf("  %s\n", textOf(stage).c_str());
  std::printf("\nkernels\n");
  for (const Json& kernel : info["kernels"]) {
    std::printf("  %-34s%-34s%s\n", textOf(kernel["stage"]).c_str(),
                textOf(kernel["kernel"]).c_str(), textOf(kernel["target"]).c_str());
  }

  if (!info["warnings"].empty()) std::printf("\nwarnings\n");
  for (const auto& [kind, entry] : info["warnings"].items()) {
    std::printf("  %8s  %s (first: %s)\n", textOf(entry["count"]).c_str(), printable(kind).c_str(),
                textOf(entry["first"]).c_str());
  }
}

}  // namespace

int infoCommand(const Words& words) {
  CommonOptions common;
  std::vector<std::string> scenes;
  std::string json;

  OptionList list;
  list.value({"json", "FILE"}, "the same as JSON; - is standard output", json);
  listCommonOptions(list, common);
  list.operands("SCENE", "a scene file, a model, or the name of a shipped scene", 1, 1, scenes);

  if (!parseOptions("whit info SCENE [options]",
                    "Lists the contents of a scene, its effects and why they are on, and the "
                    "kernels that run.",
                    list, words)) {
    return 0;
  }

  requireJsonWritable(json);
  requireSeparateFiles({json}, common, scenes);
  auto progress = makeProgressBar(common);

  CommonOptions loading = common;
  loading.warns = false;  // the report lists the warnings
  const auto open = openAndWarn(scenes[0], loading, progress.get());
  const RenderOptions options = optionsFor(open->scene, common);
  const Plan plan = planOf(open->scene, options);
  progress.reset();

  const Json info = infoJson(*open, plan, common, options);
  if (!json.empty()) writeJson(json, info);
  if (json != "-") printInfo(info, *open);
  return 0;
}

}  // namespace whit::cli
