// glTF files as models: their meshes, and the bodies that show these.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/index.h"
#include "core/text.h"
#include "io/gltf/material.h"
#include "io/gltf/nodes.h"
#include "io/model.h"
#include "io/polygon.h"
#include "scene/members.h"
#include "scene/origin.h"

namespace whit {
namespace {

void checkLength(std::size_t found, std::size_t expected, const JsonValue& attribute) {
  if (found == expected) return;
  attribute.fail(concat("as many as positions, ", expected), std::to_string(found));
}

// Reads an attribute of vertices. Returns an empty list if there is no such attribute, or no
// vertex.
std::vector<Vec3f> vectorsOf(const GltfDocument& document, const JsonValue& attribute,
                             std::size_t expected) {
  if (!attribute.exists() || expected == 0) return {};
  std::vector<Vec3f> vectors = readVectors(document, attribute);
  checkLength(vectors.size(), expected, attribute);
  return vectors;
}

// Reads the targets that have a weight at some time.
void readTargets(const GltfDocument& document, const JsonValue& targets, Deformation& to) {
  to.targets.resize(targets.size());
  for (const auto i : indices(targets)) {
    const bool weighs = i < to.weights.size() && to.weights[i] != 0;
    if (!weighs && !to.movingWeights) continue;
    for (const auto& [name, accessor] : targets[i].members()) {
      if (name == "POSITION" || name == "NORMAL" || name == "TANGENT") continue;
      document.warnings().add(
          "colors or texture coordinates of a morph target left out: they stay as they are",
          targets.where());
    }
    to.targets[i] = {vectorsOf(document, targets[i]["POSITION"], to.positions.size()),
                     vectorsOf(document, targets[i]["NORMAL"], to.normals.size())};
  }
}

// Reads which joints hold each vertex, and by what weights. The last joint is the node that shows
// the mesh; it holds the vertices without weights.
void readSkin(const GltfDocument& document, const JsonValue& primitive, Deformation& to) {
  const JsonValue attributes = primitive["attributes"];
  const std::string where = primitive.where();
  const std::size_t count = to.positions.size(), own = to.joints.size() - 1;

  std::vector<std::vector<float>> joints, weights;
  for (int set = 0;; ++set) {
    const JsonValue j = attributes[concat("JOINTS_", set)];
    const JsonValue w = attributes[concat("WEIGHTS_", set)];
    if (!j.exists() || !w.exists()) break;
    joints.push_back(readTuples(document, j, 4));
    weights.push_back(readTuples(document, w, 4));
    checkLength(joints.back().size() / 4, count, j);
    checkLength(weights.back().size() / 4, count, w);
  }

  // The weights of a vertex are kept as they are; those that cannot be used are left out.
  document.budget().charge(
      count, sizeof(std::uint32_t) + (4 * joints.size() + 1) * sizeof(Influence), where);
  to.firstInfluence.push_back(0);
  for (std::size_t i = 0; i < 4 * count; i += 4) {
    double sum = 0;
    for (std::size_t k = i; k < i + 4 * joints.size(); ++k) {
      const std::size_t set = (k - i) / 4, at = i + (k - i) % 4;
      const float joint = joints[set][at], weight = weights[set][at];
      if (!(weight > 0)) continue;
      if (joint >= 0 && joint < static_cast<float>(own)) {
        to.influences.push_back({static_cast<std::uint32_t>(joint), weight});
        sum += to.influences.back().weight;
      } else {
        document.warnings().add("joint that the skin does not have left out", where);
      }
    }

    if (!(sum > 0) || !std::isfinite(sum)) {
      document.warnings().add("vertex that no joint holds placed by its node", where);
      to.influences.resize(to.firstInfluence.back());
      to.influences.push_back({static_cast<std::uint32_t>(own), 1});
    }
    to.firstInfluence.push_back(size32(to.influences));
  }
}

// Deforms the mesh as it is at the start, and gives it the deformation where that depends on time.
// `origin` is subtracted from the positions; the first primitive of a mesh chooses it.
void deform(const GltfDocument& document, const JsonValue& primitive, Deformation own,
            std::optional<Vec3d>& origin, Mesh& mesh) {
  document.budget().charge(2 * (mesh.positions.size() + mesh.normals.size()), sizeof(Vec3d),
                           primitive.where());
  own.positions = mesh.positions;
  own.normals = mesh.normals;
  readTargets(document, primitive["targets"], own);
  if (own.skeleton) readSkin(document, primitive, own);

  // The mesh at the start decides the origin of all primitives.
  DeformedVertices start = deformVertices(own, poseAt(own, 0));
  if (!origin) {
    Box box;
    for (const Vec3f& p : start.positions) box.add(p);
    origin = originOf({Vec3d(box.lower), Vec3d(box.upper)});
  }
  own.origin = *origin;

  if (own.origin != Vec3d()) start = deformVertices(own, poseAt(own, 0));
  mesh.positions = std::move(start.positions);
  mesh.normals = std::move(start.normals);

  // Faces that a skin mirrors are turned back. Indices are not validated yet.
  for (auto& triangle : mesh.triangles) {
    const bool isWhole = std::ranges::max(triangle) < mesh.positions.size();
    if (isWhole && turnsOver(start.sides, triangle)) std::swap(triangle[1], triangle[2]);
  }
  if (own.moves()) mesh.deformation = std::make_shared<const Deformation>(std::move(own));
}

// Returns the material of a primitive in the variant of the file that was chosen
// (KHR_materials_variants).
JsonValue materialOf(const JsonValue& primitive, std::optional<std::size_t> variant) {
  const JsonValue mappings = primitive["extensions"]["KHR_materials_variants"]["mappings"];
  for (const JsonValue& mapping : mappings.elements()) {
    for (const JsonValue& number : mapping.need("variants").elements()) {
      if (variant && number.wholeOr(*variant + 1) == *variant) return mapping.need("material");
    }
  }
  return primitive["material"];
}

// Values of a primitive's mode; smaller ones are points and lines.
constexpr std::uint64_t kTriangles = 4, kTriangleStrip = 5, kTriangleFan = 6;

// Reads a primitive that consists of triangles, strips or fans as a Mesh with one material: an
// index into `materials`, whose last entry is that of primitives without one. Texture coordinates
// are those of the material, with its transforms applied, v pointing up. `variant` is the number of
// the chosen variant of the materials. Points, lines and vertices without joints are counted in the
// document's warnings. The mesh is deformed as at the start; tangents are left out, because the
// directions of normal maps follow from texture coordinates. `origin` is that of deform(). Throws
// as the accessors do, and badScene where attributes differ in length.
class PrimitiveReader {
 public:
  PrimitiveReader(const GltfDocument& document, const JsonValue& primitive,
                  const std::vector<GltfMaterial>& materials, const GltfPlacedMesh& placed,
                  std::optional<std::size_t> variant)
      : document_(document),
        primitive_(primitive),
        attributes_(primitive.need("attributes")),
        placed_(placed),
        mode_(primitive["mode"].wholeOr(kTriangles, kTriangleFan)),
        material_(materialOf(primitive, variant)
                      .indexInto(document.list("materials"))
                      .value_or(materials.size() - 1)),
        source_(materials[material_]),
        coordinates_(source_.coordinates()) {}

  // Reads the primitive into `mesh`. Returns false if there is nothing to see.
  bool read(std::optional<Vec3d>& origin, Mesh& mesh) {
    const JsonValue position = attributes_["POSITION"];
    if (mode_ < kTriangles || !position.exists()) {
      warn(mode_ < kTriangles ? "points or lines left out"
                              : "primitive without positions left out");
      return false;
    }

    mesh.positions = readVectors(document_, position);
    mesh.normals = vectorsOf(document_, attributes_["NORMAL"], mesh.positions.size());
    mesh.uvs = textureCoordinates(mesh, coordinates_.first);

    if (coordinates_.areTwo()) {
      // The second coordinates are never empty, because a scene without them looks all maps up with
      // the first.
      mesh.secondUvs = textureCoordinates(mesh, coordinates_.second);
      if (mesh.secondUvs.empty()) {
        document_.budget().charge(mesh.positions.size(), sizeof(Vec2f), primitive_.where());
      }
      mesh.secondUvs.resize(mesh.positions.size());
    }
    readVertexColors(mesh);
    if (attributes_["COLOR_1"].exists()) warn("second set of vertex colors left out");

    connect(mesh, corners(mesh.positions.size()));
    mesh.materials = {static_cast<std::uint32_t>(material_)};
    if (placed_.isDeformed()) deform(document_, primitive_, placed_.deformation, origin, mesh);
    return !mesh.triangles.empty();
  }

 private:
  void warn(const char* what) { document_.warnings().add(what, primitive_.where()); }

  void readVertexColors(Mesh& mesh) {
    const JsonValue color = attributes_["COLOR_0"];
    const bool byRamp = source_.alphaByVertex && !source_.isMapped();
    if (byRamp) mesh.uvs.assign(mesh.positions.size(), {alphaRampU(1), 0.5f});
    if (!color.exists()) return;

    GltfColors read = readColors(document_, color);
    mesh.colors = std::move(read.colors);
    checkLength(mesh.colors.size(), mesh.positions.size(), color);
    warnOfHalfMetal(mesh);
    if (!read.translucent) return;

    if (!source_.alphaByVertex) {
      if (source_.alphaMode == GltfMaterial::Alpha::opaque) return;
      warn("alpha of vertex colors left out, because textures have two sets of coordinates");
      return;
    }

    // Alpha becomes a texture coordinate: of the ramp, or of the second set beside maps.
    const std::vector<float> rgba = readTuples(document_, color, 4);
    if (!byRamp) {
      document_.budget().charge(mesh.positions.size(), sizeof(Vec2f), primitive_.where());
      mesh.secondUvs.resize(mesh.positions.size());
    }
    for (const auto i : indices(mesh.positions)) {
      const float alpha = rgba[4 * i + 3];
      if (byRamp) {
        mesh.uvs[i].x = alphaRampU(alpha);
      } else {
        mesh.secondUvs[i].x = 1 - std::clamp(alpha, 0.0f, 1.0f);
      }
    }
  }

  // Warns of materials that vertex colors tint wrongly: colors multiply the specular reflection as
  // a whole, as that of metal, or not at all.
  void warnOfHalfMetal(const Mesh& mesh) {
    const bool isInPart = source_.mixesMetal() || (source_.metallic > 0 && source_.metallic < 1);
    const auto isWhite = [](const Rgb& color) { return color == Rgb(1.0f); };
    if (!isInPart || std::ranges::all_of(mesh.colors, isWhite)) return;
    warn(
        "vertex colors of a partly metallic material: they multiply all of its reflection or none");
  }

  // Returns the coordinates as the mesh has them; empty if the primitive does not have this set.
  std::vector<Vec2f> textureCoordinates(const Mesh& mesh, const GltfUvMap& uv) const {
    const JsonValue coordinates = attributes_[concat("TEXCOORD_", uv.set)];
    if (!coordinates.exists()) return {};
    std::vector<Vec2f> uvs = readUvs(document_, coordinates);
    checkLength(uvs.size(), mesh.positions.size(), coordinates);
    for (Vec2f& at : uvs) at = uv.map(at.x, at.y);
    return uvs;
  }

  std::vector<std::uint32_t> corners(std::size_t vertices) {
    const JsonValue indices = primitive_["indices"];
    if (indices.exists()) {
      // Decoded strips are separate triangles.
      if (document_.decoded(accessorOf(document_, indices))) mode_ = kTriangles;
      return readIndices(document_, indices);
    }
    if (vertices > std::numeric_limits<std::uint32_t>::max()) {
      throwLimit(primitive_.where() + ": more than 2^32 - 1 vertices");
    }
    document_.budget().charge(vertices, sizeof(std::uint32_t), primitive_.where());
    std::vector<std::uint32_t> all(vertices);
    std::iota(all.begin(), all.end(), 0u);
    return all;
  }

  // Makes triangles with the winding of the specification. Indices out of range are dropped later.
  void connect(Mesh& mesh, const std::vector<std::uint32_t>& c) {
    const bool separate = mode_ == kTriangles;
    const std::size_t count =
        separate ? c.size() / 3 : c.size() - std::min<std::size_t>(c.size(), 2);
    if (separate && c.size() % 3 != 0) warn("triangle with fewer than three corners left out");

    document_.budget().charge(count, sizeof(mesh.triangles[0]), primitive_.where());
    mesh.triangles.reserve(count);
    if (mode_ == kTriangleStrip) {
      addStrip(c, mesh.triangles);
      return;
    }

    for (const auto i : indices(count)) {
      if (separate) {
        mesh.triangles.push_back({c[3 * i], c[3 * i + 1], c[3 * i + 2]});
      } else {
        addJoined({c[i + 1], c[i + 2], c[0]}, mesh.triangles);
      }
    }
  }

  const GltfDocument& document_;
  JsonValue primitive_, attributes_;
  const GltfPlacedMesh& placed_;
  std::uint64_t mode_;
  std::size_t material_;
  const GltfMaterial& source_;
  GltfMaterial::Coordinates coordinates_;
};

// Makes a body for each node that moves, inside that of its parent. The body is placed there when
// the first thing that it holds is.
class MoverBodies {
 public:
  MoverBodies(const Rig& movers, SceneLayout& layout, Body& scene)
      : movers_(movers), layout_(layout), scene_(scene), bodies_(movers.size(), 0) {}

  Body& of(std::uint32_t mover) {
    if (mover == kNoNode) return scene_;
    if (bodies_[mover] == 0) {
      const RigNode& node = movers_[mover];
      Body& parent = of(node.parent);
      bodies_[mover] = layout_.add("");
      parent.placements.push_back({.body = bodies_[mover],
                                   .toParent = node.toParent,
                                   .motion = node.motion,
                                   .mover = node.name});
    }
    return layout_.body(bodies_[mover]);
  }

 private:
  const Rig& movers_;
  SceneLayout& layout_;
  Body& scene_;
  std::vector<std::uint32_t> bodies_;  // 0, the layout's scene: none yet
};

class GltfModel : public Model {
 public:
  GltfModel(const ModelSource& source, const std::string& bytes)
      : document_(source.path, bytes, source.rules, source.budget, source.warnings),
        sources_(readGltfMaterials(document_)),
        maps_(document_.images(), document_.warnings()),
        content_(readGltfNodes(document_, source.instant)) {
    findVertexAlpha();
    for (const GltfMaterial& material : sources_) materials_.push_back(shadedAs(material, {}));
  }

  const std::vector<Material>& materials() const override { return materials_; }
  std::vector<Animation> animations() const override { return listGltfAnimations(document_); }
  std::vector<std::string> variants() const override {
    std::vector<std::string> names;
    const JsonValue all = document_.root()["extensions"]["KHR_materials_variants"]["variants"];
    for (const JsonValue& v : all.elements()) names.push_back(v.need("name").textOr(""));
    return names;
  }

  TexturedMaterial withMaps(std::size_t i, Material material, const GivenMembers& given,
                            TextureLoader& textures) override {
    return maps_.withMaps(
        sources_[i], std::move(material), given, textures,
        [source = sources_[i]](const GltfMeans& means) { return shadedAs(source, means); });
  }

  // Makes a body for each mesh of the file, which nodes share unless they bend it.
  Body content(SceneLayout& layout, const std::vector<std::uint32_t>& materials) override {
    std::map<std::size_t, std::uint32_t> bodies;
    bool empty = true;
    Body all;
    MoverBodies movers(content_.movers, layout, all);

    for (const GltfPlacedMesh& placed : content_.meshes) {
      const auto known = bodies.find(placed.mesh);
      const bool shared = !placed.isDeformed() && known != bodies.end();
      const std::uint32_t body = shared ? known->second : addBody(placed, layout, materials);
      if (!placed.isDeformed()) bodies.emplace(placed.mesh, body);
      empty = empty && layout.body(body).placements.empty();
      movers.of(placed.mover)
          .placements.push_back({.body = body,
                                 .toParent = placed.toMover,
                                 .item = std::make_shared<const std::string>(nameOf(placed))});
    }

    if (empty) {
      const char* why = "its meshes have no triangles";
      if (content_.meshes.empty()) why = "no node shows a mesh";
      if (document_.list("meshes").size() == 0) why = "no meshes";
      warnNothingToDraw(why, document_.name(), document_.warnings());
    }
    return all;
  }

  std::size_t viewSize() const override { return content_.cameras.size() + content_.lights.size(); }

  // The picture takes the first camera's aspect ratio.
  void addView(SceneDescription& scene, const Affine& toWorld) override {
    constexpr double kNarrowest = 0.1, kWidest = 10;
    if (content_.aspect > 0 && scene.cameras.empty()) {
      const double aspect = std::clamp(content_.aspect, kNarrowest, kWidest);
      scene.width = static_cast<int>(std::lround(aspect * scene.height));
    }

    const auto first = size32(scene.motion.rig);
    for (RigNode node : content_.movers) {
      putInParent(node.parent, node.toParent, first, toWorld, scene);
      scene.motion.rig.push_back(std::move(node));
    }

    for (auto [camera, map, mover] : content_.cameras) {
      putInParent(mover, map, first, toWorld, scene);
      camera.eye = Vec3f(map.p);
      // `at` is so far away that the direction survives the rounding of both points.
      camera.at = Vec3f(map.p - normalized(map.z) * std::max(1.0, length(map.p)));
      camera.up = Vec3f(normalized(map.y));
      const auto number = size32(scene.cameras);
      if (mover != kNoNode) scene.motion.cameras.push_back({number, mover, camera});
      scene.cameras.push_back(camera);
    }

    for (auto [light, map, mover] : content_.lights) {
      putInParent(mover, map, first, toWorld, scene);
      light.position = Vec3f(map.p);
      light.direction = Vec3f(-normalized(map.z));
      const auto number = size32(scene.lights);
      if (mover != kNoNode) {
        scene.motion.lights.push_back({number, mover, light.position, light.direction});
      }
      scene.lights.push_back(light);
    }
  }

 private:
  // Places a thing of the file in the scene. The nodes that move are numbered from `first` on
  // there; what none of them carries is moved to the scene's origin.
  static void putInParent(std::uint32_t& parent, Affine& toParent, std::uint32_t first,
                          const Affine& toWorld, const SceneDescription& scene) {
    if (parent == kNoNode) {
      toParent = toWorld * toParent;
      toParent.p = toParent.p - scene.origin;
    } else {
      parent += first;
    }
  }

  // Finds the materials for which the alpha of vertex colors counts.
  void findVertexAlpha() {
    for (const JsonValue& mesh : document_.list("meshes").elements()) {
      for (const JsonValue& primitive : mesh["primitives"].elements()) {
        const JsonValue color = primitive["attributes"]["COLOR_0"];
        std::vector<JsonValue> users{primitive["material"]};
        const JsonValue variants = primitive["extensions"]["KHR_materials_variants"]["mappings"];
        for (const JsonValue& mapping : variants.elements()) users.push_back(mapping["material"]);

        for (const JsonValue& user : users) {
          const auto number = user.indexInto(document_.list("materials"));
          if (!number || !color.exists()) continue;

          GltfMaterial& material = sources_[*number];
          const bool mayBlend =
              material.alphaMode != GltfMaterial::Alpha::opaque && !material.coordinates().areTwo();
          if (mayBlend && !material.alphaByVertex) {
            material.alphaByVertex = readColors(document_, color).translucent;
          }
        }
      }
    }
  }

  std::uint32_t addBody(const GltfPlacedMesh& placed, SceneLayout& layout,
                        const std::vector<std::uint32_t>& materials) const {
    const JsonValue source = document_.list("meshes")[placed.mesh];
    const std::string name = source["name"].textOr("");

    std::vector<Mesh> meshes;
    std::optional<Vec3d> origin;
    for (const JsonValue& primitive : source.need("primitives").elements()) {
      Mesh mesh;
      mesh.name = name;
      PrimitiveReader reader(document_, primitive, sources_, placed, variant);
      if (reader.read(origin, mesh)) meshes.push_back(std::move(mesh));
    }

    const std::uint32_t body = layout.add(name);
    addParts(std::move(meshes), materials, document_.name(), document_.budget(), layout.body(body));
    for (Placement& part : layout.body(body).placements) part.toParent.p = origin.value_or(Vec3d());
    return body;
  }

  // Returns the name of the node, or else that of its mesh.
  std::string nameOf(const GltfPlacedMesh& placed) const {
    std::string node = document_.list("nodes")[placed.node]["name"].textOr("");
    if (!node.empty()) return node;
    std::string mesh = document_.list("meshes")[placed.mesh]["name"].textOr("");
    return mesh.empty() ? concat("/nodes/", placed.node) : mesh;
  }

  GltfDocument document_;
  std::vector<GltfMaterial> sources_;
  std::vector<Material> materials_;  // materials made from sources_
  GltfMapMaker maps_;
  GltfContent content_;
};

}  // namespace

bool GltfPlacedMesh::isDeformed() const {
  const std::vector<double>& weights = deformation.weights;
  return deformation.skeleton || deformation.movingWeights ||
         std::ranges::any_of(weights, [](double weight) { return weight != 0; });
}

std::unique_ptr<Model> openGltf(const ModelSource& source) {
  return openGltf(source, readTextFile(source.path, source.budget.left() / 2));
}

std::unique_ptr<Model> openGltf(const ModelSource& source, const std::string& bytes) {
  return std::make_unique<GltfModel>(source, bytes);
}

}  // namespace whit
