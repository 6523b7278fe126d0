// Models: files with geometry and the materials that belong to it.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/warnings.h"
#include "io/files.h"
#include "io/memory_budget.h"
#include "io/scene/scene_layout.h"
#include "io/texture_loader.h"
#include "scene/description.h"
#include "scene/motion.h"

namespace whit {

inline constexpr float kModelGray = 0.6f;  // albedo of surfaces without a material
// Colors of vertices are codes up to 255 where one is larger. Rounding and emission make some that
// are a little above 1.
inline constexpr float kLargestColor = 2;

// Names of a material's members that a scene file gives itself or that follow from those, in place
// of what a model's own file says.
using GivenMembers = std::set<std::string>;

// Maps that the reader of a model leaves out if a scene file gives the member that they multiply,
// because the given value is meant as it stands. The map of a member has its name with "Map"
// behind.
struct ReplacedMap {
  const char* member;
  std::int32_t Material::*map;
};
inline constexpr std::array kReplacedMaps{ReplacedMap{"roughness", &Material::roughnessMap},
                                          ReplacedMap{"mirror", &Material::mirrorMap},
                                          ReplacedMap{"transmission", &Material::transmissionMap},
                                          ReplacedMap{"coverage", &Material::coverageMap}};

struct TexturedMaterial {
  Material material;
  // Called once the images are decoded; empty if nothing depends on what they hold.
  std::function<void(Material&)> whenDecoded;
};

// A file to open, and what its reader uses. All of it must outlive the model.
struct ModelSource {
  std::filesystem::path path;
  const PathRules& rules;
  MemoryBudget& budget;
  Warnings& warnings;
  const Instant& instant;
};

// A model whose file has been opened. Its geometry is read later, by content(), so that textures
// can be decoded meanwhile.
class Model {
 public:
  virtual ~Model() = default;

  // Returns the materials as the file has them, without their maps.
  virtual const std::vector<Material>& materials() const = 0;
  // Returns `material`, which is materials()[i] with the `given` members changed, with slots for
  // the other maps of the file.
  virtual TexturedMaterial withMaps(std::size_t i, Material material, const GivenMembers& given,
                                    TextureLoader& textures) = 0;
  // Returns the content of the model; its shared meshes become bodies of their own in `layout`.
  // `materials` has the scene's index for each of materials().
  virtual Body content(SceneLayout& layout, const std::vector<std::uint32_t>& materials) = 0;
  // Adds the file's own cameras and lights behind those of the scene. `toWorld` places the model in
  // the file's own coordinates: scene.origin is subtracted afterwards.
  virtual void addView(SceneDescription&, const Affine& /*toWorld*/) {}
  // Returns the number of cameras and lights that addView() adds.
  virtual std::size_t viewSize() const { return 0; }
  // Returns the animations of the file, whatever the instant.
  virtual std::vector<Animation> animations() const { return {}; }
  // Returns the names of the sets of materials to choose from.
  virtual std::vector<std::string> variants() const { return {}; }

  std::optional<std::size_t> variant;  // index of the set of variants() that content() uses
};

// A model that is one mesh, whose materials have no maps unless the class of the format adds some.
class MeshModel : public Model {
 public:
  explicit MeshModel(const ModelSource& source) : source_(source) {}

  const std::vector<Material>& materials() const override { return materials_; }
  TexturedMaterial withMaps(std::size_t, Material material, const GivenMembers&,
                            TextureLoader&) override {
    return {std::move(material), {}};
  }
  Body content(SceneLayout& layout, const std::vector<std::uint32_t>& materials) override;

 protected:
  ModelSource source_;
  std::vector<Material> materials_;
  Mesh mesh_;
  Vec3d origin_;  // subtracted from the file's coordinates before they were rounded
};

// Returns true if openModel() reads such a file, by its extension (any case).
bool isModelFile(const std::filesystem::path& path);
std::string modelExtensions();  // ".gltf, .obj"
// Opens a file for which isModelFile() is true.
std::unique_ptr<Model> openModel(const ModelSource& source);

// The readers that openModel() chooses from, each in the file of its format.
std::unique_ptr<Model> openByAssimp(const ModelSource& source);
std::unique_ptr<Model> openGltf(const ModelSource& source);
// Opens a model whose content is `bytes` in place of that of the file.
std::unique_ptr<Model> openGltf(const ModelSource& source, const std::string& bytes);
std::unique_ptr<Model> openObj(const ModelSource& source);
std::unique_ptr<Model> openPly(const ModelSource& source);

// Warns once of a model that leaves the picture empty; `why` is a fixed phrase.
void warnNothingToDraw(const std::string& why, const std::string& file, Warnings& warnings);

// Appends a copy of the vertex, without second texture coordinates.
void appendCopy(std::uint32_t vertex, Mesh& mesh);

// Adds `meshes` as parts, their materials replaced by the scene's.
void addParts(std::vector<Mesh> meshes, const std::vector<std::uint32_t>& materials,
              const std::string& file, MemoryBudget& budget, Body& to);

}  // namespace whit
