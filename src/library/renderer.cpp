#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/index.h"
#include "core/option_table.h"
#include "io/image/image_layers.h"
#include "io/scene/scene_sections.h"
#include "library/internal.h"

namespace whit::api {

namespace {

FrameStatistics statisticsOf(const FrameStats& frame, Mode mode) {
  FrameStatistics result;
  result.frameMs = frame.frameMs;
  result.embreeMs = frame.embreeMs();
  result.nonFinitePixels = frame.nonFinitePixels;
  result.limitedPixels = frame.limitedPixels;
  for (std::size_t i = 0; i < kStageCount && mode == Mode::packets; ++i) {
    result.stages.push_back({kStageNames[i], frame.stageMs(static_cast<Stage>(i))});
  }
  for (const auto i : indices(kRayKindCount)) {
    result.rays.push_back({kRayKinds[i].name, frame.meter.tally[i].rays});
  }
  return result;
}

}  // namespace

struct Renderer::Data {
  explicit Data(Scene s) : scene(std::move(s)), engine(scene.data_->open) {}

  // Calls one of the queries of rays.
  template <typename Query, typename... Asked>
  auto ask(const Query& query, const Asked&... asked) {
    return guarded(progress, [&](whit::Progress* reporter) {
      const RayQueries& queries = engine.rayQueries(reporter);
      const int threads = threadsOf(engine.requestedOptions());
      return query(Queried{engine.scene(), queries, threads, reporter}, asked...);
    });
  }

  // Call this before the scene is changed, because other renderers may share the scene.
  void ownScene() {
    if (scene.data_.use_count() == 1) return;
    engine.ownScene();
    followEngine();
  }
  void followEngine() {
    if (scene.data_->open == engine.opened()) return;
    scene = Scene(std::make_shared<Scene::Data>(Scene::Data{engine.opened()}));
  }

  void choose() { engine.setOptions(options, given); }

  void sizeFilm(Image& image) {
    Film& film = image.data_->film;
    const RenderOptions& wanted = engine.options();
    const whit::Scene& shown = engine.scene();
    const ImageSize size = wanted.size.value_or(ImageSize{shown.width, shown.height});
    const Crop window = wanted.crop.value_or(Crop{0, 0, size.width, size.height});
    const whit::Image& there = film.image;
    if (there.width != size.width || there.height != size.height || there.window != window) {
      film = makeFilm(shown, wanted, engine.opened()->load.maxMemoryBytes);
    }
  }

  Picture render(const PictureRequest& request, Image& image) {
    engine.prepare(request.progress);
    sizeFilm(image);
    Picture picture = engine.render(request, image.data_->film);
    const RenderOptions& made = engine.options();
    image.data_->aboutChannels = describeChannels(engine.scene(), made.channels);
    image.data_->metadata = std::move(picture.about);
    statistics = statisticsOf(picture.stats, made.mode);
    return picture;
  }

  Scene scene;  // the engine's; shared with others until ownScene()
  Engine engine;
  RenderOptions options;
  std::set<std::string> given;
  Progress progress;
  FrameStatistics statistics;
};

Renderer::Renderer(Scene scene) : data_(std::make_unique<Data>(std::move(scene))) {}
Renderer::Renderer(Renderer&& other) noexcept = default;
Renderer& Renderer::operator=(Renderer&& other) noexcept = default;
Renderer::~Renderer() = default;

Renderer& Renderer::set(const std::string& name, const std::string& value) {
  return guarded([&]() -> Renderer& {
    setOption(data_->options, name, value);
    data_->given.insert(name);
    data_->choose();
    return *this;
  });
}

std::string Renderer::get(const std::string& name) const {
  return guarded([&] { return optionText(data_->engine.requestedOptions(), name); });
}

const Scene& Renderer::scene() const {
  return guarded([&]() -> const Scene& {
    data_->engine.update();
    return data_->scene;
  });
}

Renderer& Renderer::reset() {
  data_->options = {};
  data_->given.clear();
  data_->choose();
  return *this;
}

Renderer& Renderer::lookThrough(const std::string& camera) {
  return guarded([&]() -> Renderer& {
    std::optional<whit::Camera> own;
    if (!camera.empty()) {
      JsonDocument document{"camera", parseJson(camera, "camera"), {}};
      movePoints(document.root, -data_->engine.scene().origin);
      JsonObject object{JsonValue(document)};
      readCamera(object, own.emplace());
      object.finish();
    }
    data_->engine.lookThrough(own);
    return *this;
  });
}

Renderer& Renderer::setProgress(Progress progress) {
  data_->progress = std::move(progress);
  return *this;
}

Renderer& Renderer::setMember(const std::string& pointer, const std::string& json) {
  guarded(data_->progress, [&](whit::Progress* reporter) {
    data_->ownScene();
    data_->engine.edit(pointer + "=" + json, reporter);
    data_->followEngine();
  });
  return *this;
}

Renderer& Renderer::updateMesh(const std::string& name, MeshArrays arrays) {
  guarded(data_->progress, [&](whit::Progress* reporter) {
    data_->engine.setMesh(name, givenMesh(std::move(arrays)), reporter);
    data_->followEngine();
  });
  return *this;
}

Renderer& Renderer::setTime(double seconds) {
  guarded([&] {
    const whit::Scene& scene = data_->engine.scene();
    if (scene.motion.empty()) {
      throwUsage("setTime: nothing moves in " + scene.name +
                 ", or it was loaded without LoadOptions::moves");
    }
    if (!std::isfinite(seconds)) throwUsage("setTime: expected a finite number of seconds");
    data_->ownScene();
    data_->engine.setTime(seconds);
  });
  return *this;
}

Renderer& Renderer::setTransform(const std::string& pointer, std::span<const double, 12> rows) {
  guarded([&] {
    const auto fits = [](double x) { return std::abs(x) <= kLargestCoordinate; };
    if (!std::ranges::all_of(rows, fits)) {
      throwUsage("setTransform: expected numbers up to 1.844e18");
    }
    const auto column = [&](std::size_t i) { return Vec3d{rows[i], rows[i + 4], rows[i + 8]}; };
    data_->ownScene();
    data_->engine.setTransform(pointer, Affine{column(0), column(1), column(2), column(3)});
  });
  return *this;
}

Image Renderer::render() {
  Image image;
  render(image);
  return image;
}

void Renderer::render(Image& image) {
  guarded(data_->progress,
          [&](whit::Progress* reporter) { data_->render({.progress = reporter}, image); });
}

Receipt Renderer::renderWithin(const std::string& budget, const std::string& target, Image& image) {
  return guarded(data_->progress, [&](whit::Progress* reporter) {
    const Budget wanted = parseBudget(budget, target);
    if (!wanted.isSet()) throwUsage("renderWithin: expected a budget or a target");
    const Picture picture = data_->render({.budget = wanted, .progress = reporter}, image);
    const whit::Receipt& made = *picture.receipt;
    return Receipt{made.chosen, made.probeMs, made.expectedMs, made.measuredMs,      made.error,
                   made.low,    made.high,    made.note,       receiptText(made, "")};
  });
}

void Renderer::renderOnPath(double seconds, Image& image) {
  guarded(data_->progress, [&](whit::Progress* reporter) {
    Engine& engine = data_->engine;
    engine.prepare(reporter);
    const whit::Camera camera = cameraOnPath(engine.scene(), engine.options(), seconds);
    data_->render({.camera = camera, .progress = reporter}, image);
  });
}

std::shared_ptr<OpenScene> SceneCopy::of(Renderer& renderer) {
  return renderer.data_->engine.copyScene();
}

const FrameStatistics& Renderer::statistics() const { return data_->statistics; }

RayHits Renderer::closest(const Rays& rays) { return data_->ask(api::closest, rays); }

RayHits Renderer::allHits(const Rays& rays, std::size_t limit) {
  return data_->ask(api::allHits, rays, limit);
}

RayAnswers Renderer::occluded(const Rays& rays) { return data_->ask(api::occluded, rays); }

RayAnswers Renderer::visible(const Numbers& from, const Numbers& to, const Numbers& fromNormals,
                             const Numbers& toNormals) {
  return data_->ask(api::visible, from, to, fromNormals, toNormals);
}

std::vector<float> Renderer::ambientOcclusion(const Numbers& points, const Numbers& normals,
                                              double radius, int samples) {
  return data_->ask(api::ambientOcclusion, points, normals, radius, samples);
}

std::vector<OptionInfo> options() {
  return guarded([] {
    std::vector<OptionInfo> all;
    const RenderOptions defaults;
    forEachOption(defaults, [&](const OptionSpec& spec, const auto& field) {
      all.push_back({spec.name, spec.words, spec.help, formatValue(spec, field)});
    });
    return all;
  });
}

}  // namespace whit::api
