// glTF files as models.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "io/gltf/document.h"
#include "io/gltf/material.h"
#include "io/gltf/nodes.h"
#include "io/model.h"
#include "scene/members.h"

namespace whit {

namespace {

// Replaces what a scene file has not `given` by what `fresh` has. Maps stay.
void renew(Material& to, const Material& fresh, const GivenMembers& given) {
  const float cutoff = to.alphaCutoff;
  forEachMember<Material>([&](const auto& member) {
    if (member.rules.kind == MemberKind::map || given.contains(member.name)) return;
    to.*member.field = fresh.*member.field;
  });
  if (given.contains("alphaMap")) to.alphaCutoff = cutoff;
}

// Bodies of nodes that move, each in that of its parent, where the first of what it holds comes.
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
      parent.children.push_back({bodies_[mover], node.toParent, 0, node.motion, node.name});
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
  explicit GltfModel(const ModelSource& source)
      : document_(source.path, source.rules, source.budget, source.warnings),
        sources_(readGltfMaterials(document_)),
        maps_(document_),
        stage_(readGltfNodes(document_, source.instant)) {
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
    const GltfMaps maps = maps_.ask(sources_[i], textures);
    forEachMap([&](const auto& member) {
      // A roughness or coverage that is given is meant as it stands.
      const bool isReplaced =
          (member.field == &Material::roughnessMap && given.contains("roughness")) ||
          (member.field == &Material::coverageMap && given.contains("coverage"));
      if (isReplaced || given.contains(member.name)) return;
      material.*member.field = maps.slots.*member.field;
    });
    const auto renewed = [source = sources_[i], given, means = maps.means](Material& m) {
      renew(m, shadedAs(source, *means), given);
    };
    return {std::move(material), renewed};
  }

  // A body for each mesh of the file, which nodes share unless they bend it.
  Body content(SceneLayout& layout, const std::vector<std::uint32_t>& materials) override {
    std::map<std::size_t, std::uint32_t> bodies;
    bool empty = true;
    Body all;
    MoverBodies movers(stage_.movers, layout, all);
    for (const GltfPlacedMesh& placed : stage_.meshes) {
      const auto known = bodies.find(placed.mesh);
      const bool shared = !placed.isDeformed() && known != bodies.end();
      const std::uint32_t body = shared ? known->second : addBody(placed, layout, materials);
      if (!placed.isDeformed()) bodies.emplace(placed.mesh, body);
      empty = empty && layout.body(body).parts.empty();
      Placement shown{body, placed.toMover};
      shown.item = std::make_shared<const std::string>(nameOf(placed));
      movers.of(placed.mover).children.push_back(std::move(shown));
    }
    if (empty) {
      warnNothingToDraw(document_.list("meshes").size() == 0 ? "no meshes"
                        : stage_.meshes.empty()              ? "no node shows a mesh"
                                                             : "its meshes have no triangles",
                        document_.name(), document_.warnings());
    }
    return all;
  }

  // The picture takes the first camera's aspect ratio.
  void addView(SceneDescription& scene) override {
    constexpr double kNarrowest = 0.1, kWidest = 10;
    if (stage_.aspect > 0) {
      const double aspect = std::clamp(stage_.aspect, kNarrowest, kWidest);
      scene.width = static_cast<int>(std::lround(aspect * scene.height));
    }
    scene.cameras = stage_.cameras;
    scene.lights = stage_.lights;
    const auto first = static_cast<std::uint32_t>(scene.motion.rig.size());
    for (RigNode node : stage_.movers) {
      if (node.parent != kNoNode) node.parent += first;
      scene.motion.rig.push_back(std::move(node));
    }
    for (MovingCamera camera : stage_.movingCameras) {
      camera.node += first;
      scene.motion.cameras.push_back(camera);
    }
    for (MovingLight light : stage_.movingLights) {
      light.node += first;
      scene.motion.lights.push_back(light);
    }
  }

 private:
  std::uint32_t addBody(const GltfPlacedMesh& placed, SceneLayout& layout,
                        const std::vector<std::uint32_t>& materials) const {
    const std::uint32_t body = layout.add(document_.list("meshes")[placed.mesh]["name"].textOr(""));
    addParts(readGltfMesh(document_, placed, sources_, variant), materials, document_.name(),
             document_.budget(), layout.body(body));
    return body;
  }

  // The node's, or its mesh's.
  std::string nameOf(const GltfPlacedMesh& placed) const {
    std::string node = document_.list("nodes")[placed.node]["name"].textOr("");
    if (!node.empty()) return node;
    std::string mesh = document_.list("meshes")[placed.mesh]["name"].textOr("");
    return mesh.empty() ? "/nodes/" + std::to_string(placed.node) : mesh;
  }

  GltfDocument document_;
  std::vector<GltfMaterial> sources_;
  std::vector<Material> materials_;  // of sources_
  GltfMapMaker maps_;
  GltfStage stage_;
};

}  // namespace

std::unique_ptr<Model> openGltf(const ModelSource& source) {
  return std::make_unique<GltfModel>(source);
}

}  // namespace whit
