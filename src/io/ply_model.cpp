#include "io/ply_model.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/srgb.h"
#include "io/ply_data.h"
#include "io/ply_header.h"
#include "io/polygon.h"

namespace whit {
namespace {

// Which component of a vertex a property is.
enum Component { kX, kY, kZ, kNx, kNy, kNz, kU, kV, kR, kG, kB, kComponents };

Component componentOf(const std::string& name) {
  static const std::pair<const char*, Component> names[] = {
      {"x", kX},         {"y", kY},         {"z", kZ},   {"nx", kNx},   {"ny", kNy},
      {"nz", kNz},       {"u", kU},         {"v", kV},   {"s", kU},     {"t", kV},
      {"texture_u", kU}, {"texture_v", kV}, {"red", kR}, {"green", kG}, {"blue", kB}};
  for (const auto& [known, component] : names) {
    if (name == known) return component;
  }
  return kComponents;
}

double linearColor(double value, PlyType type) {
  const double largest = type == PlyType::uint8 || type == PlyType::int8     ? 255
                         : type == PlyType::uint16 || type == PlyType::int16 ? 65535
                         : type == PlyType::uint32 || type == PlyType::int32 ? 4294967295.0
                                                                             : 0;
  return largest > 0 ? srgbToLinear(value / largest) : value;
}

class PlyReader {
 public:
  PlyReader(const std::string& text, const std::string& file, MemoryBudget& budget,
            Warnings& warnings)
      : header_(readPlyHeader(text, file)),
        data_(text, header_, file),
        file_(file),
        budget_(budget),
        warnings_(warnings) {
    // Each corner may become a triangle.
    const bool ascii = header_.format == PlyHeader::Format::ascii;
    budget.charge(text.size() / (ascii ? 2 : 1), sizeof(mesh_.triangles[0]), file);
  }

  Mesh read() {
    for (const PlyElement& element : header_.elements) {
      if (element.properties.empty()) continue;
      if (element.name == "vertex") {
        readVertices(element);
      } else if (element.name == "face") {
        readFaces(element);
      } else {
        for (std::uint64_t i = 0; i < element.count; ++i) data_.skip(element);
        if (element.count > 0) warnings_.add("elements of a kind that is not shown", file_);
      }
    }
    if (mesh_.triangles.empty()) warnings_.add("model without faces", file_);
    return std::move(mesh_);
  }

 private:
  void readVertices(const PlyElement& element) {
    std::array<bool, kComponents> has{};
    std::vector<Component> components;
    for (const PlyProperty& property : element.properties) {
      components.push_back(property.isList ? kComponents : componentOf(property.name));
      if (components.back() != kComponents) has[components.back()] = true;
    }
    if (!has[kX] || !has[kY] || !has[kZ] || !mesh_.positions.empty()) {
      throwBadScene(file_, "expected one element \"vertex\" with x, y and z");
    }
    const bool normals = has[kNx] && has[kNy] && has[kNz], uvs = has[kU] && has[kV];
    const bool colors = has[kR] && has[kG] && has[kB];
    if (has[kR] && !colors) warnings_.add("vertex colors that lack a channel left out", file_);
    reserve(element.count, normals, uvs, colors);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const std::array<float, kComponents> v = readVertex(element, components);
      mesh_.positions.push_back({v[kX], v[kY], v[kZ]});
      if (normals) mesh_.normals.push_back({v[kNx], v[kNy], v[kNz]});
      if (uvs) mesh_.uvs.push_back({v[kU], v[kV]});
      if (colors) mesh_.colors.push_back({v[kR], v[kG], v[kB]});
    }
  }

  void reserve(std::uint64_t count, bool normals, bool uvs, bool colors) {
    if (count > std::numeric_limits<std::uint32_t>::max()) {
      throwLimit(file_ + " has more than 2^32 - 1 vertices");
    }
    budget_.charge(count, 2 * sizeof(Vec3f) + sizeof(Vec2f) + (colors ? sizeof(Rgb) : 0), file_);
    mesh_.positions.reserve(count);
    if (normals) mesh_.normals.reserve(count);
    if (uvs) mesh_.uvs.reserve(count);
    if (colors) mesh_.colors.reserve(count);
  }

  std::array<float, kComponents> readVertex(const PlyElement& element,
                                            const std::vector<Component>& components) {
    std::array<float, kComponents> values{};
    for (std::size_t p = 0; p < components.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      const std::uint64_t count = property.isList ? data_.listLength(property) : 1;
      for (std::uint64_t i = 0; i < count; ++i) {
        double value = data_.number(property.type);
        if (components[p] >= kR) value = linearColor(value, property.type);
        if (components[p] != kComponents) values[components[p]] = static_cast<float>(value);
      }
    }
    return values;
  }

  void readFaces(const PlyElement& element) {
    std::size_t corners = element.find("vertex_indices");
    if (corners == element.properties.size()) corners = element.find("vertex_index");
    if (corners == element.properties.size() || !element.properties[corners].isList) {
      throwBadScene(file_, "expected a list \"vertex_indices\" in the element \"face\"");
    }
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const PlyProperty& property = element.properties[p];
        const std::uint64_t count = property.isList ? data_.listLength(property) : 1;
        face_.clear();
        for (std::uint64_t k = 0; k < count; ++k) {
          const double value = data_.number(property.type);
          if (p == corners) face_.push_back(value);
        }
        if (p == corners) addFace();
      }
    }
  }

  void addFace() {
    if (face_.size() < 3) {
      return warnings_.add("face with fewer than three corners dropped", data_.place());
    }
    points_.clear();
    numbers_.clear();
    for (const double corner : face_) {
      if (!(corner >= 0 && corner < static_cast<double>(mesh_.positions.size()))) {
        return warnings_.add("face with a vertex index out of range dropped", data_.place());
      }
      numbers_.push_back(static_cast<std::uint32_t>(corner));
      points_.emplace_back(mesh_.positions[numbers_.back()]);
    }
    if (numbers_.size() == 3) {
      mesh_.triangles.push_back({numbers_[0], numbers_[1], numbers_[2]});
      return;
    }
    triangles_.clear();
    if (!triangulate(points_, triangles_)) {
      warnings_.add("polygon without a simple outline", data_.place());
    }
    for (const auto& t : triangles_) {
      mesh_.triangles.push_back({numbers_[t[0]], numbers_[t[1]], numbers_[t[2]]});
    }
  }

  PlyHeader header_;
  PlyData data_;
  const std::string& file_;
  MemoryBudget& budget_;
  Warnings& warnings_;
  Mesh mesh_;
  std::vector<double> face_;
  std::vector<Vec3d> points_;
  std::vector<std::uint32_t> numbers_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
};

}  // namespace

PlyModel::PlyModel(const std::filesystem::path& path, const PathRules&, MemoryBudget& budget,
                   Warnings& warnings)
    : file_(path.string()), budget_(budget) {
  Material gray;
  gray.name = "default";
  gray.diffuse = Rgb(kModelGray);
  materials_.push_back(gray);
  const std::string text = readTextFile(path, budget.left());
  budget.charge(text.size(), 1, file_);
  Mesh mesh = PlyReader(text, file_, budget, warnings).read();
  if (mesh.triangles.empty()) return;
  if (!mesh.colors.empty()) materials_[0].diffuse = Rgb(1.0f);
  mesh.name = path.stem().string();
  mesh.materials = {0};
  meshes_.push_back(std::move(mesh));
}

Body PlyModel::content(SceneLayout&, const std::vector<std::uint32_t>& materials) {
  Body body;
  addParts(meshes_, materials, file_, budget_, body);
  return body;
}

}  // namespace whit
