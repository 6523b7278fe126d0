// whit turntable: a film of a model that turns.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/app/background_writer.h"
#include "cli/app/film_pipe.h"
#include "cli/app/image_output.h"
#include "cli/app/open_scene.h"
#include "cli/app/progress_bar.h"
#include "cli/commands.h"
#include "cli/json_report.h"
#include "core/error.h"
#include "core/printable.h"
#include "core/stopwatch.h"
#include "io/paths.h"
#include "make/turntable.h"
#include "render/auto_exposure.h"
#include "render/describe_image.h"

namespace whit::cli {

namespace {

constexpr const char* kTurntableUsage = "whit turntable SCENE -o FILM.mp4|FRAMES####.png [options]";
constexpr const char* kTurntableSummary =
    "Frames a model, lights it and turns it: the camera goes around it, light stays where it is.\n"
    "A film is made by ffmpeg, where that is installed; else its pictures are written, and the\n"
    "command that makes a film of them is printed. Of a scene file it goes around what its camera\n"
    "looks at.";

struct TurntableJob {
  CommonOptions common;
  std::vector<std::string> scenes;
  std::string output, range, json;
  int frames = 96;
  double fps = 24, turns = 1;
  std::optional<double> seconds;
};

OptionList listOptions(TurntableJob& job) {
  OptionList list;
  list.group("Output");
  list.value({"output", "FILE"},
             "the film, .mp4, or its pictures, .png or .exr, with #### for their number",
             job.output)
      .shortName = "o";
  list.value({"turns", "X", -1000, 1000}, "how often it turns; below 0: the other way around",
             job.turns);
  list.value({"frames", "N", 1, 1e6}, "pictures of all turns together", job.frames);
  list.value({"seconds", "S", 0.001, 1e6}, "how long they last, in place of --frames", job.seconds);
  list.value({"fps", "N", 0.001, 1000}, "pictures a second", job.fps);
  list.value({"range", "A..B"}, "those of the pictures that are made, counted from 0 (all)",
             job.range);
  list.value({"json", "FILE"}, "what was done; - is standard output", job.json);
  listCommonOptions(list, job.common);
  list.operands("SCENE", "a model, a scene file, or the name of a shipped scene", 1, 1, job.scenes);
  return list;
}

bool isFilm(const TurntableJob& job) { return extensionOf(job.output) == ".mp4"; }

void checkJob(TurntableJob& job) {
  if (job.output.empty()) {
    throwUsage("expected a film or pictures to write: -o FILM.mp4 or -o FRAMES####.png");
  }
  requireWritable(job.output, {".mp4", ".png", ".exr"});
  requireJsonWritable(job.json);
  if (job.seconds) {
    const double count = std::round(*job.seconds * job.fps);
    if (!(count >= 1 && count <= 1e6)) {
      throwUsage("--seconds: expected from 1 to 1000000 pictures at this --fps");
    }
    job.frames = static_cast<int>(count);
  }
  if (!isFilm(job)) {
    frameName(job.output, 0);
  } else if (!job.range.empty()) {
    throwUsage("--range makes pictures, no film: give -o FRAMES####.png");
  }
  const auto& size = job.common.render.size;
  if (isFilm(job) && size && (size->width % 2 != 0 || size->height % 2 != 0)) {
    throwUsage("--size: the sides of a film are even numbers of pixels");
  }
  if (isFilm(job) && job.common.render.crop) throwUsage("--crop: a film shows the whole picture");
}

FrameRange rangeOf(const TurntableJob& job) {
  if (job.range.empty()) return {0, job.frames - 1};
  const FrameRange range = parseFrameRange(job.range);
  if (range.last >= job.frames) {
    throwUsage("--range: there are pictures 0 to " + std::to_string(job.frames - 1));
  }
  return range;
}

// "out-0007.png" beside "out.mp4", where no film can be made.
std::string picturesFor(const std::string& film) {
  return film.substr(0, film.size() - extensionOf(film).size()) + "-####.png";
}

// As printf() and ffmpeg number files.
std::string numberedFormat(const std::string& pattern) {
  const std::size_t name = pattern.rfind('/') + 1, begin = pattern.find('#', name);
  const std::size_t end = std::min(pattern.find_first_not_of('#', begin), pattern.size());
  std::string format;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (i == begin) format += "%0" + std::to_string(end - begin) + "d";
    if (i < begin || i >= end) format += pattern[i] == '%' ? "%%" : std::string(1, pattern[i]);
  }
  return format;
}

// A scene, and the camera that goes around in it.
struct Stand {
  std::unique_ptr<OpenScene> open;
  RenderOptions options;
  Turntable turntable;
};

Stand openStand(TurntableJob& job, Progress* progress) {
  RenderOptions& render = job.common.render;
  std::optional<Turntable> aroundIt;
  const auto look = [&](const SceneDescription& scene) {
    ImageSize size = render.size.value_or(ImageSize{scene.width, scene.height});
    if (isFilm(job)) size = {std::max(size.width & ~1, 2), std::max(size.height & ~1, 2)};
    render.size = size;
    if (!scene.isModel || !render.camera.empty() || render.eye || render.at) return;
    ModelView view = viewOf(scene);
    view.camera.fov = render.fov.value_or(view.camera.fov);
    aroundIt = aroundModel(scene, view, size.width, size.height);
  };
  Stand stand;
  stand.open = openScene(job.scenes[0], job.common, progress, look);
  stand.options = optionsFor(stand.open->scene, job.common);
  stand.turntable =
      aroundIt ? *aroundIt : aroundTarget(chooseCamera(stand.open->scene, stand.options));
  stand.turntable.camera.up = stand.options.up.value_or(stand.turntable.camera.up);
  stand.turntable.camera.orthographicHeight =
      stand.options.ortho.value_or(stand.turntable.camera.orthographicHeight);
  return stand;
}

// Traces the pictures, each while the one before it is written.
class Turner {
 public:
  Turner(const TurntableJob& job, Stand& stand, Progress* progress)
      : job_(job), stand_(stand), renderer_(stand.open->scene, stand.options, progress) {
    settleExposure(renderer_, stand.turntable.camera, stand.options);
    CommonOptions half = job.common;
    half.load.maxMemoryBytes /= films_.size();
    for (Film& film : films_) {
      film = openFilm(stand.open->scene, half);
      film.wantDisplay = extensionOf(job.output) != ".exr";
    }
    aboutChannels_ = describeChannels(stand.open->scene, stand.options.channels);
  }

  // write(film, metadata, number of the picture), on a thread beside the tracing.
  using Write = std::function<void(const Film&, const ImageMetadata&, int)>;
  void turn(const FrameRange& range, const Write& write, Progress* progress) {
    BackgroundWriter writer;  // is done before what `write` needs is gone
    const double count = range.last - range.first + 1;
    for (int k = range.first; k <= range.last; ++k) {
      reportProgress(progress, "turning", (k - range.first) / count);
      Film& film = films_[static_cast<std::size_t>(k) % films_.size()];
      const Camera camera = turned(stand_.turntable, job_.turns * k / job_.frames);
      const FrameStats stats = renderFrame(renderer_, stand_.options.mode, camera, film);
      refuseNonFinite(stand_.open->scene, stand_.options, stats);
      frameMs_.push_back(stats.frameMs);
      ImageMetadata metadata =
          describeImage(stand_.open->scene, camera, renderer_, film, stand_.options);
      addSettings(stand_.open->settings, stand_.open->sky, metadata);
      writer.start(
          [&write, &film, metadata = std::move(metadata), k] { write(film, metadata, k); });
    }
    writer.finish();
  }

  ImageFormat format(const std::string& pattern) const {
    return {ExrStorage::zip, renderer_.machine().threads,
            channelNamedBy(pattern, stand_.options.channels), aboutChannels_};
  }
  const RenderOptions& options() const { return stand_.options; }
  ImageSize size() const { return {films_[0].image.width, films_[0].image.height}; }
  double medianMs() const {
    std::vector<double> sorted = frameMs_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return *middle;
  }

 private:
  const TurntableJob& job_;
  Stand& stand_;
  Renderer renderer_;
  std::array<Film, 2> films_;
  ImageMetadata aboutChannels_;
  std::vector<double> frameMs_;
};

// What was made of it.
struct Made {
  std::vector<std::string> files;
  std::string command;  // that makes a film of them; empty: it is made
};

Made makeFilm(const TurntableJob& job, const std::string& program, Turner& turner,
              Progress* progress) {
  FilmPipe pipe(program, job.output, turner.size().width, turner.size().height, job.fps);
  turner.turn(
      rangeOf(job),
      [&](const Film& film, const ImageMetadata&, int) { pipe.add(film.display.rgba); }, progress);
  pipe.finish();
  return {{job.output}, ""};
}

Made makePictures(const TurntableJob& job, const std::string& pattern, Turner& turner,
                  Progress* progress) {
  Made made;
  const ImageFormat format = turner.format(pattern);
  turner.turn(
      rangeOf(job),
      [&](const Film& film, const ImageMetadata& metadata, int k) {
        made.files.push_back(frameName(pattern, k));
        writeImage(made.files.back(), film, turner.options(), metadata, format);
      },
      progress);
  if (extensionOf(pattern) != ".png") return made;
  std::string film = job.output;
  if (!isFilm(job)) {
    const std::size_t mark = pattern.find('#', pattern.rfind('/') + 1);
    film = pattern.substr(0, mark);
    while (!film.empty() && (film.back() == '-' || film.back() == '_' || film.back() == '.')) {
      film.pop_back();
    }
    film = (film.empty() || film.back() == '/' ? film + "turntable" : film) + ".mp4";
  }
  made.command = filmCommand(numberedFormat(pattern), job.fps, film);
  return made;
}

void report(const TurntableJob& job, const Turner& turner, const Made& made, double ms) {
  if (!job.common.quiet) {
    const std::string what = made.files.size() == 1
                                 ? printable(made.files[0])
                                 : std::to_string(made.files.size()) + " pictures";
    std::fprintf(stderr, "wrote %s, %.1f s\n", what.c_str(), ms / 1000);
  }
  if (!made.command.empty() && job.json != "-") std::printf("%s\n", made.command.c_str());
  if (job.json.empty()) return;
  const ImageSize size = turner.size();
  Json json{{"scene", job.scenes[0]},
            {"size", Json::array({size.width, size.height})},
            {"frames", job.frames},
            {"fps", job.fps},
            {"turns", job.turns},
            {"files", made.files},
            {"frame_ms", {{"median", turner.medianMs()}}}};
  if (!made.command.empty()) json["command"] = made.command;
  writeJson(job.json, json);
}

}  // namespace

int turntableCommand(const Words& words) {
  const Stopwatch stopwatch;
  TurntableJob job;
  if (parseOptions(kTurntableUsage, kTurntableSummary, listOptions(job), words) ==
      Parsed::helpShown) {
    return 0;
  }
  settleOptions(job.common);
  checkJob(job);
  rangeOf(job);
  auto progress = makeProgressBar(job.common);
  Stand stand = openStand(job, progress.get());
  const std::optional<std::string> program =
      isFilm(job) ? findProgram("ffmpeg") : std::optional<std::string>();
  Turner turner(job, stand, progress.get());
  Made made;
  if (program) {
    made = makeFilm(job, *program, turner, progress.get());
  } else {
    const std::string pattern = isFilm(job) ? picturesFor(job.output) : job.output;
    made = makePictures(job, pattern, turner, progress.get());
  }
  progress.reset();
  if (isFilm(job) && !program) {
    std::fprintf(stderr,
                 "whit: ffmpeg is not in $PATH: pictures instead of %s; with it installed, "
                 "this makes the film:\n",
                 printable(job.output).c_str());
  }
  report(job, turner, made, stopwatch.ms());
  return 0;
}

}  // namespace whit::cli
