#include "io/gltf/deformation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/error.h"
#include "io/gltf/accessor.h"

namespace whit {

namespace {

using Attributes = std::map<std::string, int>;

class DeformationReader {
 public:
  DeformationReader(const GltfDocument& document, const tinygltf::Primitive& primitive,
                    const GltfDeformation& given, const std::string& where, const Mesh& mesh)
      : document_(document), primitive_(primitive), given_(given), where_(where) {
    document_.budget().charge(2 * (mesh.positions.size() + mesh.normals.size()), sizeof(Vec3d),
                              where_);
    result_.positions = mesh.positions;
    result_.normals = mesh.normals;
    result_.weights = given.weights;
    result_.movingWeights = given.movingWeights;
  }

  Deformation read() {
    readTargets();
    if (given_.skeleton) readSkin();
    return std::move(result_);
  }

 private:
  void warn(const char* what) const { document_.warnings().add(what, where_); }

  static int accessorOf(const Attributes& attributes, const std::string& name) {
    const auto found = attributes.find(name);
    return found == attributes.end() ? -1 : found->second;
  }

  void checkLength(std::size_t found, std::size_t expected, const std::string& name) const {
    if (found == expected) return;
    throwBadScene(where_ + name, "expected as many as positions, " + std::to_string(expected) +
                                     ", found " + std::to_string(found));
  }

  // Those that have a weight at some time.
  void readTargets() {
    result_.targets.resize(primitive_.targets.size());
    for (std::size_t i = 0; i < primitive_.targets.size(); ++i) {
      const bool weighs = i < given_.weights.size() && given_.weights[i] != 0;
      if (!weighs && !given_.movingWeights) continue;
      const Attributes& target = primitive_.targets[i];
      result_.targets[i] = {vectors(target, "POSITION", result_.positions.size()),
                            vectors(target, "NORMAL", result_.normals.size())};
    }
  }

  std::vector<Vec3f> vectors(const Attributes& target, const std::string& name,
                             std::size_t expected) const {
    const int accessor = accessorOf(target, name);
    if (accessor < 0 || expected == 0) return {};
    if (static_cast<std::size_t>(accessor) >= document_.model().accessors.size()) {
      warn("morph target that cannot be read left out");
      return {};
    }
    std::vector<Vec3f> moved = readVectors(document_, static_cast<std::size_t>(accessor));
    checkLength(moved.size(), expected, "/targets");
    return moved;
  }

  void readSkin() {
    const std::size_t count = result_.positions.size();
    std::vector<std::vector<float>> joints, weights;
    for (int set = 0;; ++set) {
      const int j = accessorOf(primitive_.attributes, "JOINTS_" + std::to_string(set));
      const int w = accessorOf(primitive_.attributes, "WEIGHTS_" + std::to_string(set));
      if (j < 0 || w < 0) break;
      joints.push_back(fours(j));
      weights.push_back(fours(w));
      checkLength(joints.back().size() / 4, count, "/attributes/JOINTS");
      checkLength(weights.back().size() / 4, count, "/attributes/WEIGHTS");
    }
    if (joints.empty())
      return warn("skinned mesh without joints and weights shown as it was modelled");
    result_.skeleton = given_.skeleton;
    result_.joints = given_.joints;
    document_.budget().charge(count, sizeof(std::uint32_t) + 4 * joints.size() * sizeof(Influence),
                              where_);
    result_.firstInfluence.push_back(0);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t set = 0; set < joints.size(); ++set) {
        for (std::size_t k = 4 * i; k < 4 * i + 4; ++k) hold(joints[set][k], weights[set][k]);
      }
      closeVertex();
    }
  }

  std::vector<float> fours(int accessor) const {
    return readTuples(document_, static_cast<std::size_t>(accessor), TINYGLTF_TYPE_VEC4);
  }

  void hold(float joint, double weight) {
    if (!(weight > 0)) return;
    if (joint >= 0 && joint < static_cast<float>(result_.joints.size())) {
      result_.influences.push_back({static_cast<std::uint32_t>(joint), weight});
    } else {
      warn("joint that the skin does not have left out");
    }
  }

  void closeVertex() {
    std::vector<Influence>& all = result_.influences;
    double sum = 0;
    for (std::size_t i = result_.firstInfluence.back(); i < all.size(); ++i) sum += all[i].weight;
    if (!(sum > 0) || !std::isfinite(sum)) {
      warn("vertex that no joint holds left where it was modelled");
      all.resize(result_.firstInfluence.back());
    }
    result_.firstInfluence.push_back(static_cast<std::uint32_t>(all.size()));
  }

  const GltfDocument& document_;
  const tinygltf::Primitive& primitive_;
  const GltfDeformation& given_;
  const std::string& where_;
  Deformation result_;
};

}  // namespace

bool GltfDeformation::none() const {
  return !skeleton && !movingWeights &&
         std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 0; });
}

void deform(const GltfDocument& document, const tinygltf::Primitive& primitive,
            const GltfDeformation& deformation, const std::string& where, Mesh& mesh) {
  Deformation own = DeformationReader(document, primitive, deformation, where, mesh).read();
  DeformedVertices start = deformVertices(own, poseAt(own, 0));
  mesh.positions = std::move(start.positions);
  mesh.normals = std::move(start.normals);
  if (start.mirrored) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  if (own.moves()) mesh.deformation = std::make_shared<const Deformation>(std::move(own));
}

}  // namespace whit
