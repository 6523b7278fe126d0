// whit render: one image, or the frames of a scene's camera path.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "accuracy/digest.h"
#include "app/image_output.h"
#include "app/open_scene.h"
#include "app/progress_bar.h"
#include "cli/commands.h"
#include "cli/json_report.h"
#include "cli/stage_table.h"
#include "core/error.h"
#include "core/image.h"
#include "core/options.h"
#include "core/printable.h"
#include "core/stopwatch.h"
#include "io/image_file.h"
#include "render/auto_exposure.h"
#include "render/describe_image.h"

namespace whit::cli {

namespace {

constexpr std::uint64_t kLargestPixel = 4 * sizeof(float);  // in a file that might be whole

// The pixels are read as well: a file that was cut off still has its head.
ImageMetadata readThrough(const std::string& path, const Image& image) {
  if (extensionOf(path) == ".png") return readPngMetadata(path);
  Warnings warnings;
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height);
  const ImageLimits limits{kImageSideLimit, kLargestPixel * pixels};
  readImage(path, limits, warnings);
  return readExrMetadata(path);
}

// In an order that does not depend on the format; without what says nothing or may differ.
ImageMetadata comparable(ImageMetadata metadata, const RenderOptions& options) {
  std::erase_if(metadata, [&](const auto& entry) {
    return entry.second.empty() || (entry.first == "simd" && options.simd == "auto") ||
           (entry.first == "packet" && options.packet == 0);
  });
  std::sort(metadata.begin(), metadata.end());
  return metadata;
}

// Whether `path` (.exr or .png) is what a render into `image` would write: there, readable to its
// last byte, and made with the same options of a scene with the same contents, as far as `expected`
// tells of them. What the options leave to the machine (--simd auto, --packet auto) may differ.
// Throws Error(io) when it is there but cannot be read.
bool isWhole(const std::string& path, const Image& image, const ImageMetadata& expected,
             const RenderOptions& options) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  try {
    return comparable(readThrough(path, image), options) == comparable(expected, options);
  } catch (const Error& broken) {
    if (broken.status() == ExitStatus::io) throw;
    return false;
  }
}

constexpr const char* kRenderUsage = "whit render SCENE -o OUT.exr|OUT.png [options]";
constexpr const char* kRenderSummary =
    "Renders one image, or with --frames the frames of the scene's camera path.";

struct RenderJob {
  CommonOptions common;
  std::vector<std::string> scenes, outputs;
  std::string frames, json;
  double fps = 24;
  bool resume = false;
};

OptionList listOptions(RenderJob& job) {
  OptionList list;
  list.group("Output");
  list.many({"output", "FILE"}, "image to write, .exr (linear) or .png; may be repeated",
            job.outputs)
      .shortName = "o";
  list.value({"frames", "A..B"}, "frames of the camera path; FILE has #### for the number",
             job.frames);
  list.value({"fps", "N", 0.001, 1e6}, "frames a second of the camera path", job.fps);
  list.flag(
      "resume",
      "leave out images that are there, whole and made with the same options of the same contents "
      "of the scene",
      job.resume);
  list.value({"json", "FILE"}, "what was done and what it cost; - is standard output", job.json);
  listCommonOptions(list, job.common);
  list.operands("SCENE", "a scene file, a model, or the name of a shipped scene", 1, 1, job.scenes);
  return list;
}

void checkJob(const RenderJob& job, const Farm& farm) {
  if (job.outputs.empty()) throwUsage("expected an image to write: -o OUT.exr or -o OUT.png");
  checkShared(farm, job.common);
  if (farm.leads()) {
    for (const std::string& output : job.outputs) requireWritable(output, {".exr", ".png"});
    requireJsonWritable(job.json);
  }
  if (job.frames.empty()) {
    for (const std::string& output : job.outputs) requireNoFrameName(output);
    return;
  }
  parseFrameRange(job.frames);
  for (const std::string& output : job.outputs) frameName(output, 0);
  if (job.common.given.contains("camera")) {
    throwUsage("--camera names a still viewpoint, --frames follows the scene's path: give one");
  }
}

class ImageWriter {
 public:
  ImageWriter(const RenderJob& job, const OpenScene& open, Farm& farm, Progress* progress)
      : job_(job),
        farm_(farm),
        open_(open),
        progress_(progress),
        options_(optionsFor(open.scene, job.common)),
        renderer_(open.scene, options_, progress),
        film_(openFilm(open.scene, job.common)) {
    // One for all frames of a path, whichever of them are asked for.
    settleExposure(renderer_, firstCamera(), options_);
    run_ = summarize(open.scene, options_, renderer_, film_, open.loadMs);
    if (farm.leads()) sceneDigest_ = accuracy::digestOf(open.scene);
    film_.wantDisplay = false;
    for (const std::string& output : job.outputs) {
      if (std::filesystem::path(output).extension() != ".exr") film_.wantDisplay = true;
    }
  }

  // With --resume, nothing is traced when all files are there.
  void write(const Camera& camera, const std::vector<std::string>& files,
             const ImageMetadata& more = {}) {
    const RenderOptions& options = options_;
    ImageMetadata metadata = describeImage(open_.scene, camera, renderer_, film_, options);
    addSettings(open_.settings, open_.sky, metadata);
    metadata.emplace_back("sceneDigest", sceneDigest_);
    metadata.insert(metadata.end(), more.begin(), more.end());
    if (farm_.leads() && job_.resume &&
        std::all_of(files.begin(), files.end(), [&](const std::string& file) {
          return isWhole(file, film_.image, metadata, options);
        })) {
      farm_.leaveOut();
      return;
    }
    run_.frames.push_back(renderShared(farm_, renderer_, options, camera, film_, progress_));
    if (!farm_.leads()) return;
    if (farm_.ranks() > 1) run_.shares.push_back(farm_.lastFrame());
    refuseNonFinite(open_.scene, options, run_.frames.back());
    run_.imageHash = accuracy::digestOf(film_.image);
    for (const std::string& file : files) {
      writeImage(file, film_, options, metadata);
      written_.push_back(file);
    }
  }

  const RunSummary& run() const { return run_; }
  const Exposure& exposure() const { return options_.exposure; }
  const std::vector<std::string>& written() const { return written_; }

 private:
  Camera firstCamera() const {
    return job_.frames.empty() ? chooseCamera(open_.scene, options_)
                               : cameraOnPath(open_.scene, options_, 0);
  }

  const RenderJob& job_;
  Farm& farm_;
  const OpenScene& open_;
  Progress* progress_;
  RenderOptions options_;  // with an automatic exposure settled
  Renderer renderer_;
  Film film_;
  RunSummary run_;
  std::string sceneDigest_;
  std::vector<std::string> written_;
};

void writePath(const RenderJob& job, const Scene& scene, ImageWriter& writer, Progress* progress) {
  const FrameRange range = parseFrameRange(job.frames);
  for (int frame = range.first; frame <= range.last; ++frame) {
    std::vector<std::string> files;
    for (const std::string& output : job.outputs) files.push_back(frameName(output, frame));
    reportProgress(progress, "frame " + std::to_string(frame),
                   static_cast<double>(frame - range.first) / (range.last - range.first + 1));
    writer.write(cameraOnPath(scene, job.common.render, frame / job.fps), files,
                 {{"frame", std::to_string(frame)}});
  }
}

void tellWritten(const std::vector<std::string>& files, double seconds) {
  const std::string what = files.size() == 1 ? files[0] : std::to_string(files.size()) + " images";
  std::fprintf(stderr, "wrote %s, %.1f s\n", printable(what).c_str(), seconds);
}

int render(const Words& words, Farm& farm) {
  const Stopwatch stopwatch;
  RenderJob job;
  if (parseOptions(kRenderUsage, kRenderSummary, listOptions(job), words) == Parsed::helpShown)
    return 0;
  settleOptions(job.common);
  quietUnlessLeading(farm, job.common);
  checkJob(job, farm);

  auto progress = makeProgressBar(job.common);
  const auto open = openScene(job.scenes[0], job.common, progress.get());
  ImageWriter writer(job, *open, farm, progress.get());
  if (job.frames.empty()) {
    writer.write(chooseCamera(open->scene, job.common.render), job.outputs);
  } else {
    writePath(job, open->scene, writer, progress.get());
  }
  progress.reset();
  if (!farm.leads()) return 0;
  const bool traced = !writer.run().frames.empty();  // else all images were there
  if (traced && !job.common.quiet) {
    std::fputs(stageTable(writer.run()).c_str(), stderr);
    if (optionsFor(open->scene, job.common).exposure.automatic) {
      std::fprintf(stderr, "exposure %+g EV\n", static_cast<double>(writer.exposure().ev));
    }
    tellWritten(writer.written(), stopwatch.ms() / 1000);
  }
  if (!job.json.empty()) {
    Json json = runJson(writer.run());
    json["files"] = writer.written();
    json["machine"] = machineJson(writer.run().machine);
    writeJson(job.json, json);
  }
  return 0;
}

}  // namespace

int renderCommand(const Words& words) {
  return Farm::run([&](Farm& farm) { return render(words, farm); });
}

}  // namespace whit::cli
