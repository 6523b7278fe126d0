#include "io/gltf/nodes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/options.h"
#include "io/gltf/accessor.h"
#include "io/scene/distinct_names.h"
#include "scene/description.h"

namespace whit {
namespace {

constexpr double kLargestHeight = 1e9;  // of what an orthographic camera shows
constexpr char kLightsExtension[] = "KHR_lights_punctual";
constexpr char kInstancesExtension[] = "EXT_mesh_gpu_instancing";
constexpr std::size_t kTopmost = ~std::size_t{0};
constexpr char kInstancesPath[] = "/extensions/EXT_mesh_gpu_instancing/attributes";

Vec3d tripleOr(const std::vector<double>& v, const Vec3d& fallback) {
  return v.empty() ? fallback : Vec3d{v[0], v[1], v[2]};
}

using Quaternion = std::array<double, 4>;

double squareOf(const Quaternion& q) {
  return q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
}

// As far as 8 bits a component can tell.
bool hasUnitLength(const Quaternion& q) {
  constexpr double kRounding = 0.0077;
  return std::abs(std::sqrt(squareOf(q)) - 1) <= kRounding;
}

Affine rotationOf(const Quaternion& q) {
  const double norm = squareOf(q);
  if (!(norm > 0) || !std::isfinite(norm)) return {};
  const double x = q[0], y = q[1], z = q[2], w = q[3], s = 2 / norm;
  return {{1 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w)},
          {s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w)},
          {s * (x * z + y * w), s * (y * z - x * w), 1 - s * (x * x + y * y)},
          {}};
}

// Column by column.
Affine mapOf(const std::vector<double>& matrix) {
  const auto column = [&](std::size_t i) {
    return Vec3d{matrix[4 * i], matrix[4 * i + 1], matrix[4 * i + 2]};
  };
  return {column(0), column(1), column(2), column(3)};
}

// As Scene::finalize() wants maps to be.
bool isUsable(const Affine& a) {
  constexpr double kSmallestSine = 1e-12;
  for (const Vec3d& column : {a.x, a.y, a.z, a.p}) {
    if (!isFinite(column) || !(maxComponent(abs(column)) <= kLargestCoordinate)) return false;
  }
  return std::abs(a.determinant()) > kSmallestSine * length(a.x) * length(a.y) * length(a.z);
}

// What a node has where its tracks do not say.
struct NodePlace {
  Vec3d translation;
  Quaternion rotation{0, 0, 0, 1};
  Vec3d scale{1, 1, 1};

  Affine map() const {
    return Affine::translation(translation) * rotationOf(rotation) * Affine::scaling(scale);
  }
};

Vec3d tripleAt(const std::optional<Track>& track, double seconds, const Vec3d& fallback) {
  return track ? tripleOr(valueAt(*track, seconds), fallback) : fallback;
}

class NodeMotion : public Motion {
 public:
  NodeMotion(const NodePlace& own, const GltfTracks& tracks) : own_(own), tracks_(tracks) {}

  Affine at(double seconds) const override {
    NodePlace place = own_;
    place.translation = tripleAt(tracks_.translation, seconds, own_.translation);
    place.scale = tripleAt(tracks_.scale, seconds, own_.scale);
    if (tracks_.rotation) {
      const std::vector<double> turn = valueAt(*tracks_.rotation, seconds);
      std::copy(turn.begin(), turn.end(), place.rotation.begin());
    }
    return place.map();
  }

 private:
  NodePlace own_;
  GltfTracks tracks_;
};

// A document's skins, whose joints may come later in the tree than the meshes they hold.
class SkinReader {
 public:
  // `nodeAt(index)` is a node of the document within its parent.
  using NodeAt = std::function<RigNode(std::size_t index)>;
  SkinReader(const GltfDocument& document, const std::vector<std::size_t>& parents, NodeAt nodeAt)
      : document_(document),
        model_(document.model()),
        parents_(parents),
        nodeAt_(std::move(nodeAt)) {}

  // Of the skin with that number; no skeleton where it cannot be read.
  const GltfDeformation& read(std::size_t skin) {
    const auto [known, isNew] = skins_.try_emplace(skin);
    if (isNew) {
      places_.clear();
      rig_.clear();
      std::vector<Deformation::Joint> joints = jointsOf(skin);
      if (!joints.empty()) {
        known->second.joints = std::move(joints);
        known->second.skeleton = std::make_shared<const Rig>(std::move(rig_));
      }
    }
    return known->second;
  }

 private:
  // None where they cannot be read.
  std::vector<Deformation::Joint> jointsOf(std::size_t skin) {
    const LooseJson source = document_.skins().at(skin), joints = source["joints"];
    std::vector<Deformation::Joint> all;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const auto node = joints.at(i).index(model_.nodes.size());
      if (!node) return {};
      all.push_back({place(*node), Affine()});
    }
    if (!source["inverseBindMatrices"].exists()) return all;
    const auto inverse = source["inverseBindMatrices"].index(model_.accessors.size());
    if (!inverse || model_.accessors[*inverse].type != TINYGLTF_TYPE_MAT4) return {};
    const std::vector<float> numbers = readTuples(document_, *inverse, TINYGLTF_TYPE_MAT4);
    if (numbers.size() < 16 * all.size()) return {};
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i].fromMesh = mapOf({numbers.begin() + static_cast<std::ptrdiff_t>(16 * i),
                               numbers.begin() + static_cast<std::ptrdiff_t>(16 * (i + 1))});
    }
    return all;
  }

  // The node in the skeleton, to which it is added with what is above it.
  std::uint32_t place(std::size_t index) {
    std::vector<std::size_t> chain;
    for (std::size_t at = index; at != kTopmost && !places_.contains(at); at = parents_[at]) {
      if (chain.size() > kGltfDepthLimit) {
        throwBadScene(document_.where("nodes", index),
                      "nested deeper than " + std::to_string(kGltfDepthLimit) + " nodes");
      }
      chain.push_back(at);
    }
    for (auto at = chain.rbegin(); at != chain.rend(); ++at) {
      document_.budget().charge(1, 2 * sizeof(RigNode), document_.where("nodes", *at));
      RigNode node = nodeAt_(*at);
      if (parents_[*at] != kTopmost) node.parent = places_.at(parents_[*at]);
      places_[*at] = static_cast<std::uint32_t>(rig_.size());
      rig_.push_back(std::move(node));
    }
    return places_.at(index);
  }

  const GltfDocument& document_;
  const tinygltf::Model& model_;
  const std::vector<std::size_t>& parents_;  // or kTopmost
  NodeAt nodeAt_;
  std::map<std::size_t, std::uint32_t> places_;  // of nodes in rig_
  Rig rig_;
  std::map<std::size_t, GltfDeformation> skins_;
};

class TreeReader {
 public:
  TreeReader(const GltfDocument& document, const std::vector<GltfTracks>& tracks,
             const std::set<std::string>& movable)
      : document_(document),
        model_(document.model()),
        tracks_(tracks),
        movable_(movable),
        skins_(document, parents_, [this](std::size_t index) { return nodeOf(index); }),
        seen_(model_.nodes.size()) {}

  GltfStage read() {
    checkTree();
    for (const std::size_t root : roots()) visit(root, Affine(), kNoNode, 0);
    nameCameras();
    return std::move(stage_);
  }

 private:
  void warn(const char* what, std::size_t node) {
    document_.warnings().add(what, document_.where("nodes", node));
  }

  // No node has two parents or is its own ancestor, which then is a root that is never reached.
  void checkTree() {
    std::vector<bool> hasParent(model_.nodes.size());
    parents_.assign(model_.nodes.size(), kTopmost);
    for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
      for (const int child : model_.nodes[i].children) {
        const auto c = static_cast<std::size_t>(child);
        if (hasParent[c]) {
          throwBadScene(document_.where("nodes", i, "/children"),
                        "expected a tree: node " + std::to_string(child) + " has two parents");
        }
        hasParent[c] = true;
        parents_[c] = i;
      }
    }
    for (std::size_t i = 0; i < hasParent.size(); ++i) {
      if (!hasParent[i]) topmost_.push_back(i);
    }
    if (topmost_.empty() && !model_.nodes.empty()) {
      throwBadScene(document_.where("nodes", 0), "expected a tree: every node has a parent");
    }
  }

  std::vector<std::size_t> roots() const {
    if (model_.scenes.empty()) return topmost_;
    const auto scene = static_cast<std::size_t>(std::max(model_.defaultScene, 0));
    const std::vector<int>& nodes = model_.scenes[scene].nodes;
    return {nodes.begin(), nodes.end()};
  }

  void visit(std::size_t index, const Affine& toMover, std::uint32_t mover, int depth) {
    if (depth > kGltfDepthLimit) {
      throwBadScene(document_.where("nodes", index),
                    "nested deeper than " + std::to_string(kGltfDepthLimit) + " nodes");
    }
    if (seen_[index]) {
      throwBadScene(document_.where("nodes", index), "expected a tree: this node is reached twice");
    }
    seen_[index] = true;
    const tinygltf::Node& node = model_.nodes[index];
    RigNode own = nodeOf(index);
    const Affine map = own.motion ? Affine() : toMover * own.toParent;
    if (own.motion) {
      document_.budget().charge(1, 2 * sizeof(RigNode), document_.where("nodes", index));
      stage_.movers.push_back({mover, toMover, std::move(own.motion), own.name});
      mover = static_cast<std::uint32_t>(stage_.movers.size() - 1);
    }
    if (!isUsable(map)) return warn("node that flattens space left out", index);
    if (node.mesh >= 0) placeMesh(index, map, mover);
    if (node.camera >= 0) addCamera(index, map, mover);
    if (const tinygltf::Value* light = findExtension(node.extensions, kLightsExtension)) {
      addLight(index, light->Get("light").GetNumberAsInt(), map, mover);
    }
    for (const int child : node.children) {
      visit(static_cast<std::size_t>(child), map, mover, depth + 1);
    }
  }

  // Within its parent: either where it stands or how it moves.
  RigNode nodeOf(std::size_t index) {
    RigNode node = asInFile(index);
    const std::string name = "/nodes/" + std::to_string(index);
    if (!movable_.contains(name)) return node;
    if (!node.motion) node.motion = std::make_shared<const FixedMotion>(node.toParent);
    return {kNoNode, Affine(), node.motion, name};
  }

  RigNode asInFile(std::size_t index) {
    const GltfTracks& tracks = tracks_[index];
    const std::vector<double>& m = model_.nodes[index].matrix;
    if (tracks.place()) {
      return {kNoNode, Affine(), std::make_shared<const NodeMotion>(placeOf(index), tracks)};
    }
    if (m.empty()) return {kNoNode, placeOf(index).map(), nullptr};
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) {
      warn("last row of a matrix, other than 0 0 0 1, left out", index);
    }
    return {kNoNode, mapOf(m), nullptr};
  }

  NodePlace placeOf(std::size_t index) {
    const tinygltf::Node& node = model_.nodes[index];
    Quaternion rotation{0, 0, 0, 1};
    std::copy(node.rotation.begin(), node.rotation.end(), rotation.begin());
    return checked({tripleOr(node.translation, {}), rotation, tripleOr(node.scale, {1, 1, 1})},
                   index);
  }

  NodePlace checked(const NodePlace& place, std::size_t index) {
    if (!hasUnitLength(place.rotation)) {
      warn("rotation that is not of unit length normalized", index);
    }
    return place;
  }

  void placeMesh(std::size_t index, const Affine& map, std::uint32_t mover) {
    const tinygltf::Node& node = model_.nodes[index];
    const auto mesh = static_cast<std::size_t>(node.mesh);
    const GltfDeformation deformation = deformationOf(index);
    if (deformation.skeleton) {
      return stage_.meshes.push_back({mesh, Affine(), kNoNode, deformation, index});
    }
    const tinygltf::Value* copies = findExtension(node.extensions, kInstancesExtension);
    if (!copies) return stage_.meshes.push_back({mesh, map, mover, deformation, index});
    for (const Affine& copy : readCopies(copies->Get("attributes"), index)) {
      const Affine toMover = map * copy;
      if (isUsable(toMover)) {
        stage_.meshes.push_back({mesh, toMover, mover, deformation, index});
      } else {
        warn("copy of a mesh that is flattened left out", index);
      }
    }
  }

  GltfDeformation deformationOf(std::size_t index) {
    const tinygltf::Node& node = model_.nodes[index];
    GltfDeformation deformation;
    if (node.skin >= 0) {
      const auto skin = static_cast<std::size_t>(node.skin);
      deformation = skins_.read(skin);
      document_.budget().charge(deformation.joints.size(), sizeof(Deformation::Joint),
                                document_.where("skins", skin));
      if (!deformation.skeleton) {
        warn("skin that cannot be read: its mesh is shown as it was modelled", index);
      }
    }
    deformation.weights = !node.weights.empty()
                              ? node.weights
                              : model_.meshes[static_cast<std::size_t>(node.mesh)].weights;
    deformation.movingWeights = tracks_[index].weights;
    return deformation;
  }

  // EXT_mesh_gpu_instancing: where they stand within the node.
  std::vector<Affine> readCopies(const tinygltf::Value& attributes, std::size_t index) {
    const auto accessor = [&](const char* name) {
      return static_cast<std::size_t>(attributes.Get(name).GetNumberAsInt());
    };
    std::vector<Vec3f> translations, scales;
    std::vector<Quaternion> rotations;
    if (attributes.Has("TRANSLATION"))
      translations = readVectors(document_, accessor("TRANSLATION"));
    if (attributes.Has("ROTATION")) rotations = readQuaternions(document_, accessor("ROTATION"));
    if (attributes.Has("SCALE")) scales = readVectors(document_, accessor("SCALE"));
    const std::size_t count = std::max({translations.size(), rotations.size(), scales.size()});
    const std::string where = document_.where("nodes", index, kInstancesPath);
    for (const std::size_t size : {translations.size(), rotations.size(), scales.size()}) {
      if (size != 0 && size != count) throwBadScene(where, "expected attributes of equal lengths");
    }
    document_.budget().charge(count, 2 * sizeof(GltfPlacedMesh) + sizeof(Instance), where);
    std::vector<Affine> copies;
    for (std::size_t i = 0; i < count; ++i) {
      const NodePlace place{translations.empty() ? Vec3d() : Vec3d(translations[i]),
                            rotations.empty() ? Quaternion{0, 0, 0, 1} : rotations[i],
                            scales.empty() ? Vec3d(1.0) : Vec3d(scales[i])};
      copies.push_back(checked(place, index).map());
    }
    return copies;
  }

  void addCamera(std::size_t index, const Affine& map, std::uint32_t mover) {
    const tinygltf::Node& node = model_.nodes[index];
    const tinygltf::Camera& source = model_.cameras[static_cast<std::size_t>(node.camera)];
    const double fov = source.perspective.yfov * 180 / std::numbers::pi;
    const double xmag = std::abs(source.orthographic.xmag);
    const double ymag = std::abs(source.orthographic.ymag);
    const bool orthographic = source.type == "orthographic" && ymag > 0 && ymag < kLargestHeight;
    if (!orthographic && (source.type != "perspective" || !(fov > 0 && fov < 180))) {
      return warn("camera of an unknown type or without an extent left out", index);
    }
    Camera camera;
    camera.name = !node.name.empty() ? node.name : source.name.empty() ? "camera" : source.name;
    camera.eye = Vec3f(map.p);
    // Far enough for the direction to survive the rounding of eye and at.
    camera.at = Vec3f(map.p - normalized(map.z) * std::max(1.0, length(map.p)));
    camera.up = Vec3f(normalized(map.y));
    if (orthographic) {
      camera.orthographicHeight = static_cast<float>(2 * ymag);
    } else {
      camera.fov = static_cast<float>(std::clamp(fov, kLeastFov, kLargestFov));
    }
    if (stage_.cameras.empty()) {
      stage_.aspect = orthographic ? xmag / ymag : source.perspective.aspectRatio;
    }
    stage_.cameras.push_back(camera);
    stage_.cameraMovers.push_back(mover);
  }

  void addLight(std::size_t index, int number, const Affine& map, std::uint32_t mover) {
    const tinygltf::Light& source = model_.lights[static_cast<std::size_t>(number)];
    Light light;
    light.name = source.name.empty() ? model_.nodes[index].name : source.name;
    if (source.type == "spot") {
      light.kind = Light::Kind::spot;
      if (!setCone(source.spot, light)) warn("spot light's cone repaired", index);
    } else if (source.type == "directional") {
      light.kind = Light::Kind::directional;
    } else if (source.type != "point") {
      return warn("light of an unknown type left out", index);
    }
    if (source.range > 0 && light.kind != Light::Kind::directional) {
      warn("light's range left out, it shines on", index);
    }
    const std::vector<double>& c = source.color;
    const Vec3d color = c.empty() ? Vec3d(1.0) : Vec3d{c[0], c[1], c[2]};
    light.position = Vec3f(map.p);
    light.direction = Vec3f(-normalized(map.z));
    light.intensity = Rgb(color * (source.intensity / kLumensPerWatt));
    stage_.lights.push_back(light);
    stage_.lightMovers.push_back(mover);
  }

  // A camera is chosen by its name.
  void nameCameras() {
    std::vector<std::string> names;
    for (const Camera& camera : stage_.cameras) names.push_back(camera.name);
    names = distinctNames(names);
    for (std::size_t i = 0; i < names.size(); ++i) stage_.cameras[i].name = names[i];
  }

  // False: they were not 0 <= inner <= outer, half a degree <= outer <= a right angle. Equal ones,
  // a sharp edge, are not what the extension allows but what writers write.
  static bool setCone(const tinygltf::SpotLight& spot, Light& light) {
    constexpr double kRightAngle = std::numbers::pi / 2, kLeastOuter = std::numbers::pi / 360;
    const double outer = std::clamp(spot.outerConeAngle, kLeastOuter, kRightAngle);
    const double inner = std::clamp(spot.innerConeAngle, 0.0, outer);
    light.outerConeAngle = static_cast<float>(outer * 180 / std::numbers::pi);
    light.innerConeAngle = std::min(static_cast<float>(inner * 180 / std::numbers::pi),
                                    std::nextafter(light.outerConeAngle, 0.0f));
    constexpr double kRounding = 1e-5;
    return std::abs(outer - spot.outerConeAngle) < kRounding &&
           std::abs(inner - spot.innerConeAngle) < kRounding;
  }

  const GltfDocument& document_;
  const tinygltf::Model& model_;
  const std::vector<GltfTracks>& tracks_;
  const std::set<std::string>& movable_;
  std::vector<std::size_t> parents_;  // or kTopmost
  SkinReader skins_;
  std::vector<bool> seen_;
  std::vector<std::size_t> topmost_;
  GltfStage stage_;
};

}  // namespace

GltfStage readGltfNodes(const GltfDocument& document, const std::vector<GltfTracks>& tracks,
                        const std::set<std::string>& movable) {
  return TreeReader(document, tracks, movable).read();
}

}  // namespace whit
