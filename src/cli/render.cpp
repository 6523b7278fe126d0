// whit render: one image, or the frames of a scene that moves.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "accuracy/digest.h"
#include "bake/move_scene.h"
#include "cli/app/background_writer.h"
#include "cli/app/image_output.h"
#include "cli/app/open_scene.h"
#include "cli/app/progress_bar.h"
#include "cli/commands.h"
#include "cli/json_report.h"
#include "cli/stage_table.h"
#include "cli/whole_image.h"
#include "core/error.h"
#include "core/options.h"
#include "core/printable.h"
#include "core/stopwatch.h"
#include "io/image/image_file.h"
#include "io/paths.h"
#include "render/auto_exposure.h"
#include "render/describe_image.h"
#include "render/verdict_schedule.h"
#include "simd/deform_vertices.h"

namespace whit::cli {

namespace {

constexpr const char* kRenderUsage = "whit render SCENE -o OUT.exr|OUT.png [options]";
constexpr const char* kRenderSummary =
    "Renders one image, or with --frames those of the scene's animation and camera path. To "
    "standard\n"
    "output (-o -) frames follow each other, as ffmpeg -f image2pipe reads them. An EXR has all\n"
    "of --channels, a PNG whose name says so (out.depth.png) is one of them, of 16 bits.";

struct RenderJob {
  CommonOptions common;
  std::vector<std::string> scenes, outputs;
  std::string frames, json;
  double fps = 24;
  bool resume = false;
  ExrStorage exr = ExrStorage::zip;

  bool toStandardOutput() const {
    return std::find(outputs.begin(), outputs.end(), kStandardOutput) != outputs.end();
  }
};

OptionList listOptions(RenderJob& job) {
  OptionList list;
  list.group("Output");
  list.many({"output", "FILE"},
            "image to write, .exr (linear) or .png; - is a PNG to standard output; may be repeated",
            job.outputs)
      .shortName = "o";
  list.value({"frames", "A..B"},
             "frames of the animation and the camera path; FILE has #### for the number",
             job.frames);
  list.value({"fps", "N", 0.001, 1e6}, "frames a second", job.fps);
  list.flag(
      "resume",
      "leave out images that are there, whole and made with the same options of the same contents "
      "of the scene",
      job.resume);
  list.value(kExrOption,
             "how an EXR keeps its pixels: floats, compressed or as they are; half floats, "
             "compressed; half floats with OpenEXR's lossy DWAA",
             job.exr);
  list.value({"json", "FILE"}, "what was done and what it cost; - is standard output", job.json);
  listCommonOptions(list, job.common);
  list.operands("SCENE", "a scene file, a model, or the name of a shipped scene", 1, 1, job.scenes);
  return list;
}

void checkStandardOutput(const RenderJob& job) {
  if (!job.toStandardOutput()) return;
  if (std::count(job.outputs.begin(), job.outputs.end(), kStandardOutput) > 1) {
    throwUsage("-o -: standard output takes one image: give it once");
  }
  if (job.json == kStandardOutput) {
    throwUsage("-o - and --json -: standard output takes one of them");
  }
  if (job.resume) throwUsage("-o -: what went to standard output cannot be resumed");
  if (isatty(STDOUT_FILENO)) throwUsage("-o -: standard output is a terminal: send it elsewhere");
}

// Channels are asked for to be written, and each PNG of one can be.
void checkChannels(const RenderJob& job) {
  const ChannelSet kept = job.common.render.channels;
  if (kept.empty()) return;
  bool written = false;
  for (const std::string& output : job.outputs) {
    const std::optional<Channel> channel = channelNamedBy(output, kept);
    written |= channel || extensionOf(output) == ".exr";
    if (channel == Channel::position) {
      throwUsage("'" + output + "': positions do not fit into a PNG: write an EXR");
    }
  }
  if (!written) {
    throwUsage(
        "--channels: expected an EXR to keep them in, or a PNG named by one, as "
        "out.depth.png");
  }
  if (job.exr == ExrStorage::dwaa) {
    throwUsage("--exr dwaa is lossy for channels as well: give --exr zip, none or half");
  }
}

void checkJob(const RenderJob& job, const Farm& farm) {
  if (job.outputs.empty()) throwUsage("expected an image to write: -o OUT.exr or -o OUT.png");
  checkShared(farm, job.common);
  checkChannels(job);
  if (farm.leads()) {
    checkStandardOutput(job);
    for (const std::string& output : job.outputs) {
      if (output != kStandardOutput) requireWritable(output, {".exr", ".png"});
    }
    requireJsonWritable(job.json);
  }
  if (job.frames.empty()) {
    for (const std::string& output : job.outputs) requireNoFrameName(output);
    return;
  }
  parseFrameRange(job.frames);
  for (const std::string& output : job.outputs) frameName(output, 0);
  if (job.common.load.instant.seconds) {
    throwUsage("--time is one instant, --frames are many: give one");
  }
}

void checkFilmed(const RenderJob& job, const Scene& scene) {
  if (job.frames.empty()) return;
  if (scene.cameraPath.empty() && scene.animations.empty()) {
    throwUsage("--frames: nothing moves in scene '" + scene.name +
               "', it has no camera path and no animation");
  }
  if (job.common.given.contains("camera") && !scene.cameraPath.empty()) {
    throwUsage("--camera names a still viewpoint, --frames follows the scene's path: give one");
  }
}

// Two films where frames follow each other and both find room: one is written while the other is
// traced.
std::vector<Film> openFilms(const RenderJob& job, const Scene& scene) {
  CommonOptions half = job.common;
  half.load.maxMemoryBytes /= 2;
  bool wantDisplay = false;
  for (const std::string& output : job.outputs) wantDisplay |= extensionOf(output) != ".exr";
  std::vector<Film> films{openFilm(scene, job.common)};
  try {
    if (!job.frames.empty()) films.push_back(openFilm(scene, half));
  } catch (const Error& limit) {
    if (limit.status() != ExitStatus::limit) throw;
  }
  for (Film& film : films) film.wantDisplay = wantDisplay;
  return films;
}

// Traces frames and writes them, each beside the tracing of the next.
class ImageWriter {
 public:
  ImageWriter(const RenderJob& job, OpenScene& open, Farm& farm, Progress* progress)
      : job_(job),
        farm_(farm),
        open_(&open),
        options_(optionsFor(open.scene, job.common)),
        films_(openFilms(job, open.scene)) {
    renderer_.emplace(open.scene, options_, progress);
    if (farm.ranks() == 1) {
      std::size_t frames = 1;
      if (!job.frames.empty()) {
        const FrameRange range = parseFrameRange(job.frames);
        frames = static_cast<std::size_t>(range.last - range.first) + 1;
      }
      const std::uint64_t most = job.common.load.maxMemoryBytes;
      schedule_.emplace(*renderer_, VerdictRun{frames, films_[0].image.pixels.size(),
                                               memoryLeft(open.scene, *renderer_, most)});
    }
    // One for all frames, whichever of them are asked for.
    settleExposure(*renderer_, camera(), options_);
    run_ = summarize(open.scene, options_, *renderer_, films_[0], open.loadMs);
    if (farm.leads()) sceneDigest_ = accuracy::digestOf(open.scene);
    aboutChannels_ = describeChannels(open.scene, options_.channels);
  }

  // Frames to come are those of another instant. Where cameras alone move, that is for nothing.
  void updateScene(double seconds) {
    const Stopwatch stopwatch;
    moveScene(open_->scene, seconds, simd::deformVertices);
    if (!scene().motion.ofGeometry && !scene().motion.ofLights()) return;
    renderer_->sceneMoved();
    run_.updateMs.push_back(stopwatch.ms());
    if (farm_.leads()) sceneDigest_ = accuracy::digestOf(open_->scene);
    run_.tracedAndWrittenMs += stopwatch.ms();
  }

  // The scene as its camera sees it. With --resume, nothing is traced when all files are there. The
  // files are there after finish().
  void write(const std::vector<std::string>& files, Progress* progress,
             const ImageMetadata& more = {}) {
    const Stopwatch stopwatch;
    const Camera camera = this->camera();
    Film& film = films_[film_];
    ImageMetadata metadata = describeImage(open_->scene, camera, *renderer_, film, options_);
    addSettings(open_->settings, open_->sky, metadata);
    metadata.emplace_back("sceneDigest", sceneDigest_);
    metadata.insert(metadata.end(), more.begin(), more.end());
    if (farm_.leads() && job_.resume && areWhole(files, film.image, metadata)) {
      farm_.leaveOut();
      ++run_.kept;
      return;
    }
    prepareAudit(camera, film);
    if (schedule_) schedule_->prepare(camera, film);
    run_.frames.push_back(renderShared(farm_, *renderer_, options_, camera, film, progress));
    if (!farm_.leads()) return;
    if (farm_.ranks() > 1) run_.shares.push_back(farm_.lastFrame());
    refuseNonFinite(open_->scene, options_, run_.frames.back());
    run_.imageHash = accuracy::digestOf(film.image);
    startWriting(film, files, std::move(metadata));
    lookForVerdicts();
    run_.tracedAndWrittenMs += stopwatch.ms();
  }

  const Scene& scene() const { return open_->scene; }

  void finish() {
    const Stopwatch stopwatch;
    writer_.finish();
    run_.tracedAndWrittenMs += stopwatch.ms();
    for (const BackgroundWriter::Times& times : writer_.times()) {
      run_.writingMs.push_back(times.spentMs);
      run_.waitedMs.push_back(times.waitedMs);
    }
  }

  const RunSummary& run() const { return run_; }
  std::size_t kept() const { return run_.kept; }
  const Exposure& exposure() const { return options_.exposure; }
  const std::vector<std::string>& written() const { return written_; }

 private:
  Camera camera() const { return chooseCamera(scene(), options_); }

  // Of an audit: the first frame asks for verdicts of shadow, and those after it have them.
  void prepareAudit(const Camera& camera, Film& film) {
    if (options_.verdicts != Verdicts::audit || options_.mode == Mode::reference) return;
    if (run_.verdicts || farm_.ranks() > 1) return;
    const std::uint64_t most = job_.common.load.maxMemoryBytes;
    renderer_->expectFrames(memoryLeft(open_->scene, *renderer_, most));
    if (!renderer_->decidesShadows()) return;
    run_.verdicts.emplace();
    renderer_->render(camera, film);
    lookForVerdicts();
  }

  void lookForVerdicts() {
    if (options_.verdicts == Verdicts::audit && run_.verdicts) {
      run_.verdicts->fillMs += renderer_->fillVerdicts().ms;
    } else if (schedule_ && schedule_->used()) {
      schedule_->frameDone();
      if (!run_.verdicts) run_.verdicts.emplace();
      run_.verdicts->fillMs = schedule_->fillMs();
    }
    if (run_.verdicts) run_.verdicts->bytes = renderer_->verdictBytes();
  }

  bool areWhole(const std::vector<std::string>& files, const Image& image,
                const ImageMetadata& metadata) const {
    return std::all_of(files.begin(), files.end(), [&](const std::string& file) {
      ImageMetadata expected = metadata;
      const auto number = static_cast<std::size_t>(&file - files.data());
      const ImageMetadata own = ownMetadata(file, formatOf(number));
      expected.insert(expected.end(), own.begin(), own.end());
      return isWhole(file, image, expected, options_);
    });
  }

  // Of the output of this number.
  ImageFormat formatOf(std::size_t output) const {
    return {job_.exr, renderer_->machine().threads,
            channelNamedBy(job_.outputs[output], options_.channels), aboutChannels_};
  }

  void startWriting(const Film& film, const std::vector<std::string>& files,
                    ImageMetadata metadata) {
    writer_.start([=, this, &film, metadata = std::move(metadata)] {
      for (std::size_t i = 0; i < files.size(); ++i) {
        writeImage(files[i], film, options_, metadata, formatOf(i));
      }
    });
    written_.insert(written_.end(), files.begin(), files.end());
    if (films_.size() == 1) writer_.finish();
    film_ = (film_ + 1) % films_.size();  // the one before has been written
  }

  const RenderJob& job_;
  Farm& farm_;
  OpenScene* open_;
  RenderOptions options_;  // with an automatic exposure settled
  std::optional<Renderer> renderer_;
  std::optional<VerdictSchedule> schedule_;
  std::vector<Film> films_;
  std::size_t film_ = 0;  // that is traced next
  RunSummary run_;
  std::string sceneDigest_;
  ImageMetadata aboutChannels_;
  std::vector<std::string> written_;
  BackgroundWriter writer_;  // last: what it writes must outlive it
};

// How far the frames have come; those that were there take no time.
class PathProgress : public Progress {
 public:
  PathProgress(Progress& whole, const FrameRange& range) : whole_(whole), range_(range) {}

  void begin(int frame, std::size_t kept) {
    frame_ = frame;
    kept_ = static_cast<double>(kept);
    report("", 0);
  }
  void report(const std::string&, double fraction) override {
    const double all = range_.last - range_.first + 1 - kept_;
    whole_.report("frame " + std::to_string(frame_) + " of " + std::to_string(range_.first) + ".." +
                      std::to_string(range_.last),
                  (frame_ - range_.first - kept_ + fraction) / all);
  }

 private:
  Progress& whole_;
  FrameRange range_;
  int frame_ = 0;
  double kept_ = 0;
};

void writeFilm(const RenderJob& job, ImageWriter& writer, Progress* progress) {
  const FrameRange range = parseFrameRange(job.frames);
  std::optional<PathProgress> path;
  if (progress) path.emplace(*progress, range);
  for (int frame = range.first; frame <= range.last; ++frame) {
    std::vector<std::string> files;
    for (const std::string& output : job.outputs) files.push_back(frameName(output, frame));
    if (path) path->begin(frame, writer.kept());
    writer.updateScene(frame / job.fps);
    writer.write(files, path ? &*path : nullptr, {{"frame", std::to_string(frame)}});
  }
}

void tellWritten(const ImageWriter& writer, double seconds) {
  const std::vector<std::string>& files = writer.written();
  std::string what = std::to_string(files.size()) + " images";
  if (files.size() == 1) what = files[0] == kStandardOutput ? "an image" : printable(files[0]);
  std::string kept;
  if (writer.kept() > 0) kept = ", kept " + std::to_string(writer.kept());
  std::fprintf(stderr, "wrote %s%s, %.1f s\n", what.c_str(), kept.c_str(), seconds);
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
  job.common.load.instant.plays = job.common.load.instant.alongPath = !job.frames.empty();
  const auto open = openScene(job.scenes[0], job.common, progress.get());
  checkFilmed(job, open->scene);
  ImageWriter writer(job, *open, farm, progress.get());
  if (job.frames.empty()) {
    writer.write(job.outputs, progress.get());
  } else {
    writeFilm(job, writer, progress.get());
  }
  writer.finish();
  progress.reset();
  if (!farm.leads()) return 0;
  const bool traced = !writer.run().frames.empty();  // else all images were there
  if (traced && !job.common.quiet) {
    std::fputs(stageTable(writer.run()).c_str(), stderr);
    if (optionsFor(open->scene, job.common).exposure.automatic) {
      std::fprintf(stderr, "exposure %+g EV\n", static_cast<double>(writer.exposure().ev));
    }
  }
  if (!job.common.quiet) tellWritten(writer, stopwatch.ms() / 1000);
  if (!job.json.empty()) {
    Json json = runJson(writer.run());
    json["files"] = writer.written();
    json["kept"] = writer.kept();
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
