// whit info: what a scene holds, which effects it calls for and why, which kernels run.
#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/app/image_output.h"
#include "cli/app/open_scene.h"
#include "cli/app/progress_bar.h"
#include "cli/commands.h"
#include "cli/json_report.h"
#include "core/error.h"
#include "core/printable.h"

namespace whit::cli {

namespace {

void printCounts(const OpenScene& open, const Renderer& renderer) {
  const Scene& s = open.scene;
  std::printf("%s\n", s.name.c_str());
  std::printf("  %-12s%llu\n", "triangles", static_cast<unsigned long long>(s.instancedTriangles));
  if (s.instancedSpheres > 0) {
    std::printf("  %-12s%llu, %llu bytes each beside the BVH\n", "spheres",
                static_cast<unsigned long long>(s.instancedSpheres),
                static_cast<unsigned long long>(bytesPerSphere(s, renderer)));
  }
  std::printf("  %-12s%zu\n", "instances", s.instances.size());
  std::printf("  %-12s(%g, %g, %g) to (%g, %g, %g)\n", "bounds", s.lower.x, s.lower.y, s.lower.z,
              s.upper.x, s.upper.y, s.upper.z);
  std::printf("  %-12s%llu\n", "objects", static_cast<unsigned long long>(s.items.count));
  std::printf("  %-12s%zu\n", "materials", s.materials.size());
  std::printf("  %-12s%zu\n", "lights", s.lights.size());
  std::printf("  %-12s%zu\n", "textures", s.textures.size());
  const ShadowCacheOutlook shadowCache = shadowCacheOutlook(s, renderer.options());
  if (shadowCache.lights > 0) {
    std::printf(
        "  %-12sshadow cache for %zu light%s, %zu pieces of triangles; used in films and pictures "
        "of more than %.3g pixel samples\n",
        "shadows", shadowCache.lights, shadowCache.lights == 1 ? "" : "s", shadowCache.parts,
        shadowCache.samples);
  } else {
    std::printf("  %-12sno shadow cache: %s\n", "shadows", shadowCache.because.c_str());
  }
  std::printf("  %-12s%s\n", "sky", printable(skyName(s.sky)).c_str());
  std::printf("  %-12s", "cameras");
  for (const Camera& camera : s.cameras) std::printf("%s ", printable(camera.name).c_str());
  for (const Animation& animation : s.animations) {
    std::printf("\n  %-12s%s: %g s, moves %zu node%s", "animation",
                printable(animation.name).c_str(), animation.seconds, animation.nodes,
                animation.nodes == 1 ? "" : "s");
  }
  std::printf("\n  %-12s%.1f MB\n", "memory", memoryMb(s, renderer));
  std::printf("  %-12s%.0f ms to load, %.0f ms to build\n", "time", open.loadMs,
              renderer.buildMs());
}

void printPlan(const OpenScene& open, const Renderer& renderer, const RenderOptions& options) {
  std::printf("\neffects\n");
  for (const EffectRow& row : effectRows(open.scene, options)) {
    std::printf("  %-18s%-5s%s\n", row.name.c_str(), row.on ? "on" : "-", row.because.c_str());
  }
  std::printf("\nstages\n");
  for (const Stage stage : renderer.plan().stages()) {
    std::printf("  %s\n", kStageNames[static_cast<std::size_t>(stage)].data());
  }
  std::printf("\nkernels\n");
  for (const KernelUse& kernel : kernelsOf(renderer.plan())) {
    std::printf("  %-34s%-34s%s\n", kStageNames[static_cast<std::size_t>(kernel.stage)].data(),
                kernel.kernel.c_str(), kernel.target.c_str());
  }
  if (open.warnings.entries().empty()) return;
  std::printf("\nwarnings\n");
  for (const auto& [kind, entry] : open.warnings.entries()) {
    std::printf("  %8llu  %s (first: %s)\n", static_cast<unsigned long long>(entry.count),
                printable(kind).c_str(), printable(entry.first).c_str());
  }
}

void printKernels() {
  std::string targets;
  for (const std::string& name : simd::compiledTargets()) targets += " " + name;
  for (const simd::Kernel& kernel : simd::kKernels) {
    std::printf("%-34s%s\n", kStageNames[static_cast<std::size_t>(kernel.stage)].data(),
                std::string(kernel.name).c_str());
  }
  std::printf("%zu kernels, each for:%s\n", simd::kKernels.size(), targets.c_str());
}

}  // namespace

int infoCommand(const Words& words) {
  CommonOptions common;
  std::vector<std::string> scenes;
  std::string json;
  bool kernels = false;
  OptionList list;
  list.flag("kernels", "list every kernel and the SIMD targets, without a scene", kernels);
  list.value({"json", "FILE"}, "the same as JSON; - is standard output", json);
  listCommonOptions(list, common);
  list.operands("SCENE", "a scene file, a model, or the name of a shipped scene", 0, 1, scenes);
  if (parseOptions("whit info SCENE [options], or whit info --kernels",
                   "Lists the contents of a scene, its effects and why they are on, and the "
                   "kernels that run.",
                   list, words) == Parsed::helpShown) {
    return 0;
  }
  settleOptions(common);
  if (kernels) {
    if (!scenes.empty())
      throwUsage("--kernels lists what is compiled, for any scene: leave it out");
    if (!json.empty()) writeJson(json, kernelsJson());
    if (json != "-") printKernels();
    return 0;
  }
  if (scenes.empty()) throwUsage("whit info expected a SCENE");
  requireJsonWritable(json);
  auto progress = makeProgressBar(common);
  CommonOptions loading = common;
  loading.quiet = true;  // the warnings are part of the report
  const auto open = openScene(scenes[0], loading, progress.get());
  const RenderOptions options = optionsFor(open->scene, common);
  const Renderer renderer(open->scene, options, progress.get());
  progress.reset();
  if (!json.empty()) {
    writeJson(json, infoJson(open->scene, renderer, options, open->warnings));
  }
  if (json == "-") return 0;
  printCounts(*open, renderer);
  printPlan(*open, renderer, options);
  return 0;
}

}  // namespace whit::cli
