#include "io/obj/obj_geometry.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <istream>
#include <limits>
#include <map>
#include <streambuf>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/vec3.h"
#include "io/obj/obj_text.h"
#include "io/polygon.h"

namespace whit {

namespace {

// OBJ files: what tinyobjloader reads, as it stands in the file.

constexpr std::int32_t kNoIndex = -1;

struct ObjCorner {
  // Indices from 0. kNoIndex: not given. May be out of range: nothing is checked here.
  std::int32_t position = kNoIndex, uv = kNoIndex, normal = kNoIndex;
  bool operator==(const ObjCorner&) const = default;
};

struct ObjFace {
  std::uint64_t firstCorner = 0;
  std::uint64_t textOffset = 0;  // behind its line
  std::uint32_t cornerCount = 0;
  std::uint32_t material = 0;  // index into the summary's materials, their number: none
};

struct ObjContents {
  std::vector<Vec3f> positions, normals;
  std::vector<Vec2f> uvs;
  std::vector<ObjCorner> corners;
  std::vector<ObjFace> faces;
};

// Reads the text where it lies, and knows how far the parser has come.
class TextBuffer : public std::streambuf {
 public:
  explicit TextBuffer(std::string& text) {
    setg(text.data(), text.data(), text.data() + text.size());
  }
  std::uint64_t offset() const { return static_cast<std::uint64_t>(gptr() - eback()); }
};

struct Collector {
  explicit Collector(ObjText& text) : buffer(text.text()) {
    const ObjSummary& summary = text.summary();
    contents.positions.reserve(summary.positions);
    contents.normals.reserve(summary.normals);
    contents.uvs.reserve(summary.uvs);
    contents.corners.reserve(summary.corners);
    contents.faces.reserve(summary.faces);
    std::uint32_t number = 0;
    for (const ObjSummary::Name& name : summary.materials) materials.emplace(name.text, number++);
    material = number;
  }

  // The format counts from 1, and back from the last one read for negative numbers.
  static std::int32_t fromZero(int index, std::size_t count) {
    if (index > 0) return index - 1;
    if (index == 0) return kNoIndex;
    const std::int64_t fromEnd = static_cast<std::int64_t>(count) + index;
    return fromEnd >= 0 ? static_cast<std::int32_t>(fromEnd)
                        : std::numeric_limits<std::int32_t>::max();  // before the first
  }

  void face(const tinyobj::index_t* indices, int count) {
    contents.faces.push_back(
        {contents.corners.size(), buffer.offset(), static_cast<std::uint32_t>(count), material});
    for (int i = 0; i < count; ++i) {
      contents.corners.push_back({fromZero(indices[i].vertex_index, contents.positions.size()),
                                  fromZero(indices[i].texcoord_index, contents.uvs.size()),
                                  fromZero(indices[i].normal_index, contents.normals.size())});
    }
  }

  TextBuffer buffer;
  ObjContents contents;
  std::map<std::string, std::uint32_t, std::less<>> materials;
  std::uint32_t material = 0;
};

Collector& collector(void* user) { return *static_cast<Collector*>(user); }

tinyobj::callback_t callbacks() {
  tinyobj::callback_t c;
  c.vertex_cb = [](void* user, float x, float y, float z, float) {
    collector(user).contents.positions.push_back({x, y, z});
  };
  c.normal_cb = [](void* user, float x, float y, float z) {
    collector(user).contents.normals.push_back({x, y, z});
  };
  c.texcoord_cb = [](void* user, float u, float v, float) {
    collector(user).contents.uvs.push_back({u, v});
  };
  c.index_cb = [](void* user, tinyobj::index_t* indices, int count) {
    collector(user).face(indices, count);
  };
  c.usemtl_cb = [](void* user, const char* name, int) {
    Collector& to = collector(user);
    const auto known = to.materials.find(trimmed(name));
    to.material = known != to.materials.end() ? known->second
                                              : static_cast<std::uint32_t>(to.materials.size());
  };
  return c;
}

ObjContents parseObj(ObjText& text) {
  Collector to(text);
  std::istream stream(&to.buffer);
  std::string warning, error;
  tinyobj::LoadObjWithCallback(stream, callbacks(), &to, nullptr, &warning, &error);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  // tinyobjloader reads what is not finite as 0.
  const ObjSummary& summary = text.summary();
  const auto spoil = [](auto& values, const std::vector<std::uint64_t>& numbers, const auto& nan) {
    for (const std::uint64_t i : numbers) {
      if (i < values.size()) values[i] = nan;
    }
  };
  spoil(to.contents.positions, summary.nonFinitePositions, Vec3f(kNan));
  spoil(to.contents.normals, summary.nonFiniteNormals, Vec3f(kNan));
  spoil(to.contents.uvs, summary.nonFiniteUvs, Vec2f{kNan, kNan});
  return std::move(to.contents);
}

// Vertex numbers of corners; open addressing, at most half full.
class VertexTable {
 public:
  explicit VertexTable(std::size_t corners)
      : slots_(std::bit_ceil(std::max<std::size_t>(2 * corners, 16)), kEmpty) {}

  // The corner's number, and whether it is new. Numbers count up from 0.
  std::pair<std::uint32_t, bool> number(const ObjCorner& corner) {
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t slot = hash(corner) & mask;; slot = (slot + 1) & mask) {
      if (slots_[slot] == kEmpty) {
        slots_[slot] = static_cast<std::uint32_t>(corners_.size());
        corners_.push_back(corner);
        return {slots_[slot], true};
      }
      if (corners_[slots_[slot]] == corner) return {slots_[slot], false};
    }
  }

 private:
  static constexpr std::uint32_t kEmpty = 0xffffffffu;

  // The finalizer of MurmurHash3 over the three indices.
  static std::size_t hash(const ObjCorner& c) {
    std::uint64_t h = static_cast<std::uint32_t>(c.position);
    h = (h << 32 | static_cast<std::uint32_t>(c.uv)) ^
        (static_cast<std::uint64_t>(static_cast<std::uint32_t>(c.normal)) << 20);
    h = (h ^ (h >> 33)) * 0xff51afd7ed558ccdull;
    h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53ull;
    return h ^ (h >> 33);
  }

  std::vector<std::uint32_t> slots_;
  std::vector<ObjCorner> corners_;
};

class MeshBuilder {
 public:
  MeshBuilder(const ObjContents& contents, bool withNormals, std::size_t corners)
      : contents_(contents), withNormals_(withNormals), table_(corners) {}

  std::uint32_t vertex(ObjCorner corner) {
    if (!withNormals_) corner.normal = kNoIndex;
    const auto [number, isNew] = table_.number(corner);
    if (isNew) {
      mesh_.positions.push_back(contents_.positions[static_cast<std::size_t>(corner.position)]);
      mesh_.uvs.push_back(
          corner.uv == kNoIndex ? Vec2f() : contents_.uvs[static_cast<std::size_t>(corner.uv)]);
      hasUvs_ |= corner.uv != kNoIndex;
      if (withNormals_) {
        mesh_.normals.push_back(contents_.normals[static_cast<std::size_t>(corner.normal)]);
      }
    }
    return number;
  }
  void triangle(const std::array<std::uint32_t, 3>& corners, std::uint32_t material) {
    mesh_.triangles.push_back(corners);
    mesh_.materials.push_back(material);
  }
  // Stores the number of the last triangle in the file; errors report it.
  void number(std::uint32_t inFile) { mesh_.order.push_back(inFile); }

  bool empty() const { return mesh_.triangles.empty(); }
  Mesh finish() {
    if (!hasUvs_) mesh_.uvs.clear();
    const std::uint32_t first = mesh_.materials[0];
    const auto isFirst = [&](std::uint32_t m) { return m == first; };
    if (std::all_of(mesh_.materials.begin(), mesh_.materials.end(), isFirst)) {
      mesh_.materials = {first};
    }
    return std::move(mesh_);
  }

 private:
  const ObjContents& contents_;
  bool withNormals_;
  bool hasUvs_ = false;
  VertexTable table_;
  Mesh mesh_;
};

class FaceReader {
 public:
  FaceReader(ObjText& text, ObjContents contents, Warnings& warnings)
      : text_(text), contents_(std::move(contents)), warnings_(warnings) {}

  std::vector<Mesh> run(MemoryBudget& budget) {
    std::array<std::size_t, 2> corners{};
    std::vector<std::uint8_t> kind(contents_.faces.size());
    constexpr std::uint8_t kDropped = 2;
    for (std::size_t i = 0; i < contents_.faces.size(); ++i) {
      kind[i] = check(contents_.faces[i]) ? hasNormals(contents_.faces[i]) : kDropped;
      if (kind[i] != kDropped) corners[kind[i]] += contents_.faces[i].cornerCount;
    }
    isMixed_ = corners[0] > 0 && corners[1] > 0;
    if (isMixed_) budget.charge(corners[0] + corners[1], sizeof(std::uint32_t), text_.file());
    std::array builders{MeshBuilder(contents_, false, corners[0]),
                        MeshBuilder(contents_, true, corners[1])};
    for (std::size_t i = 0; i < contents_.faces.size(); ++i) {
      if (kind[i] != kDropped) build(contents_.faces[i], builders[kind[i]]);
    }
    std::vector<Mesh> meshes;
    for (const std::size_t withNormals : {1u, 0u}) {
      MeshBuilder& builder = builders[withNormals];
      if (!builder.empty()) meshes.push_back(builder.finish());
    }
    return meshes;
  }

 private:
  ObjCorner* cornersOf(const ObjFace& face) { return contents_.corners.data() + face.firstCorner; }
  void warn(const std::string& kind, const ObjFace& face) {
    warnings_.add(kind, text_.placeOf(face.textOffset));
  }

  // True if the face can be built; forgets texture coordinates and normals that do not exist.
  bool check(const ObjFace& face) {
    if (face.cornerCount < 3) {
      warn("face with fewer than three corners dropped", face);
      return false;
    }
    ObjCorner* corners = cornersOf(face);
    for (std::uint32_t i = 0; i < face.cornerCount; ++i) {
      ObjCorner& c = corners[i];
      if (c.position < 0 || static_cast<std::size_t>(c.position) >= contents_.positions.size()) {
        warn("face with a vertex index out of range dropped", face);
        return false;
      }
      if (c.uv >= 0 && static_cast<std::size_t>(c.uv) >= contents_.uvs.size()) {
        warn("texture coordinate index out of range ignored", face);
        c.uv = kNoIndex;
      }
      if (c.normal >= 0 && static_cast<std::size_t>(c.normal) >= contents_.normals.size()) {
        warn("normal index out of range ignored", face);
        c.normal = kNoIndex;
      }
    }
    return true;
  }

  std::uint8_t hasNormals(const ObjFace& face) {
    const ObjCorner* corners = cornersOf(face);
    return std::none_of(corners, corners + face.cornerCount,
                        [](const ObjCorner& c) { return c.normal == kNoIndex; });
  }

  void build(const ObjFace& face, MeshBuilder& builder) {
    const ObjCorner* corners = cornersOf(face);
    if (face.cornerCount == 3) {
      add({builder.vertex(corners[0]), builder.vertex(corners[1]), builder.vertex(corners[2])},
          face.material, builder);
      return;
    }
    points_.clear();
    numbers_.clear();
    triangles_.clear();
    for (std::uint32_t i = 0; i < face.cornerCount; ++i) {
      points_.emplace_back(contents_.positions[static_cast<std::size_t>(corners[i].position)]);
      numbers_.push_back(builder.vertex(corners[i]));
    }
    if (!triangulate(points_, triangles_)) warn("polygon without a simple outline", face);
    for (const auto& t : triangles_) {
      add({numbers_[t[0]], numbers_[t[1]], numbers_[t[2]]}, face.material, builder);
    }
  }

  void add(const std::array<std::uint32_t, 3>& corners, std::uint32_t material,
           MeshBuilder& builder) {
    builder.triangle(corners, material);
    if (isMixed_) builder.number(triangleCount_++);
  }

  ObjText& text_;
  ObjContents contents_;
  Warnings& warnings_;
  bool isMixed_ = false;  // of faces with normals and without
  std::uint32_t triangleCount_ = 0;
  std::vector<Vec3d> points_;
  std::vector<std::uint32_t> numbers_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
};

void chargeFor(const ObjText& text, MemoryBudget& budget) {
  const ObjSummary& s = text.summary();
  constexpr std::uint64_t kIndexLimit = std::numeric_limits<std::int32_t>::max();
  if (std::max({s.positions, s.normals, s.uvs, s.corners}) >= kIndexLimit) {
    throwLimit(text.file() + " has more than 2^31 - 1 vertices or corners of faces");
  }
  budget.charge(s.positions + s.normals, sizeof(Vec3f), text.file());
  budget.charge(s.uvs, sizeof(Vec2f), text.file());
  budget.charge(s.faces, sizeof(ObjFace), text.file());
  // Each corner as it is read, in the table, and at worst as a vertex and a triangle of its own.
  constexpr std::uint64_t kMeshBytes =
      2 * sizeof(Vec3f) + sizeof(Vec2f) + 4 * sizeof(std::uint32_t);
  constexpr std::uint64_t kTableBytes = 4 * sizeof(std::uint32_t) + sizeof(ObjCorner);
  budget.charge(s.corners, sizeof(ObjCorner) + kTableBytes + kMeshBytes, text.file());
}

}  // namespace

std::vector<Mesh> readObjGeometry(ObjText& text, MemoryBudget& budget, Warnings& warnings) {
  chargeFor(text, budget);
  return FaceReader(text, parseObj(text), warnings).run(budget);
}

}  // namespace whit
