// glTF files as models.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "io/gltf_document.h"
#include "io/gltf_maps.h"
#include "io/gltf_material.h"
#include "io/gltf_nodes.h"
#include "io/model.h"

namespace whit {

class GltfModel : public Model {
 public:
  GltfModel(const std::filesystem::path& path, const PathRules& rules, MemoryBudget& budget,
            Warnings& warnings);

  const std::vector<Material>& materials() const override { return materials_; }
  TexturedMaterial withMaps(std::size_t i, Material material, const GivenMembers& given,
                            TextureLoader& textures) override;
  // A body for each mesh of the file, which nodes share.
  Body content(SceneLayout& layout, const std::vector<std::uint32_t>& materials) override;
  // The picture takes the first camera's aspect ratio.
  void addView(SceneDescription& scene) override;

 private:
  GltfDocument document_;
  std::vector<GltfMaterial> sources_;
  std::vector<Material> materials_;  // of sources_
  GltfMapMaker maps_;
  GltfStage stage_;
};

}  // namespace whit
