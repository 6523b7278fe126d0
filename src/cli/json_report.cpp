#include "cli/json_report.h"

#include <sys/resource.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "accuracy/report.h"
#include "cli/app/interrupt.h"
#include "core/option_table.h"
#include "core/option_values.h"
#include "core/usable_threads.h"
#include "io/atomic_file.h"

namespace whit::cli {

namespace {

constexpr int kSchema = 1;

Json orNull(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

// The words of the options, as they are given on the command line.
Json settingsJson(const RenderOptions& options) {
  Json json;
  for (const char* name : {"mode", "batch"}) json[name] = optionText(options, name);
  json["robust"] = options.robust;
  return json;
}

Json stagesJson(const FrameStats& frame) {
  Json json;
  for (std::size_t i = 0; i < kStageCount; ++i) {
    json[std::string(kStageNames[i])] = frame.stageMs(static_cast<Stage>(i));
  }
  return json;
}

Json vectorJson(const Vec3f& v) { return Json::array({v.x, v.y, v.z}); }

std::string cpuName() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    const std::size_t begin = line.find_first_not_of(" \t", line.find(':') + 1);
    if (begin != std::string::npos) return line.substr(begin);
  }
  return "unknown";
}

std::string compilerName() {
#if defined(__clang__)
  return std::string("clang++ ") + __clang_version__;
#elif defined(__GNUC__)
  return "g++ " + std::to_string(__GNUC__) + "." + std::to_string(__GNUC_MINOR__) + "." +
         std::to_string(__GNUC_PATCHLEVEL__);
#else
  return "unknown";
#endif
}

double peakRssMb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
  return static_cast<double>(usage.ru_maxrss) / 1e6;
#else
  return static_cast<double>(usage.ru_maxrss) * 1024 / 1e6;
#endif
}

}  // namespace

accuracy::RunFacts machineFacts() {
  accuracy::RunFacts facts;
  facts.cpu = cpuName();
  facts.cores = affinityThreads();
  facts.compiler = compilerName();
  facts.commit = WHIT_COMMIT;
  return facts;
}

Json machineJson(const Machine& machine) {
  const accuracy::RunFacts facts = machineFacts();
  return {{"cpu", facts.cpu},         {"cores", facts.cores},       {"simd", machine.simd},
          {"embree", machine.embree}, {"compiler", facts.compiler}, {"commit", facts.commit}};
}

namespace {

void addFrames(const RunSummary& run, Json& json) {
  const std::vector<double> times = frameTimes(run);
  const FrameStats& frame = medianFrame(run);
  json["frame_ms"] = {
      {"median", frame.frameMs}, {"min", quantile(times, 1e-9)}, {"p95", quantile(times, 0.95)}};
  json["fps"] = frame.frameMs > 0 ? 1e3 / frame.frameMs : 0;
  json["stages_ms"] = stagesJson(frame);
  json["embree_ms"] = frame.embreeMs();
  json["outside_embree_ms"] = outsideEmbreeMs(run);
  for (std::size_t i = 0; i < kRayKindCount; ++i) {
    json["rays"][std::string(kRayKinds[i].name)] = frame.meter.tally[i].rays;
  }
  const auto [lit, dark] = frame.meter.shadows;
  const std::uint64_t traced = frame.of(RayKind::shadow).rays;
  // The sum is the same with and without the shadow cache.
  json["rays"]["shadow"] = traced + lit + dark;
  if (run.shadowCache) {
    const double cold = run.shadowCache->coldMs;
    json["shadow_cache"] = {{"lit", lit},
                            {"dark", dark},
                            {"traced", traced},
                            {"cold_ms", cold > 0 ? Json(cold) : Json(nullptr)},
                            {"fill_ms", run.shadowCache->fillMs},
                            {"bytes", run.shadowCache->bytes}};
  }
  json["mrays_per_s"] = mraysPerSecond(frame.allRays(), frame.frameMs);
  for (std::size_t i = 0; i < kRayKindCount; ++i) {
    json["lanes_filled"][std::string(kRayKinds[i].name)] = lanesFilled(frame.meter.tally[i]);
  }
  json["nonfinite"] = frame.nonFinitePixels;
  json["image_hash"] = run.imageHash;
  if (!run.floorMs.empty()) {
    const double floor = quantile(run.floorMs, 0.5);
    json["floor_ms"] = floor;
    json["frame_over_floor"] = floor > 0 ? Json(frame.frameMs / floor) : Json(nullptr);
  }
  if (!run.updateMs.empty()) json["updateScene_ms"] = quantile(run.updateMs, 0.5);
  if (!run.writingMs.empty()) {
    json["writing_ms"] = {{"spent", quantile(run.writingMs, 0.5)},
                          {"waited", quantile(run.waitedMs, 0.5)}};
    json["written_per_s"] = writtenPerSecond(run);
  }
}

// By their numbers in the channel of that name, as objects are.
std::vector<std::string> materialNames(const Scene& scene) {
  std::vector<std::string> names;
  names.reserve(scene.materials.size());
  for (const Material& material : scene.materials) names.push_back(material.name);
  return names;
}

}  // namespace

Json runJson(const RunSummary& run) {
  Json json{{"scene", run.scene},
            {"size", Json::array({run.width, run.height})},
            {"threads", run.machine.threads},
            {"packet", run.machine.packet},
            {"simd", run.machine.simd}};
  json.update(settingsJson(run.options));
  json["effects_choice"] = run.options.effects == EffectChoice::all ? "all" : "auto";
  json["effects"] = effectNames(run.effects);
  json["exposure_ev"] = run.options.exposure.ev;
  json["triangles"] = run.triangles;
  json["spheres"] = run.spheres;
  json["frames"] = run.frames.size();
  json["build_ms"] = run.buildMs;
  json["load_ms"] = run.loadMs;
  json["peak_rss_mb"] = peakRssMb();
  if (!run.frames.empty()) addFrames(run, json);
  return json;
}

Json benchJson(const std::vector<RunSummary>& runs, RunPairs pairs) {
  Json json{{"schema", kSchema}, {"machine", machineJson(runs.at(0).machine)}};
  json["runs"] = Json::array();
  for (const RunSummary& run : runs) json["runs"].push_back(runJson(run));
  const char* const name = pairs == RunPairs::shadowCache ? "warm_over_off" : "all_over_auto";
  for (std::size_t i = 0; pairs != RunPairs::none && i + 1 < runs.size(); i += 2) {
    const RunRatio ratio = ratioOf(runs[i + 1], runs[i]);
    json[name].push_back({{"scene", runs[i].scene},
                          {"frame", ratio.frame},
                          {"outside_embree", ratio.outsideEmbree}});
  }
  return json;
}

Json compareJson(const Comparison& comparison) {
  const ImageDifference& d = comparison.difference;
  Json json{{"rmse", d.rmse},
            {"relmse", d.relmse},
            {"psnr_db", d.psnrDb},
            {"flip_mean", d.flipMean},
            {"max_code", d.maxCode},
            {"pixels_ge_1_code_pct", d.pixelsGe1CodePct},
            {"pixels_ge_2_codes_pct", d.pixelsGe2CodesPct},
            {"energy_ratio", d.energyRatio},
            {"path_flips_per_mpx", orNull(comparison.pathDivergencesPerMpx)},
            {"nonfinite", d.nonFinite},
            {"time_ms", {{"a", orNull(comparison.timeMsA)}, {"b", orNull(comparison.timeMsB)}}}};
  for (const ChannelDifference& c : comparison.channels) {
    Json row{{"channel", c.name}, {"pixels_differing", c.difference.differing}};
    if (!c.countsThings) {
      row["pixels_incomparable"] = c.difference.incomparable;
      row["max"] = c.difference.largest;
      row["rms"] = c.difference.rms;
    }
    json["channels"].push_back(std::move(row));
  }
  if (comparison.stages) json["stages"] = accuracy::stagesJson(*comparison.stages);
  return json;
}

Json infoJson(const Scene& scene, const Renderer& renderer, const RenderOptions& options,
              const Warnings& warnings) {
  Json json{{"scene", scene.name},
            {"triangles", scene.instancedTriangles},
            {"spheres", scene.instancedSpheres},
            {"bytes_per_sphere", bytesPerSphere(scene, renderer)},
            {"instances", scene.instances.size()},
            {"bounds", {{"lower", vectorJson(scene.lower)}, {"upper", vectorJson(scene.upper)}}},
            {"materials", scene.materials.size()},
            {"material_names", materialNames(scene)},
            {"objects", scene.items.count},
            {"object_names", scene.items.names},
            {"lights", scene.lights.size()},
            {"textures", scene.textures.size()},
            {"sky", skyName(scene.sky)},
            {"memory_mb", memoryMb(scene, renderer)}};
  const ShadowCacheOutlook shadowCache = shadowCacheOutlook(scene, options);
  json["shadow_cache"] = {{"lights", shadowCache.lights},
                          {"parts", shadowCache.parts},
                          {"samples", shadowCache.samples}};
  json["animations"] = Json::array();
  for (const Animation& animation : scene.animations) {
    json["animations"].push_back(
        {{"name", animation.name}, {"seconds", animation.seconds}, {"nodes", animation.nodes}});
  }
  json["cameras"] = Json::array();
  for (const Camera& camera : scene.cameras) json["cameras"].push_back(camera.name);
  json["warnings"] = Json::object();
  for (const auto& [kind, entry] : warnings.entries()) {
    json["warnings"][kind] = {{"count", entry.count}, {"first", entry.first}};
  }
  for (const EffectRow& row : effectRows(scene, options)) {
    json["effects"][row.name] = {{"on", row.on}, {"because", row.because}};
  }
  json["stages"] = Json::array();
  for (const Stage stage : renderer.plan().stages()) {
    json["stages"].push_back(kStageNames[static_cast<std::size_t>(stage)]);
  }
  json["kernels"] = Json::array();
  for (const KernelUse& kernel : kernelsOf(renderer.plan())) {
    json["kernels"].push_back({{"stage", kStageNames[static_cast<std::size_t>(kernel.stage)]},
                               {"kernel", kernel.kernel},
                               {"target", kernel.target}});
  }
  return json;
}

Json kernelsJson() {
  Json json{{"targets", simd::compiledTargets()}};
  for (const simd::Kernel& kernel : simd::kKernels) {
    json["kernels"].push_back(
        {{"stage", kStageNames[static_cast<std::size_t>(kernel.stage)]}, {"kernel", kernel.name}});
  }
  return json;
}

void writeJson(const std::string& path, const Json& json) {
  // Names in a scene may hold any bytes; what is no UTF-8 is replaced.
  const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  if (path == "-") {
    std::fputs(text.c_str(), stdout);
    return;
  }
  const WriteScope scope;
  writeTextFile(path, text);
}

}  // namespace whit::cli
