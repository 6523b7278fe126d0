#include "io/gltf/deformation.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "io/gltf/accessor.h"

namespace whit {

namespace {

class DeformationReader {
 public:
  DeformationReader(const GltfDocument& document, const GltfValue& primitive,
                    const GltfDeformation& given, const Mesh& mesh)
      : document_(document), primitive_(primitive), given_(given), where_(primitive.where()) {
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

  static void checkLength(std::size_t found, std::size_t expected, const GltfValue& attribute) {
    if (found == expected) return;
    attribute.fail("as many as positions, " + std::to_string(expected) + ", found " +
                   std::to_string(found));
  }

  // Reads the targets that have a weight at some time.
  void readTargets() {
    const GltfValue targets = primitive_["targets"];
    result_.targets.resize(targets.size());
    for (std::size_t i = 0; i < targets.size(); ++i) {
      const bool weighs = i < given_.weights.size() && given_.weights[i] != 0;
      if (!weighs && !given_.movingWeights) continue;
      result_.targets[i] = {vectors(targets[i]["POSITION"], result_.positions.size()),
                            vectors(targets[i]["NORMAL"], result_.normals.size())};
    }
  }

  std::vector<Vec3f> vectors(const GltfValue& attribute, std::size_t expected) const {
    if (!attribute.exists() || expected == 0) return {};
    std::vector<Vec3f> moved = readVectors(document_, attribute);
    checkLength(moved.size(), expected, attribute);
    return moved;
  }

  void readSkin() {
    const std::size_t count = result_.positions.size();
    std::vector<std::vector<float>> joints, weights;
    for (int set = 0;; ++set) {
      const GltfValue attributes = primitive_["attributes"];
      const GltfValue j = attributes["JOINTS_" + std::to_string(set)];
      const GltfValue w = attributes["WEIGHTS_" + std::to_string(set)];
      if (!j.exists() || !w.exists()) break;
      joints.push_back(readTuples(document_, j, "VEC4"));
      weights.push_back(readTuples(document_, w, "VEC4"));
      checkLength(joints.back().size() / 4, count, j);
      checkLength(weights.back().size() / 4, count, w);
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
  GltfValue primitive_;
  const GltfDeformation& given_;
  std::string where_;
  Deformation result_;
};

}  // namespace

bool GltfDeformation::none() const {
  return !skeleton && !movingWeights &&
         std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 0; });
}

void deform(const GltfDocument& document, const GltfValue& primitive,
            const GltfDeformation& deformation, Mesh& mesh) {
  Deformation own = DeformationReader(document, primitive, deformation, mesh).read();
  DeformedVertices start = deformVertices(own, poseAt(own, 0));
  mesh.positions = std::move(start.positions);
  mesh.normals = std::move(start.normals);
  if (start.mirrored) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  if (own.moves()) mesh.deformation = std::make_shared<const Deformation>(std::move(own));
}

}  // namespace whit
