// PLY files as models: vertices with normals and texture coordinates, faces of any number of
// corners. Own code: the format is small, and the errors here name a line and nothing is allocated
// that the file cannot fill.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/model.h"

namespace whit {

class PlyModel : public Model {
 public:
  // Reads all of it. Elements other than vertex and face are passed over; faces that
  // name vertices that are not there, and files without faces are counted. Colors of vertices are
  // sRGB where they are whole numbers, as scanners and their tools write them, else linear.
  PlyModel(const std::filesystem::path& path, const PathRules& rules, MemoryBudget& budget,
           Warnings& warnings);

  // A gray one; white where vertices have colors.
  const std::vector<Material>& materials() const override { return materials_; }
  TexturedMaterial withMaps(std::size_t, Material material, const GivenMembers&,
                            TextureLoader&) override {
    return {std::move(material), {}};
  }
  Body content(SceneLayout& layout, const std::vector<std::uint32_t>& materials) override;

 private:
  std::string file_;
  MemoryBudget& budget_;
  std::vector<Material> materials_;
  std::vector<Mesh> meshes_;
};

}  // namespace whit
