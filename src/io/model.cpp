#include "io/model.h"

#include <sstream>

#include "core/error.h"
#include "io/obj_geometry.h"

namespace whit {
namespace {

constexpr float kGrey = 0.6f;

MtlMaterial greyMaterial(const std::string& name, const std::string& where) {
  MtlMaterial grey;
  grey.material.name = name;
  grey.material.diffuse = Rgb(kGrey);
  grey.where = where;
  return grey;
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

}  // namespace

Model::Model(const std::filesystem::path& path, const PathRules& rules, MemoryBudget& budget,
             Warnings& warnings)
    : path_(path), budget_(budget), warnings_(warnings) {
  text_.emplace(readTextFile(path, budget.left()), path.string());
  readMaterials(rules);
}

void Model::readMaterials(const PathRules& rules) {
  const std::filesystem::path folder = path_.parent_path();
  std::map<std::string, MtlMaterial> library;
  for (const ObjSummary::Name& line : text_->summary().libraries) {
    const std::string where = path_.string() + ":" + std::to_string(line.line);
    for (const std::string& name : libraryNames(line.text, folder, where, rules)) {
      const auto file = rules.resolve(name, folder, where, /*backslashes=*/true);
      std::error_code error;
      if (std::filesystem::is_regular_file(file, error)) {
        readMtl(file, library, warnings_);
      } else {
        warnings_.add("material library missing", where + ": " + name);
      }
    }
  }
  for (const ObjSummary::Name& name : text_->summary().materials) {
    const auto known = library.find(name.text);
    if (known != library.end()) {
      materials_.push_back(known->second);
      continue;
    }
    const std::string where = path_.string() + ":" + std::to_string(name.line);
    warnings_.add("material missing, grey instead", where + ": " + name.text);
    materials_.push_back(greyMaterial(name.text, where));
  }
  materials_.push_back(greyMaterial("default", path_.string()));
}

const std::vector<Mesh>& Model::meshes() {
  if (text_) {
    meshes_ = readObjGeometry(*text_, budget_, warnings_);
    text_.reset();
    for (Mesh& mesh : meshes_) mesh.name = path_.stem().string();
  }
  return meshes_;
}

}  // namespace whit
