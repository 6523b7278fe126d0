#include "output/json_report.h"

#include <sys/resource.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "command_line/program.h"
#include "core/index.h"
#include "core/machine_limits.h"
#include "core/option_table.h"
#include "io/files.h"

namespace whit {

namespace {

#ifdef __clang__
constexpr const char* kCompiler = "clang++ " __clang_version__;
#else
constexpr const char* kCompiler = "g++ " __VERSION__;
#endif

std::string cpuName() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    const std::size_t begin = line.find_first_not_of(" \t", line.find(':') + 1);
    if (begin != std::string::npos) return line.substr(begin);
  }
  return "unknown";
}

double peakRssMb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024 / 1e6;
}

void addFrames(const RunSummary& run, Json& json) {
  const std::vector<double> times = frameTimes(run);
  const FrameStats& frame = medianFrame(run);

  json["frame_ms"] = {
      {"median", frame.frameMs}, {"min", quantile(times, 1e-9)}, {"p95", quantile(times, 0.95)}};
  json["fps"] = frame.frameMs > 0 ? 1e3 / frame.frameMs : 0;

  for (const auto i : indices(kStageCount)) {
    json["stages_ms"][std::string(kStageNames[i])] = frame.stageMs(static_cast<Stage>(i));
  }
  json["embree_ms"] = frame.embreeMs();
  json["outside_embree_ms"] = outsideEmbreeMs(frame);

  for (const auto i : indices(kRayKindCount)) {
    json["rays"][std::string(kRayKinds[i].name)] = frame.meter.tally[i].rays;
  }
  json["mrays_per_s"] = mraysPerSecond(frame.allRays(), frame.frameMs);
  for (const auto i : indices(kRayKindCount)) {
    json["lanes_filled"][std::string(kRayKinds[i].name)] = lanesFilled(frame.meter.tally[i]);
  }

  json["nonfinite"] = frame.nonFinitePixels;
  json["ray_limited"] = frame.limitedPixels;
  json["image_hash"] = run.imageHash;

  // The floor is the time that Embree alone takes for the same rays.
  if (!run.floorMs.empty()) {
    const double floor = quantile(run.floorMs, 0.5);
    json["floor_ms"] = floor;
    json["frame_over_floor"] = floor > 0 ? Json(frame.frameMs / floor) : Json(nullptr);
  }

  const std::vector<double> perRay = eventsPerRay(run);
  for (const auto i : indices(perRay)) {
    json["per_ray"][std::string(kProcessorEvents[i].name)] = perRay[i];
  }
  if (!run.noEvents.empty()) json.update({{"per_ray", nullptr}, {"no_per_ray", run.noEvents}});

  if (!run.otherTasks.empty()) json["other_tasks"] = quantile(run.otherTasks, 0.5);
  if (!run.updateMs.empty()) json["updateScene_ms"] = quantile(run.updateMs, 0.5);
  if (!run.writingMs.empty()) {
    json["writing_ms"] = {{"spent", quantile(run.writingMs, 0.5)},
                          {"waited", quantile(run.waitedMs, 0.5)}};
    json["written_per_s"] = writtenPerSecond(run);
  }
}

}  // namespace

Json jsonOf(const Vec3d& v) { return Json::array({v.x, v.y, v.z}); }

Json optionsJson(const RenderOptions& options) {
  Json json = Json::object();
  for (const auto& [name, value] : pictureOptions(options)) json[name] = value;
  return json;
}

Json machineJson(const Machine& machine) {
  return {{"cpu", cpuName()},         {"cores", affinityThreads()}, {"simd", machine.simd},
          {"embree", machine.embree}, {"compiler", kCompiler},      {"commit", WHIT_COMMIT}};
}

Json runJson(const RunSummary& run) {
  Json json{{"scene", run.scene},
            {"name", run.name},
            {"size", Json::array({run.width, run.height})},
            {"threads", run.machine.threads},
            {"packet", run.machine.packet},
            {"simd", run.machine.simd},
            {"mode", optionText(run.options, "mode")},
            {"batch", optionText(run.options, "batch")},
            {"robust", run.options.robust}};

  json["options"] = optionsJson(run.options);
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

void writeJson(const std::string& path, const Json& json) {
  constexpr int kSchema = 1;
  Json all{{"schema", kSchema}};
  all.update(json);

  // Names in a scene may hold any bytes; what is no UTF-8 is replaced.
  writeReport(path, all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void writeReport(const std::string& path, const std::string& text) {
  if (path == "-") {
    std::fputs(text.c_str(), stdout);
    return;
  }

  const cli::WriteScope scope;
  writeTextFile(path, text);
}

}  // namespace whit
