// OBJ files with their materials as models.
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "io/model.h"
#include "io/obj/mtl_reader.h"
#include "io/obj/mtl_text.h"
#include "io/obj/obj_geometry.h"
#include "io/obj/obj_text.h"
#include "io/read_file.h"

namespace whit {

namespace {

MtlMaterial grayMaterial(const std::string& name, const std::string& where) {
  MtlMaterial gray;
  gray.material.name = name;
  gray.material.diffuse = Rgb(kModelGray);
  gray.where = where;
  return gray;
}

// A library's name may hold blanks, or the line may name several libraries: the name that exists.
std::vector<std::string> libraryNames(const std::string& line, const std::filesystem::path& folder,
                                      const std::string& where, const PathRules& rules) {
  std::error_code error;
  if (std::filesystem::exists(rules.resolve(line, folder, where, true), error)) return {line};
  std::istringstream in(line);
  std::vector<std::string> names;
  for (std::string name; in >> name;) names.push_back(name);
  return names;
}

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

ObjModel::ObjModel(const std::filesystem::path& path, const PathRules& rules, MemoryBudget& budget,
                   Warnings& warnings)
    : path_(path), rules_(rules), budget_(budget), warnings_(warnings) {
  std::string text = readTextFile(path, budget.left());
  budget.charge(text.size(), 1, path.string());
  text_.emplace(std::move(text), path.string());
  const auto warn = [&](const char* kind, const ObjSummary::LeftOut& what) {
    warnings.add(kind, path.string() + ":" + std::to_string(what.line), what.count);
  };
  warn("vertex colors left out", text_->summary().colors);
  warn("points, lines or free forms left out", text_->summary().others);
  readMaterials();
  for (const MtlMaterial& source : sources_) materials_.push_back(source.material);
}

void ObjModel::readMaterials() {
  const std::filesystem::path folder = path_.parent_path();
  std::map<std::string, MtlMaterial> library;
  for (const ObjSummary::Name& line : text_->summary().libraries) {
    const std::string where = path_.string() + ":" + std::to_string(line.line);
    for (const std::string& name : libraryNames(line.text, folder, where, rules_)) {
      const auto file = rules_.resolve(name, folder, where, /*backslashes=*/true);
      std::error_code error;
      if (std::filesystem::is_regular_file(file, error)) {
        readMtl(file, library, warnings_);
      } else {
        warnings_.add("material library missing", where + ": " + name);
      }
    }
  }
  if (text_->summary().materials.size() > kMaterialLimit) {
    throwLimit(path_.string() + " uses more than " + std::to_string(kMaterialLimit) + " materials");
  }
  for (const ObjSummary::Name& name : text_->summary().materials) {
    const auto known = library.find(name.text);
    if (known != library.end()) {
      sources_.push_back(known->second);
      continue;
    }
    const std::string where = path_.string() + ":" + std::to_string(name.line);
    warnings_.add("material missing, gray instead", where + ": " + name.text);
    sources_.push_back(grayMaterial(name.text, where));
  }
  sources_.push_back(grayMaterial("default", path_.string()));
}

TexturedMaterial ObjModel::withMaps(std::size_t i, Material material, const GivenMembers& given,
                                    TextureLoader& textures) {
  MtlMaterial source = sources_[i];
  source.material = std::move(material);
  if (given.contains("diffuseMap")) source.diffuse.name.clear();
  if (given.contains("specularMap")) source.specular.name.clear();
  if (given.contains("normalMap")) {
    source.normal.name.clear();
    source.bump.name.clear();
  }
  if (given.contains("alphaMap")) {
    source.alpha.name.clear();
    source.alphaFromDiffuse = false;
  }
  return {loadTextures(source, path_.parent_path(), rules_, textures), {}};
}

Body ObjModel::content(SceneLayout&, const std::vector<std::uint32_t>& materials) {
  if (text_) {
    meshes_ = readObjGeometry(*text_, budget_, warnings_);
    if (meshes_.empty()) {
      warnNothingToDraw(text_->summary().faces == 0 ? "no faces" : "no face that can be built",
                        path_.string(), warnings_);
    }
    text_.reset();
    for (Mesh& mesh : meshes_) mesh.name = path_.stem().string();
  }
  Body body;
  addParts(meshes_, materials, path_.string(), budget_, body);
  return body;
}

}  // namespace

std::unique_ptr<Model> openObj(const std::filesystem::path& path, const PathRules& rules,
                               MemoryBudget& budget, Warnings& warnings, const Instant&) {
  return std::make_unique<ObjModel>(path, rules, budget, warnings);
}

}  // namespace whit
