#include "viewer/path_run.h"

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "cli/app/frame_summary.h"
#include "cli/app/image_output.h"
#include "cli/app/open_scene.h"
#include "core/error.h"
#include "core/stopwatch.h"
#include "render/auto_exposure.h"
#include "render/describe_image.h"
#include "render/shadow_cache_schedule.h"
#include "viewer/app.h"

namespace whit::view {

namespace {

constexpr double kFramesPerSecond = 24;

// Once around the point looked at, about the camera's own `up`.
Camera orbit(const Camera& camera, double share) {
  const Vec3d at(camera.at), arm = Vec3d(camera.eye) - at;
  Camera turned = camera;
  turned.eye = Vec3f(at + Affine::rotation(Vec3d(camera.up), 360 * share).vector(arm));
  return turned;
}

Camera cameraOf(const Scene& scene, const RenderOptions& options, double share) {
  if (scene.cameraPath.empty()) return orbit(chooseCamera(scene, options), share);
  const double begin = scene.cameraPath.front().time, end = scene.cameraPath.back().time;
  return cameraAt(scene.cameraPath, begin + share * (end - begin));
}

void show(Window& window, const DisplayImage& image) {
  window.upload(image);
  window.begin();
  window.end();
  window.present();
  window.finish();
}

// Keys struck while the picture rests, while it becomes sharper, and while others are held.
constexpr const char* kLatencyScript = R"(
  wait 30 frames
  key W
  wait 30 frames
  key A 0.1
  wait 3 frames
  key D 0.1
  wait 20 frames
  key Right
  wait 14 frames
  mouse left 5 2
  wait 17 frames
)";
constexpr int kLatencyRounds = 6;

void printLatency(const LatencyMeter& meter) {
  std::vector<double> frames, ms;
  for (const LatencyMeter::Sample& sample : meter.samples()) {
    frames.push_back(sample.frames);
    ms.push_back(sample.ms);
  }
  if (frames.empty()) return;
  std::printf("  latency    median %8.2f ms, largest %8.2f ms; %.0f and %.0f frames, %zu keys\n",
              cli::quantile(ms, 0.5), cli::quantile(ms, 1), cli::quantile(frames, 0.5),
              cli::quantile(frames, 1), frames.size());
}

void measureLatency(const ViewOptions& options, const std::shared_ptr<cli::OpenScene>& scene,
                    Window& window) {
  std::string text;
  for (int round = 0; round < kLatencyRounds; ++round) text += kLatencyScript;
  App app(options, scene, ScriptPlayer(parseScript(text, "benchmark")), window);
  app.run();
  printLatency(app.latency());
}

// From rest the window becomes another one, then the view.
constexpr const char* kChangesScript = R"(
  wait 2 seconds
  key F
  wait 4 seconds
  key F
  wait 4 seconds
  key 1
  wait 4 seconds
)";

void measureNews(const ViewOptions& options, const std::shared_ptr<cli::OpenScene>& scene,
                 Window& window) {
  App app(options, scene, ScriptPlayer(parseScript(kChangesScript, "benchmark")), window);
  app.run();
  std::printf("  at rest    something new every %8.2f ms at least\n", app.news().longestMs());
}

void flyBenchmark(const ViewOptions& options, const cli::OpenScene& open, Window& window) {
  RenderOptions settled = options.common.render;
  Renderer renderer(open.scene, settled);
  settleExposure(renderer, chooseCamera(open.scene, settled), settled);
  Film film = cli::openFilm(open.scene, options.common);
  const std::uint64_t most = options.common.load.maxMemoryBytes;
  ShadowCacheSchedule schedule(renderer, {kBenchmarkFrames, film.image.pixels.size(),
                                          cli::memoryLeft(open.scene, renderer, most)});
  std::vector<double> traced, displayed;
  for (int frame = 0; frame < kBenchmarkFrames && !window.closing(); ++frame) {
    window.poll(0);
    const double share = static_cast<double>(frame) / kBenchmarkFrames;
    const Camera camera = cameraOf(open.scene, options.common.render, share);
    traced.push_back(renderer.render(camera, film).frameMs);
    schedule.frameDone();
    const Stopwatch stopwatch;
    show(window, film.display);
    displayed.push_back(stopwatch.ms());
  }
  std::printf("%s  %dx%d  %zu frames\n", open.scene.name.c_str(), film.image.width,
              film.image.height, traced.size());
  const auto print = [](const char* what, const std::vector<double>& ms) {
    const double median = cli::quantile(ms, 0.5);
    std::printf("  %-10s median %8.2f ms, 95 %% within %8.2f ms; %.1f frames/s\n", what, median,
                cli::quantile(ms, 0.95), 1000 / median);
  };
  print("tracing", traced);
  print("display", displayed);
  std::fflush(stdout);
}

}  // namespace

void runBenchmark(const ViewOptions& options, const std::shared_ptr<cli::OpenScene>& scene,
                  Window& window) {
  window.setVsync(false);
  flyBenchmark(options, *scene, window);
  measureLatency(options, scene, window);
  measureNews(options, scene, window);
}

void recordPath(const ViewOptions& options, const cli::OpenScene& open, Window& window) {
  const std::vector<Keyframe>& path = open.scene.cameraPath;
  if (path.empty()) throwUsage("--record: scene '" + open.scene.name + "' has no camera path");
  std::error_code error;
  std::filesystem::create_directories(options.record, error);
  const std::string pattern = (std::filesystem::path(options.record) / "frame-####.png").string();
  cli::requireWritable(pattern, {".png"});
  RenderOptions settled = options.common.render;
  Renderer renderer(open.scene, settled);
  settleExposure(renderer, cameraAt(path, path.front().time), settled);
  Film film = cli::openFilm(open.scene, options.common);
  const double seconds = static_cast<double>(path.back().time) - path.front().time;
  const int frames = static_cast<int>(std::floor(seconds * kFramesPerSecond)) + 1;
  for (int frame = 0; frame < frames && !window.closing(); ++frame) {
    window.poll(0);
    const Camera camera = cameraAt(path, path.front().time + frame / kFramesPerSecond);
    renderer.render(camera, film);
    show(window, film.display);
    cli::writeImage(cli::frameName(pattern, frame), film, settled,
                    describeImage(open.scene, camera, renderer, film, settled));
  }
}

}  // namespace whit::view
