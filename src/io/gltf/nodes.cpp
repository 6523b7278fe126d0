#include "io/gltf/nodes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/index.h"
#include "core/options.h"
#include "core/text.h"

namespace whit {
namespace {

// Animated properties of a node. Properties without a track keep the value of the node itself.
struct GltfTracks {
  std::optional<Track> translation, rotation, scale;  // 3, 4 (x, y, z, w) and 3 components
  std::optional<Track> weights;                       // weights of its mesh's morph targets

  bool place() const { return translation || rotation || scale; }
};

struct Target {
  std::string_view path;
  std::size_t components;  // numbers in a key; 0: one for each morph target of the mesh
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

// Calls use(node, target, sampler) for each channel, except those without a node and those that
// move what only an extension can move.
template <typename Use>
void forEachChannel(const GltfDocument& document, const JsonValue& animation, const Use& use) {
  const JsonValue samplers = animation["samplers"];
  for (const JsonValue& channel : animation["channels"].elements()) {
    const JsonValue target = channel.need("target");
    const auto node = target["node"].indexInto(document.list("nodes"));
    const std::string path = target.need("path").textOr("");
    for (const Target& known : kTargets) {
      if (!node || known.path != path) continue;
      use(*node, known, samplers[channel.need("sampler").indexInto(samplers).value_or(0)]);
    }
  }
}

std::size_t morphTargets(const GltfDocument& document, std::size_t node) {
  const JsonValue meshes = document.list("meshes");
  const auto mesh = document.list("nodes")[node]["mesh"].indexInto(meshes);
  return mesh ? meshes[*mesh]["primitives"][std::size_t{0}]["targets"].size() : 0;
}

std::vector<double> readTimes(const GltfDocument& document, const JsonValue& input) {
  const std::vector<float> times = readTuples(document, input, 1);
  if (times.empty()) input.fail("at least one time", "none");
  for (const auto i : indices(times)) {
    if (std::isfinite(times[i]) && (i == 0 || times[i] > times[i - 1])) continue;
    input.fail("finite times that increase", formatted("%g at index %zu", double{times[i]}, i));
  }
  return {times.begin(), times.end()};
}

Track readTrack(const GltfDocument& document, const Target& target, std::size_t components,
                const JsonValue& sampler) {
  Track track;
  track.interpolation = interpolationOf(sampler);
  track.rotation = target.path == "rotation";
  track.components = components;
  track.times = readTimes(document, sampler.need("input"));

  // A cubic key has a tangent before its value and another one behind it.
  const JsonValue output = sampler.need("output");
  const std::vector<float> values =
      readTuples(document, output, std::max<std::size_t>(target.components, 1));
  const std::size_t each = track.interpolation == Track::Interpolation::cubic ? 3 : 1;
  const std::size_t expected = track.times.size() * components * each;
  if (values.size() != expected) {
    output.fail(concat(expected, " numbers for ", track.times.size(), " times"),
                std::to_string(values.size()));
  }
  if (!std::ranges::all_of(values, [](float x) { return std::isfinite(x); })) {
    output.fail("finite numbers", "one that is not");
  }
  track.values.assign(values.begin(), values.end());
  return track;
}

using AllTracks = std::vector<GltfTracks>;  // tracks of each node

AllTracks readTracks(const GltfDocument& document, const Instant& instant) {
  AllTracks tracks(document.list("nodes").size());
  if (!instant.moves()) return tracks;

  const std::vector<Animation> all = listGltfAnimations(document);
  const auto played = std::ranges::find_if(all, [&](const Animation& animation) {
    return instant.animation.empty() || animation.name == instant.animation;
  });
  if (played == all.end()) return tracks;

  const JsonValue source = document.list("animations")[played - all.begin()];
  forEachChannel(document, source,
                 [&](std::size_t node, const Target& target, const JsonValue& sampler) {
                   const std::size_t components =
                       target.components > 0 ? target.components : morphTargets(document, node);
                   if (components == 0) return;
                   tracks[node].*target.track = readTrack(document, target, components, sampler);
                 });
  return tracks;
}

constexpr double kLargestHeight = 1e9;  // largest height of an orthographic camera's view
constexpr char kLights[] = "KHR_lights_punctual";
constexpr std::size_t kTopmost = ~std::size_t{0};  // parent of a node without one

Vec3d tripleOr(const std::vector<double>& v, const Vec3d& fallback) {
  return v.empty() ? fallback : Vec3d{v[0], v[1], v[2]};
}

using Quaternion = std::array<double, 4>;

Affine rotationOf(const Quaternion& q) {
  const double norm = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  if (!(norm > 0) || !std::isfinite(norm)) return {};
  const double x = q[0], y = q[1], z = q[2], w = q[3], s = 2 / norm;
  return {{1 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w)},
          {s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w)},
          {s * (x * z + y * w), s * (y * z - x * w), 1 - s * (x * x + y * y)},
          {}};
}

// Returns the map of a matrix that is stored column by column.
Affine mapOf(const std::vector<double>& matrix) {
  const auto column = [&](std::size_t i) {
    return Vec3d{matrix[4 * i], matrix[4 * i + 1], matrix[4 * i + 2]};
  };
  return {column(0), column(1), column(2), column(3)};
}

// True if the map is finite and flattens nothing, as Scene::finalize() requires.
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

Affine placeAt(double seconds, NodePlace place, const GltfTracks& tracks) {
  const auto value = [&](const std::optional<Track>& track) {
    if (!track) return std::vector<double>();
    return valueAt(*track, seconds);
  };
  place.translation = tripleOr(value(tracks.translation), place.translation);
  place.scale = tripleOr(value(tracks.scale), place.scale);
  const std::vector<double> turn = value(tracks.rotation);
  std::ranges::copy(turn, place.rotation.begin());
  return place.map();
}

class TreeReader {
 public:
  TreeReader(const GltfDocument& document, AllTracks tracks, const std::set<std::string>& movable)
      : document_(document),
        nodes_(document.list("nodes")),
        tracks_(std::make_shared<const AllTracks>(std::move(tracks))),
        movable_(movable),
        seen_(nodes_.size()) {}

  GltfContent read() {
    findParents();
    for (const std::size_t root : roots()) visit(root, Affine(), kNoNode, 0);
    nameCameras();
    return std::move(content_);
  }

 private:
  void warn(const char* what, std::size_t node) {
    document_.warnings().add(what, nodes_[node].where());
  }

  void refuseDepth(std::size_t depth, std::size_t node) const {
    if (depth <= kGltfDepthLimit) return;
    throwBadScene(nodes_[node].where(), concat("nested deeper than ", kGltfDepthLimit, " nodes"));
  }

  // Notes the parent of each node. Nodes with two parents, or that are their own ancestors, are
  // refused by visit().
  void findParents() {
    parents_.assign(nodes_.size(), kTopmost);
    for (const auto i : indices(nodes_)) {
      for (const JsonValue& child : nodes_[i]["children"].elements()) {
        parents_[child.indexInto(nodes_).value_or(0)] = i;
      }
    }
  }

  std::vector<std::size_t> roots() const {
    const JsonValue scenes = document_.list("scenes");
    const auto scene = document_.root()["scene"].indexInto(scenes);
    std::vector<std::size_t> all;
    if (scenes.size() == 0) {
      for (const auto i : indices(parents_)) {
        if (parents_[i] == kTopmost) all.push_back(i);
      }
    }
    for (const JsonValue& node : scenes[scene.value_or(0)]["nodes"].elements()) {
      all.push_back(node.indexInto(nodes_).value_or(0));
    }
    return all;
  }

  void visit(std::size_t index, const Affine& toMover, std::uint32_t mover, std::size_t depth) {
    const JsonValue node = nodes_[index];
    refuseDepth(depth, index);
    if (seen_[index]) node.fail("a tree", "this node twice");
    seen_[index] = true;

    // A node that moves carries what is below it, so maps begin anew there.
    RigNode own = nodeOf(index);
    const Affine map = own.motion ? Affine() : toMover * own.toParent;
    if (own.motion) {
      document_.budget().charge(1, 2 * sizeof(RigNode), node.where());
      content_.movers.push_back({mover, toMover, std::move(own.motion), own.name});
      mover = size32(content_.movers) - 1;
    }

    if (!isUsable(map)) {
      warn("node that flattens space left out", index);
      return;
    }

    if (node["mesh"].exists()) placeMesh(index, map, mover);
    if (node["camera"].exists()) addCamera(index, map, mover);
    if (node["extensions"][kLights].exists()) addLight(index, map, mover);
    for (const JsonValue& child : node["children"].elements()) {
      visit(*child.indexInto(nodes_), map, mover, depth + 1);
    }
  }

  // Returns the node within its parent, with a transform or a motion.
  RigNode nodeOf(std::size_t index) const {
    const std::vector<double> matrix = nodes_[index]["matrix"].numbers(16);
    const std::string name = concat("/nodes/", index);

    RigNode node;
    if ((*tracks_)[index].place()) {
      const auto at = [index, own = placeOf(index), all = tracks_](double seconds) {
        return placeAt(seconds, own, (*all)[index]);
      };
      node.motion = std::make_shared<const Motion>(at);
    } else {
      node.toParent = matrix.empty() ? placeOf(index).map() : mapOf(matrix);
    }

    // A node that is moved by hand has a motion in any case.
    if (!movable_.contains(name)) return node;
    if (!node.motion) node.motion = fixedMotion(node.toParent);
    return {kNoNode, Affine(), node.motion, name};
  }

  NodePlace placeOf(std::size_t index) const {
    const JsonValue node = nodes_[index];
    NodePlace place{tripleOr(node["translation"].numbers(3), {}),
                    {0, 0, 0, 1},
                    tripleOr(node["scale"].numbers(3), {1, 1, 1})};
    const std::vector<double> turn = node["rotation"].numbers(4);
    std::ranges::copy(turn, place.rotation.begin());
    return place;
  }

  void placeMesh(std::size_t index, const Affine& map, std::uint32_t mover) {
    const JsonValue copies = nodes_[index]["extensions"]["EXT_mesh_gpu_instancing"];
    const std::size_t mesh = *nodes_[index]["mesh"].indexInto(document_.list("meshes"));
    const Deformation deformation = deformationOf(index, mesh);
    if (deformation.skeleton) {
      // Joints alone place the mesh, so that its copies would all be in one place.
      if (copies.exists()) warn("copies of a skinned mesh left out", index);
      content_.meshes.push_back({mesh, Affine(), kNoNode, deformation, index});
      return;
    }
    if (!copies.exists()) {
      content_.meshes.push_back({mesh, map, mover, deformation, index});
      return;
    }

    for (const Affine& copy : readCopies(copies.need("attributes"))) {
      const Affine toMover = map * copy;
      if (isUsable(toMover)) {
        content_.meshes.push_back({mesh, toMover, mover, deformation, index});
      } else {
        warn("copy of a mesh that is flattened left out", index);
      }
    }
  }

  Deformation deformationOf(std::size_t index, std::size_t mesh) {
    const JsonValue node = nodes_[index];
    Deformation deformation;
    if (const auto skin = node["skin"].indexInto(document_.list("skins"))) {
      deformation = skinOf(*skin, index);
      document_.budget().charge(deformation.joints.size(), sizeof(Deformation::Joint),
                                node.where());
    }
    deformation.weights = node["weights"].numbers();
    if (deformation.weights.empty()) {
      deformation.weights = document_.list("meshes")[mesh]["weights"].numbers();
    }
    deformation.movingWeights = (*tracks_)[index].weights;
    return deformation;
  }

  // Reads a skin. Its joints may come later in the tree than the meshes they hold. One more joint
  // is added at the end, the node `showing` that shows the mesh: it holds vertices without weights.
  Deformation skinOf(std::size_t index, std::size_t showing) {
    const JsonValue skin = document_.list("skins")[index];
    const JsonValue joints = skin.need("joints"), inverse = skin["inverseBindMatrices"];
    Deformation deformation;
    std::vector<Deformation::Joint>& all = deformation.joints;
    Rig rig;
    std::map<std::size_t, std::uint32_t> places;

    for (const JsonValue& joint : joints.elements()) {
      all.push_back({placeJoint(joint.indexInto(nodes_).value_or(0), places, rig), Affine()});
    }
    if (all.empty()) joints.fail("at least one joint");

    // Each joint has a matrix that maps the mesh into the joint's space.
    std::vector<float> numbers;
    if (inverse.exists()) numbers = readTuples(document_, inverse, 16);
    if (inverse.exists() && numbers.size() < 16 * all.size()) {
      inverse.fail(concat("a matrix for each of ", all.size(), " joints"),
                   std::to_string(numbers.size() / 16));
    }
    for (std::size_t i = 0; i < all.size() && !numbers.empty(); ++i) {
      all[i].fromMesh = mapOf({numbers.begin() + 16 * i, numbers.begin() + 16 * (i + 1)});
    }

    all.push_back({placeJoint(showing, places, rig), Affine()});
    deformation.skeleton = std::make_shared<const Rig>(std::move(rig));
    return deformation;
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

    // The chain leads from the node to its topmost ancestor, and the rig has parents first.
    for (auto at = chain.rbegin(); at != chain.rend(); ++at) {
      document_.budget().charge(1, 2 * sizeof(RigNode), document_.name());
      RigNode node = nodeOf(*at);
      if (parents_[*at] != kTopmost) node.parent = places.at(parents_[*at]);
      places[*at] = size32(rig);
      rig.push_back(std::move(node));
    }
    return places.at(index);
  }

  // Reads the places of copies of a mesh within its node (EXT_mesh_gpu_instancing).
  std::vector<Affine> readCopies(const JsonValue& attributes) const {
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
        attributes.fail("attributes of equal lengths", concat(size, " beside ", count));
      }
    }

    document_.budget().charge(count, 2 * sizeof(GltfPlacedMesh) + sizeof(Instance),
                              attributes.where());

    std::vector<Affine> copies;
    for (const auto i : indices(count)) {
      Quaternion turn{0, 0, 0, 1};
      if (turns > 0) std::copy_n(&rotations[4 * i], 4, turn.begin());
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

    if (!shows) {
      warn("camera of an unknown type or without an extent left out", index);
      return;
    }

    camera.name = node["name"].textOr("");
    if (camera.name.empty()) camera.name = source["name"].textOr("");
    if (camera.name.empty()) camera.name = "camera";

    camera.aspect = static_cast<float>(std::clamp(aspect, 0.0, kLargestAspect));
    if (content_.cameras.empty()) content_.aspect = aspect;
    content_.cameras.push_back({camera, map, mover});
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
      setCone(source.need("spot"), light);
    } else if (type == "directional") {
      light.kind = Light::Kind::directional;
    } else if (type != "point") {
      warn("light of an unknown type left out", index);
      return;
    }

    if (source["range"].numberOr(0) > 0 && light.kind != Light::Kind::directional) {
      warn("light's range left out, it shines on", index);
    }
    const Vec3d color = tripleOr(source["color"].numbers(3), Vec3d(1.0));
    light.intensity = Rgb(color * (source["intensity"].numberOr(1) / kLumensPerWatt));
    content_.lights.push_back({light, map, mover});
  }

  // Makes the names of the cameras distinct, because a camera is chosen by its name.
  void nameCameras() {
    std::vector<std::string> names;
    for (const auto& placed : content_.cameras) names.push_back(placed.thing.name);
    names = distinctNames(names);
    for (const auto i : indices(names)) content_.cameras[i].thing.name = names[i];
  }

  // Sets the cone of a spot light. Equal angles, which mean a sharp edge, are accepted: the
  // extension forbids them, but some programs write them.
  static void setCone(const JsonValue& spot, Light& light) {
    constexpr double kRightAngle = std::numbers::pi / 2, kLeastOuter = std::numbers::pi / 360;
    const double outerAngle = spot["outerConeAngle"].numberOr(std::numbers::pi / 4);
    const double outer = std::clamp(outerAngle, kLeastOuter, kRightAngle);
    const double inner = std::clamp(spot["innerConeAngle"].numberOr(0), 0.0, outer);
    light.outerConeAngle = static_cast<float>(outer * 180 / std::numbers::pi);
    light.innerConeAngle = std::min(static_cast<float>(inner * 180 / std::numbers::pi),
                                    std::nextafter(light.outerConeAngle, 0.0f));
  }

  const GltfDocument& document_;
  JsonValue nodes_;
  std::shared_ptr<const AllTracks> tracks_;
  const std::set<std::string>& movable_;
  std::vector<std::size_t> parents_;
  std::vector<bool> seen_;
  GltfContent content_;
};

// Returns the time of the last key. Its accessor should state it, but some files leave it out.
double lastTime(const GltfDocument& document, const JsonValue& input) {
  const JsonValue most = accessorOf(document, input)["max"];
  if (most.size() > 0) return most[0].numberOr(0);

  double last = 0;
  for (const float time : readTuples(document, input, 1)) last = std::fmax(last, double{time});
  return last;
}

}  // namespace

std::vector<Animation> listGltfAnimations(const GltfDocument& document) {
  const JsonValue animations = document.list("animations");
  std::vector<std::string> names;
  for (const auto i : indices(animations)) {
    const std::string name = animations[i]["name"].textOr("");
    names.push_back(name.empty() ? concat("animation ", i) : name);
  }
  names = distinctNames(names);

  std::vector<Animation> all;
  for (const auto i : indices(names)) {
    std::set<std::size_t> moved;
    double last = 0;  // the time of the last key of all samplers in use
    forEachChannel(document, animations[i],
                   [&](std::size_t node, const Target&, const JsonValue& sampler) {
                     moved.insert(node);
                     last = std::max(last, lastTime(document, sampler.need("input")));
                   });
    all.push_back({names[i], last, moved.size()});
  }
  return all;
}

GltfContent readGltfNodes(const GltfDocument& document, const Instant& instant) {
  return TreeReader(document, readTracks(document, instant), instant.movable).read();
}

}  // namespace whit
