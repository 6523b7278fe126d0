#include <algorithm>
#include <cmath>
#include <utility>

#include "core/nearest_name.h"
#include "library/internal.h"

namespace whit::api {

namespace {

std::vector<std::string> textsOf(const Warnings& warnings) {
  std::vector<std::string> all;
  for (const auto& [kind, entry] : warnings.entries()) {
    all.push_back(kind + " (" + std::to_string(entry.count) + " times, first: " + entry.first +
                  ")");
  }
  return all;
}

}  // namespace

whit::LoadOptions loadOptions(const LoadOptions& options, const char* shippedScenes) {
  whit::LoadOptions load;
  load.allowOutside = options.allowOutside;
  constexpr double kMostGb = 1.8e10;  // what 64 bits hold; a NaN becomes 0
  const double gigabytes = std::min(std::fmax(options.maxMemoryGb, 0.0), kMostGb);
  load.maxMemoryBytes = static_cast<std::uint64_t>(gigabytes * 1e9);
  constexpr int kMostThreads = 1024;  // as of the option "threads"
  load.threads = std::clamp(options.threads, 0, kMostThreads);
  load.sky = options.sky;
  load.sphereSegments = options.sphereSegments;
  load.instant.plays = options.moves;
  load.instant.movable = {options.movable.begin(), options.movable.end()};
  load.instant.animation = options.animation;
  load.variant = options.variant;
  load.settings = options.settings;
  load.shippedScenes = shippedScenes;
  return load;
}

std::shared_ptr<Scene::Data> Scene::Data::read(const std::string& name,
                                               std::shared_ptr<const SceneText> text,
                                               const whit::LoadOptions& load, bool strict,
                                               whit::Progress* progress) {
  auto data = std::make_shared<Data>();
  Warnings warnings(strict);
  SceneDescription description = text ? whit::loadScene(*text, load, warnings, progress)
                                      : whit::loadScene(name, load, warnings, progress);
  data->scene = finalizeScene(name, std::move(description), warnings, progress);
  data->name = name;
  data->text = std::move(text);
  data->load = load;
  data->strict = strict;
  data->warnings = textsOf(warnings);
  return data;
}

Scene::Scene(std::shared_ptr<Data> data) : data_(std::move(data)) {}

Scene loadScene(const std::string& name, const LoadOptions& options, const char* shippedScenes) {
  return guarded(options.progress, [&](whit::Progress* progress) {
    const whit::LoadOptions load = loadOptions(options, shippedScenes);
    return Scene(Scene::Data::read(name, nullptr, load, options.strict, progress));
  });
}

const std::string& Scene::name() const { return data_->scene.name; }
int Scene::width() const { return data_->scene.width; }
int Scene::height() const { return data_->scene.height; }
std::uint64_t Scene::triangles() const { return data_->scene.instancedTriangles; }
std::vector<std::string> Scene::warnings() const { return data_->warnings; }

std::vector<std::string> Scene::cameras() const { return namesIn(data_->scene.cameras); }

std::vector<std::string> Scene::objects() const { return data_->scene.items.names; }

std::vector<std::string> Scene::materials() const { return namesIn(data_->scene.materials); }

double Scene::pathSeconds() const {
  const std::vector<Keyframe>& path = data_->scene.cameraPath;
  return path.empty() ? 0 : static_cast<double>(path.back().time);
}

std::vector<Animation> Scene::animations() const {
  std::vector<Animation> all;
  for (const whit::Animation& a : data_->scene.animations) all.push_back({a.name, a.seconds});
  return all;
}

std::string version() { return WHIT_VERSION; }

}  // namespace whit::api
