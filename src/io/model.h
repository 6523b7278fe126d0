// Models: an OBJ file with its materials.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/warnings.h"
#include "io/memory_budget.h"
#include "io/mtl_reader.h"
#include "io/obj_text.h"
#include "io/paths.h"
#include "scene/mesh.h"

namespace whit {

// Opened first, so that textures can be asked for before the faces are parsed.
class Model {
 public:
  // Reads the text and the material libraries. A library or a material that is not there is a
  // warning; such materials are grey.
  Model(const std::filesystem::path& path, const PathRules& rules, MemoryBudget& budget,
        Warnings& warnings);

  const std::filesystem::path& path() const { return path_; }
  // One for each material that faces use, and a grey one last for faces without any.
  const std::vector<MtlMaterial>& materials() const { return materials_; }
  // Mesh::materials are indices into materials(). Parsed at the first call.
  const std::vector<Mesh>& meshes();

 private:
  void readMaterials(const PathRules& rules);

  std::filesystem::path path_;
  MemoryBudget& budget_;
  Warnings& warnings_;
  std::optional<ObjText> text_;  // until it is parsed
  std::vector<MtlMaterial> materials_;
  std::vector<Mesh> meshes_;
};

}  // namespace whit
