#include "io/gltf/mesh.h"

#include <limits>
#include <string>
#include <utility>

#include "core/error.h"
#include "io/gltf/accessor.h"
#include "io/gltf/triangle_strip.h"

namespace whit {
namespace {

// Values of a primitive's mode; smaller ones are points and lines.
constexpr std::uint64_t kTriangles = 4, kTriangleStrip = 5, kTriangleFan = 6;
constexpr char kDraco[] = "KHR_draco_mesh_compression";

class PrimitiveReader {
 public:
  PrimitiveReader(const GltfDocument& document, const GltfValue& primitive,
                  const std::vector<GltfMaterial>& materials, const GltfDeformation& deformation)
      : document_(document),
        primitive_(primitive),
        attributes_(primitive.need("attributes")),
        deformation_(deformation),
        mode_(primitive["mode"].whole(kTriangles, kTriangleFan)),
        material_(
            primitive["material"].index(document.list("materials")).value_or(materials.size() - 1)),
        coordinates_(materials[material_].coordinates()),
        opaque_(materials[material_].alphaMode == GltfMaterial::Alpha::opaque) {}

  // Returns false where nothing is to be seen.
  bool read(Mesh& mesh) {
    const GltfValue position = attributes_["POSITION"];
    if (mode_ < kTriangles || !position.exists()) {
      warn(mode_ < kTriangles ? "points or lines left out"
                              : "primitive without positions left out");
      return false;
    }
    refuseDraco(position);
    mesh.positions = readVectors(document_, position);
    readNormals(mesh);
    mesh.uvs = textureCoordinates(mesh, coordinates_.first);
    if (coordinates_.areTwo()) mesh.secondUvs = secondTextureCoordinates(mesh);
    readVertexColors(mesh);
    connect(mesh, corners(mesh.positions.size()));
    mesh.materials = {static_cast<std::uint32_t>(material_)};
    if (!deformation_.none()) deform(document_, primitive_, deformation_, mesh);
    return !mesh.triangles.empty();
  }

 private:
  void warn(const char* what) { document_.warnings().add(what, primitive_.where()); }

  // A fallback that is not compressed is read as if there were no extension.
  void refuseDraco(const GltfValue& position) const {
    const bool stored = accessorOf(document_, position)["bufferView"].exists();
    if (stored || !primitive_["extensions"][kDraco].exists()) return;
    throwBadScene(primitive_.where(),
                  std::string("compressed by ") + kDraco + ", which is not supported");
  }

  static void checkLength(std::size_t found, const Mesh& mesh, const GltfValue& attribute) {
    if (found == mesh.positions.size()) return;
    attribute.fail("as many as positions, " + std::to_string(mesh.positions.size()) + ", found " +
                   std::to_string(found));
  }

  void readNormals(Mesh& mesh) const {
    const GltfValue normal = attributes_["NORMAL"];
    if (!normal.exists()) return;
    mesh.normals = readVectors(document_, normal);
    checkLength(mesh.normals.size(), mesh, normal);
  }

  void readVertexColors(Mesh& mesh) {
    const GltfValue color = attributes_["COLOR_0"];
    if (!color.exists()) return;
    GltfColors read = readColors(document_, color);
    mesh.colors = std::move(read.colors);
    checkLength(mesh.colors.size(), mesh, color);
    if (read.translucent && !opaque_) warn("alpha of vertex colors left out");
  }

  // Empty where the primitive does not have this set.
  std::vector<Vec2f> textureCoordinates(const Mesh& mesh, const GltfUvMap& uv) const {
    const GltfValue coordinates = attributes_["TEXCOORD_" + std::to_string(uv.set)];
    if (!coordinates.exists()) return {};
    std::vector<Vec2f> uvs = readUvs(document_, coordinates);
    checkLength(uvs.size(), mesh, coordinates);
    for (Vec2f& at : uvs) {
      const double u = at.x, v = at.y;
      at.x = static_cast<float>(uv.uu * u + uv.uv * v + uv.u0);
      at.y = static_cast<float>(1 - (uv.vu * u + uv.vv * v + uv.v0));
    }
    return uvs;
  }

  // Never empty: a scene without second coordinates looks all maps up with the first.
  std::vector<Vec2f> secondTextureCoordinates(const Mesh& mesh) const {
    std::vector<Vec2f> uvs = textureCoordinates(mesh, coordinates_.second);
    if (!uvs.empty()) return uvs;
    document_.budget().charge(mesh.positions.size(), sizeof(Vec2f), primitive_.where());
    uvs.resize(mesh.positions.size());
    return uvs;
  }

  std::vector<std::uint32_t> corners(std::size_t vertices) {
    const GltfValue indices = primitive_["indices"];
    if (indices.exists()) return readIndices(document_, indices);
    if (vertices > std::numeric_limits<std::uint32_t>::max()) {
      throwLimit(primitive_.where() + ": more than 2^32 - 1 vertices");
    }
    document_.budget().charge(vertices, sizeof(std::uint32_t), primitive_.where());
    std::vector<std::uint32_t> all(vertices);
    for (std::size_t i = 0; i < vertices; ++i) all[i] = static_cast<std::uint32_t>(i);
    return all;
  }

  // The winding of the specification; indices that are out of range are dropped later.
  void connect(Mesh& mesh, const std::vector<std::uint32_t>& c) {
    const bool separate = mode_ == kTriangles;
    const std::size_t count =
        separate ? c.size() / 3 : c.size() - std::min<std::size_t>(c.size(), 2);
    if (separate && c.size() % 3 != 0) warn("triangle with fewer than three corners left out");
    document_.budget().charge(count, sizeof(mesh.triangles[0]), primitive_.where());
    mesh.triangles.reserve(count);
    if (mode_ == kTriangleStrip) return addStrip(c, mesh.triangles);
    for (std::size_t i = 0; i < count; ++i) {
      if (separate) {
        mesh.triangles.push_back({c[3 * i], c[3 * i + 1], c[3 * i + 2]});
      } else {
        addJoined({c[i + 1], c[i + 2], c[0]}, mesh.triangles);
      }
    }
  }

  const GltfDocument& document_;
  GltfValue primitive_, attributes_;
  const GltfDeformation& deformation_;
  std::uint64_t mode_;
  std::size_t material_;
  GltfMaterial::Coordinates coordinates_;
  bool opaque_;
};

}  // namespace

std::vector<Mesh> readGltfMesh(const GltfDocument& document, std::size_t index,
                               const std::vector<GltfMaterial>& materials,
                               const GltfDeformation& deformation) {
  const GltfValue source = document.list("meshes")[index], primitives = source.need("primitives");
  std::vector<Mesh> meshes;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    Mesh mesh;
    mesh.name = source["name"].text();
    PrimitiveReader reader(document, primitives[i], materials, deformation);
    if (reader.read(mesh)) {
      meshes.push_back(std::move(mesh));
    }
  }
  return meshes;
}

}  // namespace whit
