#include "io/gltf/nodes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/formatted.h"
#include "core/nearest_name.h"
#include "core/options.h"
#include "scene/description.h"
#include "scene/motion.h"

namespace whit {
namespace {

// Animated properties of a node. Properties without a track keep the value of the node itself.
struct GltfTracks {
  std::optional<Track> translation, rotation, scale;  // 3, 4 (x, y, z, w) and 3 components
  std::optional<Track> weights;                       // of its mesh's morph targets

  bool place() const { return translation || rotation || scale; }
};

struct Target {
  std::string_view path;
  std::size_t components;  // of a key; 0: as many scalars as the mesh has morph targets
  std::optional<Track> GltfTracks::*track;
};
constexpr Target kTargets[] = {
    {"translation", 3, &GltfTracks::translation},
    {"rotation", 4, &GltfTracks::rotation},
    {"scale", 3, &GltfTracks::scale},
    {"weights", 0, &GltfTracks::weights},
};

Track::Interpolation interpolationOf(const JsonValue& sampler) {
  const std::string name = sampler["interpolation"].textOr("");
  if (name == "STEP") return Track::Interpolation::step;
  return name == "CUBICSPLINE" ? Track::Interpolation::cubic : Track::Interpolation::linear;
}

class AnimationReader {
 public:
  AnimationReader(const GltfDocument& document, const JsonValue& animation)
      : document_(document), animation_(animation), nodes_(document.list("nodes")) {}

  // Time of the last key of all samplers in use.
  double seconds() const {
    double last = 0;
    forEachChannel([&](std::size_t, const Target&, const JsonValue& sampler) {
      const JsonValue most = accessorOf(document_, sampler.need("input"))["max"];
      if (most.size() > 0) last = std::max(last, most[0].numberOr(0));
    });
    return last;
  }

  std::size_t movedNodes() const {
    std::set<std::size_t> moved;
    forEachChannel([&](std::size_t node, const Target&, const JsonValue&) { moved.insert(node); });
    return moved.size();
  }

  void read(std::vector<GltfTracks>& tracks) const {
    forEachChannel([&](std::size_t node, const Target& target, const JsonValue& sampler) {
      Track track = readTrack(target, node, sampler);
      if (track.components > 0) tracks[node].*target.track = std::move(track);
    });
  }

 private:
  // Skips channels without a node and those that move what only an extension can move.
  template <typename Use>
  void forEachChannel(const Use& use) const {
    const JsonValue channels = animation_["channels"], samplers = animation_["samplers"];
    for (std::size_t i = 0; i < channels.size(); ++i) {
      const JsonValue target = channels[i].need("target");
      const auto node = target["node"].indexInto(nodes_);
      const std::string path = target.need("path").textOr("");
      for (const Target& known : kTargets) {
        if (!node || known.path != path) continue;
        use(*node, known, samplers[channels[i].need("sampler").indexInto(samplers).value_or(0)]);
      }
    }
  }

  std::size_t morphTargets(std::size_t node) const {
    const JsonValue meshes = document_.list("meshes");
    const auto mesh = nodes_[node]["mesh"].indexInto(meshes);
    return mesh ? meshes[*mesh]["primitives"][std::size_t{0}]["targets"].size() : 0;
  }

  Track readTrack(const Target& target, std::size_t node, const JsonValue& sampler) const {
    Track track;
    track.interpolation = interpolationOf(sampler);
    track.rotation = target.path == "rotation";
    track.components = target.components > 0 ? target.components : morphTargets(node);
    if (track.components == 0) return track;
    track.times = readTimes(sampler.need("input"));
    const JsonValue output = sampler.need("output");
    const std::vector<float> values =
        readTuples(document_, output, std::max<std::size_t>(target.components, 1));
    const std::size_t each = track.interpolation == Track::Interpolation::cubic ? 3 : 1;
    const std::size_t expected = track.times.size() * track.components * each;
    if (values.size() != expected) {
      output.fail(std::to_string(expected) + " numbers for " + std::to_string(track.times.size()) +
                      " times",
                  std::to_string(values.size()));
    }
    if (!std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); })) {
      output.fail("finite numbers", "one that is not");
    }
    track.values.assign(values.begin(), values.end());
    return track;
  }

  std::vector<double> readTimes(const JsonValue& input) const {
    const std::vector<float> times = readTuples(document_, input, 1);
    if (times.empty()) input.fail("at least one time", "none");
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (std::isfinite(times[i]) && (i == 0 || times[i] > times[i - 1])) continue;
      input.fail("finite times that increase",
                 formatted("%g at index %zu", static_cast<double>(times[i]), i));
    }
    return {times.begin(), times.end()};
  }

  const GltfDocument& document_;
  JsonValue animation_, nodes_;
};

}  // namespace

std::vector<Animation> listGltfAnimations(const GltfDocument& document) {
  const JsonValue animations = document.list("animations");
  std::vector<std::string> names;
  for (std::size_t i = 0; i < animations.size(); ++i) {
    const std::string name = animations[i]["name"].textOr("");
    names.push_back(name.empty() ? "animation " + std::to_string(i) : name);
  }
  names = distinctNames(names);
  std::vector<Animation> all;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const AnimationReader reader(document, animations[i]);
    all.push_back({names[i], reader.seconds(), reader.movedNodes()});
  }
  return all;
}

namespace {

std::vector<GltfTracks> readTracks(const GltfDocument& document, const Instant& instant) {
  std::vector<GltfTracks> tracks(document.list("nodes").size());
  if (!instant.moves()) return tracks;
  const std::vector<Animation> all = listGltfAnimations(document);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!instant.animation.empty() && all[i].name != instant.animation) continue;
    AnimationReader(document, document.list("animations")[i]).read(tracks);
    break;
  }
  return tracks;
}

constexpr double kLargestHeight = 1e9;  // of an orthographic camera's view
constexpr char kLights[] = "KHR_lights_punctual";
constexpr std::size_t kTopmost = ~std::size_t{0};  // parent of a node without one

Vec3d tripleOr(const std::vector<double>& v, const Vec3d& fallback) {
  return v.empty() ? fallback : Vec3d{v[0], v[1], v[2]};
}

using Quaternion = std::array<double, 4>;

double squareOf(const Quaternion& q) {
  return q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
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

// The transform of a node where its animation tracks do not replace it.
struct NodePlace {
  Vec3d translation;
  Quaternion rotation{0, 0, 0, 1};
  Vec3d scale{1, 1, 1};

  Affine map() const {
    return Affine::translation(translation) * rotationOf(rotation) * Affine::scaling(scale);
  }
};

class NodeMotion : public Motion {
 public:
  NodeMotion(const NodePlace& own, const GltfTracks& tracks) : own_(own), tracks_(tracks) {}

  Affine at(double seconds) const override {
    NodePlace place = own_;
    const auto value = [&](const std::optional<Track>& track) {
      return track ? valueAt(*track, seconds) : std::vector<double>();
    };
    place.translation = tripleOr(value(tracks_.translation), own_.translation);
    place.scale = tripleOr(value(tracks_.scale), own_.scale);
    const std::vector<double> turn = value(tracks_.rotation);
    std::copy(turn.begin(), turn.end(), place.rotation.begin());
    return place.map();
  }

 private:
  NodePlace own_;
  GltfTracks tracks_;
};

class TreeReader {
 public:
  TreeReader(const GltfDocument& document, const std::vector<GltfTracks>& tracks,
             const std::set<std::string>& movable)
      : document_(document),
        nodes_(document.list("nodes")),
        tracks_(tracks),
        movable_(movable),
        seen_(nodes_.size()) {}

  GltfStage read() {
    checkTree();
    for (const std::size_t root : roots()) visit(root, Affine(), kNoNode, 0);
    nameCameras();
    return std::move(stage_);
  }

 private:
  void warn(const char* what, std::size_t node) {
    document_.warnings().add(what, nodes_[node].where());
  }

  void refuseDepth(std::size_t depth, std::size_t node) const {
    if (depth <= kGltfDepthLimit) return;
    throwBadScene(nodes_[node].where(),
                  "nested deeper than " + std::to_string(kGltfDepthLimit) + " nodes");
  }

  // No node may have two parents. A node that is its own ancestor is found by visit().
  void checkTree() {
    parents_.assign(nodes_.size(), kTopmost);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const JsonValue children = nodes_[i]["children"];
      for (std::size_t k = 0; k < children.size(); ++k) {
        std::size_t& parent = parents_[children[k].indexInto(nodes_).value_or(0)];
        if (parent != kTopmost) {
          children.fail("a tree", "node " + std::to_string(*children[k].indexInto(nodes_)) +
                                      " with two parents");
        }
        parent = i;
      }
    }
  }

  std::vector<std::size_t> roots() const {
    const JsonValue scenes = document_.list("scenes");
    const auto scene = document_.root()["scene"].indexInto(scenes);
    std::vector<std::size_t> all;
    if (scenes.size() == 0) {
      for (std::size_t i = 0; i < parents_.size(); ++i) {
        if (parents_[i] == kTopmost) all.push_back(i);
      }
    }
    const JsonValue nodes = scenes[scene.value_or(0)]["nodes"];
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      all.push_back(nodes[i].indexInto(nodes_).value_or(0));
    }
    return all;
  }

  void visit(std::size_t index, const Affine& toMover, std::uint32_t mover, std::size_t depth) {
    const JsonValue node = nodes_[index];
    refuseDepth(depth, index);
    if (seen_[index]) node.fail("a tree", "this node twice");
    seen_[index] = true;
    RigNode own = nodeOf(index);
    const Affine map = own.motion ? Affine() : toMover * own.toParent;
    if (own.motion) {
      document_.budget().charge(1, 2 * sizeof(RigNode), node.where());
      stage_.movers.push_back({mover, toMover, std::move(own.motion), own.name});
      mover = static_cast<std::uint32_t>(stage_.movers.size() - 1);
    }
    if (!isUsable(map)) return warn("node that flattens space left out", index);
    if (node["mesh"].exists()) placeMesh(index, map, mover);
    if (node["camera"].exists()) addCamera(index, map, mover);
    if (node["extensions"][kLights].exists()) addLight(index, map, mover);
    const JsonValue children = node["children"];
    for (std::size_t k = 0; k < children.size(); ++k) {
      visit(*children[k].indexInto(nodes_), map, mover, depth + 1);
    }
  }

  // The node within its parent: it has a place or a motion.
  RigNode nodeOf(std::size_t index) {
    RigNode node = asInFile(index);
    const std::string name = "/nodes/" + std::to_string(index);
    if (!movable_.contains(name)) return node;
    if (!node.motion) node.motion = std::make_shared<const FixedMotion>(node.toParent);
    return {kNoNode, Affine(), node.motion, name};
  }

  RigNode asInFile(std::size_t index) {
    const GltfTracks& tracks = tracks_[index];
    const std::vector<double> m = nodes_[index]["matrix"].numbers(16);
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
    const JsonValue node = nodes_[index];
    NodePlace place{tripleOr(node["translation"].numbers(3), {}),
                    {0, 0, 0, 1},
                    tripleOr(node["scale"].numbers(3), {1, 1, 1})};
    const std::vector<double> turn = node["rotation"].numbers(4);
    std::copy(turn.begin(), turn.end(), place.rotation.begin());
    checkRotation(place.rotation, index);
    return place;
  }

  // The tolerance is what 8 bits a component can tell.
  void checkRotation(const Quaternion& q, std::size_t index) {
    constexpr double kRounding = 0.0077;
    if (std::abs(std::sqrt(squareOf(q)) - 1) <= kRounding) return;
    warn("rotation that is not of unit length normalized", index);
  }

  void placeMesh(std::size_t index, const Affine& map, std::uint32_t mover) {
    const JsonValue copies = nodes_[index]["extensions"]["EXT_mesh_gpu_instancing"];
    const std::size_t mesh = *nodes_[index]["mesh"].indexInto(document_.list("meshes"));
    const GltfDeformation deformation = deformationOf(index, mesh);
    if (deformation.skeleton) {
      return stage_.meshes.push_back({mesh, Affine(), kNoNode, deformation, index});
    }
    if (!copies.exists()) {
      return stage_.meshes.push_back({mesh, map, mover, deformation, index});
    }
    for (const Affine& copy : readCopies(copies.need("attributes"), index)) {
      const Affine toMover = map * copy;
      if (isUsable(toMover)) {
        stage_.meshes.push_back({mesh, toMover, mover, deformation, index});
      } else {
        warn("copy of a mesh that is flattened left out", index);
      }
    }
  }

  GltfDeformation deformationOf(std::size_t index, std::size_t mesh) {
    const JsonValue node = nodes_[index];
    GltfDeformation deformation;
    if (const auto skin = node["skin"].indexInto(document_.list("skins"))) {
      deformation = skinOf(*skin);
      document_.budget().charge(deformation.joints.size(), sizeof(Deformation::Joint),
                                node.where());
    }
    deformation.weights = node["weights"].numbers();
    if (deformation.weights.empty()) {
      deformation.weights = document_.list("meshes")[mesh]["weights"].numbers();
    }
    deformation.movingWeights = tracks_[index].weights;
    return deformation;
  }

  // Joints may come later in the tree than the meshes they hold.
  const GltfDeformation& skinOf(std::size_t index) {
    const auto [known, isNew] = skins_.try_emplace(index);
    if (!isNew) return known->second;
    const JsonValue skin = document_.list("skins")[index];
    const JsonValue joints = skin.need("joints"), inverse = skin["inverseBindMatrices"];
    std::vector<Deformation::Joint>& all = known->second.joints;
    Rig rig;
    std::map<std::size_t, std::uint32_t> places;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      all.push_back({placeJoint(joints[i].indexInto(nodes_).value_or(0), places, rig), Affine()});
    }
    if (all.empty()) joints.fail("at least one joint");
    known->second.skeleton = std::make_shared<const Rig>(std::move(rig));
    if (!inverse.exists()) return known->second;
    const std::vector<float> numbers = readTuples(document_, inverse, 16);
    if (numbers.size() < 16 * all.size()) {
      inverse.fail("a matrix for each of " + std::to_string(all.size()) + " joints",
                   std::to_string(numbers.size() / 16));
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i].fromMesh = mapOf({numbers.begin() + static_cast<std::ptrdiff_t>(16 * i),
                               numbers.begin() + static_cast<std::ptrdiff_t>(16 * (i + 1))});
    }
    return known->second;
  }

  // Returns the node's index in the skeleton `rig`, after adding the node and its ancestors to it.
  // `places` has the indices of the nodes that are there.
  std::uint32_t placeJoint(std::size_t index, std::map<std::size_t, std::uint32_t>& places,
                           Rig& rig) {
    std::vector<std::size_t> chain;
    for (std::size_t at = index; at != kTopmost && !places.contains(at); at = parents_[at]) {
      refuseDepth(chain.size(), index);
      chain.push_back(at);
    }
    for (auto at = chain.rbegin(); at != chain.rend(); ++at) {
      document_.budget().charge(1, 2 * sizeof(RigNode), document_.name());
      RigNode node = nodeOf(*at);
      if (parents_[*at] != kTopmost) node.parent = places.at(parents_[*at]);
      places[*at] = static_cast<std::uint32_t>(rig.size());
      rig.push_back(std::move(node));
    }
    return places.at(index);
  }

  // EXT_mesh_gpu_instancing: the places of the copies within the node.
  std::vector<Affine> readCopies(const JsonValue& attributes, std::size_t index) {
    const JsonValue translation = attributes["TRANSLATION"], rotation = attributes["ROTATION"];
    const JsonValue scale = attributes["SCALE"];
    std::vector<Vec3f> translations, scales;
    std::vector<float> rotations;
    if (translation.exists()) translations = readVectors(document_, translation);
    if (rotation.exists()) rotations = readTuples(document_, rotation, 4);
    if (scale.exists()) scales = readVectors(document_, scale);
    const std::size_t turns = rotations.size() / 4;
    const std::size_t count = std::max({translations.size(), turns, scales.size()});
    for (const std::size_t size : {translations.size(), turns, scales.size()}) {
      if (size != 0 && size != count) {
        attributes.fail("attributes of equal lengths",
                        std::to_string(size) + " beside " + std::to_string(count));
      }
    }
    document_.budget().charge(count, 2 * sizeof(GltfPlacedMesh) + sizeof(Instance),
                              attributes.where());
    std::vector<Affine> copies;
    for (std::size_t i = 0; i < count; ++i) {
      Quaternion turn{0, 0, 0, 1};
      if (turns > 0) std::copy_n(&rotations[4 * i], 4, turn.begin());
      checkRotation(turn, index);
      const NodePlace place{translations.empty() ? Vec3d() : Vec3d(translations[i]), turn,
                            scales.empty() ? Vec3d(1.0) : Vec3d(scales[i])};
      copies.push_back(place.map());
    }
    return copies;
  }

  void addCamera(std::size_t index, const Affine& map, std::uint32_t mover) {
    const JsonValue node = nodes_[index], cameras = document_.list("cameras");
    const JsonValue source = cameras[*node["camera"].indexInto(cameras)];
    const std::string type = source.need("type").textOr("");
    Camera camera;
    double aspect = 0;
    bool shows = false;
    if (type == "perspective") {
      const JsonValue perspective = source.need(type);
      const double fov = perspective.need("yfov").numberOr(0) * 180 / std::numbers::pi;
      shows = fov > 0 && fov < 180;
      camera.fov = static_cast<float>(std::clamp(fov, kLeastFov, kLargestFov));
      aspect = perspective["aspectRatio"].numberOr(0);
    } else if (type == "orthographic") {
      const JsonValue orthographic = source.need(type);
      const double xmag = std::abs(orthographic.need("xmag").numberOr(0));
      const double ymag = std::abs(orthographic.need("ymag").numberOr(0));
      shows = ymag > 0 && ymag < kLargestHeight;
      camera.orthographicHeight = static_cast<float>(2 * ymag);
      aspect = xmag / ymag;
    }
    if (!shows) return warn("camera of an unknown type or without an extent left out", index);
    camera.name = node["name"].textOr("");
    if (camera.name.empty()) camera.name = source["name"].textOr("");
    if (camera.name.empty()) camera.name = "camera";
    camera.eye = Vec3f(map.p);
    // Far enough for the direction to survive the rounding of eye and at.
    camera.at = Vec3f(map.p - normalized(map.z) * std::max(1.0, length(map.p)));
    camera.up = Vec3f(normalized(map.y));
    if (stage_.cameras.empty()) stage_.aspect = aspect;
    const auto number = static_cast<std::uint32_t>(stage_.cameras.size());
    if (mover != kNoNode) stage_.movingCameras.push_back({number, mover, camera});
    stage_.cameras.push_back(camera);
  }

  void addLight(std::size_t index, const Affine& map, std::uint32_t mover) {
    const JsonValue node = nodes_[index];
    const JsonValue lights = document_.root()["extensions"][kLights]["lights"];
    const JsonValue number = node["extensions"][kLights].need("light");
    const JsonValue source = lights[number.indexInto(lights).value_or(0)];
    Light light;
    light.name = source["name"].textOr("");
    if (light.name.empty()) light.name = node["name"].textOr("");
    const std::string type = source.need("type").textOr("");
    if (type == "spot") {
      light.kind = Light::Kind::spot;
      if (!setCone(source.need("spot"), light)) warn("spot light's cone repaired", index);
    } else if (type == "directional") {
      light.kind = Light::Kind::directional;
    } else if (type != "point") {
      return warn("light of an unknown type left out", index);
    }
    if (source["range"].numberOr(0) > 0 && light.kind != Light::Kind::directional) {
      warn("light's range left out, it shines on", index);
    }
    const Vec3d color = tripleOr(source["color"].numbers(3), Vec3d(1.0));
    light.position = Vec3f(map.p);
    light.direction = Vec3f(-normalized(map.z));
    light.intensity = Rgb(color * (source["intensity"].numberOr(1) / kLumensPerWatt));
    const auto place = static_cast<std::uint32_t>(stage_.lights.size());
    if (mover != kNoNode) {
      stage_.movingLights.push_back({place, mover, light.position, light.direction});
    }
    stage_.lights.push_back(light);
  }

  // A camera is chosen by its name.
  void nameCameras() {
    std::vector<std::string> names;
    for (const Camera& camera : stage_.cameras) names.push_back(camera.name);
    names = distinctNames(names);
    for (std::size_t i = 0; i < names.size(); ++i) stage_.cameras[i].name = names[i];
  }

  // Returns whether 0 <= inner <= outer and half a degree <= outer <= a right angle. Equal angles,
  // a sharp edge, are accepted: the extension forbids them, but writers produce them.
  static bool setCone(const JsonValue& spot, Light& light) {
    constexpr double kRightAngle = std::numbers::pi / 2, kLeastOuter = std::numbers::pi / 360;
    const double outerAngle = spot["outerConeAngle"].numberOr(std::numbers::pi / 4);
    const double innerAngle = spot["innerConeAngle"].numberOr(0);
    const double outer = std::clamp(outerAngle, kLeastOuter, kRightAngle);
    const double inner = std::clamp(innerAngle, 0.0, outer);
    light.outerConeAngle = static_cast<float>(outer * 180 / std::numbers::pi);
    light.innerConeAngle = std::min(static_cast<float>(inner * 180 / std::numbers::pi),
                                    std::nextafter(light.outerConeAngle, 0.0f));
    constexpr double kRounding = 1e-5;
    return std::abs(outer - outerAngle) < kRounding && std::abs(inner - innerAngle) < kRounding;
  }

  const GltfDocument& document_;
  JsonValue nodes_;
  const std::vector<GltfTracks>& tracks_;
  const std::set<std::string>& movable_;
  std::vector<std::size_t> parents_;
  std::map<std::size_t, GltfDeformation> skins_;
  std::vector<bool> seen_;
  GltfStage stage_;
};

}  // namespace

GltfStage readGltfNodes(const GltfDocument& document, const Instant& instant) {
  return TreeReader(document, readTracks(document, instant), instant.movable).read();
}

}  // namespace whit
