#include "library/whit.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/option_table.h"
#include "core/version.h"
#include "io/image_file.h"
#include "io/image_layers.h"
#include "io/load_scene.h"
#include "io/paths.h"
#include "render/auto_exposure.h"
#include "render/describe_image.h"
#include "render/renderer.h"
#include "scene/move_scene.h"
#include "simd/deform_vertices.h"

namespace whit::api {

namespace {

// Calls `body` and lets nothing out but api::Error.
template <typename Body>
decltype(auto) guarded(Body&& body) {
  try {
    return body();
  } catch (const std::exception& error) {
    const Failure failure = failureOf(error);
    throw Error(static_cast<int>(failure.status), failure.what);
  }
}

FrameStatistics statisticsOf(const FrameStats& frame, Mode mode) {
  FrameStatistics said;
  said.frameMs = frame.frameMs;
  said.embreeMs = frame.embreeMs();
  said.nonFinitePixels = frame.nonFinitePixels;
  for (std::size_t i = 0; i < kStageCount && mode == Mode::packets; ++i) {
    said.stages.push_back({kStageNames[i], frame.stageMs(static_cast<Stage>(i))});
  }
  for (std::size_t i = 0; i < kRayKindCount; ++i) {
    said.rays.push_back({kRayKindNames[i], frame.meter.tally[i].rays});
  }
  return said;
}

}  // namespace

struct Scene::Data {
  explicit Data(bool strict) : warnings(strict) {}
  whit::Scene scene;
  Warnings warnings;
  std::uint64_t maxMemoryBytes = 0;
};

Scene::Scene(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

Scene loadScene(const std::string& name, const LoadOptions& options, const char* shippedScenes) {
  return guarded([&] {
    whit::LoadOptions load;
    load.allowOutside = options.allowOutside;
    // A NaN is no memory; more than 64 bits hold is as much as they do.
    constexpr double kMostGb = 1.8e10;
    const double gigabytes = std::min(std::fmax(options.maxMemoryGb, 0.0), kMostGb);
    load.maxMemoryBytes = static_cast<std::uint64_t>(gigabytes * 1e9);
    load.threads = options.threads;
    load.sky = options.sky;
    load.sphereSegments = options.sphereSegments;
    load.instant.plays = options.moves;
    load.instant.movable = {options.movable.begin(), options.movable.end()};
    load.instant.animation = options.animation;
    load.shippedScenes = shippedScenes;
    auto data = std::make_shared<Scene::Data>(options.strict);
    data->scene =
        whit::Scene::finalize(whit::loadScene(name, load, data->warnings), data->warnings);
    data->maxMemoryBytes = load.maxMemoryBytes;
    return Scene(std::move(data));
  });
}

const std::string& Scene::name() const { return data_->scene.name; }
int Scene::width() const { return data_->scene.width; }
int Scene::height() const { return data_->scene.height; }
std::uint64_t Scene::triangles() const { return data_->scene.instancedTriangles; }

std::vector<std::string> Scene::cameras() const {
  std::vector<std::string> names;
  for (const Camera& camera : data_->scene.cameras) names.push_back(camera.name);
  return names;
}

double Scene::pathSeconds() const {
  const std::vector<Keyframe>& path = data_->scene.cameraPath;
  return path.empty() ? 0 : static_cast<double>(path.back().time);
}

std::vector<Animation> Scene::animations() const {
  std::vector<Animation> all;
  for (const whit::Animation& a : data_->scene.animations) all.push_back({a.name, a.seconds});
  return all;
}

std::vector<std::string> Scene::objects() const { return data_->scene.items.names; }

std::vector<std::string> Scene::materials() const {
  std::vector<std::string> names;
  for (const Material& material : data_->scene.materials) names.push_back(material.name);
  return names;
}

std::vector<std::string> Scene::warnings() const {
  std::vector<std::string> all;
  for (const auto& [kind, entry] : data_->warnings.entries()) {
    all.push_back(kind + " (" + std::to_string(entry.count) + " times, first: " + entry.first +
                  ")");
  }
  return all;
}

struct Image::Data {
  Film film;
  ImageMetadata metadata, aboutChannels;
};

Image::Image() : data_(std::make_unique<Data>()) {}
Image::Image(const Image& other) : data_(std::make_unique<Data>(*other.data_)) {}
// NOLINTNEXTLINE(performance-noexcept-move-constructor): what it leaves behind takes memory
Image::Image(Image&& other) : Image() { data_.swap(other.data_); }
Image& Image::operator=(Image other) noexcept {
  data_.swap(other.data_);
  return *this;
}
Image::~Image() = default;

int Image::width() const { return data_->film.image.windowWidth(); }
int Image::height() const { return data_->film.image.windowHeight(); }
int Image::left() const { return data_->film.image.window.x0; }
int Image::top() const { return data_->film.image.window.y0; }

std::span<const float> Image::rgb() const {
  static_assert(sizeof(Rgb) == 3 * sizeof(float));
  const std::vector<Rgb>& pixels = data_->film.image.pixels;
  return {pixels.empty() ? nullptr : &pixels.front().x, 3 * pixels.size()};
}

std::span<const std::uint8_t> Image::srgb() const { return data_->film.display.rgba; }

std::vector<Image::Channel> Image::channels() const {
  const ChannelLayers& layers = data_->film.channels;
  std::vector<Channel> all;
  layers.channels().forEach([&](whit::Channel c) {
    const ChannelInfo& info = infoOf(c);
    Channel channel{info.name, {}, {}, {}};
    channel.components.assign(info.suffixes.begin(),
                              info.suffixes.begin() + static_cast<std::ptrdiff_t>(info.components));
    if (info.countsThings) {
      channel.numbers = layers.numbers(c);
    } else {
      channel.values = layers.floats(c);
    }
    all.push_back(std::move(channel));
  });
  return all;
}

Image::Channel Image::channel(std::string_view name) const {
  return guarded([&] {
    for (const Channel& channel : channels()) {
      if (channel.name == name) return channel;
    }
    throwUsage("the image has no channel '" + std::string(name) + "': set(\"channels\", ...)");
  });
}

void Image::write(const std::string& path) const {
  guarded([&] {
    const std::string extension = extensionOf(path);
    if (width() == 0) throwUsage("cannot write '" + path + "': nothing has been rendered");
    if (extension == ".exr") {
      ImageMetadata said = data_->metadata;
      said.insert(said.end(), data_->aboutChannels.begin(), data_->aboutChannels.end());
      writeExr(path, data_->film.image, said, ExrStorage::zip, 1, viewsOf(data_->film.channels));
    } else if (extension == ".png") {
      writePng(path, data_->film.display, data_->metadata);
    } else {
      throwUsage("'" + path + "': expected a name that ends in .exr or .png");
    }
  });
}

struct Renderer::Data {
  explicit Data(Scene s) : scene(std::move(s)) {}

  const whit::Scene& internal() const { return moved ? *moved : scene.data_->scene; }
  void setTime(double seconds);
  void setTransform(const std::string& pointer, std::span<const double, 12> rows);
  void ownScene();
  void moveNow();
  RenderOptions settledOptions() const;
  void prepare();
  void prepare(Film& film) const;
  void render(const Camera& camera, Image& image);

  Scene scene;
  std::unique_ptr<whit::Scene> moved;  // its own copy, once it was moved
  double seconds = 0;
  bool stale = false;     // it is not yet where it was moved to
  RenderOptions options;  // as set
  std::set<std::string> given;
  RenderOptions settled;  // with what --quality stands for and follows from the scene
  bool changed = true;
  std::unique_ptr<whit::Renderer> renderer;
  FrameStatistics statistics;
};

RenderOptions Renderer::Data::settledOptions() const {
  RenderOptions all = options;
  applyQuality(all, given);
  if (internal().isModel) applyModelDefaults(all, given);
  return all;
}

// After options were set: the renderer takes them over, or is made anew.
void Renderer::Data::prepare() {
  if (stale) moveNow();
  if (!changed) return;
  settled = settledOptions();
  if (renderer && renderer->canSetOptions(settled)) {
    renderer->setOptions(settled);
  } else {
    renderer.reset();  // two acceleration structures at a time could be too many
    renderer = std::make_unique<whit::Renderer>(internal(), settled);
  }
  settleExposure(*renderer, chooseCamera(internal(), settled), settled);
  changed = false;
}

void Renderer::Data::setTime(double seconds) {
  if (internal().motion.empty()) {
    throwUsage("setTime: nothing moves in " + internal().name +
               ", or it was loaded without LoadOptions::moves");
  }
  if (!std::isfinite(seconds)) throwUsage("setTime: expected a finite number of seconds");
  ownScene();
  this->seconds = seconds;
  stale = true;
}

void Renderer::Data::setTransform(const std::string& pointer, std::span<const double, 12> rows) {
  const auto fits = [](double x) { return std::abs(x) <= kLargestCoordinate; };
  if (!std::all_of(rows.begin(), rows.end(), fits)) {
    throwUsage("setTransform: expected numbers up to 1.844e18");
  }
  const auto column = [&](std::size_t i) { return Vec3d{rows[i], rows[i + 4], rows[i + 8]}; };
  ownScene();
  setPlace(*moved, pointer, Affine{column(0), column(1), column(2), column(3)});
  stale = true;
}

void Renderer::Data::ownScene() {
  if (moved) return;
  renderer.reset();  // that of the shared scene
  moved = std::make_unique<whit::Scene>(scene.data_->scene);
  changed = true;
}

void Renderer::Data::moveNow() {
  moveScene(*moved, seconds, simd::deformVertices);
  if (renderer) renderer->sceneMoved();
  stale = false;
}

void Renderer::Data::prepare(Film& film) const {
  const ImageSize size = settled.size.value_or(ImageSize{internal().width, internal().height});
  const Crop window = settled.crop.value_or(Crop{0, 0, size.width, size.height});
  const whit::Image& image = film.image;
  if (image.width == size.width && image.height == size.height && image.window == window) return;
  film = makeFilm(internal(), settled, scene.data_->maxMemoryBytes);
}

void Renderer::Data::render(const Camera& camera, Image& image) {
  Film& film = image.data_->film;
  prepare(film);
  const FrameStats frame = settled.mode == Mode::reference ? renderer->renderReference(camera, film)
                                                           : renderer->render(camera, film);
  refuseNonFinite(internal(), settled, frame);
  image.data_->metadata = describeImage(internal(), camera, *renderer, film, settled);
  image.data_->aboutChannels = describeChannels(internal(), settled.channels);
  statistics = statisticsOf(frame, settled.mode);
}

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

Renderer& Renderer::setTime(double seconds) {
  return guarded([&]() -> Renderer& {
    data_->setTime(seconds);
    return *this;
  });
}

Renderer& Renderer::setTransform(const std::string& pointer, std::span<const double, 12> rows) {
  return guarded([&]() -> Renderer& {
    data_->setTransform(pointer, rows);
    return *this;
  });
}

Image Renderer::render() {
  Image image;
  render(image);
  return image;
}

void Renderer::render(Image& image) {
  guarded([&] {
    data_->prepare();
    data_->render(chooseCamera(data_->internal(), data_->settled), image);
  });
}

void Renderer::renderOnPath(double seconds, Image& image) {
  guarded([&] {
    data_->prepare();
    data_->render(cameraOnPath(data_->internal(), data_->settled, seconds), image);
  });
}

const FrameStatistics& Renderer::statistics() const { return data_->statistics; }

std::string version() { return versionText(); }

}  // namespace whit::api
