// OBJ files with their materials as models.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "io/files.h"
#include "io/line_reader.h"
#include "io/obj/mtl_reader.h"
#include "io/polygon.h"

namespace whit {

namespace {

constexpr std::int32_t kNoIndex = -1;
constexpr std::int32_t kOutOfRange = std::numeric_limits<std::int32_t>::max();

// Corners and vertices are counted with 32 bits, and each takes at least two letters.
constexpr std::uint64_t kLargestText = 1ull << 32;
// Upper bound of the memory for "v 0 0 0" and its kin, without faces.
constexpr std::uint64_t kBytesPerLetter = 5;

// A name in a file, and the place that names it.
struct ObjName {
  std::string name, where;
};

struct ObjCorner {
  std::int32_t position = kNoIndex, uv = kNoIndex, normal = kNoIndex;  // counted from 0
};

struct ObjVertex {
  std::int32_t uv, normal;
  std::uint32_t older;  // another one at the same position
};

constexpr std::uint32_t kNoVertex = 0xffffffffu, kNoMaterial = 0xffffffffu;

class ObjReader {
 public:
  ObjReader(const std::string& text, const std::string& file, MemoryBudget& budget,
            Warnings& warnings)
      : text_(text), lines_(text, file), file_(file), budget_(budget), warnings_(warnings) {}

  // Fills `materials` and `libraries` without reading the rest of the file, so that textures are
  // decoded while read() does that.
  void findNames() {
    std::uint64_t number = 1;
    std::size_t begin = 0;
    for (std::size_t at = 0; (at = text_.find("mtl", at)) != std::string::npos;) {
      const std::size_t start = text_.find_last_of("\r\n", at) + 1;  // npos + 1 is 0
      number +=
          static_cast<std::uint64_t>(std::count(text_.data() + begin, text_.data() + start, '\n'));
      begin = start;
      at = text_.find_first_of("\r\n", at);
      LineReader line(text_, file_, start, number);
      noteName(line.word(), line);
    }
    if (materials.size() > kMaterialLimit) {
      throwLimit(file_ + " uses more than " + std::to_string(kMaterialLimit) + " materials");
    }
  }

  // Faces with fewer than three corners or with an index that is not among the vertices so far are
  // left out and counted; such indices of texture coordinates and normals are ignored and counted.
  // The materials of the mesh are indices into `materials`; faces before the first usemtl have the
  // index after the last one.
  Mesh read() {
    const auto count = static_cast<std::uint32_t>(materials.size());
    material_ = kNoMaterial;
    for (; !lines_.done(); lines_.nextLine()) statement(lines_.word());
    if (mesh_.triangles.empty()) {
      warnNothingToDraw(hasFaces_ ? "no face that can be built" : "no faces", file_, warnings_);
      return {};
    }
    if (!hasUvs_) mesh_.uvs.clear();
    if (!hasNormals_) mesh_.normals.clear();
    for (std::uint32_t& material : mesh_.materials) material = std::min(material, count);
    if (std::ranges::count(mesh_.materials, mesh_.materials[0]) == std::ssize(mesh_.materials)) {
      mesh_.materials.resize(1);
    }
    return std::move(mesh_);
  }

  // Different names of "usemtl" and of "mtllib", in the file's order.
  std::vector<ObjName> materials, libraries;

 private:
  void statement(std::string_view keyword) {
    if (keyword == "v") {
      positions_.push_back(vector(keyword));
      double color = 0;
      if (lines_.number(color) && lines_.number(color) && lines_.number(color)) {
        warnings_.add("vertex colors left out", lines_.place());
      }
    } else if (keyword == "vn") {
      normals_.push_back(vector(keyword));
    } else if (keyword == "vt") {
      double u = 0, v = 0;
      if (!lines_.number(u)) throwBadScene(lines_.place(), "expected numbers after \"vt\"");
      lines_.number(v);
      uvs_.push_back({static_cast<float>(u), static_cast<float>(v)});
    } else if (keyword == "f") {
      face();
    } else if (keyword == "usemtl" || keyword == "mtllib") {
      noteName(keyword, lines_);
    } else if (keyword == "l" || keyword == "p" || keyword == "curv" || keyword == "curv2" ||
               keyword == "surf") {
      warnings_.add("points, lines or free forms left out", lines_.place());
    }
  }

  void noteName(std::string_view keyword, LineReader& line) {
    const std::string name(line.rest());
    if (name.empty()) return;
    if (keyword == "usemtl") {
      const auto number = static_cast<std::uint32_t>(materials.size());
      const auto [known, isNew] = materialNumbers_.emplace(name, number);
      if (isNew) materials.push_back({name, line.place()});
      material_ = known->second;
    } else if (keyword == "mtllib" && libraryNames_.insert(name).second) {
      libraries.push_back({name, line.place()});
    }
  }

  Vec3f vector(std::string_view keyword) {
    double x = 0, y = 0, z = 0;
    if (!lines_.number(x) || !lines_.number(y) || !lines_.number(z)) {
      throwBadScene(lines_.place(),
                    "expected three numbers after \"" + std::string(keyword) + "\"");
    }
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
  }

  void face() {
    line_ = lines_.line();
    corners_.clear();
    while (lines_.hasMore()) {
      // The corner itself, a vertex and a triangle.
      budget_.charge(1,
                     sizeof(ObjCorner) + sizeof(ObjVertex) + 2 * sizeof(Vec3f) + sizeof(Vec2f) +
                         5 * sizeof(std::uint32_t),
                     file_);
      ObjCorner& corner = corners_.emplace_back();
      corner.position = index(positions_.size());
      if (lines_.take('/')) corner.uv = index(uvs_.size());
      if (lines_.take('/')) corner.normal = index(normals_.size());
      if (!lines_.finishWord()) corner.position = kOutOfRange;
    }
    if (corners_.empty()) return;
    hasFaces_ = true;
    if (corners_.size() < 3) return warn("face with fewer than three corners dropped");
    for (ObjCorner& c : corners_) {
      if (c.position < 0 || static_cast<std::size_t>(c.position) >= positions_.size()) {
        return warn("face with a vertex index out of range dropped");
      }
      require(c.uv, uvs_.size(), "texture coordinate index out of range ignored");
      require(c.normal, normals_.size(), "normal index out of range ignored");
    }
    addFace();
  }

  void require(std::int32_t& index, std::size_t count, const char* warning) {
    if (index < 0 || static_cast<std::size_t>(index) < count) return;
    warn(warning);
    index = kNoIndex;
  }

  void warn(const char* kind) { warnings_.add(kind, file_ + ":" + std::to_string(line_)); }

  // The format counts from 1, and negative numbers back from the vertex that was read last.
  std::int32_t index(std::size_t count) {
    const std::int64_t written = lines_.integer();
    if (written > 0) return static_cast<std::int32_t>(written - 1);
    if (written == 0) return kNoIndex;
    const std::int64_t fromStart = static_cast<std::int64_t>(count) + written;
    return fromStart >= 0 ? static_cast<std::int32_t>(fromStart) : kOutOfRange;
  }

  void addFace() {
    // A face that lacks a normal has none.
    const bool isFlat =
        std::ranges::any_of(corners_, [](const ObjCorner& c) { return c.normal == kNoIndex; });
    mesh_.hasFlatFaces |= isFlat;
    hasNormals_ |= !isFlat;
    points_.clear();
    vertices_.clear();
    triangles_.clear();
    for (ObjCorner corner : corners_) {
      if (isFlat) corner.normal = kNoIndex;
      points_.emplace_back(positions_[static_cast<std::size_t>(corner.position)]);
      vertices_.push_back(vertex(corner));
    }
    if (!triangulate(points_, triangles_)) warn("polygon without a simple outline");
    for (const auto& t : triangles_) {
      mesh_.triangles.push_back({vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]});
      mesh_.materials.push_back(material_);
    }
  }

  // Corners that agree in position, texture coordinates and normal share a vertex.
  std::uint32_t vertex(const ObjCorner& corner) {
    const auto position = static_cast<std::size_t>(corner.position);
    if (newest_.size() <= position) newest_.resize(positions_.size(), kNoVertex);
    std::uint32_t& newest = newest_[position];
    // The search is short, so that files with many vertices at one position stay fast.
    int left = 64;
    for (std::uint32_t v = newest; v != kNoVertex && left > 0; v = known_[v].older, --left) {
      if (known_[v].uv == corner.uv && known_[v].normal == corner.normal) return v;
    }
    const auto number = static_cast<std::uint32_t>(known_.size());
    known_.push_back({corner.uv, corner.normal, std::exchange(newest, number)});
    mesh_.positions.push_back(positions_[position]);
    const bool hasUv = corner.uv != kNoIndex, hasNormal = corner.normal != kNoIndex;
    mesh_.uvs.push_back(hasUv ? uvs_[static_cast<std::size_t>(corner.uv)] : Vec2f());
    mesh_.normals.push_back(hasNormal ? normals_[static_cast<std::size_t>(corner.normal)]
                                      : Vec3f());
    hasUvs_ |= hasUv;
    return number;
  }

  const std::string& text_;
  LineReader lines_;
  const std::string& file_;
  std::map<std::string, std::uint32_t> materialNumbers_;
  std::set<std::string> libraryNames_;
  std::uint32_t material_ = kNoMaterial;  // of the faces that follow
  MemoryBudget& budget_;
  Warnings& warnings_;
  std::vector<Vec3f> positions_, normals_;
  std::vector<Vec2f> uvs_;
  Mesh mesh_;
  std::vector<ObjVertex> known_;       // one for each vertex of the mesh
  std::vector<std::uint32_t> newest_;  // of the vertices at each position
  bool hasFaces_ = false, hasUvs_ = false, hasNormals_ = false;
  // The face that is being added.
  std::uint64_t line_ = 0;
  std::vector<ObjCorner> corners_;
  std::vector<Vec3d> points_;
  std::vector<std::uint32_t> vertices_;
  std::vector<CornerTriple> triangles_;
};

MtlMaterial grayMaterial(const std::string& name) {
  MtlMaterial gray;
  gray.material.name = name;
  gray.material.diffuse = Rgb(kModelGray);
  return gray;
}

class ObjModel : public MeshModel {
 public:
  // Has one material for each that faces use, and a gray one last for faces without any. A library
  // or a material that is missing is a warning; such materials are gray.
  explicit ObjModel(const ModelSource& source) : MeshModel(source), file_(source.path.string()) {
    text_ = readTextFile(source.path, source.budget.left());
    if (text_.size() > kLargestText) throwLimit(file_ + " has more than 2^32 bytes");
    source.budget.charge(text_.size(), 1 + kBytesPerLetter, file_);
    reader_.emplace(text_, file_, source.budget, source.warnings).findNames();
    Library library;
    for (const ObjName& line : reader_->libraries) readLibraries(line, library);
    for (const auto& [name, where] : reader_->materials) {
      const auto known = library.find(name);
      if (known == library.end()) {
        source.warnings.add("material missing, gray instead", where + ": " + excerpt(name));
      }
      sources_.push_back(known == library.end() ? grayMaterial(name) : known->second);
    }
    sources_.push_back(grayMaterial(kNoMaterialName));
    for (const MtlMaterial& one : sources_) materials_.push_back(one.material);
  }

  ObjModel(const ObjModel&) = delete;
  ObjModel& operator=(const ObjModel&) = delete;

  TexturedMaterial withMaps(std::size_t i, Material material, const GivenMembers& given,
                            TextureLoader& textures) override {
    return {loadTextures(sources_[i], std::move(material), given, source_.path.parent_path(),
                         source_.rules, textures, source_.warnings),
            {}};
  }

  Body content(SceneLayout& layout, const std::vector<std::uint32_t>& materials) override {
    if (reader_) {
      mesh_ = reader_->read();
      mesh_.name = source_.path.stem().string();
      reader_.reset();
      std::string().swap(text_);
    }
    return MeshModel::content(layout, materials);
  }

 private:
  using Library = std::map<std::string, MtlMaterial>;

  // The line is one name with blanks if such a file exists, otherwise several names.
  void readLibraries(const ObjName& line, Library& library) const {
    // Empty for a library that may not be read.
    const auto resolve = [&](const std::string& name) {
      try {
        return source_.rules.resolve(name, source_.path.parent_path(), line.where,
                                     /*backslashes=*/true);
      } catch (const Error&) {
        return std::filesystem::path();
      }
    };
    std::error_code error;
    std::vector<std::string> names{line.name};
    if (!std::filesystem::exists(resolve(line.name), error)) {
      std::istringstream words(line.name);
      names.assign(std::istream_iterator<std::string>(words), {});
    }
    for (const std::string& name : names) {
      const auto file = resolve(name);
      if (std::filesystem::is_regular_file(file, error)) {
        readNamedAt(line.where, [&] { readMtl(file, library, source_.warnings); });
      } else {
        source_.warnings.add("material library missing", line.where + ": " + excerpt(name));
      }
    }
  }

  std::string file_, text_;
  std::optional<ObjReader> reader_;   // until the geometry is asked for
  std::vector<MtlMaterial> sources_;  // of materials_
};

}  // namespace

std::unique_ptr<Model> openObj(const ModelSource& source) {
  return std::make_unique<ObjModel>(source);
}

}  // namespace whit
