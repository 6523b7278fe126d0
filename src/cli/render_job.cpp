#include "cli/render_job.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "core/error.h"
#include "core/options.h"
#include "core/text.h"
#include "io/files.h"
#include "io/image/image_file.h"
#include "output/film_pipe.h"

namespace whit::cli {
namespace {

constexpr const char* kFilm = ".mp4";

bool isExr(const std::string& output) { return extensionOf(output) == ".exr"; }

void checkStandardOutput(const RenderJob& job) {
  if (!job.toStandardOutput()) return;
  refuseIf(job.resume, "-o -: what went to standard output cannot be resumed");
  refuseIf(isatty(STDOUT_FILENO),
           "-o -: this terminal shows no pictures: send standard output elsewhere");
}

// Throws if an output cannot hold the alpha or the channels of the picture.
void checkBackground(const RenderJob& job) {
  refuseIf(job.exr == ExrStorage::dwaa && !keptChannels(job.common.render).empty(),
           "--exr dwaa is lossy for channels and alpha as well: give --exr zip, none or half");

  if (job.common.render.background.kind != Background::Kind::transparent) return;
  for (const std::string& output : job.outputs) {
    refuseIf(isJpeg(output) || isFilm(output),
             "--background transparent: '" + output + "' has no alpha: write a PNG or an EXR");
  }
}

// Outputs that are named after a channel need no --channels. Throws if no output has a place for
// those that are given.
void addNamedChannels(RenderJob& job) {
  ChannelSet& kept = job.common.render.channels;
  ChannelSet named;
  bool holdsAll = false;
  for (const std::string& output : job.outputs) {
    const std::optional<Channel> channel = channelNamedBy(output, kept);
    if (channel) named = named.with(*channel);
    holdsAll |= isExr(output) && !channel;
    if (channel && needsFloats(*channel) && !isExr(output)) {
      throwUsage("'" + output + "': " + namesOf({*channel}) +
                 "s do not fit into a PNG: write an EXR");
    }

    if (isJpeg(output) || isFilm(output)) requireNoChannelName(output);
  }

  const ChannelSet homeless = holdsAll ? ChannelSet() : kept.without(named);
  refuseIf(!homeless.empty(), "--channels: expected an EXR to keep " + namesOf(homeless) +
                                  " in, or an image named after each, as out.depth.png");
  kept = kept.with(named);
}

void checkExr(const RenderJob& job) {
  refuseIf(job.exr != ExrStorage::zip && std::ranges::none_of(job.outputs, isExr),
           "--exr needs an output that ends in .exr");
}

void checkFilm(const RenderJob& job) {
  if (!job.makesFilm()) return;
  refuseIf(std::ranges::count_if(job.outputs, isFilm) > 1, "-o: one film at a time");
  refuseIf(job.frames.empty(), "a film needs --frames A..B");
  refuseIf(job.resume, "--resume keeps images, and a film is made as a whole");
  refuseIf(job.common.render.crop.has_value(), "--crop: a film shows the whole picture");

  // Codecs store color at half the resolution.
  const ImageSize size = job.common.render.size.value_or(ImageSize());
  refuseIf(size.width % 2 != 0 || size.height % 2 != 0,
           "--size: the sides of a film are even numbers of pixels");
}

bool isOurPicture(const std::string& file) try {
  const ImageMetadata texts = readPngMetadata(file);
  return std::ranges::any_of(texts, [](const auto& text) {
    return text.first == "software" && text.second.starts_with("whit ");
  });
} catch (const Error&) {
  return false;
}

void checkFrames(const RenderJob& job) {
  if (job.frames.empty()) return;
  parseFrameRange(job.frames);
  refuseIf(job.common.load.instant.seconds && !job.onTurntable,
           "--time is one instant, --frames are many: give one");
}

// Chooses SCENE.png if no output is given, and a terminal that shows pictures. A model may have a
// texture of that name, which is not overwritten.
void chooseOutputs(RenderJob& job) {
  // Without -o the picture is shown as well, unless --quiet is given; otherwise only -o - shows it.
  const bool isPlain = job.outputs.empty();
  const bool isForTerminal = isPlain ? !job.common.quiet : job.toStandardOutput();
  if (isForTerminal && job.frames.empty() && !job.resume && job.json != kStandardOutput) {
    job.graphics = terminalGraphics();
  }

  if (job.graphics != TerminalGraphics::none) std::erase(job.outputs, kStandardOutput);
  if (!isPlain) return;

  refuseIf(!job.frames.empty(), "expected a file to write: -o FILM.mp4 or -o FRAMES####.png");
  const std::filesystem::path scene(parseSceneName(job.scenes[0]).file);
  const std::string file = scene.stem().string() + ".png";
  refuseIf(std::filesystem::exists(file) && !isOurPicture(file),
           "'" + file + "' exists and was not made by whit: name another file with -o");
  job.outputs.push_back(file);
}

void checkBudget(RenderJob& job) {
  job.budget = parseBudget(job.time, job.target);
  if (!job.budget.isSet()) return;
  const std::string option = job.time.empty() ? "--target" : "--budget";
  refuseIf(!job.frames.empty(), option + " is of one picture: leave out --frames");
  refuseIf(job.resume, option + ": what is chosen differs from run to run: leave out --resume");
}

// Warns of frosted glass if the picture has no rays that sample it.
void warnOfClearGlass(const RenderJob& job, const Scene& scene) {
  if (glossySamples(job.common.render) > 0) return;
  if (std::ranges::none_of(scene.materials, &Material::isFrosted)) return;

  std::fputs("whit: warning: frosted glass shown clear: set --glossy 16 or --quality good\n",
             stderr);
}

// Throws if the error of one sample is to be written as a PNG. That error is not known, which only
// an EXR can express.
void checkErrorChannel(const RenderJob& job) {
  if (job.common.render.spp > 1) return;
  for (const std::string& output : job.outputs) {
    refuseIf(extensionOf(output) == ".png" && channelNamedBy(output, {}) == Channel::error,
             "'" + output + "': one sample leaves the error unknown: add --spp 2 or more");
  }
}

void checkFilmed(const RenderJob& job, const Scene& scene) {
  if (job.frames.empty() || job.onTurntable) return;
  refuseIf(scene.cameraPath.empty() && scene.animations.empty(),
           "--frames: nothing moves in scene '" + scene.name +
               "', it has no camera path and no animation");
  refuseIf(job.common.given.contains("camera") && !scene.cameraPath.empty(),
           "--camera names a still viewpoint, --frames follows the scene's path: give one");
}

}  // namespace

bool isFilm(const std::string& output) { return extensionOf(output) == kFilm; }

bool RenderJob::makesFilm() const { return std::ranges::any_of(outputs, isFilm); }

OptionList listOptions(RenderJob& job) {
  OptionList list;
  list.group("Output");
  list.many({"output", "FILE"},
            "image to write, .exr (linear), .png or .jpg, or a film of all frames, .mp4; - writes "
            "a PNG to standard output; may be repeated" +
                std::string(job.onTurntable ? "" : " (default: SCENE.png)"),
            job.outputs)
      .shortName = "o";

  if (job.onTurntable) {
    list.value({"turns", "X", -1000, 1000}, "turns of the camera; below 0: the other way around",
               job.turns);
    list.value({"count", "N", 1, 1e6}, "frames of all turns together", job.turntableFrames);
    list.value({"frames", "A..B"}, "frames that are rendered, counted from 0 (default: all)",
               job.frames);
  } else {
    list.value({"budget", "TIME"},
               "choose the options that are not given for the least visible error within a time, "
               "as 50ms or 10s, with all that is measured for that; prints what was chosen",
               job.time);
    list.value({"target", "ERROR"},
               "choose them for the least time within an error, as 0.5codes or flip=0.01",
               job.target)
        .everyday = false;
    list.value({"frames", "A..B"},
               "frames of the animation and the camera path; FILE has #### for the number",
               job.frames);
  }

  list.value({"fps", "N", 0.001, 1e6}, "frames per second", job.fps);
  list.flag("resume",
            "keep images that are complete and were made with the same options of the same scene",
            job.resume)
      .everyday = false;
  list.value(kExrOption,
             "pixels of an EXR: floats, compressed or not; half floats, compressed; or half floats "
             "with OpenEXR's lossy DWAA compression",
             job.exr)
      .everyday = false;
  list.flag("stats", "prints the stages with their times, and the rays", job.stats);
  list.value({"json", "FILE"}, "settings, times and counts as JSON; - is standard output",
             job.json);
  listCommonOptions(list, job.common);
  list.operands("SCENE", "a scene file, a model, or the name of a shipped scene", 1, 1, job.scenes);
  return list;
}

void checkJob(RenderJob& job) {
  checkFrames(job);
  chooseOutputs(job);
  checkBudget(job);
  addNamedChannels(job);
  checkBackground(job);
  checkExr(job);
  checkFilm(job);
  checkStandardOutput(job);

  std::vector<std::string> files{job.json};
  for (const std::string& output : job.outputs) {
    refuseIf(job.resume && isJpeg(output),
             "--resume: a JPEG does not hold the options it was made with");
    if (output != kStandardOutput)
      requireWritable(output, {".exr", ".png", ".jpg", ".jpeg", kFilm});

    // Frames need a place for their number in the file's name, and a single image has none.
    const bool isFrame = !job.frames.empty() && !isFilm(output);
    if (job.frames.empty()) requireNoFrameName(output);
    const FrameRange range = isFrame ? parseFrameRange(job.frames) : FrameRange();

    // Frames count if they would replace a file, and the last one always: patterns that agree for
    // any frame agree for the last one, which has the most digits.
    for (int frame = range.first; frame <= range.last; ++frame) {
      const std::string file = isFrame ? frameName(output, frame) : output;
      if (frame == range.last || std::filesystem::exists(file)) files.push_back(file);
    }
  }

  requireJsonWritable(job.json);
  requireSeparateFiles(files, job.common, job.scenes);
  if (job.makesFilm() && !hasFfmpeg()) {
    throwIo("ffmpeg, which makes films, is not in $PATH: write frames, as -o frame-####.png");
  }
}

void checkScene(const RenderJob& job, const Scene& scene) {
  checkBackground(job);
  checkErrorChannel(job);
  checkFilmed(job, scene);
  warnOfClearGlass(job, scene);
}

}  // namespace whit::cli
