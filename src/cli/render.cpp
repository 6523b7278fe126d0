// whit render and whit turntable: one image, or the frames of a scene or a camera that moves.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "cli/commands.h"
#include "cli/render_job.h"
#include "command_line/progress_bar.h"
#include "core/error.h"
#include "core/index.h"
#include "core/options.h"
#include "core/stopwatch.h"
#include "core/text.h"
#include "engine/engine.h"
#include "io/files.h"
#include "output/background_writer.h"
#include "output/digest.h"
#include "output/film_pipe.h"
#include "output/json_report.h"
#include "output/open_and_warn.h"

namespace whit::cli {

namespace {

constexpr const char* kRenderUsage = "whit render SCENE [-o OUT.exr|OUT.png|FILM.mp4] [options]";
constexpr const char* kRenderSummary =
    "Renders one image, or with --frames those of the scene's animation and camera path, as images "
    "or, where ffmpeg is installed, as a film. On standard output (-o -) frames follow each other "
    "as PNG files, which ffmpeg -f image2pipe reads. An EXR has all of --channels; a PNG or EXR "
    "named after a channel (out.depth.png) has that channel alone.";
constexpr const char* kTurntableUsage = "whit turntable SCENE -o FILM.mp4|FRAMES####.png [options]";
constexpr const char* kTurntableSummary =
    "Renders a model on a turntable: supplies a view and light, moves the camera once around the "
    "model and leaves the light where it is. In a scene file the camera goes around the point that "
    "it looks at. ffmpeg makes the film. Its --quality is good unless another is given.";

// Opens the scene and, for a turntable, places the camera.
Engine openFor(RenderJob& job, Progress* progress) {
  RenderOptions& options = job.common.render;
  const auto look = [&](const SceneDescription& scene) {
    ImageSize size = options.size.value_or(ImageSize{scene.width, scene.height});
    // A film needs even sides.
    if (job.makesFilm()) {
      size = {std::max(size.width & ~1, 2), std::max(size.height & ~1, 2)};
      options.size = size;
    }

    // A model gets a view that suits a turntable, unless the options choose one.
    const bool viewed = !options.camera.empty() || options.eye || options.at;
    if (!job.onTurntable || !scene.isModel || viewed) return;

    ModelView view = viewOf(scene);
    view.camera.fov = options.fov.value_or(view.camera.fov);
    job.turntable = aroundModel(scene, view, size.width, size.height);
    Camera& camera = job.turntable->camera;
    camera.up = options.up.value_or(camera.up);
    camera.orthographicHeight = options.ortho.value_or(camera.orthographicHeight);
  };

  // Presets and the options that the scene states fill in what the user has not given.
  Engine engine(openAndWarn(job.scenes[0], job.common, progress, look));
  engine.setOptions(options, job.common.given);
  options = engine.requestedOptions();
  checkScene(job, engine.scene());

  // In a scene with a viewpoint, the camera turns around the point that it looks at.
  if (job.onTurntable && !job.turntable) {
    job.turntable = aroundTarget(chooseCamera(engine.scene(), options));
  }
  if (job.turntable) engine.lookThrough(job.turntable->camera);
  return engine;
}

// Returns two films where frames follow each other and memory suffices: one is written while the
// other is traced.
std::vector<Film> openFilms(const RenderJob& job, const Scene& scene) {
  const RenderOptions& options = job.common.render;
  const std::uint64_t most = job.common.load.maxMemoryBytes;
  bool wantDisplay = job.graphics != TerminalGraphics::none;
  for (const std::string& output : job.outputs) wantDisplay |= extensionOf(output) != ".exr";
  std::vector<Film> films{makeFilm(scene, options, most)};

  // A second film of this size fits if each takes at most half of the memory.
  try {
    if (!job.frames.empty()) films.push_back(makeFilm(scene, options, most / 2));
  } catch (const Error& limit) {
    if (limit.status() != ExitStatus::limit) throw;
  }

  for (Film& film : films) film.wantDisplay = wantDisplay;
  return films;
}

// Traces frames and writes them, each beside the tracing of the next.
class ImageWriter {
 public:
  ImageWriter(const RenderJob& job, Engine& engine, Progress* progress)
      : job_(job), engine_(engine), films_(openFilms(job, engine.scene())) {
    engine_.prepare(progress);  // all frames have one exposure, whichever are written
    run_ = summary();
    sceneDigest_ = digestOf(engine_.scene());
    aboutChannels_ = describeChannels(engine_.scene(), engine_.options().channels);

    // A film is made of all frames, which go to ffmpeg one after the other.
    const auto film = std::ranges::find_if(job.outputs, isFilm);
    if (film == job.outputs.end()) return;
    const Image& image = films_[0].image;
    pipe_.emplace(*film, image.width, image.height, job.fps);
    written_.push_back(*film);
  }

  // Moves the camera of a turntable, or else the scene, to where frame `frame` shows it.
  void moveTo(int frame) {
    if (job_.turntable) {
      engine_.remember(cameraAt(frame - 1));
      camera_ = cameraAt(frame);
      return;
    }

    const Stopwatch stopwatch;
    moveToTime(frame / job_.fps);
    engine_.update();

    // A scene that has moved has another digest, by which --resume recognizes its images.
    const BakedMotion& motion = engine_.scene().motion;
    if (!motion.ofGeometry && !motion.ofLights()) return;
    run_.updateMs.push_back(stopwatch.ms());
    sceneDigest_ = digestOf(engine_.scene());
    run_.tracedAndWrittenMs += stopwatch.ms();
  }

  // Moves the scene; the channel "motion" counts from the frame before.
  void moveToTime(double seconds) {
    if (engine_.options().channels.has(Channel::motion)) {
      engine_.setTime(seconds - 1 / job_.fps);
      engine_.remember();
    }
    engine_.setTime(seconds);
  }

  // Renders a frame and starts writing it; the files are complete after finish(). With --resume
  // nothing is traced if all files are complete.
  void write(const std::vector<std::string>& files, Progress* progress,
             const ImageMetadata& more = {}) {
    const Stopwatch stopwatch;
    Film& film = films_[film_];
    const auto complete = [&](ImageMetadata about) {
      about.emplace_back("sceneDigest", sceneDigest_);
      about.insert(about.end(), more.begin(), more.end());
      return about;
    };

    if (job_.resume) {
      const Camera camera = camera_ ? *camera_ : engine_.camera();
      if (areWhole(files, film.image, complete(engine_.describe(camera, film)))) {
        ++run_.kept;
        return;
      }
    }

    Picture picture = engine_.render({camera_, job_.budget, progress}, film);
    if (picture.receipt) {
      receipt_ = std::move(picture.receipt);
      run_ = summary();  // with the options that were chosen
    }

    run_.frames.push_back(picture.stats);
    run_.imageHash = digestOf(film.image);
    startWriting(film, files, complete(std::move(picture.about)));
    run_.tracedAndWrittenMs += stopwatch.ms();
  }

  void finish() {
    const Stopwatch stopwatch;
    writer_.finish();
    if (pipe_) pipe_->finish();
    run_.tracedAndWrittenMs += stopwatch.ms();
    for (const BackgroundWriter::Times& times : writer_.times()) {
      run_.writingMs.push_back(times.spentMs);
      run_.waitedMs.push_back(times.waitedMs);
    }
  }

  const RunSummary& run() const { return run_; }
  std::size_t kept() const { return run_.kept; }
  const DisplayImage& firstPicture() const { return films_[0].display; }
  const Image& image() const { return films_[0].image; }
  const Exposure& exposure() const { return engine_.options().exposure; }
  const std::vector<std::string>& written() const { return written_; }
  const std::optional<Receipt>& receipt() const { return receipt_; }

 private:
  RunSummary summary() {
    const double loadMs = engine_.opened()->loadMs;
    return summarize(engine_.scene(), engine_.options(), engine_.renderer(), films_[0], loadMs);
  }

  Camera cameraAt(int frame) const {
    return turned(*job_.turntable, job_.turns * frame / job_.turntableFrames);
  }

  bool areWhole(const std::vector<std::string>& files, const Image& image,
                const ImageMetadata& metadata) const {
    return std::ranges::all_of(files, [&](const std::string& file) {
      ImageMetadata expected = metadata;
      const std::size_t number = &file - files.data();
      const ImageMetadata own = ownMetadata(file, formatOf(number));
      expected.insert(expected.end(), own.begin(), own.end());
      return isWhole(file, image, expected, engine_.options());
    });
  }

  // `output` is an index of job_.outputs.
  ImageFormat formatOf(std::size_t output) const {
    return {job_.exr, run_.machine.threads,
            channelNamedBy(job_.outputs[output], engine_.options().channels), aboutChannels_};
  }

  void startWriting(const Film& film, const std::vector<std::string>& files,
                    ImageMetadata metadata) {
    writer_.start([=, this, &film, metadata = std::move(metadata)] {
      for (const auto i : indices(files)) {
        if (isFilm(files[i])) {
          pipe_->add(film.display.rgba);
        } else {
          writeImage(files[i], film, metadata, formatOf(i));
        }
      }
    });

    std::ranges::copy_if(files, std::back_inserter(written_), std::not_fn(isFilm));

    // A single film must be written before the next frame is traced into it.
    if (films_.size() == 1) writer_.finish();
    film_ = (film_ + 1) % films_.size();  // its previous frame has been written
  }

  const RenderJob& job_;
  Engine& engine_;
  std::optional<Camera> camera_;  // camera of a turntable
  std::optional<Receipt> receipt_;
  std::vector<Film> films_;
  std::size_t film_ = 0;  // the film that is traced next
  RunSummary run_;
  std::string sceneDigest_;
  ImageMetadata aboutChannels_;
  std::vector<std::string> written_;
  std::optional<FilmPipe> pipe_;
  BackgroundWriter writer_;  // last, because what it writes must outlive it
};

void writeFilm(const RenderJob& job, ImageWriter& writer, Progress* progress) {
  const FrameRange range = parseFrameRange(job.frames);
  for (int frame = range.first; frame <= range.last; ++frame) {
    std::vector<std::string> files;
    for (const std::string& output : job.outputs) {
      files.push_back(isFilm(output) ? output : frameName(output, frame));
    }

    // Frames that were kept take no time, so they do not count as progress.
    const auto kept = static_cast<double>(writer.kept());
    reportProgress(progress, formatted("frame %d of %d..%d", frame, range.first, range.last),
                   (frame - range.first - kept) / (range.last - range.first + 1 - kept));

    writer.moveTo(frame);
    writer.write(files, nullptr, {{"frame", std::to_string(frame)}});
  }
}

// Prints the statistics and the receipt that were asked for.
void printReports(const ImageWriter& writer, const RenderJob& job) {
  if (job.common.quiet) return;
  if (job.stats) std::fputs(stageTable(writer.run()).c_str(), stderr);
  if (writer.receipt()) {
    std::fputs(receiptText(*writer.receipt(), job.words).c_str(), stderr);
  }
}

void printWrittenImages(const ImageWriter& writer, const RenderJob& job, double seconds) {
  const std::vector<std::string>& files = writer.written();
  const RunSummary& run = writer.run();
  std::string what = concat(files.size(), " images");
  if (files.size() == 1) what = files[0] == kStandardOutput ? "an image" : printable(files[0]);
  if (writer.kept() > 0) what += concat(", kept ", writer.kept());
  const Image& image = writer.image();
  if (!run.frames.empty()) {
    what += formatted(", %dx%d", image.windowWidth(), image.windowHeight());
  }
  if (job.common.render.exposure.automatic) {
    what += formatted(", exposure %g EV", double{writer.exposure().ev});
  }

  std::fprintf(stderr, "wrote %s, %.1f s\n", what.c_str(), seconds);
}

void writeReport(const RenderJob& job, const ImageWriter& writer) {
  Json json = runJson(writer.run());
  json["files"] = writer.written();
  json["kept"] = writer.kept();
  json["machine"] = machineJson(writer.run().machine);
  if (!job.frames.empty()) json["film_fps"] = job.fps;
  if (job.onTurntable) json["turns"] = job.turns;
  writeJson(job.json, json);
}

// Returns the words, each behind a blank, without these options and their values.
std::string wordsWithout(const std::vector<std::string>& options, const Words& words) {
  std::string kept;
  bool isValue = false;
  for (const std::string& word : words) {
    const bool isLeftOut = contains(options, word.substr(0, word.find('=')));
    if (!isLeftOut && !isValue) kept += " " + printable(quoted(word));

    // The word behind an option without '=' is its value.
    isValue = isLeftOut && word.find('=') == std::string::npos;
  }
  return kept;
}

int render(RenderJob& job) {
  const Stopwatch stopwatch;
  checkJob(job);

  auto progress = makeProgressBar(job.common);

  // Only --frames of a scene follow its animation and camera path; a turntable moves the camera
  // itself.
  job.common.load.instant.plays = job.common.load.instant.alongPath =
      !job.frames.empty() && !job.onTurntable;
  Engine engine = openFor(job, progress.get());
  ImageWriter writer(job, engine, progress.get());

  if (job.frames.empty()) {
    if (const auto seconds = job.common.load.instant.seconds) writer.moveToTime(*seconds);
    writer.write(job.outputs, progress.get());
  } else {
    writeFilm(job, writer, progress.get());
  }
  writer.finish();
  progress.reset();

  const bool traced = !writer.run().frames.empty();  // false if --resume kept all images
  if (traced) {
    printReports(writer, job);
    printPictureWarnings(writer.run());
  }

  if (job.graphics != TerminalGraphics::none) {
    const WriteScope scope;
    std::fputs(terminalPicture(writer.firstPicture(), job.graphics).c_str(), stdout);
    std::fflush(stdout);
  }

  if (!job.common.quiet && !job.outputs.empty())
    printWrittenImages(writer, job, stopwatch.ms() / 1000);
  if (!job.json.empty()) writeReport(job, writer);
  printWrittenFiles({job.json}, job.common);
  return 0;
}

}  // namespace

int renderCommand(const Words& words) {
  RenderJob job;
  job.words = wordsWithout({"--budget", "--target"}, words);
  return parseOptions(kRenderUsage, kRenderSummary, listOptions(job), words) ? render(job) : 0;
}

int turntableCommand(const Words& words) {
  RenderJob job;
  job.onTurntable = true;
  job.common.render.quality = Quality::good;
  applyQuality(job.common.render, {});  // --help states the values of the preset
  if (!parseOptions(kTurntableUsage, kTurntableSummary, listOptions(job), words)) return 0;

  if (job.frames.empty()) job.frames = concat("0..", job.turntableFrames - 1);
  return render(job);
}

}  // namespace whit::cli
