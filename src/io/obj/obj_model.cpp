// OBJ files with their materials as models.
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/display.h"
#include "core/error.h"
#include "core/index.h"
#include "core/text.h"
#include "io/files.h"
#include "io/line_reader.h"
#include "io/obj/mtl_reader.h"
#include "io/polygon.h"
#include "io/smooth_normals.h"
#include "scene/origin.h"

namespace whit {

namespace {

constexpr std::int32_t kNoIndex = -1;
constexpr std::int32_t kOutOfRange = std::numeric_limits<std::int32_t>::max();

// Corners and vertices are counted with 32 bits, and each takes at least two letters.
constexpr std::uint64_t kLargestText = 1ull << 32;
// Upper bound on the memory for statements such as "v 0 0 0", without faces.
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
  std::uint32_t older;  // an older vertex at the same position, or kNoVertex
};

constexpr std::uint32_t kNoVertex = 0xffffffffu, kNoMaterial = 0xffffffffu;

// Numbers of normals from here on are those of smoothing groups. Smaller ones are those of the
// file, which never has as many.
constexpr std::int32_t kFirstGroupNormal = 1 << 30;

bool isWithin(std::int32_t index, std::size_t count) {
  return index >= 0 && static_cast<std::size_t>(index) < count;
}

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
      number += std::count(text_.data() + begin, text_.data() + start, '\n');
      begin = start;
      at = text_.find_first_of("\r\n", at);
      LineReader line(text_, file_, start, number);
      noteName(line.word(), line);
    }

    const std::size_t vertex = text_.starts_with("v ") ? 0 : text_.find("\nv ") + 1;
    LineReader first(text_, file_, vertex);
    first.word();
    std::array<double, 6> numbers{};
    isColored = std::ranges::all_of(numbers, [&](double& x) { return first.number(x); });

    if (materials.size() > kMaterialLimit) {
      throwLimit(concat(file_, " uses more than ", kMaterialLimit, " materials"));
    }
  }

  // Faces with fewer than three corners or with an index that is not among the vertices so far are
  // left out and counted; such indices of texture coordinates and normals are ignored and counted.
  // The materials of the mesh are indices into `materials`; faces before the first usemtl have the
  // index after the last one.
  Mesh read() {
    const auto count = size32(materials);
    material_ = kNoMaterial;
    facesWithoutUvs.assign(count + 1, 0);
    findMiddle();
    for (; !lines_.done(); lines_.nextLine()) statement(lines_.word());

    if (mesh_.triangles.empty()) {
      warnNothingToDraw(hasFaces_ ? "no face that can be built" : "no faces", file_, warnings_);
      return {};
    }

    finishNormals();
    finishColors();
    if (!hasUvs_) mesh_.uvs.clear();
    if (!hasNormals_) mesh_.normals.clear();
    // A file that says nothing about its normals is smoothed; "s off" says that faces are flat.
    if (normals_.empty() && !statesSmoothing_) smoothNormals(mesh_, file_, budget_);

    // Faces without a material have the index behind the last one. A mesh of one material states it
    // once.
    for (std::uint32_t& material : mesh_.materials) material = std::min(material, count);
    if (std::ranges::count(mesh_.materials, mesh_.materials[0]) == std::ssize(mesh_.materials)) {
      mesh_.materials.resize(1);
    }
    return std::move(mesh_);
  }

  // Different names of "usemtl" and of "mtllib", in the file's order.
  std::vector<ObjName> materials, libraries;
  // Numbers of faces with a corner without texture coordinates, by their index into `materials`;
  // the last are those of no material.
  std::vector<std::uint64_t> facesWithoutUvs;
  bool isColored = false;  // the first vertex has a color
  Vec3d origin;            // subtracted from all vertices, see originOf()

 private:
  // Finds the origin that is subtracted from all vertices. Faces are read with vertices that are
  // rounded already, so the box of the vertices that faces use has to be known before. The search
  // ends once that box is as large as it is far away, because such a box stays near however it
  // grows.
  void findMiddle() {
    constexpr std::size_t kLettersOfVertex = 6;  // at least: "v 0 0"
    std::vector<Vec3d> all;
    all.reserve(text_.size() / kLettersOfVertex);
    BoxOf<Vec3d> box;
    for (LineReader line(text_, file_); !line.done(); line.nextLine()) {
      const std::string_view keyword = line.word();
      if (keyword == "v") {
        Vec3d& v = all.emplace_back();
        if (!line.number(v.x) || !line.number(v.y)) return;  // position() refuses it
        line.number(v.z);
      }
      if (keyword != "f") continue;

      for (; line.hasMore(); line.finishWord()) {
        const std::int32_t vertex = index(line, all.size());
        if (isWithin(vertex, all.size())) box.add(all[vertex]);
      }
      const bool isNear = !box.empty() && length(box.center()) < box.diagonal();
      if (isNear) return;
    }
    origin = originOf(box);
  }

  void statement(std::string_view keyword) {
    if (keyword == "v") {
      position();
    } else if (keyword == "vn") {
      normals_.push_back(normal());
    } else if (keyword == "vt") {
      double u = 0, v = 0;
      if (!lines_.number(u)) throwBadScene(lines_.place(), "expected numbers after \"vt\"");
      lines_.number(v);
      uvs_.push_back({static_cast<float>(u), static_cast<float>(v)});
    } else if (keyword == "f") {
      face();
    } else if (keyword == "usemtl" || keyword == "mtllib") {
      noteName(keyword, lines_);
    } else if (keyword == "s") {
      statesSmoothing_ = true;
      const std::string_view group = lines_.word();
      const bool isNone = group.empty() || group == "off" || group == "0";
      smoothing_ = isNone ? 0 : std::hash<std::string_view>()(group);
    } else if (keyword == "l" || keyword == "p" || keyword == "curv" || keyword == "curv2" ||
               keyword == "surf") {
      warnings_.add("points, lines or free forms left out", lines_.place());
    }
  }

  void noteName(std::string_view keyword, LineReader& line) {
    const std::string name(line.rest());
    if (name.empty()) return;
    if (keyword == "usemtl") {
      const auto number = size32(materials);
      const auto [known, isNew] = materialNumbers_.emplace(name, number);
      if (isNew) materials.push_back({name, line.place()});
      material_ = known->second;
    } else if (keyword == "mtllib" && libraryNames_.insert(name).second) {
      libraries.push_back({name, line.place()});
    }
  }

  // Returns how many of `most` numbers the line has.
  std::size_t readNumbers(double* to, std::size_t most) {
    std::size_t count = 0;
    while (count < most && lines_.number(to[count])) ++count;
    return count;
  }

  // Reads a vertex: x and y, which z, a weight and a color may follow.
  void position() {
    std::array<double, 7> v{};
    const std::size_t count = readNumbers(v.data(), v.size());
    if (count < 2 || (count < 3 && lines_.hasMore())) {
      throwBadScene(lines_.place(), "expected three numbers after \"v\"");
    }
    positions_.emplace_back(Vec3d(v[0], v[1], v[2]) - origin);
    if (count < 6) return;
    colors_.resize(positions_.size(), Rgb(1.0f));
    const double* const color = &v[count - 3];
    colors_.back() = Rgb(Vec3d(color[0], color[1], color[2]));
  }

  Vec3f normal() {
    std::array<double, 3> v{};
    if (readNumbers(v.data(), 3) < 3) {
      throwBadScene(lines_.place(), "expected three numbers after \"vn\"");
    }
    return Vec3f(Vec3d(v[0], v[1], v[2]));
  }

  void face() {
    line_ = lines_.line();
    corners_.clear();
    while (lines_.hasMore()) {
      // Each corner takes memory itself, and for up to one vertex and one triangle.
      budget_.charge(1,
                     sizeof(ObjCorner) + sizeof(ObjVertex) + 2 * sizeof(Vec3f) + sizeof(Vec2f) +
                         5 * sizeof(std::uint32_t),
                     file_);
      ObjCorner& corner = corners_.emplace_back();
      corner.position = index(lines_, positions_.size());
      if (lines_.take('/')) corner.uv = index(lines_, uvs_.size());
      if (lines_.take('/')) corner.normal = index(lines_, normals_.size());
      if (!lines_.finishWord()) corner.position = kOutOfRange;
    }

    if (corners_.empty()) return;
    hasFaces_ = true;
    if (corners_.size() < 3) {
      warn("face with fewer than three corners dropped");
      return;
    }

    for (ObjCorner& c : corners_) {
      if (!isWithin(c.position, positions_.size())) {
        warn("face with a vertex index out of range dropped");
        return;
      }
      require(c.uv, uvs_.size(), "texture coordinate index out of range ignored");
      require(c.normal, normals_.size(), "normal index out of range ignored");
    }

    addFace();
  }

  void require(std::int32_t& index, std::size_t count, const char* warning) {
    if (index < 0 || isWithin(index, count)) return;
    warn(warning);
    index = kNoIndex;
  }

  void warn(const char* kind) { warnings_.add(kind, concat(file_, ":", line_)); }

  // The format counts from 1, and negative numbers back from the vertex that was read last.
  static std::int32_t index(LineReader& line, std::size_t count) {
    const std::int64_t written = line.integer();
    if (written > 0) return static_cast<std::int32_t>(written - 1);
    if (written == 0) return kNoIndex;
    const std::int64_t fromStart = static_cast<std::int64_t>(count) + written;
    return fromStart >= 0 ? static_cast<std::int32_t>(fromStart) : kOutOfRange;
  }

  void addFace() {
    // A face that lacks a normal has none of the file's.
    const bool lacksNormals =
        std::ranges::any_of(corners_, [](const ObjCorner& c) { return c.normal == kNoIndex; });
    if (lacksNormals && smoothing_ != 0) addToGroup();

    const bool isFlat = lacksNormals && smoothing_ == 0;
    const bool lacksUvs =
        std::ranges::any_of(corners_, [](const ObjCorner& c) { return c.uv == kNoIndex; });
    if (lacksUvs) ++facesWithoutUvs[std::min<std::size_t>(material_, facesWithoutUvs.size() - 1)];
    mesh_.hasFlatFaces |= isFlat;
    hasNormals_ |= !isFlat;

    points_.clear();
    vertices_.clear();
    triangles_.clear();
    for (ObjCorner corner : corners_) {
      if (isFlat) corner.normal = kNoIndex;
      points_.emplace_back(positions_[corner.position]);
      vertices_.push_back(vertex(corner));
    }

    if (!triangulate(points_, triangles_)) warn("polygon without a simple outline");
    for (const auto& t : triangles_) {
      mesh_.triangles.push_back({vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]});
      mesh_.materials.push_back(material_);
    }
  }

  // Gives the corners the normals of the smoothing group at their positions, and adds the face's to
  // them, which is as long as twice its area.
  void addToGroup() {
    const auto at = [&](std::size_t corner) {
      return Vec3d(positions_[corners_[corner % corners_.size()].position]);
    };
    Vec3d normal;
    for (std::size_t i = 1; i + 1 < corners_.size(); ++i) {
      normal += cross(at(i) - at(0), at(i + 1) - at(0));
    }

    for (ObjCorner& corner : corners_) {
      auto& groups = groupNormals_[corner.position];
      budget_.charge(1, sizeof(Vec3d) + 8 * sizeof(void*), file_);
      const auto next = static_cast<std::int32_t>(groupSums_.size());
      const auto [known, isNew] = groups.emplace(smoothing_, next);
      if (isNew) groupSums_.emplace_back();
      groupSums_[known->second] += normal;
      corner.normal = kFirstGroupNormal + known->second;
    }
  }

  void finishNormals() {
    for (const auto i : indices(known_)) {
      const std::int32_t normal = known_[i].normal;
      if (normal < kFirstGroupNormal) continue;
      mesh_.normals[i] = Vec3f(normalized(groupSums_[normal - kFirstGroupNormal], {}));
    }
  }

  // Colors are sRGB, from 0 to 1; some programs write codes up to 255.
  void finishColors() {
    float largest = 0;
    for (const Rgb& color : mesh_.colors) largest = std::max(largest, maxComponent(color));
    const float white = largest > kLargestColor ? 255.0f : 1.0f;
    if (white > 1) warnings_.note("vertex colors above 2 read as codes up to 255", file_);
    for (Rgb& color : mesh_.colors) {
      for (int i = 0; i < 3; ++i) {
        color[i] = static_cast<float>(srgbToLinear(double{color[i] / white}));
      }
    }
    if (!mesh_.colors.empty()) mesh_.colors.resize(mesh_.positions.size(), Rgb(1.0f));
  }

  // Corners that agree in position, texture coordinates and normal share a vertex.
  std::uint32_t vertex(const ObjCorner& corner) {
    const std::size_t position = corner.position;
    if (newest_.size() <= position) newest_.resize(positions_.size(), kNoVertex);
    std::uint32_t& newest = newest_[position];

    // The search is short, so that files with many vertices at one position stay fast.
    int left = 64;
    for (std::uint32_t v = newest; v != kNoVertex && left > 0; v = known_[v].older, --left) {
      if (known_[v].uv == corner.uv && known_[v].normal == corner.normal) return v;
    }

    const auto number = size32(known_);
    known_.push_back({corner.uv, corner.normal, std::exchange(newest, number)});
    mesh_.positions.push_back(positions_[position]);
    const bool hasUv = corner.uv != kNoIndex;
    const bool hasNormal = corner.normal != kNoIndex && corner.normal < kFirstGroupNormal;
    mesh_.uvs.push_back(hasUv ? uvs_[corner.uv] : Vec2f());
    mesh_.normals.push_back(hasNormal ? normals_[corner.normal] : Vec3f());

    if (position < colors_.size()) {
      mesh_.colors.resize(mesh_.positions.size(), Rgb(1.0f));
      mesh_.colors.back() = colors_[position];
    }
    hasUvs_ |= hasUv;
    return number;
  }

  const std::string& text_;
  LineReader lines_;
  const std::string& file_;
  std::map<std::string, std::uint32_t> materialNumbers_;
  std::set<std::string> libraryNames_;
  std::uint32_t material_ = kNoMaterial;  // material of the faces that follow
  MemoryBudget& budget_;
  Warnings& warnings_;
  std::vector<Vec3f> positions_, normals_;
  std::vector<Vec2f> uvs_;
  std::vector<Rgb> colors_;    // colors of the first positions, as the file has them
  std::size_t smoothing_ = 0;  // the group of the faces that follow; 0: none
  // Numbers in groupSums_ by position and group.
  std::unordered_map<std::size_t, std::map<std::size_t, std::int32_t>> groupNormals_;
  std::vector<Vec3d> groupSums_;
  Mesh mesh_;
  std::vector<ObjVertex> known_;       // the file's indices for each vertex of the mesh
  std::vector<std::uint32_t> newest_;  // newest vertex at each position
  bool hasFaces_ = false, hasUvs_ = false, hasNormals_ = false, statesSmoothing_ = false;
  // The face that is being added.
  std::uint64_t line_ = 0;
  std::vector<ObjCorner> corners_;
  std::vector<Vec3d> points_;
  std::vector<std::uint32_t> vertices_;
  std::vector<CornerTriple> triangles_;
};

// A material without highlight, white where vertices have colors.
ObjMaterial plainMaterial(const std::string& name, bool isColored) {
  ObjMaterial plain;
  GltfMaterial& m = plain.surface;
  m.name = name;
  m.base = Rgb(isColored ? 1.0f : kModelGray);
  m.metallic = m.f90 = 0;
  m.specularColor = Rgb(0.0f);
  m.roughness = 0.5f;
  m.doubleSided = true;
  return plain;
}

class ObjModel : public MeshModel {
 public:
  // Makes one material for each that faces use, and a gray one last for faces without any. A
  // library or a material that is missing causes a warning; such materials are gray.
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
      sources_.push_back(known == library.end()
                             ? plainMaterial(name, reader_->isColored)
                             : interpretMtl(known->second, source.path.parent_path(), source.rules,
                                            images_, source.warnings));
    }

    sources_.push_back(plainMaterial(kNoMaterialName, reader_->isColored));
    for (const ObjMaterial& one : sources_) materials_.push_back(shadedAs(one, {}));
    maps_.emplace(images_, source.warnings);
  }

  ObjModel(const ObjModel&) = delete;
  ObjModel& operator=(const ObjModel&) = delete;

  TexturedMaterial withMaps(std::size_t i, Material material, const GivenMembers& given,
                            TextureLoader& textures) override {
    return maps_->withMaps(
        sources_[i].surface, std::move(material), given, textures,
        [source = sources_[i]](const GltfMeans& means) { return shadedAs(source, means); });
  }

  Body content(SceneLayout& layout, const std::vector<std::uint32_t>& materials) override {
    if (reader_) {
      mesh_ = reader_->read();
      origin_ = reader_->origin;
      warnOfMissingUvs();
      mesh_.name = source_.path.stem().string();
      reader_.reset();
      std::string().swap(text_);
      mapCoordinates();
    }
    return MeshModel::content(layout, materials);
  }

 private:
  void warnOfMissingUvs() const {
    for (const auto i : indices(reader_->facesWithoutUvs)) {
      const GltfMaterial& material = sources_[i].surface;
      if (!material.isMapped() && !material.maskMap.exists()) continue;
      source_.warnings.add(
          "face without texture coordinates has the texel at (0, 0) of its material's textures",
          file_ + ": " + excerpt(material.name), reader_->facesWithoutUvs[i]);
    }
  }

  // Applies the offsets and scales of maps. Materials whose maps have any get vertices of their
  // own, because the file's vertices are shared by materials.
  void mapCoordinates() {
    if (mesh_.uvs.empty()) return;

    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> copies;
    for (const auto i : indices(mesh_.triangles)) {
      const std::uint32_t material = mesh_.material(i);
      const GltfMaterial::Coordinates coordinates = sources_[material].surface.coordinates();
      if (coordinates == GltfMaterial::Coordinates()) continue;

      for (std::uint32_t& corner : mesh_.triangles[i]) {
        const auto next = size32(mesh_.positions);
        const auto [copy, isNew] = copies.emplace(std::pair(material, corner), next);
        if (isNew) copyVertex(corner, coordinates);
        corner = copy->second;
      }
    }

    // All vertices have second coordinates, or none.
    if (!mesh_.secondUvs.empty()) mesh_.secondUvs.resize(mesh_.positions.size());
  }

  void copyVertex(std::uint32_t vertex, const GltfMaterial::Coordinates& coordinates) {
    constexpr std::uint64_t kBytes = 2 * sizeof(Vec3f) + 2 * sizeof(Vec2f) + 64;
    source_.budget.charge(1, kBytes, file_);
    appendCopy(vertex, mesh_);

    // The files' v points up, that of GltfUvMap down.
    const Vec2f uv = mesh_.uvs[vertex];
    mesh_.uvs.back() = coordinates.first.map(uv.x, 1.0 - uv.y);
    if (!coordinates.areTwo()) return;
    mesh_.secondUvs.resize(mesh_.uvs.size());
    mesh_.secondUvs.back() = coordinates.second.map(uv.x, 1.0 - uv.y);
  }

  using Library = std::map<std::string, MtlMaterial>;

  // Reads the libraries of a line. It is one name with blanks if such a file exists, otherwise
  // several names.
  void readLibraries(const ObjName& line, Library& library) const {
    // Returns an empty path for a library that may not be read.
    const auto resolve = [&](const std::string& name) {
      try {
        return source_.rules.find(name, source_.path.parent_path(), line.where, source_.warnings);
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
  std::optional<ObjReader> reader_;   // empty after the geometry was read
  std::vector<ObjMaterial> sources_;  // sources of materials_
  std::vector<GltfImageSource> images_;
  std::optional<GltfMapMaker> maps_;  // over images_
};

}  // namespace

std::unique_ptr<Model> openObj(const ModelSource& source) {
  return std::make_unique<ObjModel>(source);
}

}  // namespace whit
