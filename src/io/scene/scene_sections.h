// The sections of a scene file, as they are read and written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/index.h"
#include "core/progress.h"
#include "core/warnings.h"
#include "io/files.h"
#include "io/json_reader.h"
#include "io/load_scene.h"
#include "io/memory_budget.h"
#include "io/model.h"
#include "io/texture_loader.h"
#include "make/shape.h"
#include "scene/description.h"
#include "scene/members.h"
#include "scene/motion.h"

namespace whit {

// The state of a scene's reading, which the readers of its sections share.
struct SceneContext {
  SceneContext(const std::filesystem::path& file, const LoadOptions& options, Warnings& warnings_,
               Progress* progress_)
      : folder(file.parent_path()),
        rules(folder, options.allowOutside),
        budget(options.maxMemoryBytes),
        warnings(warnings_),
        progress(progress_),
        sky(options.sky),
        instant(options.instant),
        textures(options.threads, budget, warnings, progress) {
    scene.name = file.stem().string();
  }

  // Returns the model at `path`, which `where` names, and opens it if it is not open yet.
  Model& model(const std::filesystem::path& path, const std::string& where) {
    std::unique_ptr<Model>& entry = models[path.string()];
    if (entry) return *entry;
    entry = readNamedAt(where, [&] { return openModel({path, rules, budget, warnings, instant}); });
    for (const Animation& animation : entry->animations()) scene.animations.push_back(animation);
    for (const std::string& variant : entry->variants()) scene.variants.push_back(variant);
    return *entry;
  }

  std::filesystem::path folder;
  PathRules rules;
  MemoryBudget budget;
  Warnings& warnings;
  Progress* progress;
  SceneDescription scene;
  const SceneParts* parts = nullptr;  // parts of a scene that a program makes
  std::string sky;                    // sky and instant are those of LoadOptions
  Instant instant;
  std::string knownSky;    // Sky::name of an image that the caller has, which is not read again
  bool hasGround = false;  // a model gets a shadow on the ground
  std::map<std::string, std::unique_ptr<Model>> models;
  TextureLoader textures;  // last: its workers write to the scene
};

// True if the camera's field of view is its member fov.
inline bool seesByFov(const Camera& c) {
  return isPerspective(c) && c.k.empty() && !(c.orthographicHeight > 0);
}
// Reads the members of a camera that are given; the others keep their values.
void readCamera(JsonObject& object, Camera& camera);
// Reads "size", "cameras" and "path". A camera has "eye", "at", "up" and either "fov", vertical in
// degrees, or "orthographicHeight", what parallel rays show of the plane through the eye.
void readCameras(JsonObject& file, const Instant& instant, SceneDescription& scene);
// Reads "options"; sceneOptionNames() lists them.
void readOptions(JsonObject& file, SceneDescription& scene);
// Reads "lights". What each type of light has is in scene/members.h; "name" is free.
void readLights(JsonObject& file, const Instant& instant, SceneDescription& scene);
// Reads "sky". Its image is there after context.textures.finish().
void readSky(JsonObject& file, SceneContext& context);
// Replaces the scene's sky if LoadOptions::sky names another.
void replaceSky(SceneContext& context);
// Reads "ambient". Returns the strength that ambientFromSky() is to be called with once the sky's
// image is there.
std::optional<double> readAmbient(JsonObject& file, SceneDescription& scene);

// Reads a rotation [x, y, z, degrees]. Returns the axis, which is not 0, and the degrees.
std::pair<Vec3d, double> readTurn(const JsonValue& value);

// Reads the member "motion" of `object` (scenes/README.md), which follows the object's other
// transforms; null if there is none. It counts as the scene's animation kSceneMotion. An object
// that is moved by hand always has a motion.
SharedMotion readMotion(JsonObject& object, const Instant& instant, SceneDescription& scene);
// Returns the pointer to the object if it is moved by hand, otherwise an empty text.
std::string movableName(const JsonObject& object, const Instant& instant);

// Returns the texture that replaces a map of a material. Its name is not null.
using ReadMap =
    std::function<std::int32_t(const JsonValue& name, const Member<Material, std::int32_t>& map)>;
// Reads the members of a material that are given; the others keep their values.
void readMaterial(JsonObject& object, const ReadMap& readMap, Material& material);
// Warns of a material that would send out more light than it gets. Thin coats over white are
// common, so a tenth too much is tolerated. Parts with a map, and a lobe that only lights show, may
// send out less than they state and are left out of the sum.
void warnOfSum(const Material& m, const std::string& where, Warnings& warnings);

// The sections "textures" and "materials".
class MaterialReader {
 public:
  // Reads both sections. Images are asked for when a material names their texture: the kind of
  // map says how they are to be read. The errors of patterns' parameters come from
  // TextureLoader::finish().
  MaterialReader(JsonObject& file, SceneContext& context);

  // Returns the index of the material called by the text of `name`.
  std::uint32_t find(const JsonValue& name) const;
  // Returns the material of items that name none: the one called "default", or else a gray one.
  std::uint32_t defaultMaterial();
  // Adds the material as it is, and returns its index.
  std::uint32_t add(Material material);

  // Reads the textures that no material names, so that their errors are reported.
  void checkUnused();

  // Reads members of a model's material before its images are asked for. Members that the model may
  // not change any more are added to `given`.
  void override(JsonObject& object, Material& material, GivenMembers& given);

 private:
  struct NamedTexture {
    JsonValue definition;
    std::map<TextureUse, std::int32_t> slots;  // a pattern has one slot
  };

  void read(JsonObject& object, Material& material);
  std::int32_t texture(const JsonValue& name, TextureUse use);
  // Without a use, the texture is read for its errors only.
  std::int32_t load(const JsonValue& definition, const JsonValue& name,
                    std::optional<TextureUse> use);

  SceneContext& context_;
  std::map<std::string, NamedTexture> textures_;
  std::map<std::string, std::uint32_t> materials_;
  std::optional<std::uint32_t> default_;
};

// Reads "objects" and "scene": fills in the scene's objects and instances.
void readItems(JsonObject& file, SceneContext& context, MaterialReader& materials);
// Reads a model as a scene of its own. The section "materials" of `file` replaces members of its
// materials.
void readModelAlone(JsonObject& file, const std::filesystem::path& path, SceneContext& context,
                    MaterialReader& materials);

// Parameters of shapes and patterns. The object reports keys that were not asked for, at its
// finish().
class JsonShapeParameters : public ShapeParameters {
 public:
  explicit JsonShapeParameters(JsonObject& object) : object_(object) {}

  double number(const std::string& key, double fallback, double low, double high) override {
    const JsonValue value = object_.find(key);
    return value ? value.number(low, high) : fallback;
  }
  int integer(const std::string& key, int fallback, int low, int high) override {
    const JsonValue value = object_.find(key);
    return value ? value.integer(low, high) : fallback;
  }
  bool flag(const std::string& key, bool fallback) override {
    const JsonValue value = object_.find(key);
    return value ? value.flag() : fallback;
  }
  Vec3d vector(const std::string& key, const Vec3d& fallback) override {
    const JsonValue value = object_.find(key);
    return value ? value.vector() : fallback;
  }
  Vec3d color(const std::string& key, const Vec3d& fallback) override {
    const JsonValue value = object_.find(key);
    return value ? Vec3d(value.color()) : fallback;
  }
  std::string word(const std::string& key, const std::string& fallback,
                   const std::vector<std::string>& choices) override {
    const JsonValue value = object_.find(key);
    return value ? value.word(choices) : fallback;
  }

 private:
  JsonObject& object_;
};

// Runs the generator called `name` with the parameters in `object`. An error names the nearest
// generator.
template <typename Made>
Made generate(const JsonValue& name, const std::map<std::string, Made (*)(ShapeParameters&)>& all,
              JsonObject& object) {
  JsonShapeParameters parameters(object);
  return all.at(name.word(keysOf(all)))(parameters);
}

// Values and sections as they are written; reading them gives the same bits.
Json describe(float x);  // the shortest decimals that are read as this float
Json describe(const Vec3f& v);
inline Json describe(bool x) { return x; }
inline Json describe(int x) { return x; }
template <typename Enum>
requires std::is_enum_v<Enum> Json describe(Enum value) { return entryOf(kWords<Enum>, value); }
Json describe(const std::vector<float>& numbers);
Json describe(const Camera& camera);
// Adds `offset` to the points of a camera's or a light's JSON, in double precision.
void movePoints(Json& noun, const Vec3d& offset);
// Adds `offset` to the points of all lights of a scene.
void moveLights(Json& root, const Vec3d& offset);
Json describe(const std::vector<Light>& lights);
Json describe(const Ambient& ambient);
Json describe(const Sky& sky);

// Rewrites all paths of images and models in a scene file from the folder `from` to the folder
// `to`, or to "$WHIT_DATA/..." where they lie below that. Returns whether one of them leaves the
// folder, so that a scene there needs --allow-outside.
bool movePaths(Json& json, const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace whit
