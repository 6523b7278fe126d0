// OBJ files with their materials as models.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "io/model.h"
#include "io/mtl_reader.h"
#include "io/obj_text.h"

namespace whit {

class ObjModel : public Model {
 public:
  // Reads the text and the material libraries. A library or a material that is not there is a
  // warning; such materials are gray.
  ObjModel(const std::filesystem::path& path, const PathRules& rules, MemoryBudget& budget,
           Warnings& warnings);

  // One for each material that faces use, and a gray one last for faces without any.
  const std::vector<Material>& materials() const override { return materials_; }
  TexturedMaterial withMaps(std::size_t i, Material material, const GivenMembers& given,
                            TextureLoader& textures) override;
  // Parses the faces at the first call.
  Body content(SceneLayout& layout, const std::vector<std::uint32_t>& materials) override;

 private:
  void readMaterials();

  std::filesystem::path path_;
  const PathRules& rules_;
  MemoryBudget& budget_;
  Warnings& warnings_;
  std::optional<ObjText> text_;  // until it is parsed
  std::vector<MtlMaterial> sources_;
  std::vector<Material> materials_;  // of sources_
  std::vector<Mesh> meshes_;
};

}  // namespace whit
