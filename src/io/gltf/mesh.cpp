#include "io/gltf/mesh.h"

#include <limits>
#include <string>
#include <utility>

#include "core/error.h"
#include "io/gltf/accessor.h"
#include "io/gltf/triangle_strip.h"

namespace whit {
namespace {

constexpr char kDraco[] = "KHR_draco_mesh_compression";

class PrimitiveReader {
 public:
  PrimitiveReader(const GltfDocument& document, const tinygltf::Primitive& primitive,
                  const std::vector<GltfMaterial>& materials, const GltfDeformation& deformation,
                  std::string where)
      : document_(document),
        primitive_(primitive),
        deformation_(deformation),
        where_(std::move(where)) {
    const bool named = primitive.material >= 0;
    material_ = named ? static_cast<std::size_t>(primitive.material) : materials.size() - 1;
    coordinates_ = materials[material_].coordinates();
    opaque_ = materials[material_].alphaMode == GltfMaterial::Alpha::opaque;
  }

  // False: nothing to be seen.
  bool read(Mesh& mesh) {
    const bool triangles = primitive_.mode == TINYGLTF_MODE_TRIANGLES ||
                           primitive_.mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
                           primitive_.mode == TINYGLTF_MODE_TRIANGLE_FAN;
    const int position = attribute("POSITION");
    if (!triangles || position < 0) {
      warn(triangles ? "primitive without positions left out" : "points or lines left out");
      return false;
    }
    refuseDraco(position);
    mesh.positions = readVectors(document_, static_cast<std::size_t>(position));
    readNormals(mesh);
    mesh.uvs = textureCoordinates(mesh, coordinates_.first);
    if (coordinates_.areTwo()) mesh.secondUvs = secondTextureCoordinates(mesh);
    readVertexColors(mesh);
    connect(mesh, corners(mesh.positions.size()));
    mesh.materials = {static_cast<std::uint32_t>(material_)};
    if (!deformation_.none()) deform(document_, primitive_, deformation_, where_, mesh);
    return !mesh.triangles.empty();
  }

 private:
  void warn(const char* what) { document_.warnings().add(what, where_); }

  int attribute(const std::string& name) const {
    const auto found = primitive_.attributes.find(name);
    return found == primitive_.attributes.end() ? -1 : found->second;
  }

  // A fallback that is not compressed will do.
  void refuseDraco(int position) const {
    const tinygltf::Accessor& accessor =
        document_.model().accessors[static_cast<std::size_t>(position)];
    if (accessor.bufferView < 0 && primitive_.extensions.count(kDraco) > 0) {
      throwBadScene(where_, std::string("compressed by ") + kDraco + ", which is not supported");
    }
  }

  template <typename Values>
  void checkLength(const Values& values, const Mesh& mesh, const std::string& name) const {
    if (values.size() == mesh.positions.size()) return;
    throwBadScene(where_ + "/attributes/" + name, "expected as many as positions, " +
                                                      std::to_string(mesh.positions.size()) +
                                                      ", found " + std::to_string(values.size()));
  }

  void readNormals(Mesh& mesh) const {
    const int normal = attribute("NORMAL");
    if (normal < 0) return;
    mesh.normals = readVectors(document_, static_cast<std::size_t>(normal));
    checkLength(mesh.normals, mesh, "NORMAL");
  }

  void readVertexColors(Mesh& mesh) {
    const int color = attribute("COLOR_0");
    if (color < 0) return;
    GltfColors read = readColors(document_, static_cast<std::size_t>(color));
    mesh.colors = std::move(read.colors);
    checkLength(mesh.colors, mesh, "COLOR_0");
    if (read.translucent && !opaque_) warn("alpha of vertex colors left out");
  }

  // None where the primitive has none of that set.
  std::vector<Vec2f> textureCoordinates(const Mesh& mesh, const GltfUvMap& uv) const {
    const std::string name = "TEXCOORD_" + std::to_string(uv.set);
    const int coordinates = attribute(name);
    if (coordinates < 0) return {};
    std::vector<Vec2f> uvs = readUvs(document_, static_cast<std::size_t>(coordinates));
    checkLength(uvs, mesh, name);
    for (Vec2f& at : uvs) {
      const double u = at.x, v = at.y;
      at.x = static_cast<float>(uv.uu * u + uv.uv * v + uv.u0);
      at.y = static_cast<float>(1 - (uv.vu * u + uv.vv * v + uv.v0));
    }
    return uvs;
  }

  // Never none: a scene without any looks all maps up with the first.
  std::vector<Vec2f> secondTextureCoordinates(const Mesh& mesh) const {
    std::vector<Vec2f> uvs = textureCoordinates(mesh, coordinates_.second);
    if (!uvs.empty()) return uvs;
    document_.budget().charge(mesh.positions.size(), sizeof(Vec2f), where_);
    uvs.resize(mesh.positions.size());
    return uvs;
  }

  std::vector<std::uint32_t> corners(std::size_t vertices) {
    if (primitive_.indices >= 0) {
      return readIndices(document_, static_cast<std::size_t>(primitive_.indices));
    }
    if (vertices > std::numeric_limits<std::uint32_t>::max()) {
      throwLimit(where_ + ": more than 2^32 - 1 vertices");
    }
    document_.budget().charge(vertices, sizeof(std::uint32_t), where_);
    std::vector<std::uint32_t> all(vertices);
    for (std::size_t i = 0; i < vertices; ++i) all[i] = static_cast<std::uint32_t>(i);
    return all;
  }

  // The winding of the specification; indices that are out of range are dropped later.
  void connect(Mesh& mesh, const std::vector<std::uint32_t>& c) {
    const bool separate = primitive_.mode == TINYGLTF_MODE_TRIANGLES;
    const std::size_t count =
        separate ? c.size() / 3 : c.size() - std::min<std::size_t>(c.size(), 2);
    if (separate && c.size() % 3 != 0) warn("triangle with fewer than three corners left out");
    document_.budget().charge(count, sizeof(mesh.triangles[0]), where_);
    mesh.triangles.reserve(count);
    if (primitive_.mode == TINYGLTF_MODE_TRIANGLE_STRIP) return addStrip(c, mesh.triangles);
    for (std::size_t i = 0; i < count; ++i) {
      if (separate) {
        mesh.triangles.push_back({c[3 * i], c[3 * i + 1], c[3 * i + 2]});
      } else {
        addJoined({c[i + 1], c[i + 2], c[0]}, mesh.triangles);
      }
    }
  }

  const GltfDocument& document_;
  const tinygltf::Primitive& primitive_;
  const GltfDeformation& deformation_;
  std::string where_;
  std::size_t material_ = 0;
  GltfMaterial::Coordinates coordinates_;
  bool opaque_ = true;
};

}  // namespace

std::vector<Mesh> readGltfMesh(const GltfDocument& document, std::size_t index,
                               const std::vector<GltfMaterial>& materials,
                               const GltfDeformation& deformation) {
  const tinygltf::Mesh& source = document.model().meshes[index];
  std::vector<Mesh> meshes;
  for (std::size_t i = 0; i < source.primitives.size(); ++i) {
    const std::string where = document.where("meshes", index, "/primitives/" + std::to_string(i));
    Mesh mesh;
    mesh.name = source.name;
    PrimitiveReader reader(document, source.primitives[i], materials, deformation, where);
    if (reader.read(mesh)) {
      meshes.push_back(std::move(mesh));
    }
  }
  return meshes;
}

}  // namespace whit
