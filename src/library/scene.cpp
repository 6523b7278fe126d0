#include <algorithm>
#include <cmath>
#include <filesystem>
#include <type_traits>
#include <utility>

#include "core/machine_limits.h"
#include "core/text.h"
#include "io/json_reader.h"
#include "io/scene/scene_sections.h"
#include "io/scene/scene_settings.h"
#include "library/internal.h"

namespace whit::api {

namespace {

std::vector<std::string> warningsOf(const OpenScene& open) {
  std::vector<std::string> all;
  for (const auto& [kind, entry] : open.warnings.entries()) {
    all.push_back(concat(kind, " (", counted(entry.count, "time"), ", first: ", entry.first, ")"));
  }
  if (std::string dark = noLightWarning(open.scene); !dark.empty()) all.push_back(std::move(dark));
  return all;
}

Json describe(const Light& light) {
  if (light.type == Light::Type::directional) {
    return {
        {"type", "directional"}, {"direction", light.direction}, {"irradiance", light.intensity}};
  }
  Json json{{"position", light.position}, {"intensity", light.intensity}, {"radius", light.radius}};
  if (light.type == Light::Type::spot) {
    json.update({{"type", "spot"},
                 {"direction", light.direction},
                 {"innerConeAngle", light.innerConeAngle},
                 {"outerConeAngle", light.outerConeAngle}});
  }
  return json;
}

// Adds a member of `noun` under its own name.
#define WHIT_ADD(name) add(#name, &std::remove_cvref_t<decltype(noun)>::name)

Json describe(const Camera& noun) {
  Json json{{"eye", noun.eye}, {"at", noun.at}, {"up", noun.up}};
  // Which other members there may be depends on the projection.
  const auto add = [&](const char* name, auto member) {
    if (noun.*member != Camera().*member) json[name] = noun.*member;
  };

  WHIT_ADD(projection);
  WHIT_ADD(fov);
  WHIT_ADD(orthographicHeight);
  WHIT_ADD(aspect);
  WHIT_ADD(aperture);
  WHIT_ADD(focus);

  WHIT_ADD(k);
  WHIT_ADD(kSize);
  WHIT_ADD(distortion);
  WHIT_ADD(angle);
  WHIT_ADD(azimuths);
  WHIT_ADD(elevations);
  WHIT_ADD(stereo);
  WHIT_ADD(eyeDistance);

  return json;
}

// Writes only members that have a value, because the defaults of others depend on them.
Json describe(const Material& noun) {
  Json json;
  const auto add = [&]<typename T>(const char* name, T Material::*member) {
    const T& value = noun.*member;
    if constexpr (std::is_same_v<T, std::string>) {
      if (!value.empty()) json[name] = value;
    } else if constexpr (std::is_same_v<T, double> || std::is_same_v<T, Vector>) {
      json[name] = value;
    } else if (value) {
      json[name] = *value;
    }
  };

  WHIT_ADD(diffuse);
  WHIT_ADD(diffuseMap);
  WHIT_ADD(specular);
  WHIT_ADD(specularMap);
  WHIT_ADD(roughness);
  WHIT_ADD(roughnessMap);
  WHIT_ADD(emission);
  WHIT_ADD(emissionMap);
  WHIT_ADD(normalMap);
  WHIT_ADD(alphaMap);
  WHIT_ADD(occlusionMap);
  WHIT_ADD(mirrorMap);
  WHIT_ADD(transmissionMap);

  WHIT_ADD(coverage);
  WHIT_ADD(coverageMap);
  WHIT_ADD(mirror);
  WHIT_ADD(mirrorGrazing);
  WHIT_ADD(transmission);
  WHIT_ADD(thin);
  WHIT_ADD(frosted);
  WHIT_ADD(ior);
  WHIT_ADD(absorption);
  WHIT_ADD(glossyReflection);
  WHIT_ADD(castsShadow);

  return json;
}

#undef WHIT_ADD

whit::LoadOptions loadOptions(const LoadOptions& options, const char* shippedScenes) {
  whit::LoadOptions load;
  load.allowOutside = options.allowOutside;

  constexpr double kMostGb = 1.8e10;  // what 64 bits hold; a NaN becomes 0
  const double gigabytes = std::min(std::fmax(options.maxMemoryGb, 0.0), kMostGb);
  load.maxMemoryBytes =
      gigabytes > 0 ? static_cast<std::uint64_t>(gigabytes * 1e9) : defaultMaxMemory();

  constexpr int kMostThreads = 1024;  // largest value of the option "threads"
  load.threads = std::clamp(options.threads, 0, kMostThreads);
  load.sky = options.sky;
  load.sphereSegments = options.sphereSegments;
  load.instant.plays = options.moves;
  load.instant.movable = {options.movable.begin(), options.movable.end()};
  load.instant.animation = options.animation;
  load.settings = options.settings;

  // Folders are searched by this path, which may lead through the file of a header.
  load.shippedScenes = std::filesystem::path(shippedScenes).lexically_normal().string();
  return load;
}

}  // namespace

GivenMesh givenMesh(MeshArrays arrays) {
  return {arrays.positions, arrays.normals,   arrays.uvs,
          arrays.colors,    arrays.triangles, std::move(arrays.keep)};
}

std::shared_ptr<Scene::Data> Scene::Data::read(const SceneSource& source,
                                               const LoadOptions& options,
                                               const char* shippedScenes,
                                               whit::Progress* progress) {
  const whit::LoadOptions load = loadOptions(options, shippedScenes);
  return std::make_shared<Data>(Data{openScene(source, load, options.strict, progress)});
}

Scene::Scene(std::shared_ptr<Data> data) : data_(std::move(data)) {}

Scene loadScene(const std::string& name, const LoadOptions& options, const char* shippedScenes) {
  return guarded(options.progress, [&](whit::Progress* progress) {
    return Scene(Scene::Data::read({name, nullptr}, options, shippedScenes, progress));
  });
}

const std::string& Scene::name() const { return data_->open->scene.name; }
int Scene::width() const { return data_->open->scene.width; }
int Scene::height() const { return data_->open->scene.height; }
std::uint64_t Scene::triangles() const { return data_->open->scene.instancedTriangles; }
std::vector<std::string> Scene::warnings() const { return warningsOf(*data_->open); }

std::vector<std::string> Scene::cameras() const { return namesIn(data_->open->scene.cameras); }

std::string Scene::camera(const std::string& name) const {
  return guarded([&] {
    RenderOptions options;
    options.camera = name;
    const double aspect = static_cast<double>(width()) / height();
    const whit::Scene& scene = data_->open->scene;
    Json camera = whit::describe(fitted(chooseCamera(scene, options), aspect));
    movePoints(camera, scene.origin);
    return camera.dump();
  });
}

std::vector<std::string> Scene::objects() const { return data_->open->scene.items.names; }

const std::vector<std::string>& Scene::settings() const { return data_->open->load.settings; }

std::vector<std::string> Scene::materials() const { return namesIn(data_->open->scene.materials); }

double Scene::pathSeconds() const {
  const std::vector<Keyframe>& path = data_->open->scene.cameraPath;
  return path.empty() ? 0 : double{path.back().time};
}

std::vector<Animation> Scene::animations() const {
  std::vector<Animation> all;
  for (const whit::Animation& a : data_->open->scene.animations) all.push_back({a.name, a.seconds});
  return all;
}

std::string version() { return WHIT_VERSION; }

struct SceneBuilder::Data {  // NOLINT(bugprone-exception-escape): moving Json does not throw
  SceneText text;

  // Adds or replaces a member of a section.
  std::string put(const char* section, const std::string& name, Json value) {
    text.root[section][name] = std::move(value);
    return std::string("/") + section + "/" + escapePointer(name);
  }
  std::string append(const char* section, Json value) {
    Json& list = text.root[section];
    list.push_back(std::move(value));
    return concat("/", section, "/", list.size() - 1);
  }
};

SceneBuilder::SceneBuilder(const std::string& name, const std::string& description)
    : data_(std::make_unique<Data>()) {
  guarded([&] {
    data_->text.name = name;
    data_->text.root = parseJson(description, name);
    if (!data_->text.root.is_object()) throwBadScene(name, "expected an object");
    if (!data_->text.root.contains("whit")) data_->text.root["whit"] = 1;
  });
}
SceneBuilder::SceneBuilder(const SceneBuilder& other)
    : data_(std::make_unique<Data>(*other.data_)) {}
SceneBuilder::SceneBuilder(SceneBuilder&& other) noexcept = default;
SceneBuilder& SceneBuilder::operator=(SceneBuilder other) noexcept {
  data_.swap(other.data_);
  return *this;
}
SceneBuilder::~SceneBuilder() = default;

SceneBuilder& SceneBuilder::addMesh(const std::string& name, MeshArrays arrays) {
  return guarded([&]() -> SceneBuilder& {
    data_->text.parts.meshes[name] = givenMesh(std::move(arrays));
    return *this;
  });
}

SceneBuilder& SceneBuilder::addTexture(const std::string& name, ImageArrays arrays) {
  return guarded([&]() -> SceneBuilder& {
    data_->text.parts.images[name] = {arrays.width, arrays.height, arrays.channels,
                                      arrays.codes, arrays.values, std::move(arrays.keep)};
    Json& textures = data_->text.root["textures"];
    if (!textures.contains(name)) textures[name] = {{"array", name}};
    return *this;
  });
}

std::string SceneBuilder::addMaterial(const std::string& name, const Material& material) {
  return guarded([&] { return data_->put("materials", name, describe(material)); });
}

std::string SceneBuilder::addLight(const Light& light) {
  return guarded([&] { return data_->append("lights", describe(light)); });
}

std::string SceneBuilder::addCamera(const std::string& name, const Camera& camera) {
  return guarded([&] { return data_->put("cameras", name, describe(camera)); });
}

std::string SceneBuilder::addInstance(const std::string& mesh, const std::string& material,
                                      const Matrix& transform) {
  return guarded([&] {
    Json item{{"mesh", mesh}};
    if (!material.empty()) item["material"] = material;
    if (transform != kIdentity) item["transform"] = {{"matrix", transform}};
    return data_->append("scene", std::move(item));
  });
}

SceneBuilder& SceneBuilder::set(const std::string& pointer, const std::string& json) {
  return guarded([&]() -> SceneBuilder& {
    JsonDocument document{data_->text.name, data_->text.root, {}};
    applySceneSetting(parseSceneSetting(pointer + "=" + json), document);
    data_->text.root = std::move(document.root);
    return *this;
  });
}

Scene SceneBuilder::build(const LoadOptions& options) const {
  return guarded(options.progress, [&](whit::Progress* progress) {
    const SceneSource source{data_->text.name, std::make_shared<const SceneText>(data_->text)};
    return Scene(Scene::Data::read(source, options, "", progress));
  });
}

}  // namespace whit::api
