#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "bake/edit_scene.h"
#include "core/option_table.h"
#include "core/stopwatch.h"
#include "inspect/budget.h"
#include "io/image/image_layers.h"
#include "io/scene/scene_sections.h"
#include "io/scene/scene_settings.h"
#include "library/internal.h"
#include "render/renderer.h"

namespace whit::api {

namespace {

FrameStatistics statisticsOf(const FrameStats& frame, Mode mode) {
  FrameStatistics said;
  said.frameMs = frame.frameMs;
  said.embreeMs = frame.embreeMs();
  said.nonFinitePixels = frame.nonFinitePixels;
  for (std::size_t i = 0; i < kStageCount && mode == Mode::packets; ++i) {
    said.stages.push_back({kStageNames[i], frame.stageMs(static_cast<Stage>(i))});
  }
  for (std::size_t i = 0; i < kRayKindCount; ++i) {
    said.rays.push_back({kRayKinds[i].name, frame.meter.tally[i].rays});
  }
  return said;
}

}  // namespace

struct Renderer::Data {
  explicit Data(Scene s) : scene(std::move(s)) {}

  const whit::Scene& internal() const { return scene.data_->scene; }
  Scene::Data& own() { return *scene.data_; }

  RenderOptions settledOptions() const {
    RenderOptions all = options;
    applyQuality(all, given);
    applySceneOptions(internal().options, given, all);
    return all;
  }

  // Brings the scene to its time and the transforms.
  void move() {
    if (!stale) return;
    moveScene(own().scene, seconds);
    queries.reset();
    if (renderer) renderer->sceneMoved();
    stale = false;
  }

  // Calls one of the queries of rays.
  template <typename Query, typename... Asked>
  auto ask(const Query& query, const Asked&... asked) {
    return guarded(progress, [&](whit::Progress* told) {
      move();
      const int wanted = settledOptions().threads, threads = wanted > 0 ? wanted : usableThreads();
      if (!queries) queries = std::make_unique<RayQueries>(internal(), threads, told);
      return query(Queried{internal(), *queries, threads, told}, asked...);
    });
  }

  whit::Camera view() const {
    return lookedThrough ? aimed(*lookedThrough, settled) : chooseCamera(internal(), settled);
  }

  // Brings scene and renderer up to date with the time, the transforms and the options.
  void prepare(whit::Progress* told) {
    move();
    if (!changed) return;
    settled = settledOptions();
    if (renderer && renderer->canSetOptions(settled)) {
      renderer->setOptions(settled);
    } else {
      renderer.reset();  // two acceleration structures may need too much memory
      renderer = std::make_unique<whit::Renderer>(internal(), settled, told);
    }
    settleExposure(*renderer, view(), settled);
    changed = false;
  }

  void setTime(double seconds) {
    if (internal().motion.empty()) {
      throwUsage("setTime: nothing moves in " + internal().name +
                 ", or it was loaded without LoadOptions::moves");
    }
    if (!std::isfinite(seconds)) throwUsage("setTime: expected a finite number of seconds");
    ownScene();
    this->seconds = seconds;
    stale = true;
  }

  void setTransform(const std::string& pointer, std::span<const double, 12> rows) {
    const auto fits = [](double x) { return std::abs(x) <= kLargestCoordinate; };
    if (!std::ranges::all_of(rows, fits)) {
      throwUsage("setTransform: expected numbers up to 1.844e18");
    }
    const auto column = [&](std::size_t i) { return Vec3d{rows[i], rows[i + 4], rows[i + 8]}; };
    const Affine place{column(0), column(1), column(2), column(3)};
    ownScene();
    setPlace(own().scene, pointer, place);
    places[pointer] = place;
    stale = true;
  }

  void setMember(const std::string& text, whit::Progress* told) {
    const SceneSetting setting = parseSceneSetting(text);
    ownScene();
    queries.reset();  // they know the materials' masks
    if (!document) {
      document =
          own().text ? readDocument(*own().text, own().load) : readDocument(own().name, own().load);
    }
    JsonDocument* const described = document ? &*document : nullptr;
    if (!editScene(setting, own().load, described, own().scene)) return readAgain(text, told);
    changed = true;  // for the automatic exposure
    try {
      if (renderer) renderer->camerasChanged();
      if (renderer) renderer->shadingChanged();
    } catch (...) {
      renderer.reset();  // prepare() makes a new one for the present scene
      throw;
    }
    addSceneSetting(text, own().load.settings);
  }

  void readAgain(const std::string& setting, whit::Progress* told) {
    whit::LoadOptions load = own().load;
    addSceneSetting(setting, load.settings);
    std::shared_ptr<Scene::Data> next =
        Scene::Data::read(own().name, own().text, load, own().strict, told);
    for (const auto& [pointer, place] : places) setPlace(next->scene, pointer, place);
    renderer.reset();
    scene = Scene(std::move(next));
    document.reset();
    changed = true;
    stale = !internal().motion.empty();
  }

  void ownScene() {
    if (scene.data_.use_count() == 1) return;
    renderer.reset();  // they refer to the shared scene
    queries.reset();
    scene = Scene(std::make_shared<Scene::Data>(own()));
    changed = true;
  }

  void sizeFilm(Image& image) const {
    Film& film = image.data_->film;
    const ImageSize size = settled.size.value_or(ImageSize{internal().width, internal().height});
    const Crop window = settled.crop.value_or(Crop{0, 0, size.width, size.height});
    const whit::Image& there = film.image;
    if (there.width != size.width || there.height != size.height || there.window != window) {
      film = makeFilm(internal(), settled, scene.data_->load.maxMemoryBytes);
    }
  }

  void render(const whit::Camera& camera, Image& image, whit::Progress* told) {
    sizeFilm(image);
    Film& film = image.data_->film;
    FrameStats frame;
    try {
      frame = renderFrame(*renderer, settled.mode, camera, film, told);
    } catch (...) {
      renderer->scheduler().forgetTracers();  // their queues are not empty
      throw;
    }
    refuseNonFinite(internal(), settled, frame);
    image.data_->metadata = describeImage(internal(), camera, *renderer, film, settled);
    image.data_->aboutChannels = describeChannels(internal(), settled.channels);
    statistics = statisticsOf(frame, settled.mode);
  }

  Scene scene;  // shared with others until ownScene()
  double seconds = 0;
  std::map<std::string, Affine> places;       // set by setTransform(), by pointer
  bool stale = false;                         // time or transforms have changed
  std::optional<JsonDocument> document;       // the scene's, after setMember()
  std::optional<whit::Camera> lookedThrough;  // in place of the scene's cameras
  RenderOptions options;
  std::set<std::string> given;
  RenderOptions settled;  // `options` with those of --quality and the scene's defaults
  bool changed = true;
  Progress progress;
  std::unique_ptr<whit::Renderer> renderer;
  std::unique_ptr<RayQueries> queries;  // none before the first query
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
    data_->changed = true;
    return *this;
  });
}

std::string Renderer::get(const std::string& name) const {
  return guarded([&] { return optionText(data_->settledOptions(), name); });
}

const Scene& Renderer::scene() const { return data_->scene; }

Renderer& Renderer::reset() {
  data_->options = {};
  data_->given.clear();
  data_->changed = true;
  return *this;
}

Renderer& Renderer::lookThrough(const std::string& camera) {
  return guarded([&]() -> Renderer& {
    std::optional<whit::Camera> own;
    if (!camera.empty()) {
      const JsonDocument document{"camera", parseJson(camera, "camera"), {}};
      JsonObject object{JsonValue(document)};
      readCamera(object, own.emplace());
      object.finish();
    }
    data_->changed |= own || data_->lookedThrough;  // for the automatic exposure
    data_->lookedThrough = std::move(own);
    return *this;
  });
}

Renderer& Renderer::setProgress(Progress progress) {
  data_->progress = std::move(progress);
  return *this;
}

Renderer& Renderer::setMember(const std::string& pointer, const std::string& json) {
  guarded(data_->progress,
          [&](whit::Progress* told) { data_->setMember(pointer + "=" + json, told); });
  return *this;
}

Renderer& Renderer::setTime(double seconds) {
  guarded([&] { data_->setTime(seconds); });
  return *this;
}

Renderer& Renderer::setTransform(const std::string& pointer, std::span<const double, 12> rows) {
  guarded([&] { data_->setTransform(pointer, rows); });
  return *this;
}

Image Renderer::render() {
  Image image;
  render(image);
  return image;
}

void Renderer::render(Image& image) {
  guarded(data_->progress, [&](whit::Progress* told) {
    data_->prepare(told);
    data_->render(data_->view(), image, told);
  });
}

Receipt Renderer::renderWithin(const std::string& budget, const std::string& target, Image& image) {
  return guarded(data_->progress, [&](whit::Progress* told) {
    const Budget wanted = parseBudget(budget, target);
    if (!wanted.isSet()) throwUsage("renderWithin: expected a budget or a target");
    data_->prepare(told);
    data_->sizeFilm(image);
    const whit::Camera camera = data_->view();
    whit::Receipt made =
        chooseOptions(*data_->renderer, camera, data_->given, wanted, image.data_->film);
    data_->settled = made.options;
    data_->changed = true;  // the next frame has the options of set() again
    const Stopwatch stopwatch;
    data_->render(camera, image, told);
    assess(made, *data_->renderer, camera, stopwatch.ms(), image.data_->film);
    return Receipt{made.chosen, made.probeMs, made.expectedMs, made.measuredMs,      made.error,
                   made.low,    made.high,    made.note,       receiptText(made, "")};
  });
}

void Renderer::renderOnPath(double seconds, Image& image) {
  guarded(data_->progress, [&](whit::Progress* told) {
    data_->prepare(told);
    data_->render(cameraOnPath(data_->internal(), data_->settled, seconds), image, told);
  });
}

Snapshot::Snapshot(Renderer& renderer) {
  Renderer::Data& data = *renderer.data_;
  data.move();
  scene = data.internal();
  name = data.own().name;
  load = data.own().load;
  if (data.seconds != 0) load.instant.seconds = data.seconds;
  isMade = data.own().text || !data.places.empty();
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
